"""Reports of floating breakwaters."""
