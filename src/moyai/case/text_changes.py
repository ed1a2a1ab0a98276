"""Change a case in its text: set a scalar, add a key, take one out.

Comments, order and layout stay: only the characters of the value or of the key change. The text is read again after
every change, and the change is refused unless it is the only difference.
"""

from __future__ import annotations

import copy
import json
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import yaml

from moyai.case.paths import assign, remove, value_of
from moyai.case.yaml_reader import CaseDocument, KeyPath, core_scalar, dotted, parse_yaml
from moyai.core.errors import CaseError, InputError

_Loader: Any = getattr(yaml, "CSafeLoader", yaml.SafeLoader)
_IN_TEXT = "change it in the text"


@dataclass(frozen=True)
class WrittenEntry:
    """A value as it is written, with its key."""

    #: Mapping or list that holds it.
    parent: yaml.CollectionNode
    #: None for entries of a list.
    key: yaml.Node | None
    value: yaml.Node
    #: Number among the entries of its parent.
    place: int


def with_scalar(document: CaseDocument, path: KeyPath, words: str, *, as_text: bool = False) -> CaseDocument:
    """Return the document with another scalar at a path; quotes stay where there were some and still fit.

    Parameters
    ----------
    document : Document
    path : tuple
        Keys and numbers of entries.
    words : str
        The value as one would write it without quotes: ``3.5 m``, ``auto``, ``true``.
    as_text : bool
        Whether the words are text even where they look like a number.

    Raises
    ------
    InputError
        When there is no scalar, or other places share it.
    """
    value = words if as_text else core_scalar(words)
    if value is None or "\n" in words or "\r" in words:
        raise InputError("there is no value", path=dotted(path), remedy="write one, or remove the key")
    entry = _entry(document, path)
    node = entry.value
    if not isinstance(node, yaml.ScalarNode) or node.style in ("|", ">"):
        raise InputError("this is no single value", path=dotted(path), remedy=_IN_TEXT)
    wanted = copy.deepcopy(document.data)
    assign(wanted, path, value)
    first, last = node.start_mark.index, node.end_mark.index
    written = document.text[first:last]
    quoted = written[:1] in ("'", '"')
    forms = list(_scalar_forms(value, words))
    if quoted and isinstance(value, str):
        forms.sort(key=lambda form: form[:1] != written[0])
    texts = [document.text[:first] + form + document.text[last:] for form in forms]
    return _first_that_reads(document, path, texts, wanted)


def without_key(document: CaseDocument, path: KeyPath) -> CaseDocument:
    """Return the document without a key or an entry and what stands below it.

    Raises
    ------
    InputError
        When it is not there, is the only one of its block, or shares its lines with others.
    """
    entry = _entry(document, path)
    siblings = entry.parent.value
    if len(siblings) == 1:
        raise InputError("nothing else is in this block", path=dotted(path), remedy="remove the block")
    wanted = copy.deepcopy(document.data)
    remove(wanted, path)
    text = document.text
    first = (entry.key or entry.value).start_mark.index
    last = _content_end(text, entry.value, first)
    if entry.parent.flow_style:
        return _first_that_reads(document, path, _flow_cuts(text, first, last), wanted)
    begin, end = _line_start(text, first), _line_end(text, last)
    if not text[begin:first].strip():
        return _first_that_reads(document, path, [text[:begin] + text[end:]], wanted)
    if entry.key is None:
        return _first_that_reads(document, path, [text[:begin] + text[end:]], wanted)
    # The first key of an entry of a list stands behind its dash: the next one takes its place
    following = siblings[1][0].start_mark.index if entry.place == 0 else end
    between = text[end:following]
    if between.strip():
        raise InputError("a comment follows this key", path=dotted(path), remedy=_IN_TEXT)
    return _first_that_reads(document, path, [text[:first] + text[following:]], wanted)


def with_key(document: CaseDocument, path: KeyPath, value: Any, *, after: str = "") -> CaseDocument:
    """Return the document with a key that was absent, behind the last one of its block or behind another.

    Parameters
    ----------
    document : Document
    path : tuple
        The last is the new key.
    value : object
        Scalar, list or mapping as a file holds it.
    after : str
        Key of the same block behind which it is put.

    Raises
    ------
    InputError
        When the block is not there, or the key is.
    """
    block = value_of(document.data, path[:-1]) if _is_there(document.data, path[:-1]) else None
    if not isinstance(block, dict) or path[-1] in block:
        said = "the key is there already" if isinstance(block, dict) else "there is no such block"
        raise InputError(said, path=dotted(path))
    node = _node(document, path[:-1])
    if not isinstance(node, yaml.MappingNode):
        raise InputError("other places share this block", path=dotted(path), remedy=_IN_TEXT)
    wanted = copy.deepcopy(document.data)
    assign(wanted, path, value)
    text, line = document.text, f"{flow(str(path[-1]))}: {flow(value)}"
    if not node.value:
        at = node.end_mark.index - 1
        return _first_that_reads(document, path, [text[:at] + line + text[at:]], wanted)
    names = [key.value for key, _ in node.value]
    key, last = node.value[names.index(after) if after in names else -1]
    end = _content_end(text, last, key.end_mark.index)
    if node.flow_style:
        return _first_that_reads(document, path, [f"{text[:end]}, {line}{text[end:]}"], wanted)
    end = _line_end(text, end)
    newline = "\r\n" if "\r\n" in text else "\n"
    head = text[:end] if text[:end].endswith(("\n", "\r")) else text[:end] + newline
    indent = " " * node.value[0][0].start_mark.column
    return _first_that_reads(document, path, [f"{head}{indent}{line}{newline}{text[end:]}"], wanted)


def flow(value: Any) -> str:
    """Return a value in one line of YAML."""
    if isinstance(value, dict):
        return "{" + ", ".join(f"{flow(str(key))}: {flow(item)}" for key, item in value.items()) + "}"
    if isinstance(value, list | tuple):
        return "[" + ", ".join(map(flow, value)) + "]"
    words = value if isinstance(value, str) else json.dumps(value)
    for form in _scalar_forms(value, words):
        try:
            if parse_yaml(f"a: {{b: {form}}}").data == {"a": {"b": value}}:
                return form
        except CaseError:
            continue
    return json.dumps(words, ensure_ascii=False)


def _scalar_forms(value: Any, words: str) -> Iterator[str]:
    yield words
    if isinstance(value, str):
        yield "'" + words.replace("'", "''") + "'"
        yield json.dumps(words, ensure_ascii=False)


def _first_that_reads(document: CaseDocument, path: KeyPath, texts: list[str], wanted: Any) -> CaseDocument:
    for text in texts:
        try:
            changed = parse_yaml(text, document.file)
        except CaseError:
            continue
        # 1 and True are equal, but not the same in a file
        if changed.data == wanted and repr(changed.data) == repr(_in_order(changed.data, wanted)):
            return changed
    raise InputError("this cannot be changed without changing more", path=dotted(path), remedy=_IN_TEXT)


def _in_order(data: Any, wanted: Any) -> Any:
    """Return ``wanted`` with its keys in the order of ``data``."""
    if isinstance(data, dict):
        return {key: _in_order(value, wanted[key]) for key, value in data.items()}
    return [_in_order(*pair) for pair in zip(data, wanted)] if isinstance(data, list) else wanted


def _is_there(data: Any, path: KeyPath) -> bool:
    for step in path:
        inside = isinstance(data, dict) and step in data
        if not inside and not (isinstance(data, list) and isinstance(step, int) and 0 <= step < len(data)):
            return False
        data = value_of(data, (step,))
    return True


def _node(document: CaseDocument, path: KeyPath) -> yaml.Node:
    return _entry(document, path).value if path else _root(document)


def _root(document: CaseDocument) -> yaml.Node:
    node = yaml.compose(document.text, Loader=_Loader)
    assert node is not None  # the text was read before
    return node


def _entry(document: CaseDocument, path: KeyPath) -> WrittenEntry:
    node, found = _root(document), None
    for step in path:
        found = None
        if isinstance(node, yaml.MappingNode):
            for place, (key, value) in enumerate(node.value):
                if isinstance(key, yaml.ScalarNode) and key.value == step:
                    found = WrittenEntry(node, key, value, place)
        elif isinstance(node, yaml.SequenceNode) and isinstance(step, int) and 0 <= step < len(node.value):
            found = WrittenEntry(node, None, node.value[step], step)
        if found is None:
            raise InputError("this is not written here", path=dotted(path), remedy=_IN_TEXT)
        node = found.value
    if found is None:
        raise InputError("the path is empty")
    return found


def _content_end(text: str, node: yaml.Node, key_end: int) -> int:
    """Return where the characters of a value end, without the comments and empty lines behind it."""
    if node.start_mark.index < key_end:
        return len(text[: _line_end(text, key_end)].rstrip())  # an alias: its anchor stands further up
    if isinstance(node, yaml.CollectionNode) and not node.flow_style and node.value:
        last = node.value[-1]
        key, value = last if isinstance(last, tuple) else (None, last)
        return _content_end(text, value, key.end_mark.index if key is not None else node.start_mark.index)
    return len(text[: node.end_mark.index].rstrip()) if node.end_mark.index else 0


def _line_start(text: str, at: int) -> int:
    return text.rfind("\n", 0, at) + 1


def _line_end(text: str, at: int) -> int:
    found = text.find("\n", at)
    return len(text) if found < 0 else found + 1


def _flow_cuts(text: str, first: int, last: int) -> list[str]:
    """Return the text without an entry in braces and one of the commas next to it."""
    behind = last + len(text[last:]) - len(text[last:].lstrip())
    before = len(text[:first].rstrip())
    cuts = []
    if text[behind : behind + 1] == ",":
        rest = text[behind + 1 :]
        cuts.append(text[:first] + rest.lstrip(" "))
    if text[before - 1 : before] == ",":
        cuts.append(text[: before - 1] + text[last:])
    return cuts
