"""Many cases at once: variations of a base case, run here or on a cluster, and what comes out of them together."""

from typing import TYPE_CHECKING

from moyai.core.exports import exports

if TYPE_CHECKING:
    from moyai.study.definition import Study as Study
    from moyai.study.execute import Standing as Standing
    from moyai.study.execute import run_study as run_study
    from moyai.study.fitting import StudyFit as StudyFit
    from moyai.study.fitting import load_fit as load_fit
    from moyai.study.fitting import run_fit as run_fit
    from moyai.study.plan import load_study as load_study
    from moyai.study.query import StudyTable as StudyTable
    from moyai.study.query import read_study_results as read_study_results
    from moyai.study.scaled_case import ScaledCase as ScaledCase
    from moyai.study.scaled_case import scale_case as scale_case
else:
    __getattr__, __dir__, __all__ = exports(
        __name__,
        {
            "definition": "Study",
            "execute": "Standing run_study",
            "fitting": "StudyFit load_fit run_fit",
            "plan": "load_study",
            "query": "StudyTable read_study_results",
            "scaled_case": "ScaledCase scale_case",
        },
    )
