"""From the waves and the current of a case to :mod:`moyai.sea`, the same for every structure."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

from moyai.case import schema_environment as surroundings
from moyai.case.headings import heading_of
from moyai.core.errors import InputError
from moyai.sea import current as currents
from moyai.sea import directional, spectra
from moyai.sea.environment import Environment, Wind
from moyai.sea.states import IrregularSea, RegularSea, SeaState
from moyai.sea.water import Water


def environment_of(model: Any, water: Water, folder: Path) -> Environment:
    """Return water, levels, seas, wind (where the schema knows it) and current of a case."""
    bearing = model.site.x_axis_bearing_deg
    levels = model.site.water_levels
    chosen = model.settings.water_levels
    names = tuple(levels) if isinstance(chosen, str) else chosen
    wind = None
    blowing = getattr(model, "wind", None)
    if blowing is not None:
        wind = Wind(blowing.speed, heading_of(blowing, bearing, "wind"), blowing.density)
    return Environment(
        water=water,
        water_levels=tuple((name, levels[name]) for name in names),
        sea_states=tuple(
            sea_state_of(state, index, model.waves, water, folder, bearing) for index, state in enumerate(model.waves)
        ),
        wind=wind,
        current=current_of(model.current, water, bearing),
    )


def sea_state_of(
    state: Any, index: int, states: tuple[Any, ...], water: Water, folder: Path, bearing: float | None
) -> SeaState:
    """Return one sea state of a case.

    Parameters
    ----------
    state : Block
        Entry ``index`` of ``states``.
    index : int
        Its place, for messages.
    states : tuple of Block
        All sea states, which are named together.
    water : Water
        At datum.
    folder : Path
        Folder that file names refer to.
    bearing : float or None
        Compass bearing of +x [deg].
    """
    path = f"waves[{index}]"
    name = surroundings.sea_names(states)[index]
    heading = heading_of(state, bearing, path)
    if isinstance(state, surroundings.RegularWavesKeys):
        return RegularSea(name, state.height, state.all_periods(), heading, state.theory)
    spectrum = spectrum_of(state, water, folder, path)
    spreading: directional.Spreading | None = None
    if isinstance(state.spreading, surroundings.FileSpreading):
        spreading = _spreading_of_file(state, folder, path)
    elif state.spreading is not None:
        spreading = _spreading(state.spreading, spectrum)
    return IrregularSea(name, spectrum, heading, spreading, state.duration, state.seed)


def spectrum_of(state: Any, water: Water, folder: Path, path: str) -> spectra.Spectrum:
    """Return the spectrum of an irregular sea state."""
    if isinstance(state, surroundings.Jonswap):
        peak = state.peak_period
        if peak is None:
            peak = spectra.goda_peak_period(state.significant_period or math.nan, state.peak_enhancement)
        return spectra.jonswap(state.significant_height, peak, state.peak_enhancement)
    if isinstance(state, surroundings.PiersonMoskowitz):
        return spectra.pierson_moskowitz(state.significant_height, state.peak_period)
    if isinstance(state, surroundings.BretschneiderMitsuyasu):
        return spectra.bretschneider_mitsuyasu(state.significant_height, state.significant_period)
    if isinstance(state, surroundings.Tma):
        return spectra.tma(state.significant_height, state.peak_period, state.peak_enhancement, water)
    try:
        if state.record is not None:
            from moyai.sea.spectrum_archives import read_archive

            return read_archive(folder / state.file).spectrum(state.record, state.place)
        return spectra.from_file(
            folder / state.file, frequency_column=state.frequency_column, density_column=state.density_column
        )
    except InputError as error:
        fault = error.fault
        raise InputError(
            f"{state.file}: {fault.message}", path=f"{path}.file", allowed=fault.allowed, remedy=fault.remedy
        ) from None


def _spreading_of_file(state: surroundings.SpectrumFile, folder: Path, path: str) -> directional.Spreading:
    from moyai.sea.spectrum_archives import read_archive

    where = f"{path}.spreading"
    if state.record is None:
        raise InputError(
            "a table of two columns holds no directions", path=where, allowed="a file of spectra and its 'record'"
        )
    try:
        return read_archive(folder / state.file).spreading(state.record, state.place)
    except InputError as error:
        raise error.at(where) from None


def _spreading(entry: Any, spectrum: spectra.Spectrum) -> directional.Spreading:
    if isinstance(entry, surroundings.CosineTwoSKeys):
        return directional.CosineTwoS(entry.exponent)
    if isinstance(entry, surroundings.MitsuyasuSpreading):
        return directional.Mitsuyasu(entry.maximum_exponent, 2.0 * math.pi / spectrum.peak_period)
    if isinstance(entry, surroundings.CosinePowerKeys):
        return directional.CosinePower(entry.exponent)
    return directional.WrappedNormal(math.radians(entry.standard_deviation_deg))


def current_of(
    entry: surroundings.SiteCurrentKeys | None, water: Water, bearing: float | None
) -> currents.CurrentProfile | None:
    """Return the current of a case, ``None`` where it gives none."""
    if entry is None:
        return None
    heading = heading_of(entry, bearing, "current")
    speed = entry.speed or 0.0
    try:
        if isinstance(entry.profile, surroundings.SpeedTable):
            heights, speeds = zip(*entry.profile.table)
            return currents.table(heights, speeds, heading)
        if isinstance(entry.profile, surroundings.PowerLawKeys):
            return currents.power_law(speed, entry.profile.power_law, heading, water)
    except InputError as error:
        raise error.at("current.profile") from None
    return currents.uniform(speed, heading)
