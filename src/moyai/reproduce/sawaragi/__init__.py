"""Sawaragi, Aoki and Liu: impact tension of a curtain that comes taut in a current."""

from moyai.reproduce.model import Equation, Paper
from moyai.reproduce.sawaragi.figures import PLOTTED, figures
from moyai.reproduce.sawaragi.runs import run
from moyai.reproduce.sawaragi.statements import STATEMENTS, filled

_STATICS = "moyai.structures.curtain.statics.closed_forms"
_IMPACT = "moyai.structures.curtain.impact"

EQUATIONS = (
    Equation("1", "added mass of the flat skirt, 2 rho d^2/pi", (f"{_IMPACT}.added_mass.flat_skirt_mass",)),
    Equation(
        "2",
        "tension of the skirt under even pressure",
        (f"{_STATICS}.solve_skirt_arc",),
        "printed with sinh; the arc of a circle needs sin",
    ),
    Equation("3", "load of the skirt on each cable", (f"{_STATICS}.solve_skirt_arc",)),
    Equation("4", "tension of the cable with stretch", (f"{_STATICS}.solve_cable",)),
    Equation(
        "5",
        "deflection of the cable",
        (f"{_STATICS}.solve_cable",),
        "printed with sinh in the second term, which is uneven; cosh closes at the supports",
    ),
    Equation("6", "tension of the cable without stretch", (f"{_STATICS}.cable_shape_number",)),
    Equation("7", "tension coefficient and the numbers it depends on", (f"{_IMPACT}.cable.impact_numbers",)),
    Equation("8", "scale of the stiffness of the cable, S^-3", ("moyai.design.similarity.Scale",)),
)

PAPER = Paper(
    key="sawaragi",
    authors="T. Sawaragi, S. Aoki and H. Liu",
    year="1991",
    title="The modelization of impact tensional force on floating silt curtains",
    journal="Proceedings on ocean development 7, 95-100",
    line="silt curtain: impact tension in a current, added mass of the skirt, similarity of cables",
    equations=EQUATIONS,
    statements=STATEMENTS,
    plotted=PLOTTED,
    run=run,
    figures=figures,
    filled=filled,
)
