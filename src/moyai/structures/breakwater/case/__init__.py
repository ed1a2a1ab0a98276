"""Case files of floating breakwaters: schema, checks, and the problem that they state."""
