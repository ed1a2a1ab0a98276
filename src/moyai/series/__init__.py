"""Series in time: waves, harmonics, spectra, snaps, cycles and extremes of what was measured or simulated."""

from typing import TYPE_CHECKING

from moyai.core.exports import exports

if TYPE_CHECKING:
    from moyai.series.acer import AcerFit as AcerFit
    from moyai.series.acer import ExceedanceRates as ExceedanceRates
    from moyai.series.acer import acer_interval as acer_interval
    from moyai.series.acer import exceedance_rates as exceedance_rates
    from moyai.series.acer import fit_tail as fit_tail
    from moyai.series.detrend import Detrend as Detrend
    from moyai.series.extremes import ExtremeFit as ExtremeFit
    from moyai.series.extremes import fit as fit
    from moyai.series.extremes import maximum_interval as maximum_interval
    from moyai.series.harmonics import Harmonics as Harmonics
    from moyai.series.harmonics import fit_harmonics as fit_harmonics
    from moyai.series.intervals import Interval as Interval
    from moyai.series.rainflow import count_cycles as count_cycles
    from moyai.series.snaps import SnapRecord as SnapRecord
    from moyai.series.snaps import find_snaps as find_snaps
    from moyai.series.wave_statistics import rayleigh_expected_maximum as rayleigh_expected_maximum
    from moyai.series.zero_crossing import WaveOptions as WaveOptions
    from moyai.series.zero_crossing import Waves as Waves
    from moyai.series.zero_crossing import find_waves as find_waves
    from moyai.series.zero_crossing import split_waves as split_waves
else:
    __getattr__, __dir__, __all__ = exports(
        __name__,
        {
            "acer": "AcerFit ExceedanceRates acer_interval exceedance_rates fit_tail",
            "detrend": "Detrend",
            "extremes": "ExtremeFit fit maximum_interval",
            "harmonics": "Harmonics fit_harmonics",
            "intervals": "Interval",
            "rainflow": "count_cycles",
            "snaps": "SnapRecord find_snaps",
            "wave_statistics": "rayleigh_expected_maximum",
            "zero_crossing": "WaveOptions Waves find_waves split_waves",
        },
    )
