"""Where parameters of the physics stand in the case file."""

KEYS = {
    "floats": "structure.floats",
    "mooring": "structure.mooring",
}
