"""Every variable of every kind of result as Markdown, made from the vocabularies, so that it cannot fall behind them.

``python -m moyai.core.vocabulary_page docs/result_variables.md`` writes the page.
"""

from __future__ import annotations

import sys
from collections.abc import Iterable
from pathlib import Path

from moyai.core.kinds import kind_of_result, kinds_of_results
from moyai.core.vocabulary import COMMON, Variable, Vocabulary

_HEAD = """# Variables of a result

<!-- made by: python -m moyai.core.vocabulary_page docs/result_variables.md -->

Name, unit and meaning of every variable and label that a result may hold, in SI units.
[Layout of a result](result_layout.md) says in which group and along which dimensions they are. A bold name is never
missing where the analysis that writes it ran to its end.
"""
#: Root attributes that separate models of a kind, for :meth:`moyai.core.kinds.Kind.vocabulary_of`.
_MODELS: tuple[dict[str, str], ...] = ({}, {"cage_model": "rigid"}, {"cage_model": "flexible"})


def vocabularies() -> dict[str, Vocabulary]:
    """Return the vocabulary of every kind of result and of every part that has its own, by its name."""
    kinds = [kind for name in kinds_of_results() if (kind := kind_of_result(name)) is not None]
    found = [own for kind in kinds for root in _MODELS if (own := kind.vocabulary_of(root)) is not None]
    parts = [part for own in found for part in own.parts.values()]
    # the union of the models of a kind says nothing that they do not
    return {own.kind: own for own in (*found, *parts) if own.kind != "cage"}


def page() -> str:
    """Return the page."""
    blocks = [_HEAD, _table("Several kinds", COMMON.values(), ())]
    for name, own in sorted(vocabularies().items()):
        always = {variable for names in own.always.values() for variable in names}
        mine = (variable for variable in own.variables.values() if COMMON.get(variable.name) != variable)
        rows = [_row(f"names like `{pattern}`", unit, "") for pattern, unit in own.patterns.items()]
        blocks.append("\n".join([_table(name.capitalize().replace("_", " "), mine, always), *rows]))
    return "\n".join(f"{block.rstrip()}\n" for block in blocks)


def _table(title: str, variables: Iterable[Variable], always: Iterable[str]) -> str:
    rows = [f"## {title}", "", "| name | unit | meaning |", "|---|---|---|"]
    for variable in variables:
        name = f"**`{variable.name}`**" if variable.name in always else f"`{variable.name}`"
        rows.append(_row(name, variable.units, variable.long_name))
    return "\n".join(rows)


def _row(*cells: str) -> str:
    return "| " + " | ".join(cell.replace("|", "\\|") for cell in cells) + " |"


if __name__ == "__main__":
    Path(sys.argv[1]).write_text(page(), encoding="utf-8")
