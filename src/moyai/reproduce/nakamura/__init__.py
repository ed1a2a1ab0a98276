"""Nakamura, Ohmori and Ide: the chain-moored floating breakwater under drift and damping."""

from moyai.reproduce.model import Paper
from moyai.reproduce.nakamura.equations import EQUATIONS
from moyai.reproduce.nakamura.figures import PLOTTED, figures
from moyai.reproduce.nakamura.filled import filled
from moyai.reproduce.nakamura.runs import run
from moyai.reproduce.nakamura.statements import STATEMENTS

PAPER = Paper(
    key="nakamura",
    authors="T. Nakamura, S. Ohmori and Y. Ide",
    year="1990s",
    title="Effect of Wave Drift and Damping Forces on the Dynamics of a Floating Breakwater",
    journal="Proceedings on ocean development, Japan",
    line="moored floating breakwater: motions, drift, line stiffness, transmission and reflection in both domains",
    equations=EQUATIONS,
    statements=STATEMENTS,
    plotted=PLOTTED,
    run=run,
    figures=figures,
    filled=filled,
)
