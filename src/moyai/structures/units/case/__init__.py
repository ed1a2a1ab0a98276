"""Case files of floating rows of units: schema, checks, and the problem that they state."""
