"""Tabata and others: field record of the mooring forces of a curtain of new construction."""

from moyai.reproduce.model import Equation, Paper
from moyai.reproduce.tabata.figures import PLOTTED, figures
from moyai.reproduce.tabata.runs import run
from moyai.reproduce.tabata.statements import STATEMENTS, filled

_SEAS = "moyai.structures.curtain.seas"

EQUATIONS = (
    Equation(
        "1",
        "squared velocity of waves and current over the curtain's depth",
        (f"{_SEAS}.squared_velocity.squared_velocity",),
        "the print has U h omega in the cross term, which has no height; it is U H omega. It is the mean over "
        "the depth at the "
        "crest, not in time",
    ),
    Equation(
        "2", "wave height corrected by direction, 1.8 H_1/3 cos^2", (f"{_SEAS}.squared_velocity.effective_height",)
    ),
    Equation("3", "largest speed of the float", (f"{_SEAS}.anchor_energy.EnergyModel.float_speed",)),
    Equation("4", "kinetic energy of the float", (f"{_SEAS}.anchor_energy.EnergyModel.fluctuating_tension",)),
    Equation(
        "5",
        "balance with the energy of the rope",
        (f"{_SEAS}.anchor_energy.EnergyModel.fluctuating_tension", f"{_SEAS}.anchor_energy.calibrate"),
        "M = 0.2 would be a negative added mass: it is a share of energy that reaches the rope, or K = 890 kN/m is "
        "the force of a strain of one, 890 kN, and M is 9.2",
    ),
)

PAPER = Paper(
    key="tabata",
    authors="C. Tabata and others",
    year="about 2000",
    title="Field observation of mooring forces of a silt curtain of new construction",
    journal="Proceedings of coastal engineering, Japan",
    line="curtain in the field: anchor tensions under waves and current, direction, energy model, a typhoon",
    equations=EQUATIONS,
    statements=STATEMENTS,
    plotted=PLOTTED,
    run=run,
    figures=figures,
    filled=filled,
)
