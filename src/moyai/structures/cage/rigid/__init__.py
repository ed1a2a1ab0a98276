"""Rigid net cages of small models: floats, net panels and lines as one body."""
