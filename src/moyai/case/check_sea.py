"""Checks of site, waves, wind and current, the same for every structure."""

from __future__ import annotations

import math
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any

from moyai.case.faults import did_you_mean
from moyai.case.findings import Findings, duplicates
from moyai.case.schema_environment import PowerLawKeys, RegularWavesKeys, SpectrumFile, SpeedTable, Tma, sea_names
from moyai.case.yaml_reader import KeyPath

if TYPE_CHECKING:
    from moyai.core.validity import Notice
    from moyai.sea.states import RegularSea
    from moyai.sea.water import Water

#: Beyond it waves run along the structure and reflection and transmission lose their meaning
LARGEST_HEADING_DEG = 89.5
#: From the normal of a structure; beyond it less than a quarter of a velocity acts across it
LARGEST_USUAL_ANGLE_DEG = 75.0
#: [m/s]; strongest gust and strongest tidal stream on record are near 113 and 10 m/s
LARGEST_SPEED = {"wind": 113.0, "current": 10.0}


_HIGH = {"HWL", "HHWL", "MHWL", "MHWS", "HAT", "HHWOST"}
_LOW = {"LWL", "LLWL", "MLWL", "MLWS", "LAT", "LLWOST"}


def check_surroundings(model: Any, findings: Findings, folder: Path) -> None:
    """Check water levels, headings, sea states and current against each other."""
    _check_levels(model.site, findings)
    _check_order(model.site.water_levels, findings)
    _check_bearings(model, findings)
    for index in duplicates(sea_names(model.waves)):
        name = sea_names(model.waves)[index]
        findings.fault(wave_path(findings, index, "name"), f"two sea states are called '{name}'", remedy="rename one")
    for index, state in enumerate(model.waves):
        if isinstance(state, Tma) and math.isinf(model.site.water_depth):
            findings.fault(
                wave_path(findings, index, "kind"),
                "a TMA spectrum needs a finite water depth",
                remedy="use jonswap, which it tends to",
            )
        if isinstance(state, SpectrumFile):
            check_file(wave_path(findings, index, "file"), state.file, folder, findings)
    _check_current(model, findings)
    for name in model.site.water_levels:
        _check_name(("site", "water_levels", name), name, findings)
    for index, name in enumerate(sea_names(model.waves)):
        _check_name(wave_path(findings, index, "name"), name, findings)
    for key in ("wind", "current"):
        entry = getattr(model, key, None)
        speed = getattr(entry, "speed", None)
        if speed is not None and abs(speed) > LARGEST_SPEED[key]:
            findings.warn((key, "speed"), f"{speed:g} m/s is more than has been measured")


def along(path: KeyPath, what: str, degrees: float, structure: str, findings: Findings) -> None:
    """Warn of waves or a current that run nearly along a structure.

    Parameters
    ----------
    path : KeyPath
        Of the heading.
    what : str
        Whose heading it is.
    degrees : float
        From the normal of the structure.
    structure : str
        With its article.
    findings : Findings
    """
    findings.warn(
        path,
        f"the heading of the {what} lies {abs(degrees):.4g} degrees from the normal of {structure}, nearly along it: "
        f"{100.0 * math.cos(math.radians(degrees)):.1f} % of the horizontal velocity acts across",
        allowed=f"usually at most {LARGEST_USUAL_ANGLE_DEG:g} degrees",
        remedy="check the heading; what comes from the front loads it most",
    )


def check_level_names(model: Any, findings: Findings) -> None:
    """Check that the site has the water levels that ``settings.water_levels`` names, each once."""
    chosen = model.settings.water_levels
    if isinstance(chosen, str):
        return
    for index, name in enumerate(chosen):
        if name not in model.site.water_levels:
            findings.fault(
                ("settings", "water_levels", index),
                f"there is no water level '{name}'",
                allowed=", ".join(model.site.water_levels),
                remedy=did_you_mean(name, model.site.water_levels),
            )
    for index in duplicates(chosen):
        findings.fault(("settings", "water_levels", index), f"'{chosen[index]}' is given twice", remedy="remove one")


def _check_name(path: KeyPath, name: str, findings: Findings) -> None:
    """Refuse names that cannot stand as a group of the results file."""
    if "/" in name or name.strip() in ("", ".", ".."):
        findings.fault(path, f"'{name}' cannot name a group of results", allowed="words without '/'")


def wave_path(findings: Findings, index: int, *keys: str) -> KeyPath:
    """Return the path of a sea state's key, whether the file has a list or a single block."""
    single = ("waves", 0) not in findings.document.values
    return ("waves", *keys) if single else ("waves", index, *keys)


def check_file(path: KeyPath, name: str, folder: Path, findings: Findings, *, folder_allowed: bool = False) -> bool:
    """Check that a named file is there; return whether it is."""
    target = folder / name
    try:
        if target.is_dir() and not folder_allowed:
            findings.fault(path, f"'{name}' is a folder", remedy="name the file in it")
        elif not target.exists():
            findings.fault(path, f"there is no file '{name}' in {folder}", remedy="paths count from the case file")
        else:
            return True
    except (OSError, ValueError) as error:
        findings.fault(path, f"'{name}' cannot be opened: {error}")
    return False


def _check_order(levels: dict[str, float], findings: Findings) -> None:
    """Warn of a high water that lies below a low water."""
    high = {name: z for name, z in levels.items() if name.upper() in _HIGH}
    low = {name: z for name, z in levels.items() if name.upper() in _LOW}
    for name, z in high.items():
        under = [other for other, height in low.items() if height > z]
        if under:
            findings.warn(
                ("site", "water_levels", name), f"{name} lies below {under[0]}: {z:g} and {low[under[0]]:g} m",
                remedy="heights count upwards from datum; were they exchanged?",
            )  # fmt: skip


def _check_levels(site: Any, findings: Findings) -> None:
    for name, level in site.water_levels.items():
        if site.water_depth + level <= 0.0:
            findings.fault(
                ("site", "water_levels", name),
                f"the water level {level:g} m leaves no water over the bed",
                allowed=f"above {-site.water_depth:g} m",
            )
    values = list(site.water_levels.items())
    for index in duplicates([f"{level!r}" for _, level in values]):
        name, level = values[index]
        findings.warn(("site", "water_levels", name), f"there is another water level at {level:g} m as well")


def _check_bearings(model: Any, findings: Findings) -> None:
    if model.site.x_axis_bearing_deg is not None:
        return
    entries: list[tuple[KeyPath, Any]] = [
        (wave_path(findings, index), state) for index, state in enumerate(model.waves)
    ]
    given = [(name, getattr(model, name, None)) for name in ("wind", "current")]
    entries += [((name,), entry) for name, entry in given if entry is not None]
    for path, entry in entries:
        for key in ("from_bearing_deg", "to_bearing_deg"):
            if getattr(entry, key, None) is not None:
                findings.fault(
                    (*path, key),
                    f"'{key}' needs 'site.x_axis_bearing_deg'",
                    remedy="give the bearing that +x points to, or use 'heading_deg'",
                )


def _check_current(model: Any, findings: Findings) -> None:
    current = model.current
    if current is None:
        return
    if isinstance(current.profile, PowerLawKeys) and math.isinf(model.site.water_depth):
        findings.fault(
            ("current", "profile"), "a power law needs a finite water depth", remedy="use 'uniform' or a table"
        )
    if isinstance(current.profile, SpeedTable):
        lowest, highest = current.profile.table[0][0], current.profile.table[-1][0]
        if highest > 0.0:
            findings.fault(
                ("current", "profile", "table", len(current.profile.table) - 1),
                f"the height {highest:g} m is above still water",
                allowed="at most 0 m",
            )
        # heights count from still water, which stands deepest over the bed at the highest water level
        deepest = model.site.water_depth + max(model.site.water_levels.values())
        if lowest < -deepest * (1.0 + 1e-9):
            findings.fault(
                ("current", "profile", "table", 0),
                f"the height {lowest:g} m is under the bed",
                allowed=f"at least {-deepest:g} m",
            )


def _check_heading(state: Any, heading: float, path: KeyPath, findings: Findings) -> None:
    """Check that waves meet the structure from the side of negative x, as the two-dimensional theory takes them."""
    degrees = math.degrees(math.remainder(heading, 2.0 * math.pi))
    if abs(degrees) <= LARGEST_USUAL_ANGLE_DEG:
        return
    key = "from_bearing_deg" if getattr(state, "from_bearing_deg", None) is not None else "heading_deg"
    if abs(degrees) <= LARGEST_HEADING_DEG:
        along((*path, key), "waves", degrees, "the structure", findings)
        return
    findings.fault(
        (*path, key),
        f"the waves travel at {degrees:.4g} degrees to +x, along the structure or towards -x",
        allowed=f"-{LARGEST_HEADING_DEG} to {LARGEST_HEADING_DEG} degrees",
        remedy="turn the x axis so that waves come from -x, mirroring lines and section",
    )


def _of_theory(sea: RegularSea, period: float, water: Water) -> tuple[Notice, ...]:
    """Compare a regular wave with breaking and against the theory that it is run in."""
    from moyai.sea.regular_theory import theory_of
    from moyai.sea.validity import check_wave

    linear = theory_of(sea.theory, sea.height, period, water) == "linear"
    return check_wave(sea.height, period, water, theory="airy" if linear else "stream_function")


def check_waves(
    model: Any,
    environment: Any,
    findings: Findings,
    check_heading: Callable[[Any, float, KeyPath, Findings], None] = _check_heading,
) -> None:
    """Compare every sea state with breaking and the limits of its theory, at every water level.

    Parameters
    ----------
    model : Block
        The case.
    environment : Environment
        Built from it.
    findings : Findings
        Where faults and warnings go.
    check_heading : callable
        Judges the heading [rad] of a state at a path; from the side of negative x by default.
    """
    from moyai.sea.states import ComponentSea
    from moyai.sea.validity import check_sea_state, check_spectrum, check_wave

    for index, (state, sea) in enumerate(zip(model.waves, environment.sea_states)):
        check_heading(state, sea.heading, wave_path(findings, index), findings)
        said: set[str] = set()
        for name, level in environment.water_levels:
            water = environment.water_at(level)
            if isinstance(state, RegularWavesKeys):
                pairs = [("height", _of_theory(sea, period, water)) for period in sea.periods]
            elif isinstance(sea, ComponentSea):
                judge = check_wave if sea.omega.size == 1 else check_sea_state
                pairs = [("kind", judge(sea.height, sea.peak_period, water))]
            else:
                key = "file" if isinstance(state, SpectrumFile) else "significant_height"
                pairs = [(key, check_spectrum(sea.spectrum, water))]
            for key, notices in pairs:
                for notice in notices:
                    # waves of a file, one by one, are run as they are: their peak period is but an estimate
                    drawn = isinstance(sea, ComponentSea) and notice.code == "sea-steepness"
                    record = findings.fault if notice.severity == "error" and not drawn else findings.warn
                    if notice.severity == "information" or notice.code in said:
                        continue
                    said.add(notice.code)
                    where = f" (water level {name})" if len(environment.water_levels) > 1 else ""
                    record(wave_path(findings, index, key), f"{notice.message}{where}", remedy=notice.remedy)
