"""Structures: one folder each, with its case, its model, its analyses, its report and its template."""

from typing import TYPE_CHECKING

from moyai.core.exports import exports

if TYPE_CHECKING:
    from moyai.structures.cage.flexible.build import build_cage as build_cage
    from moyai.structures.cage.flexible.equilibrium import CageEquilibrium as CageEquilibrium
    from moyai.structures.cage.flexible.equilibrium import horizontal_balance as horizontal_balance
    from moyai.structures.cage.flexible.equilibrium import solve_cage_equilibrium as solve_cage_equilibrium
    from moyai.structures.cage.flexible.model import FlexibleCage as FlexibleCage
    from moyai.structures.cage.flexible.parts import CageNetwork as CageNetwork
    from moyai.structures.cage.rigid.lines import CageLine as CageLine
    from moyai.structures.cage.rigid.matsubara import model_cage as model_cage
    from moyai.structures.cage.rigid.matsubara import taut_lines as taut_lines
    from moyai.structures.cage.rigid.parts import RigidCage as RigidCage
    from moyai.structures.cage.rigid.statics import RigidCageEquilibrium as RigidCageEquilibrium
    from moyai.structures.cage.rigid.statics import equilibrium_with_lines as equilibrium_with_lines
    from moyai.structures.cage.rigid.statics import free_floating as free_floating
    from moyai.structures.curtain.impact.cable import Impact as Impact
    from moyai.structures.curtain.impact.cable import ImpactPeak as ImpactPeak
    from moyai.structures.curtain.impact.cable import closed_form as closed_form
else:
    __getattr__, __dir__, __all__ = exports(
        __name__,
        {
            "cage.flexible.build": "build_cage",
            "cage.flexible.equilibrium": "CageEquilibrium horizontal_balance solve_cage_equilibrium",
            "cage.flexible.model": "FlexibleCage",
            "cage.flexible.parts": "CageNetwork",
            "cage.rigid.lines": "CageLine",
            "cage.rigid.matsubara": "model_cage taut_lines",
            "cage.rigid.parts": "RigidCage",
            "cage.rigid.statics": "RigidCageEquilibrium equilibrium_with_lines free_floating",
            "curtain.impact.cable": "Impact ImpactPeak closed_form",
        },
    )
