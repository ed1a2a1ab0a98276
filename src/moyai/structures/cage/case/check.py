"""Checks of a cage case that all models share: surroundings, water levels, breaking waves; then those of its model."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

from moyai.case.build_sea import spectrum_of
from moyai.case.check_sea import check_level_names, check_surroundings, wave_path
from moyai.case.findings import Findings
from moyai.case.schema_environment import PeriodRange, RegularWavesOfHeights, SpectrumFile
from moyai.core.errors import InputError
from moyai.sea.water import Water
from moyai.structures.cage.case import check_flexible, check_rigid, schema


def check(model: schema.CageCase, findings: Findings, folder: Path) -> None:
    """Record every fault and warning of a cage case in ``findings``."""
    check_surroundings(model, findings, folder)
    check_level_names(model, findings)
    if findings.sound("site", "waves"):
        _check_waves(model, findings, folder)
    if findings.sound("site", "waves", "current"):
        of_model = check_rigid.check if model.structure.model == "rigid" else check_flexible.check
        of_model(model, findings, folder)


def _check_waves(model: schema.CageCase, findings: Findings, folder: Path) -> None:
    """Compare every sea state with breaking and the limits of linear theory, at every water level."""
    from moyai.sea.validity import check_spectrum, check_wave

    for index, state in enumerate(model.waves):
        said: set[str] = set()
        for name, level in model.site.water_levels.items():
            depth = model.site.water_depth
            water = Water(depth if math.isinf(depth) else depth + level, model.site.density, model.site.gravity)
            pairs: list[tuple[str, Any]] = []
            if isinstance(state, RegularWavesOfHeights):
                if isinstance(state.periods, PeriodRange) and state.periods.first == state.periods.last:
                    findings.fault(wave_path(findings, index, "periods"), "'from' and 'to' are equal")
                    break
                key = "height" if state.height is not None else "heights"
                rigid = model.structure.model == "rigid"
                if rigid and state.theory == "stream_function":
                    findings.fault(
                        wave_path(findings, index, "theory"), "a rigid cage is for linear waves only",
                        allowed="automatic, linear", remedy="use 'model: flexible' for steep waves",
                    )  # fmt: skip
                    break
                linear = rigid or state.theory == "linear"
                pairs = [
                    (key, check_wave(state.highest, period, water, theory="airy" if linear else "stream_function"))
                    for period in state.all_periods()
                ]
            else:
                key = "file" if isinstance(state, SpectrumFile) else "significant_height"
                try:
                    pairs = [(key, check_spectrum(spectrum_of(state, water, folder, f"waves[{index}]"), water))]
                except InputError as error:
                    findings.raised(error, wave_path(findings, index))
                    break
            for key, notices in pairs:
                for notice in notices:
                    if notice.severity == "information" or notice.code in said:
                        continue
                    said.add(notice.code)
                    record = findings.fault if notice.severity == "error" else findings.warn
                    where = f" (water level {name})" if len(model.site.water_levels) > 1 else ""
                    record(wave_path(findings, index, key), f"{notice.message}{where}", remedy=notice.remedy)
