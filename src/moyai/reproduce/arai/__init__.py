"""Arai and others: forces and circulation on horizontal members at low Keulegan-Carpenter numbers."""

from moyai.reproduce.arai.figures import PLOTTED, figures
from moyai.reproduce.arai.runs import run
from moyai.reproduce.arai.statements import STATEMENTS, filled
from moyai.reproduce.model import Equation, Paper

EQUATIONS = (
    Equation("1", "horizontal force by Morison", ("moyai.morison.forces.strip_forces",)),
    Equation("2", "vertical force by Morison", ("moyai.morison.forces.strip_forces",)),
    Equation("3", "inertia coefficient of Chaplin, 2 - 0.21 KC^2", ("moyai.morison.circulation.settled_circulation",)),
    Equation(
        "4",
        "inertia coefficient of Otsuka and Ikeda, 2 - (2/pi^2) KC^2",
        ("moyai.morison.circulation.settled_circulation",),
    ),
    Equation("5", "fall of the inertia coefficient", ("moyai.morison.circulation.inertia_reduction",)),
    Equation("6", "lift rho V Gamma, to the left of the flow", ("moyai.morison.circulation.magnus_force",)),
    Equation(
        "7",
        "circulation 18 KC^2 in cm2/s",
        ("moyai.morison.circulation.settled_circulation", "moyai.records.streaks.circulation_law.fit_circulation_law"),
        "the printed unit, cm2 times s, is wrong: only cm2/s gives (8) to (10). Without dimension Gamma = 0.936 V^2 T",
    ),
    Equation("8", "fall of the circle, 0.19 KC^2", ("moyai.morison.circulation.inertia_reduction",)),
    Equation("9", "fall of the square, 0.15 KC^2", ("moyai.morison.circulation.inertia_reduction",)),
    Equation("10", "fall of the rectangle, 0.28 KC^2", ("moyai.morison.circulation.inertia_reduction",)),
)

PAPER = Paper(
    key="arai",
    authors="S. Arai and others",
    year="1990s",
    title="Fall of the inertia force and circulating flow on horizontal members in regular waves at low KC",
    journal="Proceedings of coastal engineering, Japan",
    line="horizontal members at low KC: fall of the inertia force, circulation and lift of circle, square and "
    "rectangle",
    equations=EQUATIONS,
    statements=STATEMENTS,
    plotted=PLOTTED,
    run=run,
    figures=figures,
    filled=filled,
)
