"""Case files of networks: schema, checks, and the problem that they state."""
