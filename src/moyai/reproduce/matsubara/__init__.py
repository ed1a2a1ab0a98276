"""Matsubara, Noda and Nishihira: drag of nets and the answer of a moored net cage to waves."""

from moyai.reproduce.matsubara.figures import PLOTTED, figures
from moyai.reproduce.matsubara.filled import filled
from moyai.reproduce.matsubara.runs import run
from moyai.reproduce.matsubara.statements import STATEMENTS
from moyai.reproduce.model import Equation, Paper

_MOTION = "moyai.structures.cage.rigid.time.march"
_PRINTED = "moyai.structures.cage.rigid.literal.literal_pack"

EQUATIONS = (
    Equation("1", "drag coefficient on the area of the twines", ("moyai.records.nets.towing.tow_coefficients",)),
    Equation("2", "drag law of all nets, C_d = 9.84 Re^-0.36", ("moyai.morison.net_laws.matsubara.Matsubara",)),
    Equation(
        "3",
        "motion along the waves",
        (_MOTION, _PRINTED),
        "as printed the mass is the weight in water, the volume that of the whole cage, and the signs of the "
        "lines hold only "
        "when they cross; read as: dry mass, solid volume, lines along their own direction",
    ),
    Equation(
        "4",
        "vertical motion",
        (_MOTION, _PRINTED),
        "printed with a constant buoyancy and the axis named y; read as: buoyancy of the wet part of each float",
    ),
    Equation(
        "5",
        "rotation about the centre of gravity",
        (_MOTION, _PRINTED),
        "the print leaves out the vertical forces of lines, floats and water, and one lever is exchanged; "
        "read as: moments of "
        "all parts",
    ),
)

PAPER = Paper(
    key="matsubara",
    authors="Y. Matsubara, H. Noda and F. Nishihira",
    year="1990s",
    title="Dynamic response of an offshore fish cage to waves",
    journal="Proceedings of coastal engineering, Japan",
    line="net cage: drag of wire nets, motions, rotation and line tensions on taut and slack moorings",
    equations=EQUATIONS,
    statements=STATEMENTS,
    plotted=PLOTTED,
    run=run,
    figures=figures,
    filled=filled,
)
