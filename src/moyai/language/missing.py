"""How much of the package speaks a language: ``python -m moyai.language.missing [ja]``.

A text counts as translated when the catalogue puts it, with sample numbers in its places, wholly into the language.
"""

from __future__ import annotations

import sys
from collections.abc import Iterable
from dataclasses import dataclass
from importlib import resources
from pathlib import Path

from moyai.core.kinds import templates as file_templates
from moyai.language.comments import comments
from moyai.language.current import require_language
from moyai.language.extract import Text, texts
from moyai.language.translator import translator

COMMENTS = "comments of moyai new"


@dataclass(frozen=True)
class Coverage:
    """What is translated of a group of texts."""

    group: str
    translated: int
    total: int


def all_texts() -> list[Text]:
    """Return the texts of the source, each once a group, and the comments of the files that ``moyai new`` prints."""
    with resources.as_file(resources.files("moyai")) as folder:
        found = list(texts(Path(folder)))
    for name, kind in file_templates().items():
        found += [Text(comment, COMMENTS, name) for comment in comments(kind.template(name))]
    return list({(text.group, text.template): text for text in found}.values())


def is_translated(template: str, language: str) -> bool:
    """Whether a template is put wholly into a language.

    Parameters
    ----------
    template : str
    language : str
    """
    sample = template.strip(" ,;.")  # a part of a sentence stands behind the mark that joins it
    for number in range(template.count("{")):
        sample = sample.replace(f"{{{number}}}", f"{number + 1}")
    return translator(language).left(sample) == 0


def coverage(found: Iterable[Text], language: str) -> tuple[list[Coverage], list[Text]]:
    """Return how much of each group is translated, and the texts that are not.

    Parameters
    ----------
    found : iterable of Text
    language : str
    """
    counts: dict[str, list[int]] = {}
    missing = []
    for text in found:
        count = counts.setdefault(text.group, [0, 0])
        count[1] += 1
        if is_translated(text.template, language):
            count[0] += 1
        else:
            missing.append(text)
    return [Coverage(group, *count) for group, count in sorted(counts.items())], missing


def main() -> None:
    """Print the texts that are not translated, then the share of each group."""
    language = require_language(sys.argv[1] if len(sys.argv) > 1 else "ja")
    groups, missing = coverage(all_texts(), language)
    for text in missing:
        sys.stdout.write(f"{text.place}: {text.template}\n")
    for group in (*groups, Coverage("all", sum(g.translated for g in groups), sum(g.total for g in groups))):
        share = 100.0 * group.translated / group.total
        sys.stdout.write(f"{group.group}: {group.translated} of {group.total} ({share:.0f} %)\n")


if __name__ == "__main__":
    main()
