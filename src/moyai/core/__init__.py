"""Foundation of the package: errors, validity notices, identity checks, quantities, results, progress."""

from typing import TYPE_CHECKING

from moyai.core.exports import exports

if TYPE_CHECKING:
    from moyai.core.attachment import PointCarrier as PointCarrier
    from moyai.core.errors import CaseError as CaseError
    from moyai.core.errors import ConvergenceError as ConvergenceError
    from moyai.core.errors import Fault as Fault
    from moyai.core.errors import InputError as InputError
    from moyai.core.errors import MoyaiError as MoyaiError
    from moyai.core.headline import Band as Band
    from moyai.core.headline import Criterion as Criterion
    from moyai.core.headline import Headline as Headline
    from moyai.core.headline import Judgement as Judgement
    from moyai.core.headline import Verdict as Verdict
    from moyai.core.kinds import StructureKind as StructureKind
    from moyai.core.progress import Progress as Progress
    from moyai.core.results import Result as Result
    from moyai.core.validation import ValidationCase as ValidationCase
    from moyai.core.validity import IdentityCheck as IdentityCheck
    from moyai.core.validity import Notice as Notice
else:
    __getattr__, __dir__, __all__ = exports(
        __name__,
        {
            "attachment": "PointCarrier",
            "errors": "CaseError ConvergenceError Fault InputError MoyaiError",
            "headline": "Band Criterion Headline Judgement Verdict",
            "kinds": "StructureKind",
            "progress": "Progress",
            "results": "Result",
            "validation": "ValidationCase",
            "validity": "IdentityCheck Notice",
        },
    )
