"""Read a case file: all its errors at once, or a frozen case."""

from __future__ import annotations

import copy
import hashlib
import json
import os
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from pydantic import ValidationError

from moyai.case.derived import Number, case_html
from moyai.case.faults import FaultTranslator, did_you_mean, nearest
from moyai.case.findings import Findings
from moyai.case.paths import assign, resolve
from moyai.case.schema import root_schema
from moyai.case.schema_types import Block, Notes
from moyai.case.templates import kind_by_keys, next_command
from moyai.case.yaml_reader import CaseDocument, KeyPath, dotted, parse_yaml, read_yaml
from moyai.core.errors import CaseError, Fault, InputError
from moyai.core.kinds import structure_kind, structure_kinds
from moyai.core.units import plain_text


@dataclass(frozen=True)
class Case:
    """A case file that was read and found sound."""

    #: The content by the schema of its structure; SI units, headings in degrees.
    model: Any
    #: The file with the place of every key.
    document: CaseDocument
    #: The file.
    path: Path
    #: What is allowed but odd, with its place.
    warnings: tuple[Fault, ...]
    #: SHA-256 of the content and of the files that it names; comments, order of keys and choice of units do not matter.
    case_hash: str

    @property
    def kind(self) -> str:
        """Kind of the structure."""
        return str(self.model.structure.kind)

    @property
    def title(self) -> str:
        """Title of the case."""
        return str(self.model.title)

    @property
    def text(self) -> str:
        """The file as it was read."""
        return self.document.text

    @property
    def folder(self) -> Path:
        """Folder of the file, from which it names other files."""
        return self.path.parent

    def _repr_html_(self) -> str:
        """Return what a notebook shows: title, numbers that follow from the case, warnings, the text folded away."""
        return case_html(self.title, f"{self.kind}, {self.path}", self.warnings, derived_numbers(self), self.text)

    def __repr__(self) -> str:
        return f"<case of kind {self.kind}: {self.title!r}, {self.path}>"

    def located(self, error: InputError) -> InputError:
        """Return an error of a run with the key that its parameter came from, and the line of that key.

        Parameters
        ----------
        error : InputError
            As the run raised it.
        """
        return Findings(self.document, structure_kind(self.kind).keys()).located(error)

    def replace(self, path: str | Mapping[str, Any], value: Any = None) -> Case:
        """Return the case with other values, checked as a file is.

        Parameters
        ----------
        path : str or mapping
            Where: keys joined by dots, entries of a list in brackets by number, name or ``*``; or several such paths
            with their values.
        value : object
            As the file would hold it: a number in SI units, text with a unit, a list, a block.

        Returns
        -------
        Case
            Its text holds the values of now, without the comments of the file.

        Raises
        ------
        InputError
            When the case has no such place, with the nearest that it has.
        CaseError
            When the changed case is faulty.

        Examples
        --------
        >>> import moyai
        >>> case = moyai.load_case(moyai.template("breakwater"))
        >>> deeper = case.replace("structure.draught", "3.2 m")
        >>> deeper.model.structure.draught
        3.2
        >>> both = case.replace({"site.water_depth": 12.0, "lines[*].segments[0].length": "110 m"})
        >>> both.model.lines[1].segments[0].length
        110.0
        """
        data = copy.deepcopy(self.document.data)
        for where, what in (path if isinstance(path, Mapping) else {path: value}).items():
            for place in resolve(data, where):
                assign(data, place, copy.deepcopy(what))
        return case_of(parse_yaml(written(data), f"{self.path} (changed)"), self.path)


def load_case(source: str | os.PathLike[str] | Mapping[str, Any]) -> Case:
    """Read a case.

    Parameters
    ----------
    source : path-like, str or mapping
        A YAML file, UTF-8; its text, known by its line breaks; or its content. Without a file, other files are named
        from the folder of work.

    Returns
    -------
    Case
        Checked; its warnings are kept with it.

    Raises
    ------
    CaseError
        With every error of the file at once, each with line and column.
    InputError
        For content that no file can hold.

    Examples
    --------
    >>> import moyai
    >>> moyai.load_case(moyai.template("breakwater")).kind
    'breakwater'
    """
    if isinstance(source, Mapping):
        source = written(source)
    if isinstance(source, str) and "\n" in source:
        return case_of(parse_yaml(source, "case"), Path("case.yaml"))
    return case_of(read_yaml(source), Path(source))


def derived_numbers(case: Case) -> tuple[Number, ...]:
    """Return the numbers that follow from a case.

    Parameters
    ----------
    case : Case
        From :func:`load_case`.

    Returns
    -------
    tuple of Number
        Each with its value in SI units, and the unit that it is shown in.

    Raises
    ------
    InputError
        When a file that the case names has changed or become unreadable since it was checked.

    Examples
    --------
    >>> import moyai
    >>> from moyai.case import derived_numbers
    >>> numbers = derived_numbers(moyai.load_case(moyai.template("member")))
    >>> numbers[0].label, numbers[0].value, numbers[0].unit
    ('length', 20.0, 'm')
    """
    numbers: tuple[Number, ...] = structure_kind(case.kind).derived(case)
    return numbers


def written(content: Any) -> str:
    """Return the content of a case as the text of a file.

    Raises
    ------
    InputError
        For values that no file can hold.
    """
    import yaml

    try:
        return str(yaml.safe_dump(_plain(content), sort_keys=False, allow_unicode=True, width=120))
    except yaml.YAMLError as error:
        raise InputError(
            f"a value cannot be written into a case file: {error}", path="case", allowed="numbers, text, lists, blocks"
        ) from None


def _plain(content: Any) -> Any:
    if isinstance(content, Mapping):
        return {str(key): _plain(value) for key, value in content.items()}
    if isinstance(content, list | tuple | np.ndarray):
        return [_plain(value) for value in content]
    return content.item() if isinstance(content, np.generic) else content


def case_of(document: CaseDocument, path: Path) -> Case:
    """Return the case of a document that was read already; see :func:`load_case`.

    Parameters
    ----------
    document : Document
        Content of the file with the place of every value, from :func:`moyai.case.yaml_reader.parse_yaml`.
    path : Path
        The file; other files are named from its folder.

    Returns
    -------
    Case
        Checked; its warnings are kept with it.

    Raises
    ------
    CaseError
        With every error of the file at once, each with line and column.

    Examples
    --------
    >>> from pathlib import Path
    >>> from moyai.case import case_of, template
    >>> from moyai.case.yaml_reader import parse_yaml
    >>> case_of(parse_yaml(template("member"), "case"), Path("case.yaml")).kind
    'member'
    """
    from moyai.case.checks import check

    empty = _empty_values(document.data, (), document)
    root = _choose_root(document, empty)
    model, faults, repaired = _validate(document, root)
    faults = [*empty, *(fault for fault in faults if fault.path not in _without_value(document.data, ()))]
    if empty or (model is None and repaired is None):
        raise CaseError(_in_order(faults))
    found = check(model if model is not None else repaired, document, path.parent)
    faults.extend(found.faults)
    if faults or model is None:
        raise CaseError(_in_order(faults))
    return Case(model, document, path, tuple(_in_order(found.warnings)), case_hash(model, path.parent))


def like_checked(case: Case, document: CaseDocument) -> Case:
    """Return the case of a document that has fewer analyses or seas than that of a checked one, and no other values.

    It is not checked again.
    """
    model, faults, _ = _validate(document, _choose_root(document, []))
    if model is None:
        raise CaseError(_in_order(faults))
    return Case(model, document, case.path, case.warnings, case_hash(model, case.folder))


def read_block(document: CaseDocument, root: type[Block]) -> Any:
    """Return the content of a file by a schema that is not that of a case: of a study, of measurements.

    Parameters
    ----------
    document : Document
        The file as read.
    root : type of Block
        Its schema.

    Returns
    -------
    Block
        Of the type ``root``.

    Raises
    ------
    CaseError
        With every error of the file at once, each with line and column.
    """
    if not isinstance(document.data, dict):
        keys = ", ".join(root.key_names())
        raise CaseError([document.fault((), "the file is no block of keys", remedy=f"it starts with the keys {keys}")])
    empty = _empty_values(document.data, (), document)
    model, faults, _ = _validate(document, root)
    faults = [*empty, *(fault for fault in faults if fault.path not in _without_value(document.data, ()))]
    if faults or model is None:
        raise CaseError(_in_order(faults))
    return model


def _in_order(faults: list[Fault]) -> list[Fault]:
    return sorted(dict.fromkeys(faults), key=lambda fault: (fault.line, fault.column))


def _empty_values(data: Any, path: KeyPath, document: CaseDocument) -> list[Fault]:
    """Return a fault for every key without a value: nothing in a case file means 'nothing' on purpose."""
    if data is None and path:
        torn = _decimal_comma(path, document)
        if torn is not None:
            return [torn]
        return [document.fault(path, "there is no value", remedy="give one, or remove the key", of_key=True)]
    faults = []
    if isinstance(data, (dict, list)):
        for key, value in data.items() if isinstance(data, dict) else enumerate(data):
            faults.extend(_empty_values(value, (*path, key), document))
    return faults


def _without_value(data: Any, path: KeyPath) -> set[str]:
    """Return the dotted paths of all keys without a value."""
    if data is None and path:
        return {dotted(path)}
    entries = data.items() if isinstance(data, dict) else enumerate(data) if isinstance(data, list) else ()
    return {found for key, value in entries for found in _without_value(value, (*path, key))}


def _decimal_comma(path: KeyPath, document: CaseDocument) -> Fault | None:
    """Return a fault where braces tore ``3,6 m`` apart: into the value 3 and a key ``6 m`` without a value."""
    block: Any = document.data
    for step in path[:-1]:
        block = block[step]
    if not isinstance(block, dict):
        return None
    keys = list(block)
    index = keys.index(path[-1])
    before = block[keys[index - 1]] if index else None
    tail = plain_text(str(path[-1]))
    if isinstance(before, bool) or not isinstance(before, (int, str)) or not tail[:1].isdigit():
        return None
    whole = plain_text(str(before))
    if not whole.lstrip("+-").isdigit():
        return None
    return document.fault(
        (*path[:-1], keys[index - 1]),
        f"the comma of '{whole},{tail}' ends the value '{whole}' in braces",
        remedy=f"write a decimal point: {whole}.{tail}",
    )


def _choose_root(document: CaseDocument, faults: list[Fault]) -> type[Block]:
    """Return the schema that ``structure.kind`` names, or raise what stands in the way."""
    data = document.data
    if not isinstance(data, dict):
        raise CaseError([document.fault((), "a case file is a block of keys", remedy="'moyai new' prints a template")])
    kinds = structure_kinds()
    known = ", ".join(kinds)
    structure = data.get("structure")
    if "structure" not in data:
        near, other = nearest("structure", data), kind_by_keys(data)
        if other is not None:
            found = document.fault(
                (),
                f"this is a file of the kind '{other}', no case",
                remedy=f"its command: {next_command(other, 'FILE')}",
            )
        elif near:
            path: KeyPath = (near,)
            found = document.fault(path, f"unknown key '{near}'", remedy="did you mean 'structure'?", of_key=True)
        else:
            written = ", ".join(list(data)[:8])
            remedy = f"the file has the keys {written}"
            found = document.fault((), "the key 'structure' is missing", remedy=remedy)
    elif not isinstance(structure, dict):
        found = document.fault(("structure",), "expected a block of keys with 'kind'", allowed=known)
    elif "kind" not in structure:
        found = document.fault(("structure", "kind"), "the key 'kind' is missing", allowed=known)
    elif structure["kind"] not in kinds:
        written = str(structure["kind"])
        remedy = did_you_mean(written, kinds)
        found = document.fault(
            ("structure", "kind"), f"'{written}' is not a known structure", allowed=known, remedy=remedy
        )
    else:
        return root_schema(str(structure["kind"]))
    raise CaseError(_in_order([*(fault for fault in faults if fault.path != found.path), found]))


def _validate(document: CaseDocument, root: type[Block]) -> tuple[Any, list[Fault], Any]:
    """Return the model (or ``None``), the faults, and a model of corrected data on which checks can still run."""
    notes = Notes()
    error: ValidationError | None = None
    model: Any = None
    try:
        model = root.model_validate(document.data, context=notes)
    except ValidationError as found:
        error = found
    translator = FaultTranslator(document, notes, root)
    faults = translator.translate(error)
    if not faults:
        return model, [], None
    data = translator.repaired()
    if data is None:
        return None, faults, None
    try:
        return None, faults, root.model_validate(data, context=Notes())
    except ValidationError:
        return None, faults, None


def case_hash(model: Block, folder: Path) -> str:
    """Return the SHA-256 of a case's content and of the files it names; how it is shown does not matter."""
    content = model.model_dump(mode="json", by_alias=True)
    for shown in ("display", "app"):
        content.pop(shown, None)
    text = json.dumps(content, sort_keys=True, ensure_ascii=False, default=str)
    digest = hashlib.sha256(text.encode("utf-8"))
    for name in sorted(named_files(content)):
        target = folder / name
        members = sorted(target.rglob("*")) if target.is_dir() else [target]
        for member in members:
            if member.is_file():
                digest.update(member.name.encode("utf-8", "surrogateescape"))
                digest.update(member.read_bytes())
    return digest.hexdigest()


def named_files(content: Any) -> set[str]:
    """Return every file that a case names, under the keys ``file`` and ``path``."""
    found: set[str] = set()
    if isinstance(content, dict):
        for key, value in content.items():
            if key in ("file", "path") and isinstance(value, str):
                found.add(value)
            else:
                found |= named_files(value)
    elif isinstance(content, (list, tuple)):
        for value in content:
            found |= named_files(value)
    return found
