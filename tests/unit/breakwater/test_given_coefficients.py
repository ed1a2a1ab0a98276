"""Coefficients of another program in place of the section: the section's own, handed over as such, change nothing."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from moyai.core.errors import InputError
from moyai.structures.breakwater.assembly import assemble
from moyai.structures.breakwater.hydrodynamics import solve_unit
from moyai.structures.breakwater.run import run

FAR_FIELD = ("reflection_coefficient", "transmission_coefficient", "radiated_wave")


def without_far_field(problem):
    def coefficients(unit):
        own = solve_unit(unit, problem).per_metre
        return own.drop_vars([name for name in own.data_vars if name in FAR_FIELD or "lid" in name or "Froude" in name])

    return coefficients


@pytest.mark.slow
def test_same_motions_as_the_section_without_drift(pontoon_problem):
    problem = replace(pontoon_problem, settings=pontoon_problem.settings.changed(drift=False))
    section = run(problem).tree
    given = run(problem, coefficients=without_far_field(problem)).tree
    for group in ("SWL/frequency/waves", "SWL/time/waves"):
        ours, theirs = section[group].to_dataset(), given[group].to_dataset()
        # in time the damping of a 3-D body is taken to vanish at zero frequency, which that of a section does not
        within = 1e-6 if "frequency" in group else 5e-3
        assert theirs.motion_amplitude.values == pytest.approx(ours.motion_amplitude.values, rel=within, abs=1e-9)
        assert theirs.line_tension_maximum.values == pytest.approx(ours.line_tension_maximum.values, rel=within)
    assert "reflection_coefficient" not in given["SWL/frequency/waves"]


def test_missing_heading_is_refused(pontoon_problem):
    sea = replace(pontoon_problem.environment.sea_states[0], heading=np.radians(20.0))
    problem = replace(pontoon_problem, environment=replace(pontoon_problem.environment, sea_states=(sea,)))
    unit = assemble(problem, "SWL", 0.0)
    with pytest.raises(InputError, match="no heading of 20 degrees"):
        solve_unit(unit, problem, coefficients=without_far_field(pontoon_problem))
