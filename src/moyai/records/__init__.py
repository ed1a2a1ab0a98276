"""Measured records: reading them, and what is found in surveys, force tests, net tests and streak images."""
