"""Flexible net cages: collar, net, weights and grid mooring as a network."""
