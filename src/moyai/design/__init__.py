"""Design: similarity of models, extremes, utilisation against a code."""

from typing import TYPE_CHECKING

from moyai.core.exports import exports

if TYPE_CHECKING:
    from moyai.design.codes import DesignCode as DesignCode
    from moyai.design.codes import LineCheck as LineCheck
    from moyai.design.codes import LineLoad as LineLoad
    from moyai.design.codes import check_line as check_line
    from moyai.design.codes import design_code as design_code
    from moyai.design.fatigue import EnduranceCurve as EnduranceCurve
    from moyai.design.fatigue import damage as damage
    from moyai.design.fatigue import dirlik_damage as dirlik_damage
    from moyai.design.fatigue import equivalent_range as equivalent_range
    from moyai.design.fatigue import life as life
    from moyai.design.long_term import JointSea as JointSea
    from moyai.design.long_term import environmental_contour as environmental_contour
    from moyai.design.long_term import fit_joint_sea as fit_joint_sea
    from moyai.design.long_term import return_level as return_level
    from moyai.design.similarity import Scale as Scale
    from moyai.design.similarity import scale_water as scale_water
else:
    __getattr__, __dir__, __all__ = exports(
        __name__,
        {
            "codes": "DesignCode LineCheck LineLoad check_line design_code",
            "fatigue": "EnduranceCurve damage dirlik_damage equivalent_range life",
            "long_term": "JointSea environmental_contour fit_joint_sea return_level",
            "similarity": "Scale scale_water",
        },
    )
