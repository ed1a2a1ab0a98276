"""A row whose coefficients come from files of other programs answers as the one that computed them."""

import numpy as np
import pytest

from moyai.case.builder import build
from moyai.case.reader import case_of
from moyai.case.yaml_reader import parse_yaml
from moyai.core.errors import CaseError
from moyai.core.store import DatasetStore
from moyai.interop.bodies import in_order, moved_axes
from moyai.interop.coefficients import assemble, dof_names
from moyai.interop.whole_body import coefficients_of_result
from moyai.interop.write import write_coefficients
from moyai.structures.units.assembly import assemble as row_at
from moyai.structures.units.hydrodynamics import solve_row
from moyai.structures.units.run import row_panels, run
from moyai.structures.units.seas import frequencies_of, headings_of
from moyai.structures.units.time.band import wide_coefficients

CASE = """
moyai: 1
title: Two units
site: {water_depth: 10 m, density: 1025 kg/m3, gravity: 9.81 m/s2}
waves:
  - {name: regular, kind: regular, height: 0.6 m, periods: [5 s, 6 s], heading_deg: 30}
  - {name: sea, kind: jonswap, significant_height: 0.8 m, peak_period: 6 s, peak_enhancement: 3.3,
     heading_deg: 30, duration: 10 min}
structure:
  kind: units
  section: {shape: rectangle, beam: 8 m, height: 3.5 m}
  units: {length: 12 m, places: [{y: -7 m}, {x: 2 m, y: 7 m, heading_deg: -20}]}
  draught: 2.4 m
  centre_of_gravity_above_keel: 1.8 m
  pitch_gyradius: 3.6 m
  roll_gyradius: 2.6 m
  yaw_gyradius: 4 m
  connectors: [{name: ball, kind: ball, above_keel: 3 m}]
  damping: {fraction_of_critical: 0.1, modes: [sway, surge, heave, roll, yaw]}
lines:
  - {name: sea, kind: spring, fairlead: {x: -4 m, y: 0 m, above_keel: 2.4 m}, anchor: {x: -40 m, y: -10 m, z: 0 m},
     stiffness: 20 kN/m, pretension: 30 kN}
  - {name: shore, kind: spring, fairlead: {x: 4 m, y: 0 m, above_keel: 2.4 m}, anchor: {x: 40 m, y: 10 m, z: 0 m},
     stiffness: 20 kN/m, pretension: 30 kN}
analyses: [statics, frequency]
settings: {panel_size: 6 m, frequencies: [0.8, 1, 1.3, 1.6, 1.9], compare_with_section: false}
"""
POINTS = "reference_points: [[0, -7, -0.6], [2, 7, -0.6]]"
ENTRIES = {
    "wamit": "path: wamit/unit.1", "nemoh": "path: nemoh", "bemio": f"path: bemio/unit.h5, {POINTS}",
}  # fmt: skip
#: Mean drift is found by turns, to a thousandth; everything else follows from it
DRIFT = 1e-3
#: Lines are a little stiffer or softer where drift moves them; without drift everything agrees to 1e-9
RAO = 1e-5


def case(folder, *changes):
    text = CASE
    for old, new in changes:
        assert old in text, old
        text = text.replace(old, new, 1)
    return case_of(parse_yaml(text, "case.yaml"), folder / "case.yaml")


def from_file(entry, *changes):
    line = f"  coefficients_file: {{{entry}}}\n  damping"
    return [("  damping", line), ("panel_size: 6 m, ", ""), *changes]


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    return tmp_path_factory.mktemp("row")


@pytest.fixture(scope="module")
def kept(folder):
    """Return where the frequencies that a run has solved are kept for the others."""
    return DatasetStore(folder / "kept")


@pytest.fixture(scope="module")
def computed(folder, kept):
    """The row with its drift shared alike, as that of a file is, which does not tell the units apart."""

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("moyai.structures.units.seas.near_drift", lambda *_: None)
        return run(build(case(folder)), store=kept)


@pytest.fixture(scope="module")
def dataset(computed, folder):
    found = coefficients_of_result(computed)
    infinite = found["added_mass"].isel(omega=-1, drop=True)
    found = found.assign(infinite_frequency_added_mass=infinite)
    for program in ENTRIES:
        write_coefficients(program, found, folder / program)
    return found


def compare(found, wanted, without, tolerance):
    for name, item in wanted.data_vars.items():
        if str(name).endswith(("_low", "_high")):
            # the drift of a file is that of its own motions: it does not follow the damping at the ends of its band
            continue
        if item.dtype.kind not in "fc" or name in without:
            continue
        scale = float(np.nanmax(np.abs(item.values), initial=0.0))
        np.testing.assert_allclose(
            found[name].values, item.values, rtol=0.0, atol=tolerance * scale, err_msg=str(name), equal_nan=True
        )


@pytest.mark.slow
@pytest.mark.parametrize("program", [pytest.param("wamit", marks=pytest.mark.slow), "bemio"])
def test_motions_drift_and_headlines_are_those_of_the_computation(program, folder, computed, dataset):
    found = run(build(case(folder, *from_file(f"program: {program}, {ENTRIES[program]}"))))
    level, own = computed.tree["SWL"], found.tree["SWL"]
    compare(own["hydrodynamics"].to_dataset(), level["hydrodynamics"].to_dataset(), (), 1e-12)
    # a ball lets its ends not part: what is left is rounding
    for sea in ("regular", "sea"):
        data = level[f"frequency/{sea}"].to_dataset()
        compare(own[f"frequency/{sea}"].to_dataset(), data, ("relative_motion_largest",), DRIFT)
        np.testing.assert_allclose(own[f"frequency/{sea}/mean_drift"], data["mean_drift"], rtol=DRIFT)
    np.testing.assert_allclose(own["frequency/regular/rao"], level["frequency/regular/rao"], rtol=RAO)
    assert [item.name for item in found.headlines] == [item.name for item in computed.headlines]
    for item, wanted in zip(found.headlines, computed.headlines):
        assert item.value == pytest.approx(wanted.value, rel=DRIFT, nan_ok=True)
    assert {notice.code for notice in found.notices} >= {"coefficients-drift"}


@pytest.mark.slow
def test_without_drift_in_the_file_the_row_moves_as_without_drift(folder, dataset, kept):
    still = run(build(case(folder, ("{panel_size", "{drift: false, panel_size"))), store=kept)
    found = run(build(case(folder, *from_file(f"program: nemoh, {ENTRIES['nemoh']}"))))
    for sea in ("regular", "sea"):
        data = still.tree[f"SWL/frequency/{sea}"].to_dataset()
        without = ("relative_motion_largest", "drift_per_amplitude_squared")
        compare(found.tree[f"SWL/frequency/{sea}"].to_dataset(), data, without, 1e-9)
    (reported,) = [notice for notice in found.notices if notice.code == "coefficients-without-drift"]
    assert reported.severity == "warning"


@pytest.mark.slow
def test_in_time_the_band_of_the_file_carries_the_memory(folder, kept):
    time = (
        ("analyses: [statics, frequency]", "analyses: [statics, frequency, time]"),
        ("compare_with_section: false", "compare_with_section: false, time: {realisations: 1, memory_frequencies: 14}"),
        ("duration: 10 min", "duration: 3 min"),
    )
    problem = build(case(folder, *time))
    at = row_at(problem.row, problem.environment, "SWL", 0.0)
    omega, headings = frequencies_of(problem.environment, problem.settings), headings_of(problem.environment)
    panels = row_panels(at, problem.settings, 1.6 * float(omega.max()))
    hydro = solve_row(panels, at.water, at.centres, omega, headings, store=kept)
    wide = wide_coefficients(hydro, 14, store=kept)
    wanted = run(problem, store=kept)
    names = ("one", "two")
    given = assemble(
        program="moyai", source="band", dofs=dof_names(names), omega=wide.omega, added_mass=wide.added_mass,
        radiation_damping=wide.damping, wave_direction=headings, forces={"excitation_force": wide.excitation},
        density=1025.0, gravity=9.81, water_depth=10.0, reference_point=at.centres, bodies=names,
    )  # fmt: skip
    write_coefficients("nemoh", given, folder / "band")
    found = run(build(case(folder, *from_file("program: nemoh, path: band", *time))))
    assert found.tree["SWL/memory"].sizes["omega"] == len(wide.omega)
    level = wanted.tree["SWL/memory"].to_dataset()
    compare(found.tree["SWL/memory"].to_dataset(), level, ("memory_residue", "memory_pole"), 1e-6)
    # drift is left out of this file, and moves the row in the computation
    regular = wanted.tree["SWL/time/regular"].to_dataset()
    own = found.tree["SWL/time/regular"].to_dataset()
    np.testing.assert_allclose(own["maximum_motion"], regular["maximum_motion"], rtol=0.0,
                               atol=0.02 * float(regular["maximum_motion"].max()))  # fmt: skip


@pytest.mark.slow
def test_bodies_in_another_order_and_axes(folder, computed, dataset):
    """The same row in the axes of the file that computed it: x along the row, another origin, bodies the other way."""
    turned = moved_axes(in_order(dataset, [2, 1]), (30.0, -5.0), np.radians(-90.0))
    write_coefficients("wamit", turned, folder / "turned")
    entry = "program: wamit, path: turned/unit.1"
    with pytest.raises(CaseError, match="is at x = "):
        case(folder, *from_file(entry))
    # axes of the file in those of the row: turned back by 90 degrees, its origin at -R(90) (30, -5) = (-5, -30)
    entry += ", x_axis_heading_deg: 90, origin: [-5 m, -30 m]"
    with pytest.raises(CaseError, match=r"is in unit 2.*give bodies: \[unit_1, unit_2\]"):
        case(folder, *from_file(entry))
    found = run(build(case(folder, *from_file(entry + ", bodies: [unit_1, unit_2]"))))
    wanted = computed.tree["SWL/frequency/regular"].to_dataset()
    np.testing.assert_allclose(found.tree["SWL/frequency/regular/rao"], wanted["rao"], rtol=RAO)
    np.testing.assert_allclose(found.tree["SWL/frequency/regular/mean_drift"], wanted["mean_drift"], rtol=DRIFT)


SLIPS = {
    "one body": ("program: nemoh, path: one", (), "the file holds 1 bodies (1), the row has 2 units"),
    "not there": ("program: nemoh, path: nowhere", (), "nowhere"),
    "no such body": ("program: nemoh, path: nemoh, bodies: [unit_1, stern]", (), "has no body 'stern'"),
    "other heading": ("program: nemoh, path: nemoh", (("heading_deg: 30}", "heading_deg: 75}"),), "no waves of 75"),
    "other waves": ("program: nemoh, path: nemoh", (("[5 s, 6 s]", "[3 s, 6 s]"),), "the file holds 0.8 to 1.9 rad/s"),
    "other depth": ("program: nemoh, path: nemoh", (("water_depth: 10 m", "water_depth: 14 m"),), "a depth of 10 m"),
    "other section": ("program: nemoh, path: nemoh", (("beam: 8 m", "beam: 10 m"),), "the heave stiffness of body"),
    "other place": ("program: nemoh, path: nemoh", (("y: 7 m", "y: 15 m"),), "body 'unit_2' of the file is"),
    "map": ("program: nemoh, path: nemoh", (("[statics, frequency]", "[statics, frequency, map]"),), "the panels"),
    "lid": ("program: nemoh, path: nemoh", (("  draught", "  gap_damping_lid: 0.1\n  draught"),), "of the gaps"),
    "no points": ("program: bemio, path: bemio/unit.h5", (), "reference_points"),
    "a point too few": ("program: bemio, path: bemio/unit.h5, reference_points: [[0, 0, 0]]", (), "numbers of each"),
    "conjugated": ("program: nemoh, path: conjugated", (), "does not follow the acceleration"),
}  # fmt: skip


@pytest.mark.slow
@pytest.mark.parametrize("slip", list(SLIPS))
def test_each_slip_gives_one_clear_message(slip, folder, dataset):
    entry, changes, words = SLIPS[slip]
    if slip == "one body":
        from moyai.interop.bodies import one_body

        write_coefficients("nemoh", one_body(dataset, 1), folder / "one")
    if slip == "conjugated":
        wrong = dataset.assign(excitation_force=dataset["excitation_force"].conj())
        write_coefficients("nemoh", wrong, folder / "conjugated")
    with pytest.raises(CaseError) as caught:
        case(folder, *from_file(entry, *changes))
    found = {str(fault) for fault in caught.value.faults}
    needed = [fault for fault in found if words in fault]
    assert needed, found
    assert len(found) == 1 or slip in ("map", "conjugated"), found


@pytest.mark.slow
def test_headings_between_those_of_the_file(folder):
    """Splines over headings 10 degrees apart meet what the solver says there."""
    problem = build(case(folder))
    at = row_at(problem.row, problem.environment, "SWL", 0.0)
    omega = np.array([1.0, 1.6])
    panels = row_panels(at, problem.settings, 1.6)
    there = np.radians([0.0, 10.0, 20.0, 30.0, 40.0, 50.0, 60.0])
    hydro = solve_row(panels, at.water, at.centres, omega, np.append(there, np.radians(25.0)))
    excitation, wanted = hydro.excitation[:, :-1], hydro.excitation[:, -1:]
    names = ("one", "two")
    given = assemble(
        program="moyai", source="headings", dofs=dof_names(names), omega=omega, added_mass=hydro.added_mass,
        radiation_damping=hydro.damping, wave_direction=there, forces={"excitation_force": excitation},
        density=1025.0, gravity=9.81, water_depth=10.0, reference_point=at.centres, bodies=names,
    )  # fmt: skip
    from moyai.structures.units.coefficients_file import row_from_file

    found = row_from_file(given, at, omega, np.radians([25.0]))
    assert "coefficients-headings" in {notice.code for notice in found.notices}
    scale = np.abs(wanted).reshape(2, 1, 2, 6).max(axis=(0, 1, 2))
    apart = np.abs(found.hydro.excitation - wanted).reshape(2, 1, 2, 6).max(axis=(0, 1, 2))
    assert float((apart / scale).max()) < 0.01
