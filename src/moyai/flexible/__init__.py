"""Flexible networks: lines, nets and all that hangs, floats and snaps, from rest to the peak of a snap load."""
