"""Report of force records."""
