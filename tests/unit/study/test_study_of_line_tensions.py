"""Lines of any kind of structure held against codes: found by the common names, wave by wave."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import xarray as xr

from moyai.cli.runner import run
from moyai.study.assess import assess
from moyai.study.execute import run_study
from moyai.study.plan import load_study
from moyai.study.responses import kept, largest_tensions

CAGE = Path(__file__).parents[3] / "src" / "moyai" / "reproduce" / "cases" / "matsubara" / "taut.yaml"
STUDY = f"""moyai: 1
study:
  title: Lines of the cage in the flume
  base: {CAGE}
  set:
    analyses: [statics, time]
    waves: [{{name: swell, kind: regular, height: 3 cm, periods: [1.2], heading_deg: 0}}]
    structure.mooring.breaking_load: 50 N
    settings.rigid: {{periods: 8, settled_periods: 2, tolerance: 1e-3}}
  variations:
    - grid: {{'waves[swell].height': [2 cm, 3 cm]}}
  assess:
    lines: {{codes: {{name: own rule, analysis: dynamic, safety_factor_intact: 2}}}}
"""


def test_the_lines_of_a_rigid_cage_are_held_against_a_code(tmp_path: Path) -> None:
    path = tmp_path / "study.yaml"
    path.write_text(STUDY, encoding="utf-8")
    study = load_study(path)
    result = assess(study, run_study(study, tmp_path / "out", run, workers=1), study.assessment)
    assert not [notice.message for notice in result.notices if notice.severity == "error"]
    tension = result.tree["SWL/waves/swell"]["line_tension_maximum"]
    assert tension.attrs["units"] == "N" and set(tension.dims) == {"height", "wave", "line", "end"}
    used = result.tree["assessment/lines"]["factored_utilisation"].sel(code="own rule").squeeze("sea")
    expected = 2.0 * tension.max(("wave", "end")) / 50.0
    assert float(expected.min()) > 0.0
    np.testing.assert_allclose(used.transpose("height", "line"), expected.transpose("height", "line"), rtol=1e-12)


def test_the_mean_is_that_of_the_wave_of_the_largest_tension() -> None:
    values = np.array([[[5.0, 1.0], [9.0, 2.0]], [[7.0, 30.0], [8.0, 4.0]]])
    held = xr.Dataset(
        {
            "line_tension_maximum": (("period", "line", "end"), values),
            "line_tension_mean": (("period", "line", "end"), values / 10.0 + 100.0 * np.arange(2)[:, None, None]),
        },
        {"period": [4.0, 5.0], "line": ["sea", "lee"], "end": ["cage", "anchor"]},
    )
    found = largest_tensions(held, ())
    assert found["line_tension_maximum"].values.tolist() == [30.0, 9.0]
    assert found["line_tension_mean"].values.tolist() == [103.0, 0.9]
    # a study keeps them over labels alone
    record = kept(xr.DataTree.from_dict({"/SWL/frequency/swell": held}))
    assert record["SWL/frequency/swell/line_tension_maximum"]["dims"] == ["line", "end"]
    assert record["SWL/frequency/swell/line_tension_mean"]["values"] == [[100.7, 103.0], [0.9, 100.4]]
