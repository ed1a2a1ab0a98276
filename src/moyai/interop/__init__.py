"""Files of other programs: coefficients of three-dimensional bodies, series of MoorDyn, in SI units and own names."""

from typing import TYPE_CHECKING

from moyai.core.exports import exports

if TYPE_CHECKING:
    from moyai.interop.aqwa import read_aqwa as read_aqwa
    from moyai.interop.bemio import read_bemio as read_bemio
    from moyai.interop.capytaine import read_capytaine as read_capytaine
    from moyai.interop.moordyn_output import MoorDynOutput as MoorDynOutput
    from moyai.interop.moordyn_output import read_output as read_output
    from moyai.interop.nemoh import read_nemoh as read_nemoh
    from moyai.interop.read import read_coefficients as read_coefficients
    from moyai.interop.wamit import read_wamit as read_wamit
    from moyai.interop.whole_body import coefficients_of_result as coefficients_of_result
    from moyai.interop.whole_body import from_planar as from_planar
    from moyai.interop.write import write_coefficients as write_coefficients
else:
    __getattr__, __dir__, __all__ = exports(
        __name__,
        {
            "aqwa": "read_aqwa",
            "bemio": "read_bemio",
            "capytaine": "read_capytaine",
            "moordyn_output": "MoorDynOutput read_output",
            "nemoh": "read_nemoh",
            "read": "read_coefficients",
            "wamit": "read_wamit",
            "whole_body": "coefficients_of_result from_planar",
            "write": "write_coefficients",
        },
    )
