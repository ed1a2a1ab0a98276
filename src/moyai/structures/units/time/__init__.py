"""The row of units in time: memory of the water, integration with nonlinear connectors and lines, seas."""
