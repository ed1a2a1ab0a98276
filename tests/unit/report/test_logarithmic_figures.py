"""Logarithmic axes on paper: labels are numbers, not markup."""

from __future__ import annotations

import numpy as np

from moyai.report.document import Abscissa, Figure, Panel, Series
from moyai.report.figures_static import draw_figure


def test_labels_of_powers_are_plain_numbers():
    x = np.geomspace(30.0, 3000.0, 20)
    figure = Figure(
        "drag", "Drag", (Abscissa("re", "Re", log=True),), (Panel("C_D"),), (Series("law", {"re": x}, 9.84 * x**-0.36),)
    )
    svg = draw_figure(figure).decode()
    assert "mathdefault" not in svg
    assert "1000" in svg
