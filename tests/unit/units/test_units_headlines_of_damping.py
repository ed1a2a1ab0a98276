"""The band of damping on the first page of a row: in time as in the frequency domain, and at named regular seas."""

from types import SimpleNamespace

import numpy as np
import pytest
import xarray as xr

from moyai.core.headline import Criterion, judge
from moyai.report.headlines import headline_text
from moyai.structures.units.headlines import (
    _connectors,
    _gaps,
    _waves,
    _with_damping,
    _with_tilt,
    governing_seas,
)
from moyai.structures.units.largest import each_of
from moyai.structures.units.line_headlines import line_headlines
from moyai.structures.units.time.damping import curves_matter

DOFS = ["sway", "heave", "roll"]


def motions(name: str, roll: tuple[float, ...], *, ends: tuple[float, float] | None = None) -> xr.Dataset:
    """Two units over some periods."""
    values = np.zeros((len(roll), 2, 3))
    values[:, 1, 2] = roll
    data = {name: (("period", "unit", "dof"), values)}
    if ends is not None:
        for end, factor in zip(("low", "high"), ends, strict=True):
            data[f"{name}_{end}"] = (("period", "unit", "dof"), factor * values)
    coords = {"period": [3.0 + row for row in range(len(roll))], "unit": [1, 2], "dof": DOFS}
    return xr.Dataset(data, coords=coords, attrs={"status": "converged"})


def test_the_time_domain_keeps_the_band_of_damping():
    frequency = motions("motion_amplitude", (0.06, 0.04), ends=(0.6, 1.5))
    time = motions("motion_amplitude", (0.05, 0.03))
    ((path, data),) = governing_seas({"/SWL/frequency/daily": frequency, "/SWL/time/daily": time})
    assert path == "/SWL/time/daily"
    found = each_of([(path, _with_tilt(data, "roll"))], "tilt")
    roll, other = (next(one for one in found if f"T = {period:g} s" in one.where) for period in (3.0, 4.0))
    assert (roll.value, other.value) == pytest.approx((0.10, 0.06))
    assert (roll.band.low, roll.band.high) == pytest.approx((0.06, 0.15))


def test_ends_that_were_run_in_time_stay():
    frequency = motions("motion_amplitude", (0.06, 0.04), ends=(0.2, 9.0))
    time = motions("motion_amplitude", (0.05, 0.03), ends=(0.9, 1.2))
    found = _with_damping(time, frequency)
    assert found["motion_amplitude_high"].values[:, 1, 2] == pytest.approx((0.06, 0.036))
    assert found["motion_amplitude_low"].values[:, 1, 2] == pytest.approx((0.045, 0.027))


def test_realisations_are_widened_by_the_damping():
    """Largest double amplitudes of three seeds, about their mean, with a range of damping on top."""
    seeds = np.array([0.04, 0.05, 0.06])
    each = np.zeros((3, 1, 3))
    each[:, 0, 2] = seeds
    significant = np.array([[0.0, 0.0, 0.08]])
    dims = ("unit", "dof")
    time = xr.Dataset(
        {
            "maximum_motion": (dims, each.mean(axis=0)),
            "maximum_motion_of_realisation": (("member", *dims), each),
            "significant_motion": (dims, significant),
        },
        coords={"unit": [1], "dof": DOFS},
    )
    spread = {f"significant_motion_{end}": (dims, f * significant) for end, f in (("low", 0.8), ("high", 1.25))}
    frequency = time[["significant_motion"]].assign(spread)
    (roll,) = each_of([("/SWL/time/storm", _with_tilt(_with_damping(time, frequency), "roll"))], "tilt")
    assert roll.value == pytest.approx(0.10) and not roll.band.decides
    assert (roll.band.low, roll.band.high) == pytest.approx((0.8 * 0.08, 1.25 * 0.12))
    # Johnson's interval of three skewed values: 4.899 standard errors of 0.02 / sqrt(3), then the damping
    assert roll.band.judged[1] == pytest.approx(1.25 * (0.10 + 4.8994 * 0.02 / np.sqrt(3.0)), rel=1e-4)


def test_a_named_regular_sea_is_judged_in_every_period():
    data = xr.Dataset(
        {
            "transmission_coefficient": ("period", [0.5, 0.4]),
            "transmission_coefficient_low": ("period", [0.49, 0.3]),
            "transmission_coefficient_high": ("period", [0.51, 0.7]),
            "section_transmission": ("period", [0.4, 0.4]),
        },
        coords={"period": [3.0, 4.0]},
    )
    items = list(_waves([("/SWL/map/daily", data)]))
    # without a sea the period with the worst end is judged too
    limit = Criterion("greatest_transmission", "transmission", 0.6, "at most", "case file")
    assert judge(items, [limit], computed=True).outcome == "does not hold"
    named = [item for item in _waves([("/SWL/map/daily", data)]) if item.sea == "daily"]
    assert [item.value for item in named] == [0.5, 0.4] and max(item.band.high for item in named) == 0.7


def lines_of(tension: float, mean: float = 10.0e3) -> xr.Dataset:
    """One line of a regular sea of one period, one connector that is not stretched across."""
    coords = {"period": [4.0], "line": ["s"], "connector": ["c"], "gap": ["g"]}
    data = {
        "line_tension_maximum": (("period", "line"), [[tension]]),
        "line_tension_mean": (("period", "line"), [[mean]]),
        "connector_resultant_largest": (("period", "connector"), [[5.0e3]]),
        "gap_closing_largest": (("period", "gap"), [[0.2]]),
    }
    return xr.Dataset(data, coords=coords, attrs={"status": "converged"})


REST = xr.Dataset({"breaking_load": ("line", [1.0e6]), "gap_width": ("gap", [0.5])}, coords={"gap": ["g"]})


@pytest.mark.parametrize(("tension", "known"), [(49.0e3, True), (51.0e3, False)])
def test_lines_beyond_their_range_make_the_frequency_domain_unknown(tension, known):
    """The motions that pull a line tight are not held back by it: neither the tension nor what gaps leave is proved."""
    groups, seas = {"/SWL/statics": REST}, [("/SWL/frequency/daily", lines_of(tension))]
    share = next(item for item in line_headlines(groups, seas) if item.name == "line_utilisation")
    safety = Criterion("line_safety", "line_utilisation", 0.5, "at most", "case file")
    assert judge([share], [safety], computed=True).outcome == ("holds" if known else "not judged")
    assert np.isnan(share.value) != known
    closing = next(item for item in _gaps(groups, seas) if item.name == "gap_closing")
    assert (closing.value, closing.bound) == (0.4, "" if known else "at least")
    # in time lines at rest still tell the least that there is
    timed = [("/SWL/time/daily", lines_of(tension))]
    assert next(iter(line_headlines(groups, timed))).bound == ("" if known else "at least")
    assert next(iter(_gaps(groups, timed))).bound == ""


def test_lines_beyond_their_range_at_an_end_of_the_damping_are_not_known_either():
    """That end is what is judged, and the motions there hold a line as little as those in between."""
    ends = {f"line_tension_maximum_{end}": (("period", "line"), [[v]]) for end, v in (("low", 40e3), ("high", 80e3))}
    data, groups = lines_of(45.0e3).assign(ends), {"/SWL/statics": REST}
    tension, *_ = line_headlines(groups, [("/SWL/frequency/daily", data)])
    assert tension.text == "not known" and "45 kN, with damping at the end of its band 80 kN" in tension.detail
    assert next(iter(_gaps(groups, [("/SWL/frequency/daily", data)]))).bound == "at least"
    assert curves_matter(SimpleNamespace(joints=()), data, lines_of(45.0e3))
    assert not curves_matter(SimpleNamespace(joints=()), lines_of(45.0e3), lines_of(45.0e3))


def test_an_inextensible_line_that_does_not_reach_is_not_known():
    found = list(line_headlines({"/SWL/statics": REST}, [("/SWL/frequency/daily", lines_of(np.inf))]))
    assert {item.text for item in found} == {"not known"} and "does not reach" in found[0].detail


def test_the_parts_of_a_motion_that_does_not_repeat_are_a_band():
    parts = np.array([40.0, 42.0, 41.0, 45.0, 43.0]) * 1e3
    named = {"line_tension_maximum_of_realisation": (("member", "period", "line"), parts[:, None, None])}
    data = lines_of(float(parts.mean())).assign(named)
    (found,) = each_of([("/SWL/time/daily", data)], "line_tension_maximum")
    assert (found.band.low, found.band.high) == (40e3, 45e3) and "5 parts of a record" in found.band.of
    assert found.band.judged[1] > found.value and found.band.more == "settings.time.duration"
    # those of periods that do repeat are blank
    (still,) = each_of(
        [("/SWL/time/daily", data.assign({k: v * np.nan for k, v in data[list(named)].items()}))], found.name
    )
    assert still.band is None and still.bound == ""


def test_the_moment_of_a_connector_has_the_band_of_its_realisations():
    each = np.array([600.0, 700.0, 650.0])
    dims = ("connector", "component")
    moments = np.zeros((3, 1, 3))
    moments[:, 0, 2] = each
    data = xr.Dataset(
        {
            "connector_resultant_largest": ("connector", [50.0]),
            "connector_moment_largest": (dims, moments.mean(axis=0)),
            "connector_moment_largest_of_realisation": (("member", *dims), moments),
            "relative_motion_largest": (dims, np.zeros((1, 3))),
            "line_tension_maximum": ("line", [1.0]),
            "line_tension_mean": ("line", [1.0]),
        },
        coords={"connector": ["h"], "line": ["s"], "component": list("xyz")},
        attrs={"status": "converged"},
    )
    rest = xr.Dataset({"connector_breaking_load": ("connector", [np.inf])})
    found = _connectors({"/SWL/statics": rest}, [("/SWL/time/storm", data)])
    (moment,) = [item for item in found if item.name == "connector_moment"]
    assert (moment.value, moment.band.low, moment.band.high) == pytest.approx((650.0, 600.0, 700.0))
    assert moment.band.judged[1] > 650.0


@pytest.mark.parametrize(
    ("tension", "curved", "shown"), [(424.0e3, False, "420 kN"), (44.1e3, False, "44.1 kN"), (44.1e3, True, "44 kN")]
)
def test_a_tension_that_no_run_repeats_has_two_digits(tension, curved, shown):
    """Scaled and mirrored, such a row gives other digits: rounding decides when a chain comes taut."""
    named = {"line_tension_maximum_of_realisation": (("member", "period", "line"), tension * np.ones((5, 1, 1)))}
    stretched = {"elongation_highest": (("period", "connector"), [[0.1 if curved else np.nan]])}
    groups = {"/SWL/statics": REST}
    data = lines_of(tension).assign(named | stretched)
    (line, share, *_) = line_headlines(groups, [("/SWL/time/daily", data)])
    assert headline_text(line).removeprefix("at least ") == shown
    assert share.digits == line.digits and share.value == tension / 1.0e6
    # one run of regular waves that repeats, or the frequency domain, is known
    alone = data.drop_vars(list(named))
    assert next(iter(line_headlines(groups, [("/SWL/time/daily", alone)]))).digits == 3
    assert (
        next(iter(line_headlines(groups, [("/SWL/frequency/daily", lines_of(44.1e3).assign(stretched))]))).digits == 3
    )
