"""Where parameters of the physics stand in the case file."""

KEYS = {
    "start": "structure.start",
}
