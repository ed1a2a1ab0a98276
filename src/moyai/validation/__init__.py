"""Published and exact cases, one module a topic, each with a tuple ``CASES``; ``moyai validate`` runs them all."""

from typing import TYPE_CHECKING

from moyai.core.exports import exports

if TYPE_CHECKING:
    from moyai.validation._cases import Outcome as Outcome
    from moyai.validation._cases import choose as choose
    from moyai.validation._cases import compute as compute
    from moyai.validation._cases import topics as topics
else:
    __getattr__, __dir__, __all__ = exports(
        __name__,
        {
            "_cases": "Outcome choose compute topics",
        },
    )
