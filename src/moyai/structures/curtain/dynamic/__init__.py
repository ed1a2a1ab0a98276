"""The whole span through time, as a network of cables and sheets."""
