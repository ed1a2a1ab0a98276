"""Water and site, dispersion, waves, spectra, irregular seas, kinematics, currents."""

from typing import TYPE_CHECKING

from moyai.core.exports import exports

if TYPE_CHECKING:
    from moyai.sea import current as current
    from moyai.sea import spectra as spectra
    from moyai.sea.breaking import BreakingLimit as BreakingLimit
    from moyai.sea.breaking import breaking_limit as breaking_limit
    from moyai.sea.components import WaveComponents as WaveComponents
    from moyai.sea.current import CurrentProfile as CurrentProfile
    from moyai.sea.directional import CosinePower as CosinePower
    from moyai.sea.directional import CosineTwoS as CosineTwoS
    from moyai.sea.directional import Mitsuyasu as Mitsuyasu
    from moyai.sea.directional import Spreading as Spreading
    from moyai.sea.directional import WrappedNormal as WrappedNormal
    from moyai.sea.dispersion import angular_frequency as angular_frequency
    from moyai.sea.dispersion import group_velocity as group_velocity
    from moyai.sea.dispersion import phase_velocity as phase_velocity
    from moyai.sea.dispersion import wave_number as wave_number
    from moyai.sea.dispersion import wave_number_in_current as wave_number_in_current
    from moyai.sea.irregular import synthesise as synthesise
    from moyai.sea.nonlinear import nonlinear_wave as nonlinear_wave
    from moyai.sea.permanent_wave import NonlinearWave as NonlinearWave
    from moyai.sea.regular import RegularWave as RegularWave
    from moyai.sea.spectrum import Spectrum as Spectrum
    from moyai.sea.water import Water as Water
else:
    __getattr__, __dir__, __all__ = exports(
        __name__,
        {
            "": "current spectra",
            "breaking": "BreakingLimit breaking_limit",
            "components": "WaveComponents",
            "current": "CurrentProfile",
            "directional": "CosinePower CosineTwoS Mitsuyasu Spreading WrappedNormal",
            "dispersion": "angular_frequency group_velocity phase_velocity wave_number wave_number_in_current",
            "irregular": "synthesise",
            "nonlinear": "nonlinear_wave",
            "permanent_wave": "NonlinearWave",
            "regular": "RegularWave",
            "spectrum": "Spectrum",
            "water": "Water",
        },
    )
