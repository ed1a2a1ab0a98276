"""Names, units and meanings of everything that the evaluation of a record writes; the one file that owns them."""

from __future__ import annotations

from moyai.core.vocabulary import NO_UNIT, Vocabulary

# name: (units, long name)
VARIABLES: dict[str, tuple[str, str]] = {
    "time": ("s", "start of the block"),
    # waves, directions, current, reflection and tensions of every block
    "count": ("1", "number of waves"),
    "maximum_height": ("m", "highest wave Hmax"),
    "maximum_period": ("s", "period of the highest wave"),
    "tenth_height": ("m", "mean height of the highest tenth H1/10"),
    "tenth_period": ("s", "mean period of the highest tenth T1/10"),
    "third_height": ("m", "significant height H1/3"),
    "third_period": ("s", "significant period T1/3"),
    "mean_height": ("m", "mean height"),
    "mean_period": ("s", "mean zero-crossing period"),
    "rms_height": ("m", "root mean square height"),
    "maximum_crest": ("m", "highest crest"),
    "minimum_trough": ("m", "lowest trough"),
    "spectral_height": ("m", "spectral height 4 sqrt(m0)"),
    "peak_period": ("s", "peak period Tp"),
    "smooth_peak_period": ("s", "peak period from the centroid of S^4"),
    "period_m01": ("s", "mean period m0/m1"),
    "period_m02": ("s", "mean period sqrt(m0/m2)"),
    "period_energy": ("s", "energy period m-1/m0"),
    "spectral_width": ("1", "spectral width"),
    "mean_heading": ("rad", "mean heading, direction of travel"),
    "spread": ("rad", "directional spread"),
    "peak_heading": ("rad", "heading at the peak"),
    "peak_spread": ("rad", "spread at the peak"),
    "current_x": ("m/s", "mean current along x"),
    "current_y": ("m/s", "mean current along y"),
    "current_speed": ("m/s", "speed of the mean current"),
    "current_heading": ("rad", "heading of the mean current"),
    "current_deviation": ("m/s", "deviation from the mean current"),
    "current_normal": ("m/s", "mean current normal to the structure U_x"),
    "reflection_coefficient": ("1", "reflection coefficient"),
    "reflection_error": ("1", "standard error of the reflection coefficient"),
    "incident_height": ("m", "height of the incident waves 4 sqrt(m0)"),
    "reflected_height": ("m", "height of the reflected waves 4 sqrt(m0)"),
    "transmission_coefficient": ("1", "transmission coefficient"),
    "transmission_error": ("1", "standard error of the transmission coefficient"),
    "transmitted_height": ("m", "height of the transmitted waves 4 sqrt(m0)"),
    "steady": ("N", "steady tension"),
    "maximum": ("N", "highest tension of a wave above the steady part T_max"),
    "tenth": ("N", "mean of the highest tenth T_1/10"),
    "third": ("N", "mean of the highest third T_1/3"),
    "mean": ("N", "mean of all waves T_mean"),
    "waves": ("1", "waves that were matched"),
    "snap_count": ("1", "snap events"),
    "lag": ("s", "lag of the tension behind the wave"),
    # spectra
    "density": ("m2/Hz", "one-sided spectral density"),
    "degrees_of_freedom": ("1", "degrees of freedom"),
    # responses; the attribute "units_of_modulus" gives the unit of each motion
    "modulus": (NO_UNIT, "response amplitude per wave amplitude"),
    "phase": ("rad", "phase of the response, Re(X exp(-i omega t))"),
    "coherence": ("1", "squared coherence"),
    # quality
    "start": ("s", "first instant"),
    # fits; the unit follows from the relation
    "value": (NO_UNIT, "estimate"),
    "error": (NO_UNIT, "standard error"),
    "low": (NO_UNIT, "lower 95 % bound"),
    "high": (NO_UNIT, "upper 95 % bound"),
    "determination": ("1", "R^2"),
    # the whole record
    "ratio": ("1", "height over the H1/3 of its block"),
    "exceedance": ("1", "share of waves above"),
    "weibull_scale": ("1", "scale of the Weibull fit"),
    "weibull_shape": ("1", "shape of the Weibull fit (2: Rayleigh)"),
    "weibull_shape_error": ("1", "standard error of the shape"),
    "weibull_distance": ("1", "distance of the Weibull fit"),
    "rayleigh_scale": ("1", "scale of the Rayleigh fit"),
    "rayleigh_distance": ("1", "distance of the Rayleigh fit"),
    "wave_count": ("1", "waves of the whole record"),
}
LABELS: dict[str, str] = {
    "group": "group of lines",
    "motion": "channel of the motion",
    "channel": "channel",
    "detail": "detail",
    "relation": "relation",
    "of": "fitted to",
    "parameter": "parameter",
}
VOCABULARY = Vocabulary.of(
    "records",
    VARIABLES,
    labels=LABELS,
    # One set for every channel of the record; the attribute "channel" names it
    patterns={
        r"channel_\d+_(mean|deviation|smallest|largest)": NO_UNIT,
        r"channel_\d+_share": "1",
    },
)
