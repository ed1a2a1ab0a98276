"""Submerged members: the model of a case, its analyses and its checks."""
