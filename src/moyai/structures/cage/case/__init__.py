"""Case files of net cages: schema, checks, and the problem that they state."""
