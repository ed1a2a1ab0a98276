"""Floating breakwaters: the model, its analyses and its checks."""
