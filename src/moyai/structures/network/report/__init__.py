"""Reports of networks."""
