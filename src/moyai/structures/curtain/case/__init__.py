"""Case files of silt curtains: schema, checks, and the problem that they state."""
