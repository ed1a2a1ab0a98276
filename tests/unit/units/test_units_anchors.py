"""What the lines of a row ask of their anchors, against closed forms; what the first page says and judges of it."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
import xarray as xr

from moyai.core.headline import Criterion, Headline, judge, unfavourable
from moyai.core.wording import kilonewton
from moyai.design.anchor_needs import sinker_weight
from moyai.mooring.lines import Line, LineType, Segment
from moyai.series.intervals import reach_of_mean
from moyai.structures.units.anchor_headlines import anchor_headlines
from moyai.structures.units.anchors import (
    AT_REST,
    TENSION,
    anchor_curves,
    anchored,
    loads_at,
    loads_of_record,
    with_anchor_loads,
)
from moyai.structures.units.assembly import RowAtLevel, steady_position
from moyai.structures.units.datasets import mean_loads, statics_dataset
from moyai.structures.units.headlines import headlines_of
from moyai.structures.units.line_headlines import line_headlines
from moyai.structures.units.links import Work
from moyai.structures.units.model import Connector, UnitLine
from moyai.validation.units import at_rest, row

WEIGHT, LENGTH, DEPTH = 600.0, 49.0, 10.0
#: Fairleads 0.5 m above the keel of a draught of 3 m.
RISE = DEPTH - 3.0 + 0.5
CHAIN = LineType("chain", WEIGHT, 1e12, 2e6)


def _moored(units: tuple[int, ...], connectors: tuple[Connector, ...] = (), count: int = 1) -> RowAtLevel:
    lines = tuple(
        UnitLine(f"{side}", 1, units, (sign * 5.0, 0.0, 0.5), (sign * 50.0, 0.0, 0.0), (Segment(CHAIN, LENGTH),))
        for side, sign in (("sea", -1.0), ("shore", 1.0))
    )
    return at_rest(replace(row(connectors, count=count), lines=lines), replace(at_rest(row()).water, depth=DEPTH))


def _curves(at: RowAtLevel) -> xr.Dataset:
    return xr.Dataset(anchor_curves(at), coords={"line": list(at.line_names)})


@pytest.mark.parametrize("share", [1.3, 3.0, 10.0, 60.0])
def test_pull_and_uplift_are_those_of_the_catenary_of_that_tension(share: float) -> None:
    """H = T - w Z with chain on the bed; else V from T^2 = H^2 + (V + w L)^2 and (T - w Z)^2 = H^2 + V^2."""
    tension = share * WEIGHT * RISE
    pull, uplift, lies = loads_at(np.array([tension, tension]), _curves(_moored((0,))))[:, 0]
    hanging = np.sqrt(RISE**2 + 2.0 * RISE * (tension / WEIGHT - RISE))
    if hanging < LENGTH:
        assert pull == pytest.approx(tension - WEIGHT * RISE, rel=2e-3)
        assert uplift == pytest.approx(0.0, abs=1e-3 * tension) and lies == pytest.approx(LENGTH - hanging, rel=2e-2)
        return
    lifted = (2.0 * tension * WEIGHT * RISE - (WEIGHT * RISE) ** 2 - (WEIGHT * LENGTH) ** 2) / (2.0 * WEIGHT * LENGTH)
    assert uplift == pytest.approx(lifted, rel=5e-3) and lies == 0.0
    assert pull == pytest.approx(np.sqrt((tension - WEIGHT * RISE) ** 2 - lifted**2), rel=2e-3)


def _sea(at: RowAtLevel, tension: float, *, irregular: bool = False) -> dict[str, xr.Dataset]:
    names = ("significant_motion",) if irregular else ()
    data = xr.Dataset(
        {
            "line_tension_maximum": ("line", [tension, 0.5 * tension]),
            "line_tension_mean": ("line", [0.4 * tension, 0.4 * tension]),
            **{name: ("dof", [0.1]) for name in names},
        },
        coords={"line": list(at.line_names)},
    )
    groups = {"/SWL/statics": _curves(at), "/SWL/frequency/daily": data}
    return groups | dict(anchored(groups))


def _found(groups: dict[str, xr.Dataset]) -> dict[str, Headline]:
    seas = [(path, data) for path, data in groups.items() if path.endswith("daily")]
    return {item.name: item for item in anchor_headlines(seas)}


UPLIFT = Criterion("greatest_uplift", "anchor_vertical_tension", 0.0, "at most", "source", "uplift on the anchors", "N")


def test_uplift_of_the_line_that_pulls_hardest_fails_and_chain_on_the_bed_holds() -> None:
    at = _moored((0,))
    found = _found(_sea(at, 3.5e5))
    tension, lifted = 3.5e5, found["anchor_vertical_tension"]
    expected = (2.0 * tension * WEIGHT * RISE - (WEIGHT * RISE) ** 2 - (WEIGHT * LENGTH) ** 2) / (2.0 * WEIGHT * LENGTH)
    assert lifted.value == pytest.approx(expected, rel=5e-3)
    assert "not a drag anchor" in found["anchor_capacity_required"].detail
    assert judge(found.values(), [UPLIFT], computed=True).outcome == "does not hold"
    found = _found(_sea(at, 1.2e4))
    assert (
        found["anchor_vertical_tension"].text == "none"
        and "stays on the bed" in found["anchor_vertical_tension"].detail
    )
    capacity = found["anchor_capacity_required"].value
    assert capacity == pytest.approx(1.5 * (1.2e4 - WEIGHT * RISE), rel=5e-3)
    assert judge(found.values(), [UPLIFT], computed=True).outcome == "holds"


def test_no_uplift_without_slow_drift_is_not_known() -> None:
    found = _found(_sea(_moored((0,)), 1.2e4, irregular=True))
    assert (
        found["anchor_vertical_tension"].text == "not known" and "slow drift" in found["anchor_vertical_tension"].detail
    )
    assert found["anchor_horizontal_tension"].bound == "at least"
    assert judge(found.values(), [UPLIFT], computed=True).outcome == "not judged"


def test_anchors_stand_on_the_page_where_no_sea_was_run() -> None:
    at = _moored((0,))
    groups = {"/SWL/statics": statics_dataset(at, np.zeros(at.size), np.zeros(at.size))}
    found = {item.name: item for item in headlines_of(groups)}
    assert found["anchor_vertical_tension"].text == "none" and found["anchor_vertical_tension"].value == 0.0


PINS = tuple(Connector(f"pin {n}", "hinge", ((n, n + 1),), 0.0, 1.0, axis=(1.0, 0.0, 0.0)) for n in range(3))
PUSH = 2e3


@pytest.mark.parametrize(("units", "felt"), [((0, 3), True), ((0, 1, 2, 3), False)])
def test_drift_goes_through_the_pins_of_units_without_lines(units: tuple[int, ...], felt: bool) -> None:
    """The pin between an end unit that is moored and one that is not bears the drift of the latter, by symmetry."""
    at = _moored(units, PINS, count=4)
    pushed = np.zeros(at.size)
    pushed[0::6] = PUSH
    shear = np.abs(mean_loads(at, steady_position(at, pushed), Work(at.rounding, np.zeros(0)))[:, 0])
    assert shear == pytest.approx([PUSH * felt, 0.0, PUSH * felt], abs=1e-3 * PUSH)


def test_a_light_rope_without_a_breaking_load_pulls_on_a_straight_line() -> None:
    """Ten and ten thousand times its weight: pull and uplift are the tension along the chord."""
    rope = LineType("rope", 0.5, 2e6)
    lines = (UnitLine("s", 1, (0,), (-5.0, 0.0, 0.5), (-31.0, 0.0, 0.0), (Segment(rope, 27.0),)),)
    at = at_rest(replace(row(count=1), lines=lines), replace(at_rest(row()).water, depth=DEPTH))
    for tension in (22.5e3, 37.6e3, 2e6):
        pull, uplift, lies = loads_at(np.array([tension]), _curves(at))[:, 0]
        assert np.hypot(pull, uplift) == pytest.approx(tension, rel=1e-3) and lies == 0.0
        # at 22.5 kN the rope is 1.1 % longer
        assert uplift / tension == pytest.approx(RISE / (27.0 * (1.0 + min(tension, 6e5) / 2e6)), rel=5e-3)


def test_anchors_of_a_record_are_those_of_the_lines_where_the_row_is() -> None:
    """A unit that heaves by 1 m while it drifts by 3.3 m: the line from anchor to fairlead is solved by itself."""
    at = _moored((0,))
    motions = np.zeros((50, at.size))
    motions[:, 0], motions[:, 2] = np.linspace(0.0, 3.3, 50), np.linspace(0.0, 1.0, 50)
    tension = np.array([at.tensions(position) for position in motions])
    found = loads_of_record(at, motions, tension)
    line = at.lines[0][0]
    assert isinstance(line, Line)
    across = line.fairlead[0] - line.anchor[0] + 3.3
    out, _ = line.solve_plane(np.array([across]), np.array([RISE + 1.0]), DEPTH + float(at.centres[0, 2]))
    assert found[TENSION][0] == pytest.approx(np.hypot(out[0, 0], out[0, 1]), rel=1e-6)
    assert found[AT_REST[0]][0] == pytest.approx(out[0, 0], rel=1e-6)
    assert found[AT_REST[1]][0] == pytest.approx(max(out[0, 3], 0.0), rel=1e-6)
    # and the same tension with the fairlead at its height at rest lifts less
    assert found[AT_REST[1]][0] > loads_at(tension.max(axis=0), _curves(at))[1, 0]


def test_ends_of_damping_lift_an_anchor_that_lies_at_the_value() -> None:
    at = _moored((0,))
    groups = _sea(at, 8e4)
    data = groups["/SWL/frequency/daily"]
    ends = {
        "line_tension_maximum_low": 0.9 * data["line_tension_maximum"],
        "line_tension_maximum_high": 1.5 * data["line_tension_maximum"],
    }
    groups["/SWL/frequency/daily"] = data.assign(ends)
    found = _found(groups | dict(anchored(groups)))
    lifted = found["anchor_vertical_tension"]
    assert lifted.text == "none" and lifted.band is not None and lifted.band.high > 1e3
    assert judge(found.values(), [UPLIFT], computed=True).outcome == "does not hold"
    pull = found["anchor_horizontal_tension"]
    assert pull.band is not None and lifted.band is not None
    weight = sinker_weight(pull.band.high, lifted.band.high)
    assert f"{weight / 1e3:.0f} kN" in found["anchor_capacity_required"].detail
    assert "not a drag anchor" in found["anchor_capacity_required"].detail


def test_an_anchor_that_no_realisation_lifts_is_judged_at_the_end_of_its_tension() -> None:
    """Three realisations lie on the bed; at the 95 % end of their mean tension the chain is lifted."""
    at = _moored((0,))
    # lifted from w (L^2 + Z^2) / (2 Z) on: 98.3 kN
    each = np.array([[8.0e4, 4e4], [9.0e4, 4e4], [9.7e4, 4e4]])
    data = xr.Dataset(
        {
            "line_tension_maximum_of_realisation": (("member", "line"), each),
            "line_tension_maximum": ("line", each.mean(axis=0)),
            "line_tension_mean": ("line", [4e4, 4e4]),
            "significant_motion": ("dof", [0.1]),
        },
        coords={"line": list(at.line_names)},
    )
    groups = {"/SWL/statics": _curves(at), "/SWL/time/storm": data}
    seas = [("/SWL/time/storm", with_anchor_loads(data, groups["/SWL/statics"]).assign(_curves(at).data_vars))]
    found = {item.name: item for item in anchor_headlines(seas)}
    lifted = found["anchor_vertical_tension"]
    assert lifted.text == "none" and lifted.band is not None and lifted.band.high > 0.0
    assert judge(found.values(), [UPLIFT], computed=True).outcome == "does not hold"
    assert "not a drag anchor" in found["anchor_capacity_required"].detail


@pytest.mark.parametrize(("path", "bound"), [(5.0e4, "at least"), (2.6e4, "")])
def test_a_chain_that_comes_taut_along_regular_waves_is_a_bound(path: float, bound: str) -> None:
    """Mean and linear amplitude are 22 kN; the line at rest along the path gives more than twice that."""
    at = _moored((0,))
    sea = xr.Dataset(
        {
            "line_tension_maximum": (("period", "line"), [[path, 1.2e4]]),
            "line_tension_mean": (("period", "line"), [[1.2e4, 1.2e4]]),
            "tension_amplitude": (("period", "line"), [[1.0e4, 1e3]]),
            "largest_offset": (("period", "unit"), [[0.4]]),
        },
        coords={"period": [4.0], "line": list(at.line_names), "unit": [1]},
    )
    statics = _curves(at).assign(breaking_load=("line", [2e6, 2e6]))
    groups = {"/SWL/statics": statics}
    seas = [("/SWL/frequency/daily", with_anchor_loads(sea, statics))]
    found = {item.name: item for item in [*line_headlines(groups, seas), *anchor_headlines(seas)]}
    for name in ("line_tension", "line_utilisation", "anchor_horizontal_tension"):
        assert found[name].bound == bound, name


def test_the_sinker_is_that_of_the_line_that_is_lifted_where_it_asks_for_more() -> None:
    """A chain that pulls with 13 kN lies on the bed, a light rope that pulls with 11.9 kN lifts its anchor."""
    rope = LineType("rope", 0.5, 2e6)
    lines = (
        UnitLine("chain", 1, (0,), (5.0, 0.0, 0.5), (50.0, 0.0, 0.0), (Segment(CHAIN, LENGTH),)),
        UnitLine("rope", 1, (0,), (-5.0, 0.0, 0.5), (-31.0, 0.0, 0.0), (Segment(rope, 27.0),)),
    )
    at = at_rest(replace(row(count=1), lines=lines), replace(at_rest(row()).water, depth=DEPTH))
    tension = np.array([1.75e4, 1.24e4])
    data = xr.Dataset(
        {"line_tension_maximum": ("line", tension), "line_tension_mean": ("line", 0.5 * tension)},
        coords={"line": list(at.line_names)},
    )
    seas = [("/SWL/frequency/daily", with_anchor_loads(data, _curves(at)))]
    found = next(item for item in anchor_headlines(seas) if item.name == "anchor_capacity_required")
    pull, uplift, _ = loads_at(tension, _curves(at))
    assert pull[0] > pull[1] and uplift[0] == 0.0 < uplift[1]
    assert f"{sinker_weight(pull[1], uplift[1]) / 1e3:.3g} kN in water at line rope" in found.detail
    assert "no drag anchor holds line rope" in found.detail


def test_an_uplift_reaches_to_the_tension_at_which_its_line_is_judged() -> None:
    """One of three realisations hardly lifts the anchor: their mean is cut off at nothing, the tension's end is not."""
    at = _moored((0,))
    each = np.array([[8.0e4, 4e4], [9.0e4, 4e4], [9.9e4, 4e4]])
    data = xr.Dataset(
        {
            "line_tension_maximum_of_realisation": (("member", "line"), each),
            "line_tension_maximum": ("line", each.mean(axis=0)),
            "line_tension_mean": ("line", [4e4, 4e4]),
            "significant_motion": ("dof", [0.1]),
        },
        coords={"line": list(at.line_names)},
    )
    data = with_anchor_loads(data, _curves(at)).assign(_curves(at).data_vars)
    lifted = next(
        item for item in anchor_headlines([("/SWL/time/storm", data)]) if item.name == "anchor_vertical_tension"
    )
    judged = each[:, 0].mean() + reach_of_mean(each[:, 0])
    assert lifted.value > 0.0 and lifted.band is not None
    assert lifted.band.high == pytest.approx(loads_at(np.array([judged, 0.0]), _curves(at))[1, 0], rel=1e-9)


@pytest.mark.parametrize("turned", [False, True])
def test_the_line_with_the_wider_band_is_judged_whatever_the_order(turned: bool) -> None:
    """Of a line of 26 kN that may bear 30 kN and one of 25 kN that may bear 350 kN the second decides."""
    at, order = _moored((0,)), slice(None, None, -1 if turned else 1)
    ends = {"": [2.6e4, 2.5e4], "_low": [2.5e4, 2.4e4], "_high": [3.0e4, 3.5e5]}
    data = xr.Dataset(
        {f"line_tension_maximum{end}": ("line", values[order]) for end, values in ends.items()},
        coords={"line": list(at.line_names)},
    ).assign(line_tension_mean=("line", [8e4, 8e4]))
    groups = {"/SWL/statics": _curves(at).assign(breaking_load=("line", [4e5, 4e5])), "/SWL/time/daily": data}
    groups |= dict(anchored(groups))
    seas = [(path, data) for path, data in groups.items() if path.endswith("daily")]
    seas = [(path, data.assign(groups["/SWL/statics"].data_vars)) for path, data in seas]
    items = [*anchor_headlines(seas), *line_headlines(groups, seas)]
    wide = at.line_names[0 if turned else 1]
    for name, limit in (
        ("anchor_vertical_tension", 1e3),
        ("anchor_horizontal_tension", 5e4),
        ("line_utilisation", 0.5),
    ):
        asked = Criterion("limit", name, limit, "at most", "source", "limit", "N")
        judged = max((item for item in items if item.name == name), key=unfavourable)
        assert judge(items, [asked], computed=True).outcome == "does not hold" and wide in judged.where, name
    pull, uplift, _ = loads_at(np.array([3.5e5, 3.5e5]), _curves(at))[:, 0]
    sinker = next(item.detail for item in items if item.name == "anchor_capacity_required")
    assert f"sinker of {kilonewton(sinker_weight(float(pull), float(uplift)))}" in sinker


def test_an_uplift_of_the_line_listed_last_is_not_lost_behind_one_of_nothing() -> None:
    at = _moored((0,))
    data = xr.Dataset(
        {
            "line_tension_maximum": ("line", [1.2e4, 1.2e4]),
            "line_tension_maximum_low": ("line", [1.1e4, 1.1e4]),
            "line_tension_maximum_high": ("line", [1.3e4, 3.5e5]),
            "line_tension_mean": ("line", [8e4, 8e4]),
        },
        coords={"line": list(at.line_names)},
    )
    found = _found({"/SWL/statics": _curves(at), "/SWL/frequency/daily": data} | dict(anchored(
        {"/SWL/statics": _curves(at), "/SWL/frequency/daily": data}
    )))  # fmt: skip
    assert judge(found.values(), [UPLIFT], computed=True).outcome == "does not hold"
    assert "not a drag anchor" in found["anchor_capacity_required"].detail


def test_an_end_of_damping_beyond_the_range_of_lines_at_rest_keeps_no_limit() -> None:
    at = _moored((0,))
    data = xr.Dataset(
        {
            "line_tension_maximum": ("line", [2.0e4, 1.0e4]),
            "line_tension_maximum_low": ("line", [1.9e4, 0.9e4]),
            "line_tension_maximum_high": ("line", [9.0e4, 1.1e4]),
            "line_tension_mean": ("line", [1.0e4, 1.0e4]),
        },
        coords={"line": list(at.line_names)},
    )
    groups = {"/SWL/statics": xr.Dataset({"breaking_load": ("line", [4e5, 4e5])}), "/SWL/time/daily": data}
    items = list(line_headlines(groups, [("/SWL/time/daily", data)]))
    assert items[0].bound == "at least" and "end of its band" in items[0].detail
    kept = Criterion("limit", "line_utilisation", 0.5, "at most", "source", "limit", "1")
    assert judge(items, [kept], computed=True).outcome == "not judged"


def _rows_in_time(tensions: dict[str, list[float]], mean: list[float], load: list[float]) -> list[Headline]:
    data = xr.Dataset(
        {f"line_tension_maximum{end}": ("line", values) for end, values in tensions.items()},
        coords={"line": ["rope", "chain"]},
    ).assign(line_tension_mean=("line", mean))
    curves = {"anchor_curve_tension": (("line", "anchor_point"), [[0.0, 1e6], [0.0, 1e6]])}
    groups = {"/SWL/statics": xr.Dataset({"breaking_load": ("line", load), **curves}), "/SWL/time/daily": data}
    return list(line_headlines(groups, [("/SWL/time/daily", data)]))


def test_a_line_known_as_a_bound_alone_is_not_lost_behind_a_larger_one_that_is_known() -> None:
    """A rope at 0.46 of its load is known; a chain at 0.35, seventeen times its mean, may bear more."""
    for strength in (1.0, 2.0):
        items = _rows_in_time({"": [7.1e5, 2.3e5]}, [3e5, 1.4e4], [strength * 1.55e6, 6.6e5])
        use = Criterion("limit", "line_utilisation", 0.5, "at most", "source", "limit", "1")
        assert judge(items, [use], computed=True).outcome == "not judged"


def test_a_code_that_weighs_the_mean_is_judged_on_the_line_whose_tension_varies_most() -> None:
    """1.1 mean + 1.5 varying part: 0.77 of a load of which 0.20 stands asks for more than 0.785 of which 0.55 does."""
    items = _rows_in_time({"": [0.785e5, 0.768e5]}, [0.55e5, 0.20e5], [1e5, 1e5])
    weighed = Criterion(
        "limit", "line_utilisation", 0.95 / 1.5, "at most", "source", "limit", "1", mean_weight=1.1 / 1.5
    )
    demands = [1.1 * mean + 1.5 * (most - mean) for most, mean in ((0.785, 0.55), (0.768, 0.20))]
    assert demands[0] < 1.0 < demands[1]
    limit = replace(weighed, limit=1.0 / 1.5)
    assert judge(items, [limit], computed=True).outcome == "does not hold"
    alone = _rows_in_time({"": [0.785e5, 0.1e5]}, [0.55e5, 0.05e5], [1e5, 1e5])
    assert judge(alone, [limit], computed=True).outcome == "holds"


def test_a_line_of_a_row_without_a_strength_next_to_one_that_has_it_is_not_judged() -> None:
    use = Criterion("limit", "line_utilisation", 0.5, "at most", "source", "limit", "1")
    items = _rows_in_time({"": [1e5, 1e5]}, [5e4, 5e4], [4e5, float("nan")])
    assert judge(items, [use], computed=True).message.endswith("breaking load not given of chain")
    assert judge(_rows_in_time({"": [1e5, 1e5]}, [5e4, 5e4], [4e5, 4e5]), [use], computed=True).outcome == "holds"
