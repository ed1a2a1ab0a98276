"""Reports of net cages."""
