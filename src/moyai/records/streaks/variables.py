"""Names, units and meanings of everything that the evaluation of streaks writes; the one file that owns them."""

from __future__ import annotations

from moyai.core.vocabulary import NO_UNIT, Vocabulary

# name: (units, long name)
VARIABLES: dict[str, tuple[str, str]] = {
    # calibration, and particles of a run; the misfit of the targets is in pixels, that of streaks in metres
    "residual": (NO_UNIT, "misfit"),
    "position": ("m", "mean position from the centre"),
    "drift_velocity": ("m/s", "drift, background taken off"),
    "deviation": ("m/s", "standard error of a component of the drift"),
    "outline": ("m", "outline of the section"),
    # circulation of a run
    "contour": ("1", "size ratio Bc/B"),
    "circulation_deviation": ("m2/s", "standard error of the circulation"),
    "circulation_samples": ("m2/s", "circulation of resampled clouds"),
    # picture of a run
    "picture": ("1", "brightened picture"),
    "streak_end": ("1", "column and row of the ends of the streaks"),
    "streak_picture": ("1", "picture that the streak is in"),
    "streak_particle": ("1", "particle of the streak, -1 where it has none"),
    # law over all runs
    "keulegan_carpenter": ("1", "Keulegan-Carpenter number KC"),
    "period": ("s", "wave period"),
    "circulation": ("m2/s", "circulation along the orbits"),
    "circulation_low": ("m2/s", "lower end of its interval"),
    "circulation_high": ("m2/s", "upper end of its interval"),
    "circulation_linear": ("m2/s", "straight line to the section (paper)"),
    "law": (NO_UNIT, "fitted law [m2/s]"),
    "weight": ("1", "weight in the law"),
    "reduction": ("1", "reduction of the inertia coefficient by the Magnus force"),
    "reduction_low": ("1", "lower end of its interval"),
    "reduction_high": ("1", "upper end of its interval"),
    "measured_reduction": ("1", "reduction found from forces"),
}
VOCABULARY = Vocabulary.of("streaks", VARIABLES)
