"""Where parameters of the physics stand in the case file."""

KEYS = {
    "bodies": "structure.bodies",
    "lines": "structure.lines",
    "motions": "structure.motions",
    "nets": "structure.nets",
    "points": "structure.points",
    "sheets": "structure.sheets",
}
