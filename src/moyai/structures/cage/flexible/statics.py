"""Datasets of a flexible cage: what it is, and its rest in a range of currents."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from moyai.structures.cage.flexible.afloat import floating_balance
from moyai.structures.cage.flexible.equilibrium import CageEquilibrium, collar_forces, horizontal_balance, ring_shape
from moyai.structures.cage.flexible.loads import PARTS, pull_on_anchors
from moyai.structures.cage.flexible.model import FlexibleCage
from moyai.structures.cage.flexible.parts import CageNetwork
from moyai.structures.cage.flexible.variables import described

if TYPE_CHECKING:
    import xarray as xr

#: Drag, over the largest tension, below which the balance is that of rounding
_FELT = 1e-5
#: Worst of all currents: name, and what it is the worst of
_WORST = {
    "worst_volume_share": "volume_share",
    "worst_net_deflection": "net_deflection",
    "worst_net_tension": "net_tension",
    "worst_line_tension_maximum": "line_tension_maximum",
    "worst_utilisation": "utilisation",
    "worst_anchor_tension": "anchor_tension",
    "worst_anchor_vertical_tension": "anchor_vertical_tension",
    "worst_collar_stress": "collar_stress_largest",
}


def cage_dataset(model: FlexibleCage, built: CageNetwork) -> xr.Dataset:
    """Return what a cage is: mesh, parts, masses."""
    import xarray as xr

    network = built.network
    panels = network.panels
    assert panels is not None
    kind = np.full(len(network.bars), 4)
    line = np.full(len(network.bars), -1)
    for cage in built.cages:
        kind[cage.net_bars] = 0
        for ring in cage.collar_bars:
            kind[ring] = 1
        kind[cage.ring_bars] = 2
    for number, part in enumerate(built.lines):
        bars = network.strands[part.strand].bars
        kind[bars], line[bars] = 3, number
    weight, spare = floating_balance(model.design, model.water)
    first = built.cages[0]
    own = np.concatenate([first.wall_panels, first.bottom_panels])
    mass = network.bars.of_type("mass_per_length") * network.bars.length
    return described(
        xr.Dataset(
            {
                "node_rest": (("node", "axis"), network.nodes.position),
                "bar_start": ("bar", network.bars.start),
                "bar_end": ("bar", network.bars.end),
                "bar_kind": ("bar", kind),
                "bar_line": ("bar", line),
                "panel_corners": (("panel", "corner"), panels.corners),
                "collar_nodes": (("cage", "around"), np.stack([cage.collar[0] for cage in built.cages])),
                "rest_volume": ("cage", np.array([cage.rest_volume for cage in built.cages])),
                "net_area": float(panels.area[own].sum()),
                "net_mass": float(mass[first.net_bars].sum()),
                "submerged_weight": weight,
                "reserve_buoyancy": spare,
                "solidity": model.design.net.net.solidity,
                "breaking_load": ("line", np.array([part.breaking_load for part in built.lines])),
                "anchor_node": ("anchor", built.anchors),
                "buoy_node": ("buoy", built.buoys),
                "sinker_node": ("sinker", built.sinkers),
            },
            coords={
                "axis": ["x", "y", "z"],
                "cage": [cage.name for cage in built.cages],
                "line": [part.name for part in built.lines],
                "line_kind": ("line", [part.kind for part in built.lines]),
            },
            attrs={
                "shape": model.design.shape, "size": model.design.size, "law": model.design.net.law.name,
                "wake": model.design.net.wake, "bed": model.bed.level, "collar_rings": model.design.collar.rings,
                "collar_rigid": int(model.design.collar.rigid), "held": int(not built.anchors.size),
                "pipe_diameter": model.design.collar.pipe.diameter,
            },
        )
    )  # fmt: skip


def line_numbers(built: CageNetwork, tension: np.ndarray) -> dict[str, np.ndarray]:
    """Return lower, upper and largest tension and utilisation of every line [N]."""
    bars = [built.network.strands[part.strand].bars for part in built.lines]
    largest = np.array([float(tension[own].max()) for own in bars])
    broken = np.array([part.breaking_load for part in built.lines])
    return {
        "lower_end_tension": np.array([float(tension[own[0]]) for own in bars]),
        "upper_end_tension": np.array([float(tension[own[-1]]) for own in bars]),
        "line_tension_maximum": largest,
        "utilisation": largest / broken if len(bars) else largest,
    }


def deflection(built: CageNetwork, position: np.ndarray, calm: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return for each cage the largest displacement of its knots against its collar and the deepest one's lift."""
    furthest, lift = [], []
    for cage in built.cages:
        knots = cage.net_nodes
        moved = position[knots] - position[cage.collar[0]].mean(axis=0)
        before = calm[knots] - calm[cage.collar[0]].mean(axis=0)
        furthest.append(float(np.linalg.norm(moved - before, axis=1).max()))
        deepest = knots[int(np.argmin(calm[knots, 2]))]
        lift.append(float(position[deepest, 2] - calm[deepest, 2]))
    return np.array(furthest), np.array(lift)


def statics_dataset(
    model: FlexibleCage, speeds: list[float], heading: float, rests: list[CageEquilibrium]
) -> xr.Dataset:
    """Return the rest of a cage in every current; the first rest is that in the slowest.

    Parameters
    ----------
    model : FlexibleCage
    speeds : list of float
        At the surface [m/s].
    heading : float
        Of the current [rad].
    rests : list of CageRest
    """
    import xarray as xr

    built = rests[0].built
    along = np.array([math.cos(heading), math.sin(heading), 0.0])
    columns: dict[str, list[np.ndarray | float]] = {}

    def add(**values: np.ndarray | float) -> None:
        for key, value in values.items():
            columns.setdefault(key, []).append(value)

    calm = rests[int(np.argmin(speeds))].state.position
    for rest in rests:
        position = rest.state.position
        split, pull = horizontal_balance(rest)
        total = float(split.sum(axis=0) @ along)
        shapes = [ring_shape(cage, position, built.network.nodes.position) for cage in built.cages]
        far, lift = deflection(built, position, calm)
        missing = float(np.linalg.norm(pull[:2] - split[:, :2].sum(axis=0)))
        add(
            volume_share=np.array([float(cage.volume(position)) / cage.rest_volume for cage in built.cages]),
            drag=split[:, :2], drag_along=split @ along, total_drag=total, pull=pull,
            balance=missing / max(float(np.linalg.norm(split[:, :2].sum(axis=0))), _FELT * float(rest.tension.max())),
            residual=rest.residual,
            collar_place=np.stack([shape[0] for shape in shapes]),
            collar_ovality=np.array([shape[1] for shape in shapes]),
            collar_warp=np.array([shape[2] for shape in shapes]),
            net_tension=built.net_tension(rest.tension),
            net_deflection=far, bottom_lift=lift, position=position, tension=rest.tension,
            **line_numbers(built, rest.tension),
        )  # fmt: skip
        if built.anchors.size:
            each = pull_on_anchors(built, rest.network, position, rest.tension)
            add(anchor_tension=np.linalg.norm(each, axis=1), anchor_vertical_tension=np.maximum(each[:, 2], 0.0))
        if built.cages[0].collar_bars and not model.design.collar.rigid:
            forces = collar_forces(model, rest, position, rest.tension)
            for key in ("stress", "axial", "in_plane", "out_of_plane", "torsion"):
                add(**{f"collar_{key}": np.array([[ring[key] for ring in rings] for rings in forces])})
            add(collar_stress_largest=np.array([max(ring["stress"].max() for ring in rings) for rings in forces]))
    ends: dict[str, tuple[str, ...]] = {
        "volume_share": ("cage",), "drag": ("part", "horizontal"), "drag_along": ("part",), "pull": ("axis",),
        "collar_place": ("cage", "axis"), "collar_ovality": ("cage",), "collar_warp": ("cage",),
        "net_deflection": ("cage",), "bottom_lift": ("cage",), "net_tension": ("cage",),
        "position": ("node", "axis"), "tension": ("bar",),
        "lower_end_tension": ("line",), "upper_end_tension": ("line",), "line_tension_maximum": ("line",),
        "utilisation": ("line",),
        "anchor_tension": ("anchor",), "anchor_vertical_tension": ("anchor",), "collar_stress_largest": ("cage",),
        **{
            f"collar_{key}": ("cage", "ring", "around")
            for key in ("stress", "axial", "in_plane", "out_of_plane", "torsion")
        },
    }  # fmt: skip
    # a study keeps what stands over labels alone: the worst of all currents
    worst = {
        name: (
            ends[key],
            np.array(columns[key]).min(axis=0) if key == "volume_share" else np.array(columns[key]).max(axis=0),
        )
        for name, key in _WORST.items()
        if key in columns and key in ends
    }
    return described(
        xr.Dataset(
            {
                **{key: (("current", *ends.get(key, ())), np.array(values)) for key, values in columns.items()},
                **worst,
                "worst_drag": ((), float(np.array(columns["total_drag"]).max())),
            },
            coords={
                "current_speed": ("current", np.array(speeds)), "part": list(PARTS), "axis": ["x", "y", "z"],
                "horizontal": ["x", "y"], "cage": [cage.name for cage in built.cages],
                "line": [part.name for part in built.lines],
                **({"anchor": built.anchor_names} if built.anchors.size else {}),
            },
            attrs={"heading": heading},
        )
    )  # fmt: skip
