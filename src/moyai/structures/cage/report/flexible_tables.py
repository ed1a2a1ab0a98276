"""Tables of a flexible cage: the cage, its rest in each current, lines and anchors, runs, uncertainty of peaks."""

from __future__ import annotations

import numpy as np

from moyai.report.document import Column, Table, in_one_unit
from moyai.report.reading import Group
from moyai.structures.cage.report.flexible_figures import design_row
from moyai.structures.cage.report.rigid_reading import CageLevel, key
from moyai.structures.cage.report.rigid_tables import _listing as listing
from moyai.structures.cage.report.rigid_tables import _row as row

_CAGE = ("rest_volume", "net_area", "net_mass", "solidity", "submerged_weight", "reserve_buoyancy")


def cage_table(level: CageLevel) -> Table | None:
    """Return volume, net and weights of one cage."""
    group = level.part("cage")
    first = group.labels("cage")
    rows = [
        found
        for name in _CAGE
        if (found := row(group, name, **({"cage": first[0]} if name == "rest_volume" and first else {}))) is not None
        and not (name == "reserve_buoyancy" and int(group.attributes.get("held", 0)))
    ]
    if not rows:
        return None
    words = f"Net law: {group.attributes.get('law', '')}; shelter: {group.attributes.get('wake', '')}."
    return listing(key(level, "cage"), "One cage" if len(first) > 1 else "Cage", rows, note=words)


def current_table(level: CageLevel) -> Table | None:
    """Return volume, drag, collar and loads in every current."""
    statics = level.part("statics")
    speed, share = statics.real("current_speed", "current"), statics.array("volume_share", "current", "cage")
    total, away = statics.array("total_drag", "current"), statics.array("net_deflection", "current", "cage")
    if speed is None or share is None or total is None or away is None:
        return None
    columns = [
        Column("Current", list(speed), "m/s"),
        Column("volume, least", list(100.0 * share.min(axis=1)), "%"),
        Column("drag", list(np.where(np.abs(total) < 1e-6 * np.abs(total).max(), 0.0, total)), "N"),
        Column("net deflection", list(away.max(axis=1)), "m"),
    ]
    if len(statics.labels("cage")) > 1:
        columns[1:2] = [
            Column(f"volume, {name}", list(100.0 * share[:, k]), "%") for k, name in enumerate(statics.labels("cage"))
        ]
    place = statics.array("collar_place", "current", "cage", "axis")
    anchors = statics.array("anchor_tension", "current", "anchor")
    uplift = statics.array("anchor_vertical_tension", "current", "anchor")
    stress = statics.array("collar_stress_largest", "current", "cage")
    ovality = statics.array("collar_ovality", "current", "cage")
    if anchors is not None and place is not None and anchors.shape[1]:
        offset = np.linalg.norm(place[:, :, :2] - place[:1, :, :2], axis=2).max(axis=1)
        columns.append(Column("collar, offset", list(offset), "m"))
        columns.append(Column("largest anchor pull", list(anchors.max(axis=1)), "N"))
    if uplift is not None and uplift.shape[1]:
        columns.append(Column("uplift", list(uplift.max(axis=1)), "N"))
    if ovality is not None and stress is not None:
        columns.append(Column("collar, ovality", list(100.0 * ovality.max(axis=1)), "%"))
    if stress is not None:
        columns.append(Column("collar, stress", list(stress.max(axis=1)), "Pa"))
    return Table(
        key(level, "currents"), "At rest in each current", in_one_unit(columns),
        note="Offsets and deflections from still water. Ovality: largest less smallest diameter over their "
        "mean, each over that as built.",
    )  # fmt: skip


def law_table(level: CageLevel) -> Table | None:
    """Return the design state under every law that was measured on nets like this one."""
    laws = level.part("laws")
    names = laws.labels("law")
    if len(names) < 2:
        return None
    columns = [Column("Law", list(names))]
    for name, label, factor, unit in (
        ("normal_drag_coefficient", "C_D, normal flow", 1.0, ""), ("law_volume_share", "volume left", 100.0, "%"),
        ("law_drag", "drag", 1.0, "N"), ("law_line_tension_maximum", "largest tension", 1.0, "N"),
        ("law_largest_offset", "offset", 1.0, "m"), ("law_anchor_tension_maximum", "largest anchor pull", 1.0, "N"),
    ):  # fmt: skip
        values = laws.real(name, "law")
        if values is not None and np.isfinite(values).any():
            columns.append(Column(label, list(factor * values), unit))
    return Table(
        key(level, "laws"), "The current of the site under each valid law of nets", in_one_unit(columns),
        note=f"At {float(laws.attributes.get('speed', 0.0)):.3g} m/s, twine Reynolds number "
        f"{float(laws.attributes.get('reynolds', 0.0)):.3g}; the first law is that of the case. Laws outside their "
        "range, of one net or of single twines are left out.",
    )  # fmt: skip


def split_table(level: CageLevel) -> Table | None:
    """Return the drag split in every current."""
    statics = level.part("statics")
    speed, split = statics.real("current_speed", "current"), statics.array("drag_along", "current", "part")
    if speed is None or split is None:
        return None
    keep = [k for k in range(split.shape[1]) if np.abs(split[:, k]).max() > 0.0]
    if not keep:
        return None
    names = statics.labels("part")
    columns = [Column("Current", list(speed), "m/s")]
    columns += [Column(names[k], list(np.where(np.abs(split[:, k]) < 1e-9, 0.0, split[:, k])), "N") for k in keep]
    balance = statics.array("balance", "current")
    if balance is not None:
        columns.append(Column("pull less drag", list(np.where(speed > 0.0, 100.0 * balance, np.nan)), "%"))
    return Table(
        key(level, "split"), "Drag split, along the current", in_one_unit(columns),
        note="The last column holds the pull of the anchors (or of the held collar) against the sum.",
    )  # fmt: skip


def lines_table(level: CageLevel) -> Table | None:
    """Return the tensions of every line in still water and in the current of the site."""
    statics = level.part("statics")
    names, speed = statics.labels("line"), statics.real("current_speed", "current")
    lower, upper = (statics.array(f"{end}_end_tension", "current", "line") for end in ("lower", "upper"))
    used = statics.array("utilisation", "current", "line")
    if not names or speed is None or lower is None or upper is None or used is None:
        return None
    columns = [Column("Line", list(names))]
    design = design_row(level, speed)
    for k in sorted({0, design}):
        columns.append(Column(f"lower end, {speed[k]:.3g} m/s", list(lower[k]), "N"))
        columns.append(Column(f"upper end, {speed[k]:.3g} m/s", list(upper[k]), "N"))
    columns.append(Column("of its breaking load", list(100.0 * used[design]), "%"))
    worst = int(np.argmax(used[design]))
    return Table(
        key(level, "lines"), "Lines, bridles and frame at rest", in_one_unit(columns), emphasised=(worst,),
        note="Breaking load: of new rope, without a safety factor.", collapsed=len(names) > 40,
    )  # fmt: skip


def run_table(level: CageLevel, sea: str, run: Group) -> Table | None:
    """Return tensions and snaps of every line in one run."""
    names = run.labels("line")
    values = {
        name: run.real(name, "line")
        for name in (
            "line_tension_mean",
            "line_tension_minimum",
            "line_tension_maximum",
            "lower_end_tension_maximum",
            "utilisation",
            "slack_share",
            "snap_count",
        )
    }
    if not names or any(value is None for value in values.values()):
        return None
    got = {name: np.asarray(value) for name, value in values.items()}
    columns = (
        Column("Line", list(names)),
        Column("mean", list(got["line_tension_mean"]), "N"),
        Column("smallest", list(got["line_tension_minimum"]), "N"),
        Column("highest", list(got["line_tension_maximum"]), "N"),
        Column("highest, lower end", list(got["lower_end_tension_maximum"]), "N"),
        Column("of its breaking load", list(100.0 * got["utilisation"]), "%"),
        Column("slack, of the time", list(100.0 * got["slack_share"]), "%"),
        Column("snaps", [int(value) for value in got["snap_count"]]),
    )
    return Table(
        key(level, sea, run.name, "lines"),
        f"Tensions: {run.attributes.get('wave', run.name)}",
        in_one_unit(columns),
        emphasised=(int(np.argmax(got["utilisation"])),),
        note="Upper ends after the ramp; highest: anywhere in the line, at every step; lower end: at the anchor. A "
        "snap is a peak after slack, above the multiple of the mean that the settings name.",
        collapsed=len(names) > 40,
    )


def drag_table(level: CageLevel, sea: str, run: Group) -> Table | None:
    """Return the mean and largest drag of every part in one run."""
    mean, largest = run.array("drag_mean", "part", "horizontal"), run.array("drag_largest", "part")
    if mean is None or largest is None:
        return None
    names = run.labels("part")
    keep = [k for k in range(len(names)) if largest[k] > 0.0]
    return Table(
        key(level, sea, run.name, "drag"),
        f"Drag on the parts: {run.attributes.get('wave', run.name)}",
        in_one_unit(
            (
                Column("Part", [names[k] for k in keep]),
                Column("mean, x", [float(mean[k, 0]) for k in keep], "N"),
                Column("mean, y", [float(mean[k, 1]) if abs(mean[k, 1]) > 1e-9 else 0.0 for k in keep], "N"),
                Column("largest, horizontal", [float(largest[k]) for k in keep], "N"),
            )
        ),
    )


def sensitivity_table(level: CageLevel, sea: Group) -> Table | None:
    """Return peaks with another step, mesh and damping."""
    values = sea.array("value", "variant", "quantity")
    if values is None:
        return None
    variants, quantities = sea.labels("variant"), sea.labels("quantity")
    columns = [Column("Quantity", list(quantities))]
    columns += [
        Column(name if k == 0 else f"{name}, change", list(values[k]) if k == 0 else list(_change(values, k)),
               "" if k == 0 else "%", uniform=k > 0, digits=4)
        for k, name in enumerate(variants)
    ]  # fmt: skip
    return Table(
        key(level, sea.name, "sensitivity"),
        f"Uncertainty of the peaks: {sea.name}",
        tuple(columns),
        note=f"{sea.attributes.get('wave', '')}; a shorter run with each change.",
    )


def _change(values: np.ndarray, k: int) -> np.ndarray:
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.asarray(np.where(values[0] != 0.0, 100.0 * (values[k] / values[0] - 1.0), np.nan))
