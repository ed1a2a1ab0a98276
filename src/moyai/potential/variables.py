"""Vocabulary of a radiation and diffraction solve: names, units and long names of every variable."""

from __future__ import annotations

from moyai.core.vocabulary import Vocabulary

_WAVE = "omega wave_direction"
_PAIR = "radiating_dof influenced_dof"
#: name -> (dimensions, units, long name); units of forces and masses are those of a translation
VARIABLES: dict[str, tuple[str, str, str]] = {
    "added_mass": (f"omega {_PAIR}", "kg/m", "added mass, motion uniform along the structure"),
    "radiation_damping": (f"omega {_PAIR}", "kg/(m s)", "radiation damping, motion uniform along the structure"),
    "radiated_wave": ("omega radiating_dof side", "s", "wave amplitude per unit velocity of the mode"),
    "Froude_Krylov_force": (f"{_WAVE} influenced_dof", "N/m2", "force of the undisturbed wave per unit amplitude"),
    "diffraction_force": (f"{_WAVE} influenced_dof", "N/m2", "force of the scattered wave per unit amplitude"),
    "excitation_force": (f"{_WAVE} influenced_dof", "N/m2", "force on the section held fixed per unit wave amplitude"),
    "reflection_coefficient": (_WAVE, "1", "reflected wave of the section held fixed, phase at x = 0"),
    "transmission_coefficient": (_WAVE, "1", "transmitted wave of the section held fixed, phase at x = 0"),
    "lid_loss": (_WAVE, "1", "share of the incident energy taken by the damping lid, section held fixed"),
    "infinite_frequency_added_mass": (_PAIR, "kg/m", "added mass at infinite frequency"),
    "zero_frequency_added_mass": (_PAIR, "kg/m", "added mass at zero frequency, NaN where it has no limit"),
    "oblique_added_mass": (f"{_WAVE} {_PAIR}", "kg/m", "added mass, motion as exp(i k sin(beta) y)"),
    "oblique_radiation_damping": (f"{_WAVE} {_PAIR}", "kg/(m s)", "radiation damping, motion as exp(i k sin(beta) y)"),
    "oblique_radiated_wave": (
        f"{_WAVE} radiating_dof side",
        "s",
        "wave per unit velocity, motion as exp(i k sin(beta) y)",
    ),
}

VOCABULARY = Vocabulary.of(
    "hydrodynamic coefficients",
    {
        **{name: (units, text) for name, (_, units, text) in VARIABLES.items()},
        "omega": ("rad/s", "angular frequency"),
        "period": ("s", "period"),
        "wavenumber": ("rad/m", "wave number"),
        "wave_direction": ("rad", "direction in which waves travel, 0 along +x"),
    },
    labels={
        "radiating_dof": "mode that moves",
        "influenced_dof": "mode that is pushed",
        "side": "side of the section, x to minus or plus infinity",
    },
)
