"""Mooring lines in motion: their network, their water, their drag, and events of irregular seas."""
