"""Case files of submerged members: schema, checks, and the problem that they state."""
