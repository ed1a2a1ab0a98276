"""What catalogues and materials give in figures, since a thinner line or film would not follow the scale.

A chain or film of the same make has EA with the square of its thickness, where the cube is wanted, and its strength and
weight in another water follow neither. Keys that name a make are replaced by what it gives in the size given.
"""

from __future__ import annotations

import math
from typing import Any

from moyai.case.reader import Case
from moyai.case.schema_lines import CatalogueSegment
from moyai.case.schema_types import Block
from moyai.core.errors import InputError
from moyai.sea.water import Water
from moyai.structures.cage.case.schema_flexible import RopeEntry
from moyai.structures.curtain.case import schema as schema_curtain
from moyai.structures.curtain.case.build import curtain_of
from moyai.structures.network.case.schema_parts import CatalogueType
from moyai.tables.lines import LineProperties, line_type

Figures = dict[str, tuple[float, str]]

_MAKES = ("catalogue", "material", "film", "line_type")


def equivalents(block: Block, case: Case, path: str) -> dict[str, tuple[str, Figures]]:
    """Return the keys of a block that name a make: what it is, and the figures that stand for it.

    Parameters
    ----------
    block : Block
        Of the case given.
    case : Case
        For the water, and for the curtain as it was built.
    path : str
        Of the block, for messages.

    Raises
    ------
    InputError
        For a make whose figures are not known here.
    """
    if isinstance(block, CatalogueSegment):
        return {"catalogue": (block.catalogue, _line(block, case))}
    if isinstance(block, CatalogueType):
        return {"catalogue": (block.catalogue, _line_in_motion(block.catalogue, block.diameter, block.curve is None))}
    if isinstance(block, RopeEntry):
        if block.catalogue is None:
            return {}
        figures = _line_in_motion(block.catalogue, block.diameter, stretches=True)
        figures["drag"] = figures.pop("drag_normal")
        return {"catalogue": (block.catalogue, figures)}
    if isinstance(block, schema_curtain.Cable):
        if block.catalogue is None:
            return {}
        return {"catalogue": (block.catalogue, _cable(block, case, path))}
    if isinstance(block, schema_curtain.SkirtEntry):
        if block.film is None:
            return {}
        skirt = _curtain(case).skirt
        figures = {"stiffness": (skirt.stiffness, "N/m")}
        if block.submerged_weight is None and block.mass_per_area is None:
            figures["submerged_weight"] = (skirt.submerged_weight, "N/m2")
        return {"film": (block.film.material, figures)}
    if isinstance(block, schema_curtain.Toe):
        if block.chain_mass is None or block.chain_density is not None:  # mass and density follow the scale together
            return {}
        return {"chain_mass": ("steel chain", {"weight": (_curtain(case).skirt.toe_load, "N/m")})}
    named = next((key for key in _MAKES if isinstance(getattr(block, key, None), str)), None)
    if named is not None:
        raise InputError(
            f"'{getattr(block, named)}' is taken from a catalogue, which does not follow the scale",
            path=f"{path}.{named}".lstrip("."),
            remedy="give its figures in place of its name",
        )
    return {}


def _line(block: CatalogueSegment, case: Case) -> Figures:
    found, site = line_type(block.catalogue, block.diameter), case.model.site
    return _known(
        {
            "submerged_weight": (found.submerged_weight_per_length(site.density, site.gravity), "N/m"),
            "mass": (found.mass_per_length, "kg/m"),
            "axial_stiffness": (found.axial_stiffness, "N"),
            **_in_water(found),
            "breaking_load": (found.breaking_load, "N"),
        }
    )


def _in_water(found: LineProperties) -> Figures:
    names = ("drag_normal", "drag_tangential", "added_mass_normal", "added_mass_tangential")
    return {name: (getattr(found, name), "") for name in names}


def _line_in_motion(name: str, diameter: float, stretches: bool) -> Figures:
    """Return the figures of a line of the catalogue; without EA where a curve of its own stands for it."""
    found = line_type(name, diameter)
    stretch = {"axial_stiffness": (found.axial_stiffness, "N")} if stretches else {}
    return _known(
        {
            "mass": (found.mass_per_length, "kg/m"),
            "volume": (found.volume_per_length, "m2"),
            **stretch,
            **_in_water(found),
            "breaking_load": (found.breaking_load, "N"),
        }
    )


def _curtain(case: Case) -> Any:
    site = case.model.site
    return curtain_of(case.model, Water(site.water_depth, site.density, site.gravity))


def _cable(block: schema_curtain.Cable, case: Case, path: str) -> Figures:
    curtain = _curtain(case)
    upper = path.endswith("upper")
    figures = {"axial_stiffness": (curtain.upper_stiffness if upper else curtain.lower_stiffness, "N")}
    if block.breaking_load is None:
        strength = curtain.strengths.upper_cable if upper else curtain.strengths.lower_cable
        figures["breaking_load"] = (strength.capacity, "N")
    return _known(figures)


def _known(figures: Figures) -> Figures:
    return {key: (value, unit) for key, (value, unit) in figures.items() if math.isfinite(value)}
