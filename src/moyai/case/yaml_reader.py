"""Read YAML into plain data and remember the line and column of every key and value.

The scanner is PyYAML's (libyaml where it is there); the layer above it is ours: scalars follow the core schema of
YAML 1.2 (``5e6`` is a number, ``no`` and ``1:30`` are text), duplicate keys are faults, tags cannot call code,
and every fault is a :class:`~moyai.core.errors.Fault` with its place.
"""

from __future__ import annotations

import os
import re
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import yaml

from moyai.case.yaml_text import decode, refuse_odd_characters, refuse_wide_signs, syntax_fault
from moyai.core.errors import CaseError, Fault
from moyai.core.options import checks_words

KeyPath = tuple[str | int, ...]

_MAXIMUM_DEPTH = 60
_MAXIMUM_ENTRIES = 200_000
_MAXIMUM_BYTES = 20_000_000

_NULL = re.compile(r"null|Null|NULL|~|")
_TRUE = re.compile(r"true|True|TRUE")
_FALSE = re.compile(r"false|False|FALSE")
_INTEGER = re.compile(r"[-+]?[0-9]+")
_OCTAL = re.compile(r"0o[0-7]+")
_HEXADECIMAL = re.compile(r"0x[0-9a-fA-F]+")
_FLOAT = re.compile(r"[-+]?(\.[0-9]+|[0-9]+(\.[0-9]*)?)([eE][-+]?[0-9]+)?")
_INFINITE = re.compile(r"[-+]?(\.inf|\.Inf|\.INF)")
_NOT_A_NUMBER = re.compile(r"\.nan|\.NaN|\.NAN")

_Loader: Any = getattr(yaml, "CLoader", yaml.Loader)


@dataclass(frozen=True)
class Place:
    """Line and column, both counted from 1."""

    line: int
    column: int


@dataclass(frozen=True)
class CaseDocument:
    """A YAML file as plain data with places."""

    #: Mappings, lists, text, numbers, truth values, ``None``.
    data: Any
    #: The file as it was read.
    text: str
    #: Its name for messages.
    file: str
    #: Place of the key of every path, such as ``("lines", 0, "anchor", "x")``.
    keys: dict[KeyPath, Place] = field(default_factory=dict)
    #: Place of the value of every path.
    values: dict[KeyPath, Place] = field(default_factory=dict)

    @checks_words
    def place(self, path: KeyPath, *, of_key: bool = False) -> Place:
        """Return the place of ``path``, or of the nearest block around it that is written in the file.

        Parameters
        ----------
        path : sequence of str or int
            Keys and numbers of entries, from the root.
        of_key : bool
            Whether the key is meant and not its value.

        Returns
        -------
        Place
            Line and column, counted from 1.
        """
        for length in range(len(path), -1, -1):
            head = tuple(path[:length])
            # Of a block that lacks a key, the line of its own key gives more than the line of its first entry
            first, second = (self.keys, self.values) if of_key or length < len(path) else (self.values, self.keys)
            found = first.get(head) or second.get(head)
            if found:
                return found
        return Place(1, 1)

    @checks_words
    def fault(self, path: KeyPath, message: str, *, allowed: str = "", remedy: str = "", of_key: bool = False) -> Fault:
        """Return a fault at ``path`` with its place in the file.

        Parameters
        ----------
        path : sequence of str or int
            Keys and numbers of entries, from the root.
        message : str
            What is wrong.
        allowed : str
            What is allowed.
        remedy : str
            How to correct it.
        of_key : bool
            Whether the key is meant and not its value.
        """
        place = self.place(path, of_key=of_key)
        return Fault(message, dotted(path), allowed, remedy, self.file, place.line, place.column)


def dotted(path: KeyPath) -> str:
    """Return ``("lines", 0, "anchor")`` as ``lines[0].anchor``."""
    text = ""
    for item in path:
        text += f"[{item}]" if isinstance(item, int) else (f".{item}" if text else item)
    return text


def read_yaml(path: str | os.PathLike[str]) -> CaseDocument:
    """Read a YAML file.

    Parameters
    ----------
    path : path-like
        UTF-8, with or without byte-order mark.

    Returns
    -------
    CaseDocument

    Raises
    ------
    CaseError
        The file cannot be read, is not UTF-8, or is not YAML; with all duplicate keys at once.
    """
    file = str(path)

    def refuse(message: str, remedy: str = "") -> CaseError:
        return CaseError([Fault(message, file=file, remedy=remedy)])

    try:
        target = Path(path)
        if target.is_dir():
            raise refuse("this is a folder, not a case file", "name the YAML file inside it")
        if target.exists() and target.stat().st_size > _MAXIMUM_BYTES:
            raise refuse(f"the file is larger than {_MAXIMUM_BYTES // 1_000_000} MB: not a case file")
        raw = target.read_bytes()
    except FileNotFoundError:
        raise refuse("no such file", _similar_file(file)) from None
    except (OSError, ValueError) as error:
        raise refuse(f"the file cannot be read: {getattr(error, 'strerror', None) or error}") from None
    return parse_yaml(decode(raw, file), file)


def _similar_file(file: str) -> str:
    import difflib

    folder = Path(file).parent
    try:
        names = [entry.name for entry in folder.iterdir() if entry.suffix in (".yaml", ".yml")]
    except OSError:
        return ""
    close = difflib.get_close_matches(Path(file).name, names, n=1)
    return f"did you mean '{folder / close[0]}'?" if close else ""


def parse_yaml(text: str, file: str = "<text>") -> CaseDocument:
    """Parse YAML text; see :func:`read_yaml`."""
    refuse_odd_characters(text, file)
    refuse_wide_signs(text, file)
    try:
        # Null-terminated libyaml strings end at a lone surrogate or NUL; both were refused above
        builder = _Builder(_Loader(text), text, file)
        return builder.document()
    except yaml.MarkedYAMLError as error:
        raise CaseError([syntax_fault(error, text, file)]) from None
    except yaml.YAMLError as error:
        raise CaseError([Fault(f"this is not YAML: {error}", file=file)]) from None


@dataclass
class _Recorded:
    """An event tree node kept for aliases: plain lists, so that an alias can be built again under its new path."""

    kind: str
    place: Place
    value: Any = None
    children: list[Any] = field(default_factory=list)
    complete: bool = True


class _Builder:
    """Turns the events of the scanner into data; recursion is bounded by the depth limit."""

    def __init__(self, loader: Any, text: str, file: str) -> None:
        self.loader = loader
        self.text = text
        self.file = file
        self.faults: list[Fault] = []
        self.anchors: dict[str, _Recorded] = {}
        self.keys: dict[KeyPath, Place] = {}
        self.values: dict[KeyPath, Place] = {}
        self.entries = 0

    def document(self) -> CaseDocument:
        root: _Recorded | None = None
        while self.loader.check_event():
            event = self.loader.get_event()
            if isinstance(event, yaml.DocumentStartEvent):
                if root is not None:
                    self._stop("a second document begins here", event, "keep one case per file: remove the '---'")
                root = self._record(self.loader.get_event(), 0)
        if root is None or (root.kind == "scalar" and root.value is None):
            raise CaseError([Fault("the file is empty", file=self.file, remedy="'moyai new' prints a template")])
        data = self._build(root, ())
        if self.faults:
            raise CaseError(self.faults)
        return CaseDocument(data, self.text, self.file, self.keys, self.values)

    def _place(self, event: Any) -> Place:
        return Place(event.start_mark.line + 1, event.start_mark.column + 1)

    def _fault(self, message: str, place: Place, path: KeyPath = (), remedy: str = "") -> None:
        self.faults.append(Fault(message, dotted(path), "", remedy, self.file, place.line, place.column))

    def _stop(self, message: str, event: Any, remedy: str = "") -> None:
        place = self._place(event)
        raise CaseError([*self.faults, Fault(message, "", "", remedy, self.file, place.line, place.column)])

    def _record(self, event: Any, depth: int) -> _Recorded:
        place = self._place(event)
        if depth > _MAXIMUM_DEPTH:
            self._stop(f"blocks are nested more than {_MAXIMUM_DEPTH} deep", event)
        if isinstance(event, yaml.AliasEvent):
            known = self.anchors.get(str(event.anchor))
            if known is None:
                self._stop(f"'*{event.anchor}' refers to an anchor that is not defined above", event)
            elif not known.complete:
                self._stop(f"'*{event.anchor}' is inside the block that it refers to", event)
            return _Recorded("alias", place, known)
        node = _Recorded("scalar", place)
        if event.anchor:
            self.anchors[event.anchor] = node
        node.complete = False
        if isinstance(event, yaml.ScalarEvent):
            node.value = self._scalar(event, place)
            node.children = [event.value]
        elif isinstance(event, yaml.SequenceStartEvent):
            node.kind = "sequence"
            self._check_tag(event, place, "tag:yaml.org,2002:seq")
            while not self.loader.check_event(yaml.SequenceEndEvent):
                node.children.append(self._record(self.loader.get_event(), depth + 1))
            self.loader.get_event()
        else:
            node.kind = "mapping"
            self._check_tag(event, place, "tag:yaml.org,2002:map")
            while not self.loader.check_event(yaml.MappingEndEvent):
                key = self._record(self.loader.get_event(), depth + 1)
                node.children.append((key, self._record(self.loader.get_event(), depth + 1)))
            self.loader.get_event()
        node.complete = True
        return node

    def _check_tag(self, event: Any, place: Place, expected: str) -> None:
        if event.tag not in (None, "!", expected):
            self._fault(f"the tag '{event.tag}' is not allowed", place, remedy="case files hold plain data: remove it")

    def _scalar(self, event: Any, place: Place) -> Any:
        tag, text = event.tag, event.value
        if tag == "tag:yaml.org,2002:str" or (tag in (None, "!") and not event.implicit[0]):
            return text
        if tag not in (None, "!", *(f"tag:yaml.org,2002:{name}" for name in ("int", "float", "bool", "null"))):
            self._fault(f"the tag '{tag}' is not allowed", place, remedy="case files hold plain data: remove it")
            return text
        return core_scalar(text)

    def _build(self, node: _Recorded, path: KeyPath, place: Place | None = None) -> Any:
        self.entries += 1
        if self.entries > _MAXIMUM_ENTRIES:
            raise CaseError([Fault(f"aliases expand to more than {_MAXIMUM_ENTRIES} entries", file=self.file)])
        if node.kind == "alias":
            return self._build(node.value, path, node.place)
        self.values[path] = place or node.place
        if node.kind == "scalar":
            return node.value
        if node.kind == "sequence":
            return [self._build(child, (*path, index)) for index, child in enumerate(node.children)]
        return self._build_mapping(node, path)

    def _build_mapping(self, node: _Recorded, path: KeyPath) -> dict[str, Any]:
        out: dict[str, Any] = {}
        merged: dict[str, tuple[_Recorded, Place]] = {}
        for key, value in node.children:
            scalar = key.value if key.kind == "alias" else key
            if scalar.kind != "scalar":
                self._fault("a key must be plain text", key.place, path, "is a '{', '[' or '?' out of place?")
                continue
            name = scalar.children[0]
            if name == "<<":
                merged.update(self._merge_sources(value, path))
                continue
            here = (*path, name)
            if name == "":
                self._fault("a key is missing before ':'", key.place, path)
            elif name in out:
                first = self.keys[here]
                self._fault(
                    f"the key '{name}' is given twice",
                    key.place,
                    here,
                    f"it was given in line {first.line}: remove one",
                )
            else:
                self.keys[here] = key.place
                out[name] = self._build(value, here)
        for name, (value, place) in merged.items():
            if name not in out:
                self.keys[(*path, name)] = place
                out[name] = self._build(value, (*path, name))
        return out

    def _merge_sources(self, value: _Recorded, path: KeyPath) -> dict[str, tuple[_Recorded, Place]]:
        """Return what ``<<: *block`` adds; own keys win, then earlier sources."""
        target = value.value if value.kind == "alias" else value
        if target.kind == "sequence":
            collected: dict[str, tuple[_Recorded, Place]] = {}
            for child in reversed(target.children):
                collected.update(self._merge_sources(child, path))
            return collected
        if target.kind != "mapping":
            self._fault("'<<' merges a block of keys", value.place, (*path, "<<"), "write '<<: *name_of_the_block'")
            return {}
        entries: dict[str, tuple[_Recorded, Place]] = {}
        for key, item in target.children:
            scalar = key.value if key.kind == "alias" else key
            if scalar.kind == "scalar" and scalar.children[0] == "<<":
                entries = {**self._merge_sources(item, path), **entries}
            elif scalar.kind == "scalar":
                entries[scalar.children[0]] = (item, key.place)
        return entries


def core_scalar(text: str) -> Any:
    """Return a plain scalar by the core schema of YAML 1.2."""
    if _NULL.fullmatch(text):
        return None
    if _TRUE.fullmatch(text):
        return True
    if _FALSE.fullmatch(text):
        return False
    if _INTEGER.fullmatch(text):
        # Digits beyond a double's range carry no meaning here, and int() refuses very long ones
        return int(text) if len(text) < 30 else float(text)
    if _OCTAL.fullmatch(text):
        return int(text[2:], 8)
    if _HEXADECIMAL.fullmatch(text):
        return int(text[2:], 16)
    if _FLOAT.fullmatch(text):
        return float(text)
    if _INFINITE.fullmatch(text):
        return float(text.lower().replace(".inf", "inf"))
    if _NOT_A_NUMBER.fullmatch(text):
        return float("nan")
    return text
