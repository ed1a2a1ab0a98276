"""The five papers behind the package, each computed again on one page."""

from typing import TYPE_CHECKING

from moyai.core.exports import exports

if TYPE_CHECKING:
    from moyai.reproduce.model import Paper as Paper
    from moyai.reproduce.page import compose as compose
    from moyai.reproduce.reproduction import Reproduction as Reproduction
    from moyai.reproduce.reproduction import paper as paper
    from moyai.reproduce.reproduction import papers as papers
    from moyai.reproduce.reproduction import reproduce as reproduce
    from moyai.reproduce.stored import as_result as as_result
else:
    __getattr__, __dir__, __all__ = exports(
        __name__,
        {
            "model": "Paper",
            "page": "compose",
            "reproduction": "Reproduction paper papers reproduce",
            "stored": "as_result",
        },
    )
