"""Files that describe net tests: schema, and the campaign that they state."""
