"""Where parameters of the physics stand in the case file."""

KEYS = {
    "breakwater": "structure",
    "coefficients_file": "structure.coefficients_file",
    "current_drag_coefficient": "structure.current_drag_coefficient",
    "draught": "structure.draught",
    "mass": "structure.mass",
    "section": "structure.section",
    "wind_drag_coefficient": "structure.wind_drag_coefficient",
}
