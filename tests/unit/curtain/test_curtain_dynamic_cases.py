"""The whole span through time from case files: snaps, waves, strengths, stops, and their faults."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from renamed import unmissed

import moyai
from moyai.core.errors import CaseError, InputError
from moyai.structures.curtain.dynamic.runs import DynamicRun, run_span

CASE = """
moyai: 1
title: Dynamic
site: {water_depth: 10 m, density: 1025 kg/m3, gravity: 9.81 m/s2}
current: {speed: 0.3 m/s, heading_deg: 20}
structure:
  kind: curtain
  span: 15 m
  length: 16.5 m
  skirt: {length: 3 m, mass_per_area: 0.8 kg/m2, sheet_density: 1380 kg/m3, stiffness: 300 kN/m}
  toe: {kind: held, chain_mass: 15 kg/m}
  cables: {upper: {axial_stiffness: 400 kN}, lower: {axial_stiffness: 400 kN}}
  floats: {buoyancy: 980 N/m, weight: 150 N/m}
  drag: {law: constant, coefficient: 1.5}
analyses: [dynamic]
settings: {dynamic: {cells_along: 8, cells_down: 4}}
"""

STRONG = {
    "{axial_stiffness: 400 kN}, lower": "{axial_stiffness: 400 kN, breaking_load: 9 kN}, lower",
    "cells_down: 4}": "cells_down: 4, sensitivity: false}, safety_factors: {cable: 3}",
}


def write(folder: Path, text: str) -> Path:
    path = folder / "case.yaml"
    path.write_text(text)
    return path


@pytest.mark.slow
def test_case_of_a_snap_in_the_current(tmp_path: Path) -> None:
    result = moyai.run(moyai.load_case(write(tmp_path, CASE)))
    assert result.status == "converged", result.message
    table = result.tree["/SWL/dynamic"].to_dataset()
    run = result.tree["/SWL/dynamic/snap in the current"].to_dataset()
    assert float(table["both_cables_tension_maximum"][0]) > 1e3
    assert table["both_cables_tension_maximum"].attrs["units"] == "N"
    assert float(table["both_cables_tension_maximum"][0]) == pytest.approx(
        float(run["both_cables_tension_peak_since_row"].max())
    )
    assert {"upper cable", "lower cable"} == set(run["line"].values)
    frames = result.tree["/SWL/dynamic/snap in the current/frames"].to_dataset()
    assert frames["node_position"].shape[1:] == (45, 3)


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ("length: 16.5 m", "length: 15 m", "starts from slack"),
        ("stiffness: 300 kN/m", "stiffness: inextensible", "skirt that stretches"),
        ("mass_per_area: 0.8 kg/m2, sheet_density: 1380 kg/m3", "submerged_weight: 2 N/m2", "mass of the sheet"),
        ("cells_along: 8", "cells_along: 3", "cells_along"),
        ("cells_down: 4", "cells_down: 4.5", "cells_down"),
        ("cells_down: 4", "cells_down: 4, shear_stiffness: 3 kN/m", "span_stiffness"),
        ("cells_down: 4", "cells_down: 4, ballast_density: 900 kg/m3", "floats"),
        ("cells_down: 4", "cells_down: 4, startt: drifting", "startt"),
        ("length: 3 m", "length: 12 m", "deep"),
        ("weight: 150 N/m", "weight: 0 N/m", "mass"),
        ("floats: {", "anchors: {line_length: 30 m, axial_stiffness: 1 MN}\n  floats: {", "support_mass"),
        ("current: {speed: 0.3 m/s, heading_deg: 20}", "", "needs"),
    ],
)
def test_case_faults(tmp_path: Path, old: str, new: str, words: str) -> None:
    assert old in CASE
    with pytest.raises((CaseError, InputError), match=words):
        moyai.run(moyai.load_case(write(tmp_path, CASE.replace(old, new))))


@pytest.mark.slow  # a minute of a span through time, and statics of a held toe
def test_current_dies_down_to_the_statics_of_the_same_case(tmp_path: Path) -> None:
    """Held toe: the tensions that a long run in the current ends at are those of `statics`, which solves another model.

    Statics takes one section for the whole span; the span's sections near the supports hang steeper.
    """
    text = CASE.replace("heading_deg: 20", "heading_deg: 0").replace("[dynamic]", "[statics, dynamic]")
    text = text.replace(
        "cells_along: 8, cells_down: 4",
        "cells_along: 8, cells_down: 4, duration: 60 s, start: at_rest, sensitivity: false",
    )
    result = moyai.run(moyai.load_case(write(tmp_path, text)))
    assert result.status == "converged", result.message
    rest = result.tree["/SWL/statics"].to_dataset().sel(drag_case="given")
    run = result.tree["/SWL/dynamic/snap in the current"].to_dataset()
    late = run.isel(time=run["time"].values > 50.0)
    ends = late["line_tension_peak_since_row"].mean("time").values
    assert float(late["both_cables_tension_peak_since_row"].std()) < 0.01 * float(
        late["both_cables_tension_peak_since_row"].mean()
    )
    assert ends[0] == pytest.approx(float(rest["upper_tension"]), rel=0.06)
    assert ends[1] == pytest.approx(float(rest["lower_tension"]), rel=0.06)
    assert float(late["mid_span_x"].mean()) == pytest.approx(float(rest["sag"]), rel=0.05)


@pytest.mark.slow
def test_waves_fold_the_cloth_but_not_its_added_mass(tmp_path: Path) -> None:
    """Light cloth in waves, all forces of turning sections: energy is kept, nothing is left out, little is eaten."""
    text = CASE.replace(
        "structure:", "waves: {name: swell, kind: regular, height: 0.8 m, periods: [5 s], heading_deg: 0}\nstructure:"
    )
    text = text.replace(
        "cells_along: 8, cells_down: 4", "cells_along: 16, cells_down: 4, analysed_periods: 1, sensitivity: false"
    )
    result = moyai.run(moyai.load_case(write(tmp_path, text)))
    assert result.status == "converged", result.message
    assert not [notice for notice in result.notices if notice.code == "dynamic-turning"]
    taken = next(check for check in result.checks if "viscosity" in check.name)
    assert 0.0 < taken.value < 0.05


def slack_span_in_oblique_waves(tmp_path: Path, cells: str) -> Path:
    """A case whose cloth gathers: skirt 5.9 m, waves of 1.24 m and 6.5 s at 32 degrees."""
    text = CASE.replace("{speed: 0.3 m/s, heading_deg: 20}", "{speed: 0.14 m/s, heading_deg: 0}")
    text = text.replace("length: 16.5 m", "length: 19.2 m").replace("span: 15 m", "span: 14.9 m")
    text = text.replace("length: 3 m", "length: 5.9 m").replace("chain_mass: 15", "chain_mass: 120")
    text = text.replace("buoyancy: 980", "buoyancy: 2357").replace("water_depth: 10 m", "water_depth: 12.8 m")
    text = text.replace("{axial_stiffness: 400 kN}, lower: {axial_stiffness: 400 kN}",
                        "{axial_stiffness: 149 kN}, lower: {axial_stiffness: 594 kN}")  # fmt: skip
    text = text.replace(
        "structure:",
        "waves: {name: swell, kind: regular, height: 1.24 m, periods: [6.5 s], heading_deg: 32}\nstructure:",
    )
    return write(
        tmp_path,
        text.replace(
            "cells_along: 8, cells_down: 4", f"{cells}, sensitivity: false, settled_periods: 1, analysed_periods: 3"
        ),
    )


@pytest.mark.slow
def test_gathered_cloth_goes_on_with_turning_sections(tmp_path: Path) -> None:
    """Loads held over too many steps once blew this mesh up; now it runs, and takes no energy from nowhere."""
    result = moyai.run(moyai.load_case(slack_span_in_oblique_waves(tmp_path, "cells_along: 32, cells_down: 4")))
    assert result.status == "converged", result.message
    assert not [notice for notice in result.notices if notice.code == "dynamic-turning"]
    taken = next(check for check in result.checks if "viscosity" in check.name)
    # a third of what the program calls crumpling, in the four periods run here; this motion never settles, and over
    # eleven to sixteen periods viscosity takes 0.14
    assert 0.0 < taken.value < 0.1


@pytest.mark.parametrize("way", [pytest.param("stopped", marks=pytest.mark.slow), "viscosity took"])
@pytest.mark.slow
def test_a_run_that_turning_sections_spoil_is_made_again_with_held_normals(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, way: str
) -> None:
    """Which meshes crumple hangs on rounding, so that the spoilt run is made here: it stops, or feeds viscosity."""
    import moyai.structures.curtain.analyses.dynamic as analysis

    kept: list[DynamicRun] = []

    def stopping(*given: object, **more: object) -> DynamicRun:
        run = run_span(*given, **more)  # type: ignore[arg-type]
        history = run.history
        if run.built.mesh.turning and way == "stopped":
            return replace(run, history=replace(history, status="not_converged", message="the energy grew"))
        if run.built.mesh.turning:
            # work that went through the span into viscosity within a row
            work = np.array(history.work)
            work[-1] += 40.0 * float(np.max(history.kinetic_energy + history.elastic_energy))
            return replace(run, history=replace(history, work=work))
        kept.append(run)
        return run

    monkeypatch.setattr(analysis, "run_span", stopping)
    result = moyai.run(moyai.load_case(slack_span_in_oblique_waves(tmp_path, "cells_along: 8, cells_down: 4")))
    assert result.status == "converged", result.message
    (reported,) = [notice for notice in result.notices if notice.code == "dynamic-turning"]
    assert "held as in the just-taut span" in reported.message and way in reported.message
    taken = next(check for check in result.checks if "viscosity" in check.name)
    assert 0.0 < taken.value < 0.05
    (run,) = kept
    assert float(result.tree["/SWL/dynamic"]["both_cables_tension_maximum"][0]) == pytest.approx(run.peak("both")[0])


def test_too_many_periods_are_refused(tmp_path: Path) -> None:
    text = CASE.replace(
        "structure:", "waves: {name: swell, kind: regular, height: 0.8 m, periods: [5 s], heading_deg: 0}\nstructure:"
    ).replace("cells_down: 4", "cells_down: 4, analysed_periods: 1000000")
    with pytest.raises(CaseError, match="1000007 wave periods"):
        moyai.load_case(write(tmp_path, text))


@pytest.mark.slow
def test_settling_waves_are_reported(tmp_path: Path) -> None:
    """The published example: 16 kN while the waves come up, then less from period to period."""
    text = CASE.replace(
        "structure:", "waves: {name: swell, kind: regular, height: 0.8 m, periods: [5 s], heading_deg: 0}\nstructure:"
    ).replace("cells_along: 8, cells_down: 4", "cells_along: 8, cells_down: 4, sensitivity: false, settled_periods: 0")
    result = moyai.run(moyai.load_case(write(tmp_path, text)))
    codes = {notice.code for notice in result.notices}
    assert "dynamic-unsettled" in codes


@pytest.mark.parametrize("stage", ["network", "half the step"])
def test_a_stopped_run_is_kept(tmp_path: Path, stage: str) -> None:
    """Ctrl-C keeps what the run has reached, and the whole run where it comes in one of the sensitivity runs."""

    def stop(what: str, done: float, total: float) -> None:
        if what == stage and done > 0.3 * total:
            raise KeyboardInterrupt

    # of a given duration, so that no second run of it follows
    text = CASE.replace("cells_down: 4", "cells_down: 4, duration: 4 s")
    result = moyai.run(moyai.load_case(write(tmp_path, text)), stop)
    assert result.status == "interrupted"
    table = result.tree["/SWL/dynamic"].to_dataset()
    run = result.tree["/SWL/dynamic/snap in the current"].to_dataset()
    assert run.attrs["status"] == ("interrupted" if stage == "network" else "converged")
    assert run.sizes["time"] > 100 and float(table["both_cables_tension_maximum"][0]) >= 0.0
    assert any(notice.code == "dynamic-interrupted" for notice in result.notices)
    # models of an impact stand next to the span where there is a current; a run that did not end is missed nothing of
    assert stage == "network" or unmissed(result) == {"dynamic_model_tension"}


def changed(text: str, changes: dict[str, str]) -> str:
    for old, new in changes.items():
        assert old in text
        text = text.replace(old, new)
    return text


@pytest.mark.slow
@pytest.mark.parametrize("analyses", ["dynamic", pytest.param("statics, dynamic", marks=pytest.mark.slow)])
def test_moving_spans_are_held_against_the_strengths(tmp_path: Path, analyses: str) -> None:
    """The table of loads takes the highest tension of a span where it was run."""
    text = changed(CASE, STRONG | {"analyses: [dynamic]": f"analyses: [{analyses}]"})
    result = moyai.run(moyai.load_case(write(tmp_path, text)))
    peak = float(result.tree["/SWL/dynamic"].to_dataset()["upper_peak"][0])
    loads = result.tree["/SWL/loads"].to_dataset()
    row = loads.sel(component="upper cable")
    assert peak > 3e3
    assert float(row["governing_load"]) == float(row["dynamic_load"]) == peak
    assert float(row["factored_utilisation"]) == pytest.approx(peak * 3.0 / 9e3)
    assert str(row["governing"].values) == "dynamic"
    assert str(row["dynamic_source"].values) == "snap in the current"
    assert loads.attrs["governing_component"] == "upper cable"
    # an overload is a matter of the design: the headline tells it, no notice and no status of the computation
    used = next(item for item in result.headlines if item.name == "cable_utilisation")
    assert used.value == pytest.approx(peak / 9e3) and used.model == "whole span through time" and not used.bound
    assert result.status == "converged"
    assert not [notice for notice in result.notices if notice.code == "curtain-strength"]
    steady = float(row["steady_load"])
    assert steady < peak if "statics" in analyses else np.isnan(steady)
    assert np.isnan(float(loads.sel(component="anchor")["governing_load"]))


@pytest.mark.slow
def test_a_run_that_had_to_stop_gives_no_peak(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Its last instants are no motion of the curtain; the series stays for the search of the cause."""
    import moyai.structures.curtain.analyses.dynamic as analysis

    def stopping(*given: object, **more: object) -> DynamicRun:
        run = run_span(*given, **more)  # type: ignore[arg-type]
        return replace(run, history=replace(run.history, status="not_converged", message="the energy grew at 3 s"))

    monkeypatch.setattr(analysis, "run_span", stopping)
    result = moyai.run(moyai.load_case(write(tmp_path, changed(CASE, STRONG))))
    table = result.tree["/SWL/dynamic"].to_dataset()
    run = result.tree["/SWL/dynamic/snap in the current"].to_dataset()
    assert np.isnan(table["both_cables_tension_maximum"]).all() and np.isnan(run["line_tension_maximum"]).all()
    assert float(run["both_cables_tension_peak_since_row"].max()) > 0.0
    assert np.isnan(result.tree["/SWL/loads"].to_dataset()["factored_utilisation"]).sum() >= 6
    assert any("no peak of it is given" in notice.message for notice in result.notices)
    moyai.write_report(result, tmp_path / "report")


@pytest.mark.slow
def test_the_start_of_an_irregular_sea_is_reported(tmp_path: Path) -> None:
    """A strong current that comes up in one period pulls harder than the small sea after it."""
    sea = (
        "waves: {name: sea, kind: jonswap, significant_height: 0.1 m, significant_period: 3 s, peak_enhancement: 3.3,"
        " heading_deg: 0, duration: 50 s, seed: 2}\nstructure:\n"
    )
    text = changed(CASE, STRONG | {"structure:\n": sea, "speed: 0.3 m/s": "speed: 0.6 m/s"})
    settled = moyai.run(moyai.load_case(write(tmp_path, text)))
    assert not any(notice.code == "dynamic-start" for notice in settled.notices)
    result = moyai.run(
        moyai.load_case(write(tmp_path, changed(text, {"{cells_along": "{settled_periods: 0, cells_along"})))
    )
    reported = [notice for notice in result.notices if notice.code == "dynamic-start"]
    run = result.tree["/SWL/dynamic/sea"].to_dataset()
    late = run["both_cables_tension_peak_since_row"].values[run["time"].values > 0.5 * float(run["time"][-1])]
    assert len(reported) == 1 and reported[0].value > 1.5
    peak = float(result.tree["/SWL/dynamic"].to_dataset()["both_cables_tension_maximum"][0])
    assert reported[0].value == pytest.approx(peak / late.max())


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ("mass_per_area: 0.8 kg/m2, sheet_density: 1380 kg/m3", "submerged_weight: 3 N/m2", "cannot weigh 3 N/m2"),
        ("cells_along: 8", "cells_along: 8, ballast_density: 900 kg/m3", "ballast of 900 kg/m3 floats"),
    ],
)
def test_masses_that_cannot_be_are_found_before_the_run(tmp_path: Path, old: str, new: str, words: str) -> None:
    text = changed(CASE, {"cells_along: 8": "cells_along: 8, sheet_mass: 0.1 kg/m2", old: new})
    with pytest.raises(CaseError, match=words):
        moyai.load_case(write(tmp_path, text))


@pytest.mark.slow
def test_cables_that_stretch_as_no_rope_are_reported(tmp_path: Path) -> None:
    """Newtons for kilonewtons, without a breaking load that the check could compare them with."""
    text = changed(CASE, {"400 kN": "400 N", "cells_down: 4}": "cells_down: 4, sensitivity: false, duration: 15 s}"})
    result = moyai.run(moyai.load_case(write(tmp_path, text)))
    reported = [notice for notice in result.notices if notice.code == "dynamic-stretched"]
    run = result.tree["/SWL/dynamic/snap in the current"].to_dataset()
    assert len(reported) == 1 and reported[0].value == pytest.approx(float(run["line_tension_maximum"].max()) / 400.0)
