"""The reference of all keys as Markdown, made from the schemas, so that it cannot fall behind them.

``python -m moyai.case.reference docs`` renews everything below the mark in the pages of that folder: one page a kind of
structure under ``case_file``, and ``record_files.md`` and ``study_file.md``.
"""

from __future__ import annotations

import sys
import typing
from collections.abc import Iterator
from pathlib import Path
from typing import Any, Literal

from pydantic.fields import FieldInfo
from pydantic_core import PydanticUndefined

from moyai.case.schema import root_schema
from moyai.case.schema_types import Block, QuantityOf
from moyai.core.kinds import further_files, structure_kinds

#: Kinds whose name is no word for one of them
_WORDS = {"units": "row of units"}
#: Files on the pages that are not about cases
_FILES = {
    "record_files.md": {
        "records": "Records of loggers", "forces": "Force record of a member", "nets": "Tests of nets and model cages",
        "streaks": "Streak pictures", "snaps": "Impact tensions of flume runs",
    },
    "study_file.md": {"study": "Study", "fit": "Fit"},
}  # fmt: skip
_HEAD = """# Keys of a {kind}

How a case is read, its units, axes and errors: [the case file](../case_file.md). `moyai new` prints a template that
runs.

"""


def pages() -> tuple[str, ...]:
    """Return the pages of the reference, as paths in the folder of the documentation."""
    return (*(f"case_file/{kind}.md" for kind in structure_kinds()), *_FILES)


def called(kind: str) -> str:
    """Return the word for one structure of a kind."""
    return _WORDS.get(kind, kind)


def _mark(page: str) -> str:
    return f"<!-- made by: python -m moyai.case.reference docs, page {page} -->"


def reference_markdown(page: str) -> str:
    """Return the tables of every block: of a kind of structure, or of the files that a page is about."""
    lines: list[str] = []
    if page in _FILES:
        known = further_files()
        roots = {f"Keys: {title.lower()}": known[name].file_schema(name) for name, title in _FILES[page].items()}
    else:
        kind = Path(page).stem
        roots = {f"Case of a {called(kind)}": root_schema(kind)}
    for title, root in roots.items():
        lines += [f"## {title}", ""]
        for name, model in _blocks(root):
            lines += _section(name, model)
    return "\n".join(lines).rstrip() + "\n"


def _blocks(root: type[Block]) -> Iterator[tuple[str, type[Block]]]:
    """Yield every block once, from the outside inwards, with the path that leads to it first."""
    waiting: list[tuple[str, type[Block]]] = [("", root)]
    seen: set[type[Block]] = set()
    while waiting:
        path, model = waiting.pop(0)
        if model in seen:
            continue
        seen.add(model)
        yield path, model
        inner = []
        for name, field in model.model_fields.items():
            key = f"{path}.{field.alias or name}".lstrip(".")
            inner += [(key, found) for found in _models_in(field)]
        waiting = inner + waiting


def _models_in(field: FieldInfo) -> list[type[Block]]:
    found: list[type[Block]] = []

    def walk(annotation: Any) -> None:
        if isinstance(annotation, type) and issubclass(annotation, Block):
            found.append(annotation)
        for argument in typing.get_args(annotation):
            walk(argument)

    walk(field.annotation)
    return found


def _section(path: str, model: type[Block]) -> list[str]:
    title = f"`{path}`" if path else "The file"
    chosen = next((model.model_fields[key] for key in ("kind", "shape", "program") if key in model.model_fields), None)
    if path and chosen is not None:
        title += " " + ", ".join(f"`{value}`" for value in typing.get_args(chosen.annotation))
    lines = [f"### {title}", "", f"{(model.__doc__ or '').strip().splitlines()[0]}", ""]
    for rule, words in ((model.exactly_one, "Exactly one of"), (model.at_least_one, "At least one of")):
        lines += [f"{words} {', '.join(f'`{key}`' for key in group)}." for group in rule]
    if lines[-1]:
        lines.append("")
    lines += ["| key | meaning | form | default |", "|---|---|---|---|"]
    grouped = {key for rule in (model.exactly_one, model.at_least_one) for group in rule for key in group}
    for name, field in model.model_fields.items():
        key = field.alias or name
        default = _default(field, key in grouped)
        meaning = (field.description or "").split(" Default:")[0]
        cells = (f"`{key}`", meaning, _form(field), default)
        lines.append("| " + " | ".join(cell.replace("|", "\\|") for cell in cells) + " |")
    return [*lines, ""]


def _form(field: FieldInfo) -> str:
    """Return what may stand at a key: words, a quantity, a list, a block."""
    direct = next((entry for entry in field.metadata if isinstance(entry, QuantityOf)), None)
    if direct is not None:
        return _quantity(direct)
    many = _holds(field.annotation, tuple)
    inner = next(_quantities_in(field.annotation), None)
    words = [f"`{word}`" for word in _words_in(field.annotation)]
    models = bool(_models_in(field))
    parts: list[str] = []
    if words:
        every = "list of " if many and inner is None and not models and "all" not in words[0] else ""
        parts.append(every + ", ".join(words))
    whole = int in _plain_types(field.annotation) and inner is None
    if inner is None and many and not models and not (words and "all" not in words[0]):
        parts.append(f"list of whole numbers{_bounds(field)}" if whole else "list of names")
    elif whole:
        texts = ["text"] * (str in _plain_types(field.annotation))
        parts += [*texts, f"whole number{_bounds(field)}"]
    if inner is not None:
        container = "list of " if many else ("names, each with " if _holds(field.annotation, dict) else "")
        parts.append(container + _quantity(inner))
    if models:
        parts.append("list of blocks" if many and inner is None else "block")
    if parts:
        return " or ".join(parts)
    if bool in (field.annotation, *typing.get_args(field.annotation)):
        return "true or false"
    return "names, each with text" if _holds(field.annotation, dict) else "text"


#: An upper limit of a whole number from which it is only there against slips.
_NO_LIMIT = 1_000_000


def _bounds(field: FieldInfo) -> str:
    """Return the least and the most of a whole number, where both or one are given."""
    entries = [*field.metadata, *_further_metadata(field.annotation)]
    least = next((entry.ge for entry in entries if hasattr(entry, "ge")), None)
    most = next((entry.le for entry in entries if hasattr(entry, "le") and entry.le < _NO_LIMIT), None)
    if least is None and most is None:
        return ""
    return f", {least} or more" if most is None else f", {most} or less" if least is None else f", {least} to {most}"


def _further_metadata(annotation: Any) -> Iterator[Any]:
    for entry in getattr(annotation, "__metadata__", ()):
        yield entry
        yield from getattr(entry, "metadata", ())
    for argument in typing.get_args(annotation):
        yield from _further_metadata(argument)


def _plain_types(annotation: Any) -> list[Any]:
    arguments = typing.get_args(annotation)
    return [annotation] if not arguments else [found for argument in arguments for found in _plain_types(argument)]


def _holds(annotation: Any, container: type) -> bool:
    """Whether a tuple or a mapping may stand there."""
    if typing.get_origin(annotation) is container:
        return True
    return any(_holds(argument, container) for argument in typing.get_args(annotation))


def _quantity(entry: QuantityOf) -> str:
    kind = entry.kind.name.split(" ", 1)[1]
    unit = f" [{entry.kind.unit}]" if entry.kind.unit else ""
    return f"{kind}{unit}" + (f", {entry.allowed}" if entry.allowed else "")


def _quantities_in(annotation: Any) -> Iterator[QuantityOf]:
    for entry in getattr(annotation, "__metadata__", ()):
        if isinstance(entry, QuantityOf):
            yield entry
    for argument in typing.get_args(annotation):
        yield from _quantities_in(argument)


def _words_in(annotation: Any) -> list[str]:
    if typing.get_origin(annotation) is Literal:
        return [str(value) for value in typing.get_args(annotation)]
    return [word for argument in typing.get_args(annotation) for word in _words_in(argument)]


def _default(field: FieldInfo, grouped: bool) -> str:
    if field.is_required():
        return "**required**"
    value = field.default if field.default is not PydanticUndefined else None
    if value is None and any(word == "auto" for entry in field.metadata for word, _ in getattr(entry, "words", ())):
        return "auto"
    if grouped or value in (None, ()) or isinstance(value, Block):
        return ""
    if isinstance(value, tuple):
        return "[" + ", ".join(item if isinstance(item, str) else f"{item:g}" for item in value) + "]"
    if isinstance(value, dict):
        return ", ".join(f"{key}: {item:g}" for key, item in value.items())
    return f"{value:g}" if isinstance(value, float) else str(value).lower()


def renew(text: str, page: str) -> str:
    """Return the text of a page with everything below the mark made again; a new page begins with its mark."""
    mark = _mark(page)
    head = text[: text.index(mark)] if mark in text else _HEAD.format(kind=called(Path(page).stem))
    return f"{head}{mark}\n\n{reference_markdown(page)}"


if __name__ == "__main__":
    for name in pages():
        target = Path(sys.argv[1]) / name
        target.parent.mkdir(exist_ok=True)
        known_text = target.read_text(encoding="utf-8") if target.exists() else ""
        target.write_text(renew(known_text, name), encoding="utf-8", newline="\n")
