"""Forces on slender members: ideal inertia coefficients, Morison forces, the circulation of orbital flow."""

from typing import TYPE_CHECKING

from moyai.core.exports import exports

if TYPE_CHECKING:
    from moyai.morison import sections as sections
    from moyai.morison.circulation import CirculationLaw as CirculationLaw
    from moyai.morison.coefficients import CoefficientRule as CoefficientRule
    from moyai.morison.coefficients import Conditions as Conditions
    from moyai.morison.coefficients import KeuleganCarpenterTable as KeuleganCarpenterTable
    from moyai.morison.contour import Contour as Contour
    from moyai.morison.forces import StripForces as StripForces
    from moyai.morison.forces import strip_forces as strip_forces
    from moyai.morison.inertia import InertiaCoefficients as InertiaCoefficients
    from moyai.morison.inertia import inertia_coefficients as inertia_coefficients
    from moyai.morison.members import StraightMember as StraightMember
    from moyai.morison.net_law_base import NetLaw as NetLaw
    from moyai.morison.net_law_base import panel_force as panel_force
    from moyai.morison.net_law_names import available_net_laws as available_net_laws
    from moyai.morison.net_law_names import net_law as net_law
    from moyai.morison.nets import Net as Net
    from moyai.morison.sections import MemberSection as MemberSection
else:
    __getattr__, __dir__, __all__ = exports(
        __name__,
        {
            "": "sections",
            "circulation": "CirculationLaw",
            "coefficients": "CoefficientRule Conditions KeuleganCarpenterTable",
            "contour": "Contour",
            "forces": "StripForces strip_forces",
            "inertia": "InertiaCoefficients inertia_coefficients",
            "members": "StraightMember",
            "net_law_base": "NetLaw panel_force",
            "net_law_names": "available_net_laws net_law",
            "nets": "Net",
            "sections": "MemberSection",
        },
    )
