"""Labelled dataset of a radiation and diffraction solve: names, units and long names of every variable."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any

import numpy as np

from moyai.core.vocabulary import Vocabulary

if TYPE_CHECKING:
    import xarray as xr

    from moyai.potential.solution import RadiationDiffraction

_WAVE = "omega wave_direction"
_PAIR = "radiating_dof influenced_dof"
#: name -> (dimensions, units, long name); units of forces and masses are those of a translation
_VARIABLES: dict[str, tuple[str, str, str]] = {
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
        **{name: (units, text) for name, (_, units, text) in _VARIABLES.items()},
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


def build_dataset(solution: RadiationDiffraction) -> xr.Dataset:
    """Return the dataset; the ``oblique_`` variables are there only when a heading is oblique."""
    normal = solution.normal
    over = solution._over_headings
    values: dict[str, Any] = {
        "added_mass": normal.added_mass,
        "radiation_damping": normal.radiation_damping,
        "radiated_wave": normal.radiated_wave,
        "Froude_Krylov_force": over("froude_krylov_force"),
        "diffraction_force": over("diffraction_force"),
        "excitation_force": over("excitation_force"),
        "reflection_coefficient": over("reflection"),
        "transmission_coefficient": over("transmission"),
        "lid_loss": over("lid_loss"),
        "infinite_frequency_added_mass": solution.infinite_frequency_added_mass,
        "zero_frequency_added_mass": solution.zero_frequency_added_mass,
    }
    if solution.oblique:
        values["oblique_added_mass"] = over("added_mass")
        values["oblique_radiation_damping"] = over("radiation_damping")
        values["oblique_radiated_wave"] = over("radiated_wave")
    data = {name: (dims.split(), values[name]) for name, (dims, _, _) in _VARIABLES.items() if name in values}
    names = list(solution.modes.names)
    coordinates = {
        "omega": normal.states.omega,
        "period": ("omega", 2.0 * np.pi / normal.states.omega),
        "wavenumber": ("omega", normal.states.wave_number),
        "wave_direction": solution.heading,
        "radiating_dof": names,
        "influenced_dof": names,
        "side": ["minus", "plus"],
    }
    attributes = {
        **solution.conventions,
        "water_depth": solution.water.depth,
        "rho": solution.water.density,
        "g": solution.water.gravity,
        "section": solution.section.name,
        "draught": solution.section.draught,
        "lid": solution.lid,
        "status": solution.status,
        "message": solution.message,
        "checks": json.dumps([check.as_dict() for check in solution.checks]),
        "per": "metre of structure",
    }
    return VOCABULARY.dataset(data, coordinates, attributes)
