"""A case file in another size: every quantity scaled by its dimension, the text otherwise kept as it was written."""

from __future__ import annotations

import math
import re
import tempfile
import types
import typing
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any, Literal

import yaml

from moyai.case.line_code import component_of
from moyai.case.reader import Case, case_of
from moyai.case.schema_lines import CatalogueSegment
from moyai.case.schema_types import Block, QuantityOf
from moyai.case.yaml_reader import KeyPath, dotted, parse_yaml
from moyai.core.errors import CaseError, InputError
from moyai.core.options import checks_words
from moyai.core.quantities import VISCOSITY, QuantityKind, parse_quantity
from moyai.design.similarity import Scale, ScaledQuantity
from moyai.structures.cage.case.schema_flexible import RopeEntry
from moyai.structures.network.case.schema_parts import CatalogueType
from moyai.study.scaled_files import scaled_files
from moyai.study.scaled_materials import Figures, equivalents
from moyai.study.scaled_text import Edits, number_text, without_remarks, written_in

_SIZE_IN_TITLE = re.compile(r" \((?:model|prototype of) 1:[0-9.e+]+\)$")
_SHOWN = ("m", "s", "m/s", "kg", "N", "N/m", "kg/m", "Pa", "N m", "kg m2")


@checks_words
@dataclass(frozen=True)
class ScaledCase:
    """A case file in another size."""

    #: The new case file.
    text: str
    #: Every quantity that changed, named by its path in the file; ``prototype`` and ``model`` in its unit.
    rows: tuple[ScaledQuantity, ...]
    #: The new file as it was read again, with its warnings.
    case: Case
    #: Whether the file given was that of the model.
    from_model: bool
    #: Ratios of prototype to model.
    scale: Scale
    #: Name and text of the files that stand next to the new case.
    files: tuple[tuple[str, str], ...] = ()


@dataclass(frozen=True)
class _Leaf:
    """A value of the file with its kind and its place in the text."""

    path: KeyPath
    kind: QuantityKind
    data: Any
    node: Any


@checks_words
def scale_case(case: Case, scale: Scale, *, from_model: bool = False, digits: int = 7) -> ScaledCase:
    """Return a case in another size by Froude with the Cauchy number kept [eq:similarity-ratio].

    Units, order and comments stay; each changed line gives the value and the factor it comes from. Lines of the
    catalogue become lines with figures of their own, since stretch and strength of a thinner chain would not follow
    the scale. Lengths, times and the like that were left to a default are written out.

    Parameters
    ----------
    case : Case
        As read, of any structure.
    scale : Scale
        Ratios of prototype to model; ``density`` sets the water of the new file.
    from_model : bool
        Whether ``case`` is that of the model.
    digits : int
        Significant digits of the new figures.

    Returns
    -------
    ScaledCase
        The new file, read again, and every quantity that changed.

    Raises
    ------
    InputError
        A file or a make is named whose figures would not follow, or one figure is shared between quantities.
    CaseError
        The new figures are out of the range of the schema.

    Examples
    --------
    >>> import moyai
    >>> from moyai.design import Scale
    >>> from moyai.study import scale_case
    >>> prototype = moyai.load_case(moyai.template("breakwater"))
    >>> model = scale_case(prototype, Scale(length=20.0, density=1.025, gravity=1.0)).case
    >>> prototype.model.structure.draught, model.model.structure.draught     # [m]
    (3.0, 0.15)
    """
    if not 3 <= digits <= 17:
        raise InputError(f"{digits} significant digits", path="digits", allowed="3 to 17")
    files = scaled_files(case, scale, from_model)
    given = without_remarks(case.text)
    root = yaml.compose(given, Loader=yaml.SafeLoader)
    edits = Edits(given)
    rows: list[ScaledQuantity] = []
    tree = list(_blocks(case.model, case.document.data, root, ()))
    makes: dict[KeyPath, dict[str, tuple[str, Figures]]] = {}
    replaced: set[KeyPath] = set()
    for block, _, path in tree:  # from the outside inwards
        if not _inside(path, replaced) and (known := equivalents(block, case, dotted(path))):
            makes[path] = known
            replaced |= {(*path, key) for key in known}
    for leaf in _leaves(case.model, type(case.model), case.document.data, root, ()):
        if _inside(leaf.path, replaced):
            continue
        row = _scaled(leaf, scale, from_model)
        if row is None:
            continue
        new = row.prototype if from_model else row.model
        old = row.model if from_model else row.prototype
        text = _as_written(leaf.data, new, row.unit, digits)
        _replace(edits, leaf, text, f"{written_in(old, row.unit)} ({_factor(row.ratio, from_model)})")
        rows.append(row)
    for block, node, path in tree:
        if _inside(path, replaced):
            continue
        rows += _defaults(edits, block, node, path, scale, from_model, digits)
        for key, (make, figures) in makes.get(path, {}).items():
            own = [_both(dotted((*path, name)), *figures[name], scale, from_model) for name in figures]
            entries = [f"{name}: {_new(row, from_model, digits)}" for name, row in zip(figures, own, strict=True)]
            if isinstance(block, CatalogueSegment) and block.catalogue:
                entries.append(f"name: {block.catalogue}")
            if isinstance(block, CatalogueSegment | CatalogueType | RopeEntry):
                entries.append(f"component: {component_of(make)}")
            edits.replace_entry(node, key, entries, f"figures of {make} scaled, which no thinner one has")
            rows += [row for row in own if row.ratio != 1.0]
    for path, (name, _) in files.items():
        edits.replace(_node_at(root, path), name, f"scaled from {_value_at(case.document.data, path)}")
        block = _node_at(root, path[:-1])
        for key, column in (("frequency_column", "1"), ("density_column", "2"), ("place", "0")):
            node = _child(block, key)
            if node is not None:
                edits.replace(node, column, "", quote=False)
    _rename(edits, root, case.title, scale, from_model)
    text = _header(case, scale, from_model) + edits.text()
    companions = tuple(files.values())
    return ScaledCase(text, tuple(rows), _read_again(text, case.path, companions), from_model, scale, companions)


def _inside(path: KeyPath, keys: set[KeyPath]) -> bool:
    return any(path[:length] in keys for length in range(1, len(path) + 1))


def _read_again(text: str, given: Path, files: tuple[tuple[str, str], ...]) -> Case:
    """Read the new file, with those next to it where it needs any."""
    name = f"{given.name} scaled"
    try:
        if not files:
            return case_of(parse_yaml(text, name), given.parent / name)
        with tempfile.TemporaryDirectory(prefix="moyai-scale-") as folder:
            for other, content in files:
                (Path(folder) / other).write_text(content, encoding="utf-8")
            return case_of(parse_yaml(text, name), Path(folder) / name)
    except CaseError as error:
        first = error.faults[0]
        raise InputError(
            f"the scaled case is refused: {first.message}",
            path=first.path,
            allowed=first.allowed,
            remedy="choose another scale, or correct the value in the file given",
        ) from None


def _node_at(node: Any, path: KeyPath) -> Any:
    """Return the node at a path; of a sea state without its list the number is not written."""
    for key in path:
        node = node.value[key] if isinstance(key, int) else _child(node, key)
    return node


def _value_at(data: Any, path: KeyPath) -> Any:
    for key in path:
        data = data[key]
    return data


def _child(node: Any, key: str) -> Any:
    """Return the value node of a key, own keys before merged ones."""
    merged: list[Any] = []
    for name, value in node.value:
        if name.value == key:
            return value
        if name.value == "<<":
            merged += value.value if isinstance(value, yaml.SequenceNode) else [value]
    return next((found for source in merged if (found := _child(source, key)) is not None), None)


def _leaves(model: Any, annotation: Any, data: Any, node: Any, path: KeyPath) -> Iterator[_Leaf]:
    """Yield every scalar of the file that the schema reads as a quantity."""
    if isinstance(model, Block):
        for name, field in type(model).model_fields.items():
            key = field.alias or name
            if not (isinstance(data, dict) and key in data):
                continue
            inner: Any = field.annotation
            for entry in field.metadata:
                inner = Annotated[inner, entry] if isinstance(entry, QuantityOf) else inner
            yield from _leaves(getattr(model, name), inner, data[key], _child(node, key), (*path, key))
        return
    origin, arguments = typing.get_origin(annotation), typing.get_args(annotation)
    if origin is Annotated:
        quantity = next((entry for entry in arguments[1:] if isinstance(entry, QuantityOf)), None)
        if quantity is None:
            yield from _leaves(model, arguments[0], data, node, path)
        elif isinstance(data, (int, float, str)) and not (
            isinstance(data, str) and data.strip() in dict(quantity.words)
        ):
            yield _Leaf(path, quantity.kind, data, node)
    elif origin in (typing.Union, types.UnionType):
        fitting = next((member for member in arguments if _fits(member, data)), None)
        if fitting is not None:
            yield from _leaves(model, fitting, data, node, path)
    elif origin is tuple:
        if isinstance(data, dict):  # one block where a list may stand
            yield from _leaves(model[0], arguments[0], data, node, path)
            return
        for index, value in enumerate(data):
            member = arguments[0] if arguments[-1] is Ellipsis else arguments[index]
            yield from _leaves(model[index], member, value, node.value[index], (*path, index))
    elif origin is dict:
        for key, value in data.items():
            yield from _leaves(model.get(key), arguments[1], value, _child(node, key), (*path, key))


def _fits(annotation: Any, data: Any) -> bool:
    """Whether data may be read by one form of a union; blocks are known by their model and not asked here."""
    origin, arguments = typing.get_origin(annotation), typing.get_args(annotation)
    if origin is Annotated:
        quantity = next((entry for entry in arguments[1:] if isinstance(entry, QuantityOf)), None)
        if quantity is not None:
            return isinstance(data, (int, float)) or (isinstance(data, str) and not _is_word(data, quantity))
        return _fits(arguments[0], data)
    if origin in (typing.Union, types.UnionType):
        return any(_fits(member, data) for member in arguments)
    if origin is tuple:
        return isinstance(data, list)
    if origin is dict:
        return isinstance(data, dict)
    if origin is Literal:
        return data in arguments
    return isinstance(annotation, type) and issubclass(annotation, Block) and isinstance(data, dict)


def _is_word(text: str, quantity: QuantityOf) -> bool:
    return text.strip()[:1].isalpha() and text.strip() not in dict(quantity.words)


def _blocks(model: Any, data: Any, node: Any, path: KeyPath) -> Iterator[tuple[Block, Any, KeyPath]]:
    """Yield every block of the file with its place."""
    if isinstance(model, Block) and isinstance(data, dict):
        yield model, node, path
        for name, field in type(model).model_fields.items():
            key = field.alias or name
            if key in data:
                yield from _blocks(getattr(model, name), data[key], _child(node, key), (*path, key))
    elif isinstance(model, tuple):
        if isinstance(data, dict):
            yield from _blocks(model[0], data, node, path)
        elif isinstance(data, list):
            for index, value in enumerate(data):
                yield from _blocks(model[index], value, node.value[index], (*path, index))
    elif isinstance(model, dict) and isinstance(data, dict):
        for key, value in data.items():
            yield from _blocks(model.get(key), value, _child(node, key), (*path, key))


def _scaled(leaf: _Leaf, scale: Scale, from_model: bool) -> ScaledQuantity | None:
    """Return a value in both sizes in the unit it was written in, ``None`` where it stays."""
    if isinstance(leaf.data, str):
        quantity = parse_quantity(leaf.data)
        unit, value = quantity.unit.symbol or leaf.kind.unit, float(quantity.number)
    else:
        unit, value = leaf.kind.unit, float(leaf.data)
    if leaf.kind == VISCOSITY:
        # that of the water in either size: the Reynolds number is not kept, and the table of numbers says so
        return None
    if scale.ratio(unit) == 1.0 or value == 0.0:
        return None
    return _both(dotted(leaf.path), value, unit, scale, from_model)


def _as_written(data: Any, value: float, unit: str, digits: int) -> str:
    """Return the new value as the old one was written: plain, or with a unit that suits it."""
    if isinstance(data, str) and parse_quantity(data).unit.symbol:
        return written_in(value, unit, digits)
    return number_text(value, digits)


def _factor(ratio: float, from_model: bool) -> str:
    shown = f"{ratio if ratio >= 1.0 else 1.0 / ratio:.5g}"
    multiplied = (ratio >= 1.0) == from_model
    return f"times {shown}" if multiplied else f"1/{shown}"


def _replace(edits: Edits, leaf: _Leaf, text: str, remark: str) -> None:
    if not edits.replace(leaf.node, text, remark):
        raise InputError(
            "one value is used for quantities that scale differently (a YAML alias)",
            path=dotted(leaf.path),
            remedy="write the figure out at each place",
        )


def _both(name: str, value: float, unit: str, scale: Scale, from_model: bool) -> ScaledQuantity:
    """Return a value of the size given in both sizes."""
    ratio = scale.ratio(unit)
    prototype, model = (value * ratio, value) if from_model else (value, value / ratio)
    return ScaledQuantity(name, unit, prototype, model, ratio)


def _new(row: ScaledQuantity, from_model: bool, digits: int) -> str:
    """Return the value of the new size with its unit."""
    return written_in(row.prototype if from_model else row.model, row.unit, digits)


def _defaults(
    edits: Edits, block: Block, node: Any, path: KeyPath, scale: Scale, from_model: bool, digits: int
) -> list[ScaledQuantity]:
    """Write out the quantities of a block that were left to a default other than zero."""
    rows: list[ScaledQuantity] = []
    text = _default_keys(block, path, scale, from_model, digits, rows, given=block.model_fields_set)
    if text:
        edits.add_keys(node, text, "left to its default in the file given")
    return rows


def _default_keys(
    block: Block,
    path: KeyPath,
    scale: Scale,
    from_model: bool,
    digits: int,
    rows: list[ScaledQuantity],
    given: set[str],
) -> list[str]:
    keys = []
    for name, field in type(block).model_fields.items():
        if name in given:
            continue
        key, value = field.alias or name, getattr(block, name)
        if isinstance(value, Block):
            inner = _default_keys(value, (*path, key), scale, from_model, digits, rows, value.model_fields_set)
            if inner:
                keys.append(f"{key}: {{{', '.join(inner)}}}")
            continue
        quantity = _quantity_of(field)
        if quantity is None or not isinstance(value, float) or not math.isfinite(value) or value == 0.0:
            continue
        unit, ratio = quantity.kind.unit, scale.ratio(quantity.kind.unit)
        if ratio == 1.0:
            continue
        row = _both(dotted((*path, key)), value, unit, scale, from_model)
        rows.append(row)
        keys.append(f"{key}: {_new(row, from_model, digits)}")
    return keys


def _quantity_of(field: Any) -> QuantityOf | None:
    """Return the quantity that a field reads, also where the key may be absent."""

    def inside(annotation: Any) -> QuantityOf | None:
        for entry in getattr(annotation, "__metadata__", ()):
            if isinstance(entry, QuantityOf):
                return entry
        if typing.get_origin(annotation) in (typing.Union, types.UnionType):
            return next((found for member in typing.get_args(annotation) if (found := inside(member))), None)
        return None

    return next((entry for entry in field.metadata if isinstance(entry, QuantityOf)), None) or inside(field.annotation)


def _rename(edits: Edits, root: Any, title: str, scale: Scale, from_model: bool) -> None:
    node = _child(root, "title")
    what = "prototype of" if from_model else "model"
    if node is not None:
        title = _SIZE_IN_TITLE.sub("", title)
        new = f"{title} ({what} 1:{scale.length:.6g})".replace("\\", "\\\\").replace('"', '\\"')
        edits.replace(node, f'"{new}"', "", quote=False)


def _header(case: Case, scale: Scale, from_model: bool) -> str:
    sizes = ("Prototype", "model") if from_model else ("Model", "prototype")
    ratios = ", ".join(f"{unit} {scale.ratio(unit):.6g}" for unit in _SHOWN)
    lines = [
        f"{sizes[0]} of '{case.path.name}', made by 'moyai scale': Froude, Cauchy number kept.",
        f"Prototype over model: {ratios}.",
        f"Density of the water {scale.density:.6g}, gravity {scale.gravity:.6g} times.",
        f"Behind a changed value is that of the {sizes[1]} and the factor; other comments are of the file given.",
    ]
    return "".join(f"# {line}\n" for line in lines) + "\n"
