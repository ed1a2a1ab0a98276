"""Where parameters of the physics stand in the case file."""

KEYS = {
    "coefficients_file": "structure.coefficients_file",
    "connectors": "structure.connectors",
    "draught": "structure.draught",
    "kind": "structure.kind",
    "section": "structure.section",
    "units": "structure.units",
}
