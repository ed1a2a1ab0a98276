"""Reports of silt curtains."""
