"""Similarity of models: scale laws by solvers in both sizes, springs in series, a case file there and back."""

from __future__ import annotations

import tempfile
from pathlib import Path

from moyai.core.validation import ValidationCase
from moyai.design.model_needs import model_need
from moyai.design.similarity import Scale, cauchy_number, scale_quantities, scale_water
from moyai.mooring.catenary import solve_catenary
from moyai.sea.water import Water
from moyai.structures.curtain.impact.cable import Impact, peak_by_energy

_SEA = Water(12.0, 1025.0, 9.81)
_SCALE = Scale(26.0, 1.025, 1.0)


def _impact_ratio() -> float:
    """Return the tension of a curtain over that of its model, over the ratio of forces."""
    figures = {
        "span": (20.0, "m"),
        "length": (23.0, "m"),
        "draught": (5.0, "m"),
        "upper_stiffness": (3e6, "N"),
        "lower_stiffness": (2e6, "N"),
        "speed": (0.3, "m/s"),
    }
    rows = scale_quantities(figures, _SCALE)
    large = Impact(water=_SEA, **{row.name: row.prototype for row in rows})
    small = Impact(water=scale_water(_SEA, _SCALE), **{row.name: row.model for row in rows})
    return _SCALE.to_prototype(peak_by_energy(small).tension, "N") / peak_by_energy(large).tension


def _chain_ratio() -> float:
    """Return the same of the horizontal tension of an elastic chain that lies on the bed."""
    figures = {"x": (60.0, "m"), "z": (8.0, "m"), "l": (62.0, "m"), "EA": (3e7, "N"), "w": (500.0, "N/m")}
    rows = scale_quantities(figures, _SCALE)
    large = solve_catenary(*(row.prototype for row in rows))
    small = solve_catenary(*(row.model for row in rows))
    return _SCALE.to_prototype(float(small.horizontal_tension), "N") / float(large.horizontal_tension)


def _spring() -> float:
    """Return EA of a line too stiff with its spring in series over EA wanted."""
    row = scale_quantities({"EA": (890.0, "kN")}, _SCALE)[0]
    spring = float(model_need(row, 2.0, "kN", _SCALE, line_length=46.0).remedy.split()[2])
    length = 46.0 / _SCALE.length
    return length / (length / 2000.0 + 1.0 / spring) / (1e3 * row.model)


def _case_there_and_back() -> float:
    """Return the draught of a case file that went to a model of 1:26 and back."""
    from moyai.case.reader import load_case
    from moyai.case.templates import template
    from moyai.study.scaled_case import scale_case

    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "pontoon.yaml"
        path.write_text(template("breakwater"), encoding="utf-8")
        there = scale_case(load_case(path), _SCALE, digits=17)
        back = scale_case(there.case, _SCALE, from_model=True, digits=17)
    return float(back.case.model.structure.draught)


CASES: tuple[ValidationCase, ...] = (
    ValidationCase(
        "similarity: impact tension of a curtain, 1:26 in fresh water", "similarity, S^3 rho", _impact_ratio, 1.0, 1e-11
    ),
    ValidationCase("similarity: chain on the bed, 1:26 in fresh water", "similarity, S^3 rho", _chain_ratio, 1.0, 1e-9),
    ValidationCase(
        "similarity: elastic number C_E of prototype and model",
        "similarity, equation (8) of Sawaragi, Aoki and Liu (1991)",
        lambda: cauchy_number(_SCALE.to_model(4e7, "N"), scale_water(_SEA, _SCALE)) / cauchy_number(4e7, _SEA),
        1.0,
        1e-13,
    ),
    ValidationCase(
        "similarity: line with a spring in series", "springs in series", _spring, 1.0, 1e-5, note="five digits given"
    ),
    ValidationCase(
        "similarity: draught of a case file after 1:26 and back [m]", "the file given", _case_there_and_back, 3.0, 1e-13
    ),
)
