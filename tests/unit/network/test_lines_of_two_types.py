"""Lines of two types: a coarse heavy stretch on the bed at rest, a light one under a heavy top in an irregular sea."""

from __future__ import annotations

import numpy as np
import pytest
import xarray as xr

import moyai
from moyai.core.headline import Band, Headline
from moyai.structures.network.at_rest import with_mesh_of_rest
from moyai.structures.network.chance import SNAPS_OF_ONE_SEED, of_pull, one_seed_of_snaps

AT_REST = """
moyai: 1
title: Buoy on rope and ground chain
site: {water_depth: DEPTH m, density: 1025 kg/m3, gravity: 9.81 m/s2}
current: {speed: SPEED m/s, heading_deg: 0, profile: {power_law: 0.143}}
structure:
  kind: network
  bed: {stiffness: 1e6 Pa/m, damping: 3e4 Pa s/m, friction: 0.5}
  line_types:
    chain: {diameter: 40 mm, mass: 35 kg/m, volume: 4.5e-3 m2, axial_stiffness: 140 MN, damping_ratio: 0.1,
            drag_normal: 2.0, drag_tangential: 0.6, added_mass_normal: 1}
    rope: {diameter: 48 mm, mass: 1.9 kg/m, volume: 1.75e-3 m2, axial_stiffness: 0.8 MN, damping_ratio: 0.1,
           drag_normal: 1.2, drag_tangential: 0.1, added_mass_normal: 1}
  points:
    anchor: {kind: fixed, position: [0, 0, bed]}
    buoy: {kind: cylinder, position: [CHAIN m, 0, 0], diameter: 1.6 m, height: 1.8 m, mass: 900 kg,
           drag_coefficient: 1.0, added_mass_coefficient: 0.6}
  lines:
    line: {start: anchor, end: buoy, parts: [{type: chain, length: CHAIN m, segments: COARSE},
                                             {type: rope, length: ROPE m, segments: 40}]}
analyses: [statics]
criteria: {greatest_offset: LIMIT m}
"""


def offset(depth: float, speed: float, chain: float, rope: float, coarse: int, limit: float):
    text = AT_REST
    words = {"DEPTH": depth, "SPEED": speed, "CHAIN": chain, "ROPE": rope, "COARSE": coarse, "LIMIT": limit}
    for word, value in words.items():
        text = text.replace(word, f"{value:g}")
    result = moyai.run(text)
    (found,) = [item for item in result.headlines if item.name == "offset" and item.shown]
    return result, found


@pytest.mark.slow
@pytest.mark.parametrize(
    ("depth", "speed", "chain", "rope", "coarse"),
    [(15.0, 0.8, 40.0, 17.0, 4), (20.0, 0.7, 30.0, 22.0, 2), (40.0, 0.5, 100.0, 42.0, 8)],
)
def test_the_offset_on_coarse_ground_chain_holds_that_on_a_fine_one(
    depth: float, speed: float, chain: float, rope: float, coarse: int
) -> None:
    """Bars of kilonewtons lie as a whole under a rope of some hundred newtons: two meshes of them agree by chance."""
    _, fine = offset(depth, speed, chain, rope, 200, 1e3)
    result, found = offset(depth, speed, chain, rope, coarse, 0.995 * fine.value)
    assert found.value < 0.985 * fine.value
    assert found.band is not None and found.band.low <= fine.value <= found.band.high
    assert result.verdict.outcome == "does not hold"


def groups(light: np.ndarray, heavy: np.ndarray, pull: np.ndarray) -> dict[str, xr.Dataset]:
    """Return the record of a line from a fixed point: a light stretch under a heavy one."""
    time = np.arange(light.size, dtype=float)
    series = xr.Dataset(
        {
            "line_tension_peak_since_row": (("time", "line"), np.maximum(light, heavy)[:, None]),
            "stretch_tension": (("time", "stretch"), np.stack([light, heavy], axis=1)),
            "point_load_peak_since_row": (("time", "point", "measure"), pull[:, None, None]),
        },
        coords={
            "time": time, "line": ["line"], "stretch": ["line stretch 1", "line stretch 2"], "point": ["anchor"],
            "measure": ["size"],
        },
        attrs={"irregular": 1, "skip": 0.0, "growth": 0.0, "period": 8.0, "seed": 1},
    )  # fmt: skip
    network = xr.Dataset(
        {
            "point_node": ("point", [0]), "bar_start": ("bar", [0, 1]), "bar_end": ("bar", [1, 2]),
            "bar_line": ("bar", np.array(["line", "line"], dtype=object)),
        },
        coords={"point": ["anchor"]},
    )  # fmt: skip
    summary = xr.Dataset({"snap_count": (("run", "line"), [[0.0]])}, coords={"run": ["storm"], "line": ["line"]})
    return {"/SWL/time/storm": series, "/SWL/network": network, "/SWL/dynamic": summary}


def sea() -> np.ndarray:
    """Return 1200 s of waves of 8 s whose height grows and falls."""
    time = np.arange(1200.0)
    return np.sin(2.0 * np.pi * time / 8.0) * (1.0 + 0.5 * np.sin(2.0 * np.pi * time / 170.0))


def test_a_light_stretch_near_slack_is_seen_under_a_heavy_one() -> None:
    light, heavy = 2700.0 + 1600.0 * sea(), 5000.0 + 1600.0 * sea()
    found = one_seed_of_snaps(groups(light, heavy, light), "SWL", "storm", np.zeros(0))
    assert light.min() < light.mean() / 3.0 < heavy.mean() / 3.0 < heavy.min()
    assert found and found[0] == SNAPS_OF_ONE_SEED
    assert one_seed_of_snaps(groups(heavy, heavy, heavy), "SWL", "storm", np.zeros(0)) == []


def test_a_pull_that_friction_holds_grows_as_the_tension_does() -> None:
    tension = 6000.0 + 800.0 * sea()
    still = np.full(tension.size, 3106.0) + 1e-3 * sea()
    every = groups(tension, tension, still)
    held, said = of_pull(every, "SWL", "storm", every["/SWL/time/storm"], "anchor")
    assert held is not None and said == "as the tension of line over the bed"
    every = groups(tension, tension, tension)
    free, nothing = of_pull(every, "SWL", "storm", every["/SWL/time/storm"], "anchor")
    assert free is not None and nothing == ""
    beyond = free.range[1] - free.observed
    assert beyond > 0.0 and held.range[1] - held.observed == pytest.approx(beyond, rel=1e-9)


RUN = AT_REST.replace("analyses: [statics]", "analyses: [ANALYSES]\nsettings: {duration: 20 s, mesh_check: off}")


@pytest.mark.parametrize("analyses", [pytest.param("statics, dynamic", marks=pytest.mark.slow), "dynamic"])
def test_the_offset_of_a_run_has_the_meshes_of_the_rest(analyses: str) -> None:
    """The check of a run looks at the peak of the tension: the ground chain lies in it as coarse as in the run."""
    words = {"DEPTH": 15, "SPEED": 0.8, "CHAIN": 40, "ROPE": 17, "COARSE": 4, "LIMIT": 48}
    text = RUN.replace("ANALYSES", analyses)
    for word, value in words.items():
        text = text.replace(word, f"{value:g}")
    result = moyai.run(text)
    (found,) = [item for item in result.headlines if item.name == "offset" and item.shown]
    assert found.value < 47.5
    if "statics" in analyses:
        # 48.34 m with 200 segments of chain
        assert found.band is not None and found.band.low <= 48.34 <= found.band.high
        assert result.verdict.outcome != "holds"
    else:
        assert found.bound == "at least" and "touchdown" in found.bound_by
        assert result.verdict.outcome != "holds"


def test_a_point_that_stays_at_rest_gets_what_the_mesh_moves_and_no_multiple_of_it() -> None:
    """A clump on the bed: its offset at rest is none, in a run some millimetres."""
    condition = ["still water", "current"]
    rest = xr.Dataset(
        {
            "point_position": (("condition", "point", "axis"), np.zeros((2, 1, 3))),
            "point_position_of_mesh": (("condition", "mesh", "point", "axis"), np.zeros((2, 2, 1, 3))),
            "lift_of_mesh": (("condition", "mesh"), [[0.4, 0.1], [0.4, 0.1]]),
        },
        coords={"condition": condition, "point": ["clump"]},
    )  # fmt: skip
    run = Headline("offset", "Largest offset", 0.004, "m", band=Band(0.003, 0.006, "seeds", judged=(0.003, 0.005)))
    found = with_mesh_of_rest(run, {"/SWL/statics": rest}, "SWL", "point", "clump", None)
    assert found.value == 0.004 and found.band is not None and found.band.judged is not None
    assert (found.band.low, found.band.high) == pytest.approx((0.003, 0.106))
    assert found.band.judged == pytest.approx((0.003, 0.105))
