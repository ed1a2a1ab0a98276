"""Connectors that let go within a wave, and hulls that meet: what the first page then still knows."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
import xarray as xr

from moyai.core.errors import InputError
from moyai.core.headline import Criterion, judge
from moyai.potential.shapes import circle, trapezoid
from moyai.structures.units.contact import loses_contact, measured_ends, meeting_variables, steady_meeting, touches
from moyai.structures.units.datasets import with_damping_band
from moyai.structures.units.doubts import curve_notices, meeting_notices
from moyai.structures.units.headlines import _connectors, _gaps, governing_seas, greatest_rolls
from moyai.structures.units.line_headlines import line_headlines
from moyai.structures.units.model import Connector, Curve, Placement
from moyai.structures.units.outlines import breadths, check_apart, least_distance
from moyai.validation.units import at_rest, row

FENDER = Curve((-1.05, -0.05, 1.05), (-3e6, 0.0, 0.0))
CHAIN = Curve((-0.9, 0.1, 1.1), (0.0, 0.0, 2e6))
RUBBER = Curve((-0.1, 0.0, 0.2), (-8e4, 0.0, 6e4))
TIE = Curve((-0.3, 0.0, 0.3), (-3e5, 0.0, 3e2))
PULLING = Curve((-0.1, 0.0, 0.2), (0.0, 0.0, 6e4))


@pytest.mark.parametrize(
    ("curve", "low", "high", "expected"),
    [
        (FENDER, -0.09, -0.06, (True, False)),  # pressed all the while
        (FENDER, -0.09, -0.02, (True, True)),
        (FENDER, -0.04, 3.0, (False, False)),  # beyond its curve as well
        (CHAIN, 0.2, 0.5, (True, False)),
        (CHAIN, -0.2, 0.5, (True, True)),
        (RUBBER, -0.05, 0.1, (True, False)),  # changes its side at one point
        (PULLING, -0.05, 0.1, (True, True)),
        (PULLING, 0.01, 0.1, (True, False)),
        (FENDER, -0.06, -0.06, (True, False)),  # no motion
        (FENDER, 0.0, 0.0, (False, False)),
        (TIE, -0.01, 0.01, (True, True)),  # hardly pulls
        (TIE, -0.02, -0.01, (True, False)),
    ],
)
def test_a_connector_lets_go_where_its_curve_is_zero_over_a_stretch(
    curve: Curve, low: float, high: float, expected: tuple[bool, bool]
) -> None:
    assert touches(curve, low, high)[:2] == expected


PIN = Connector("pin", "ball", ((0, 1),), 0.0, 1.0)


def _fender(name: str) -> Connector:
    return Connector(name, "fender", ((0, 1),), 0.0, 3.0, (0.0, 1.0, 0.0), curve=FENDER)


@pytest.mark.parametrize(
    ("connectors", "worked", "lost"),
    [
        ((_fender("f"),), [(-0.09, -0.06)], False),
        ((_fender("f"),), [(-0.09, 0.02)], True),
        ((_fender("f"),), [(-0.02, 0.02)], False),
        # one that is lifted next to one that never is, and next to a ball
        ((_fender("f"), _fender("g")), [(-0.09, 0.02), (-0.09, -0.06)], True),
        ((PIN, _fender("f")), [(np.nan, np.nan), (-0.09, 0.02)], True),
        ((PIN,), [(np.nan, np.nan)], False),
    ],
)
def test_contact_of_a_row_is_lost_where_any_connector_lets_go(
    connectors: tuple[Connector, ...], worked: list[tuple[float, float]], lost: bool
) -> None:
    """A fender that is pressed by 3 cm at rest is no spring that pulls."""
    low, high = np.array(worked).T
    assert loses_contact(at_rest(row(connectors)), low, high) is lost


def test_contact_that_is_lost_at_an_end_of_the_damping_is_lost() -> None:
    own, other = (xr.Dataset({"connector_loses_contact": ((), lost)}) for lost in (0, 1))
    assert int(with_damping_band(own, [own, other])["connector_loses_contact"]) == 1


DIMS = ("connector", "component")


def _regular(*, loses: int = 0, meet: int = 0, closing: float = 0.05, force: float = 5e2) -> xr.Dataset:
    """One period over two units with a fender in a gap of 0.5 m."""
    data = xr.Dataset(
        {
            "connector_resultant_largest": ("connector", [force]),
            "connector_moment_largest": (DIMS, [[10.0, 0.0, 0.0]]),
            "relative_motion_largest": (DIMS, [[0.0, 0.006, 0.0]]),
            "connector_loses_contact": ((), loses),
            "gap_closing_largest": ("gap", [closing]),
            "hulls_meet": ((), meet),
            "least_distance": ((), 0.4),
            "elongation_lowest": ("connector", [-0.21]),
            "elongation_highest": ("connector", [0.33]),
            "line_tension_maximum": ("line", [2.0]),
            "line_tension_mean": ("line", [2.0]),
        },
        coords={"connector": ["f"], "component": list("xyz"), "gap": ["gap 1-2"], "line": ["a"]},
    )
    return data.expand_dims({"period": [4.0]})


def _groups(sea: xr.Dataset, domain: str = "frequency", **statics: Any) -> dict[str, xr.Dataset]:
    known = {"connector_breaking_load": ("connector", [1e5]), "gap_width": ("gap", [0.5]), **statics}
    rest = xr.Dataset(known, coords={"connector": ["f"]})
    return {"/SWL/statics": rest, f"/SWL/{domain}/daily": sea}


LIMITS = (
    Criterion("factor", "connector_utilisation", 0.5, "at most", "case", as_factor=True),
    Criterion("motion", "gap_motion", 0.3, "at most", "case"),
    Criterion("closing", "gap_closing", 1.0, "at most", "case"),
)


def test_regular_waves_that_lift_a_fender_give_bounds_that_hold_nothing() -> None:
    for loses, outcome in ((0, "holds"), (1, "not judged")):
        groups = _groups(_regular(loses=loses))
        seas = governing_seas(groups)
        found = [*_connectors(groups, seas), *_gaps(groups, seas)]
        assert {item.bound for item in found} == {"at least" if loses else ""}
        assert {item.outcome for item in judge(found, LIMITS, computed=True).judgements} == {outcome}
        words = {item.name: item.detail for item in found}
        for name in ("connector_force", "gap_motion", "gap_closing"):
            assert ("releases within the wave" in words[name]) is bool(loses), name
            assert "slow drift" not in words[name]


@pytest.mark.parametrize("force", [0.0, 2.7e5])
def test_nothing_is_known_of_connectors_between_hulls_that_meet(force: float) -> None:
    """Neither no load nor the pull of a chain whose ends have passed through each other."""
    groups = _groups(_regular(meet=1, closing=1.33, force=force))
    seas = governing_seas(groups)
    found = [*_connectors(groups, seas), *_gaps(groups, seas)]
    assert {item.name for item in found if item.text == "not known" and np.isnan(item.value)} == {
        "connector_force", "connector_utilisation", "connector_moment", "gap_motion",
    }  # fmt: skip
    assert all("hulls meet" in item.detail for item in found if item.text)
    outcomes = {item.criterion.name: item.outcome for item in judge(found, LIMITS, computed=False).judgements}
    assert outcomes == {"factor": "not judged", "motion": "not judged", "closing": "does not hold"}
    (notice,) = meeting_notices(groups, seas)
    assert notice.severity == "error" and notice.limit == 1.0 and notice.value == pytest.approx(2.66)
    assert "T = 4 s" in notice.message and "1.33 m of 0.5 m" in notice.message


def test_a_sea_in_which_hulls_meet_stands_before_one_that_is_known() -> None:
    groups = {**_groups(_regular()), "/SWL/frequency/storm": _regular(meet=1, closing=0.6, force=0.0)}
    force = next(item for item in _connectors(groups, governing_seas(groups)) if item.name == "connector_force")
    assert force.text == "not known" and "storm" in force.where and force.shown


@pytest.mark.parametrize(("known", "shown"), [(0.0, "not known"), (3e3, "")])
def test_no_load_in_one_sea_is_none_in_the_next(known: float, shown: str) -> None:
    """A chain that stays slack in regular waves; in the storm, where it bears and lets go, nothing is known of it."""
    groups = {**_groups(_regular(force=known)), "/SWL/frequency/storm": _regular(loses=1, force=0.0)}
    found = [item for item in _connectors(groups, governing_seas(groups)) if item.name == "connector_force"]
    assert [item.text for item in found if item.shown] == [shown]
    assert {item.text for item in found} == {"not known", ""}


def test_one_realisation_in_which_hulls_meet_is_reported() -> None:
    sea = _regular(meet=1, closing=0.45).squeeze("period", drop=True)
    sea["gap_closing_largest_of_realisation"] = (("member", "gap"), [[0.4], [0.52]])
    groups = _groups(sea)
    (notice,) = meeting_notices(groups, [("/SWL/time/storm", sea)])
    assert notice.value == pytest.approx(1.04)


def test_hulls_that_meet_with_less_damping_are_reported() -> None:
    """The force is then not known, and the run is no more within its range than its verdict says."""
    own, other = _regular(closing=0.45), _regular(meet=1, closing=0.52)
    sea = with_damping_band(own, [own, other])
    groups = _groups(sea)
    seas = governing_seas(groups)
    (notice,) = meeting_notices(groups, seas)
    assert notice.severity == "error" and notice.value == pytest.approx(1.04)
    assert {item.text for item in _connectors(groups, seas) if item.name == "connector_force"} == {"not known"}


def test_hulls_meet_by_their_motion_or_where_they_lie_in_the_mean() -> None:
    at = at_rest(row())
    moved = np.zeros(12)
    assert not meeting_variables(at, moved, np.array([0.99]))["hulls_meet"]
    assert meeting_variables(at, moved, np.array([1.0]))["hulls_meet"]
    moved[7] = -1.6
    found = meeting_variables(at, moved, np.array([0.0]))
    assert found["hulls_meet"] and float(found["least_distance"]) == pytest.approx(-0.6)
    (notice,) = steady_meeting(at, moved)
    assert notice.value == pytest.approx(1.6) and "without waves" in notice.message
    # beyond the corner of a unit there is no gap that is followed
    aside = at_rest(replace(row(), placements=(Placement(0.0, 0.0), Placement(11.0, 21.0))))
    moved = np.zeros(12)
    assert not list(steady_meeting(aside, moved))
    moved[6:8] = -1.25, -1.5
    (notice,) = steady_meeting(aside, moved)
    assert "overlap by 0.25 m" in notice.message and notice.severity == "error"


def test_decks_that_lie_in_one_another_are_refused() -> None:
    """Trapezoids of 4 m at the keel and 6 m at the deck, 5.5 m from middle to middle: waterlines apart, decks not."""
    hull = trapezoid(4.0, 6.0, 2.2)
    assert np.allclose(breadths(hull), [[-3.0, 3.0]])
    places = (Placement(0.0, 0.0), Placement(5.5, 0.0))
    given = replace(row(), hull=hull, placements=places)
    assert least_distance(given, places) == (pytest.approx(-0.5), (0, 1))
    with pytest.raises(InputError, match=r"units 1 and 2 overlap by 0.5 m"):
        check_apart(given)
    check_apart(replace(given, placements=(places[0], Placement(6.1, 0.0))))
    # turned by a right angle, its end 0.2 m from the deck of the other
    least, _ = least_distance(given, (places[0], Placement(13.2, 0.0, 0.5 * np.pi)))
    assert least == pytest.approx(0.2)
    assert np.allclose(breadths(circle(3.0)), [[-3.0, 3.0]], atol=3e-3)


def test_rubber_beyond_its_curve_bears_at_least_what_is_shown() -> None:
    """From -0.21 to 0.33 m on a curve from -0.1 to 0.2 m, in time as well; a side that bears nothing has no end."""
    assert measured_ends(RUBBER, "rubber") == (-0.1, 0.2)
    low, high = measured_ends(PULLING, "rubber")
    assert np.isnan(low) and high == 0.2
    assert np.isnan(measured_ends(CHAIN, "chain")).all()
    for ends, bound in (((-0.1, 0.2), "at least"), ((-0.3, 0.4), ""), ((np.nan, 0.4), "")):
        known = {"curve_lowest": ("connector", [ends[0]]), "curve_highest": ("connector", [ends[1]])}
        sea = _regular().assign_attrs(status="converged")
        groups = {**_groups(sea, **known), "/SWL/time/daily": sea}
        seas = governing_seas(groups)
        found = {item.name: item for item in _connectors(groups, seas)}
        assert found["connector_force"].bound == found["connector_utilisation"].bound == bound
        assert ("curve ends at -0.1 and 0.2 m" in found["connector_force"].detail) is bool(bound)
        notices = list(curve_notices(seas))
        assert len(notices) == bool(bound)
        assert all("worked from -0.21 to 0.33 m" in item.message for item in notices)


def test_roll_is_held_against_the_deck_edge_from_upright_at_the_end_of_its_band() -> None:
    dims = ("unit", "dof")
    data = xr.Dataset(
        {
            "significant_motion": (dims, [[0.4], [0.6]]), "significant_motion_high": (dims, [[0.4], [0.75]]),
            "significant_motion_low": (dims, [[0.4], [0.5]]),
            "most_probable_maximum_motion": (dims, [[0.3], [0.45]]), "mean_offset": (dims, [[0.1], [-0.02]]),
        },
        coords={"unit": [1, 2], "dof": ["roll"]},
    )  # fmt: skip
    ((where, roll),) = greatest_rolls([("/SWL/frequency/storm", data)])
    # Gumbel's law: 19 of 20 storms have less than the mode of three deviations and 2.97 thirds of one
    storm = 1.0 - math.log(-math.log(0.95)) / 3.0**2
    assert where == "SWL, storm, unit 2" and roll == pytest.approx(0.02 + 0.45 * 0.75 / 0.6 * storm)


def _met(closing: float) -> dict[str, xr.Dataset]:
    """A sea in time of which damping at the end of its band closes the gap by a quarter more."""
    data = (
        _regular(closing=closing)
        .isel(period=0, drop=True)
        .assign(
            gap_closing_largest_of_realisation=(("member", "gap"), [[0.9 * closing], [1.1 * closing]]),
            largest_offset=("unit", [0.8]),
            connector_damage_rate=("connector", [1e-9]),
        )
    )
    data.attrs |= {"status": "converged", "duration": 3600.0}
    ends = {f"{name}_{end}": factor * data[name] for name in ("gap_closing_largest", "connector_resultant_largest")
            for end, factor in (("low", 0.8), ("high", 1.25))}  # fmt: skip
    statics = xr.Dataset(
        {
            "connector_breaking_load": ("connector", [1e6]), "gap_width": ("gap", [0.5]),
            "breaking_load": ("line", [1e6]), "connector_endurance_exponent": ("connector", [4.0]),
        }
    )  # fmt: skip
    return {"/SWL/statics": statics, "/SWL/frequency/storm": data.assign(ends), "/SWL/time/storm": data}


@pytest.mark.parametrize(("closing", "known"), [(0.35, True), (0.38, False)])
def test_hulls_that_meet_in_one_realisation_with_damping_at_its_end_leave_nothing_known(
    closing: float, known: bool
) -> None:
    """A tenth above the mean and a quarter more with damping: 0.38 m of 0.5 m is 0.52 m."""
    groups = _met(closing)
    seas = governing_seas(groups)
    found = [item for item in [*_connectors(groups, seas), *line_headlines(groups, seas)] if item.shown]
    for name in ("connector_force", "line_tension", "line_utilisation"):
        (item,) = (one for one in found if one.name == name)
        assert (item.text != "not known") is known, name
    assert bool(list(meeting_notices(groups, seas))) is not known


def test_the_life_of_a_connector_has_the_band_of_damping_to_the_power_of_its_endurance() -> None:
    groups = _met(0.1)
    damage = next(item for item in _connectors(groups, governing_seas(groups)) if item.name == "connector_damage")
    assert damage.band is not None and damage.value == pytest.approx(3.6e-6)
    assert (damage.band.low, damage.band.high) == pytest.approx((0.8**4 * 3.6e-6, 1.25**4 * 3.6e-6))
