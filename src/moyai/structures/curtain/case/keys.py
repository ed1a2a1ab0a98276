"""Where parameters of the physics stand in the case file."""

KEYS = {
    "anchors": "structure.anchors",
    "anchors.length": "structure.anchors.line_length",
    "draught": "settings.impact.draught",
    "floats": "structure.floats",
    "length": "structure.length",
    "plan.flow_angle": "current",
    "plan.length": "structure.length",
    "plan.load": "current",
    "position": "settings.impact.release_position",
    "skirt.chord": "settings.impact.chord",
    "skirt.length": "structure.skirt.length",
    "skirt.stiffness": "structure.skirt.stiffness",
    "skirt.toe_load": "structure.toe",
}
