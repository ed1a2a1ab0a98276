"""Slips of a thousand: every number of a case file times 1000 and 0.001, and whether reading and checking tells.

``python tests/unit/case/slips.py [--list] [FILE ...]`` prints the share per structure; without files, that of every
template and example.
"""

from __future__ import annotations

import copy
import re
import signal
import sys
import time
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from moyai.case.reader import case_of
from moyai.case.templates import template
from moyai.case.yaml_reader import CaseDocument, dotted, parse_yaml
from moyai.core.errors import CaseError, InputError
from moyai.core.quantities import parse_quantity

ROOT = Path(__file__).parents[3]
FACTORS = (1000, 0.001)
#: Version, seeds and numbers that name something: no quantity that a unit could be mistaken for
NO_QUANTITY = ("moyai", "seed", "record", "place", "frequency_column", "density_column")
TEMPLATES = ("breakwater", "units", "curtain", "cage", "rigid_cage", "member", "network")
_NUMBER = re.compile(r"[+-]?(?:\d+(?:\.\d*)?|\.\d+)(?:[eE][+-]?\d+)?")


@dataclass(frozen=True)
class Slip:
    """One number of a file, wrong by a factor, and what the check said."""

    structure: str
    file: str
    path: str
    value: str
    factor: float
    outcome: str

    @property
    def reported(self) -> bool:
        """Whether it was stopped or warned of."""
        return self.outcome in ("stopped", "warned")


def sources() -> Iterator[tuple[str, str, Path]]:
    """Yield name, text and folder of every template and example that is a case."""
    for kind in TEMPLATES:
        yield f"template {kind}", template(kind), ROOT
    for path in sorted((ROOT / "examples").rglob("*.yaml")):
        if "new_structure" in path.parts:  # a structure of another package, which is not installed here
            continue
        text = path.read_text(encoding="utf-8")
        if re.search(r"^structure:", text, re.MULTILINE):
            yield str(path.relative_to(ROOT)), text, path.parent


def designs() -> Iterator[tuple[str, str, Path]]:
    """Yield name, text and folder of designs that were written after the ranges were set."""
    for path in sorted((Path(__file__).parent / "designs").glob("*.yaml")):
        yield path.name, path.read_text(encoding="utf-8"), path.parent


def numbers(data: Any, path: tuple[str | int, ...] = ()) -> Iterator[tuple[tuple[str | int, ...], Any]]:
    """Yield path and value of every number but zero in the data of a case."""
    if isinstance(data, dict):
        for key, value in data.items():
            if key not in NO_QUANTITY:
                yield from numbers(value, (*path, key))
    elif isinstance(data, list):
        for index, value in enumerate(data):
            yield from numbers(value, (*path, index))
    elif isinstance(data, (int, float)) and not isinstance(data, bool):
        if data != 0:
            yield path, data
    elif isinstance(data, str):
        try:
            if parse_quantity(data).number != 0:
                yield path, data
        except InputError:
            return


def slipped(value: Any, factor: float) -> Any:
    """Return a number or a text with a unit times ``factor``."""
    if isinstance(value, str):
        match = _NUMBER.match(value.strip())
        assert match is not None
        return f"{float(match[0]) * factor:.10g}{value.strip()[match.end() :]}"
    return value * factor


def with_value(document: CaseDocument, path: tuple[str | int, ...], value: Any) -> CaseDocument:
    """Return the document with another value at ``path``."""
    data = copy.deepcopy(document.data)
    block = data
    for key in path[:-1]:
        block = block[key]
    block[path[-1]] = value
    return CaseDocument(data, document.text, document.file, document.keys, document.values)


class _TooLong(BaseException):
    pass


def outcome(document: CaseDocument, folder: Path, usual: frozenset[str], limit: int = 20) -> str:
    """Return what reading and checking say: stopped, warned, silent, hangs, or the name of a traceback."""

    def stop(*_: Any) -> None:
        raise _TooLong

    signal.signal(signal.SIGVTALRM, stop)  # processor time: a loaded machine is no hang
    signal.setitimer(signal.ITIMER_VIRTUAL, limit)
    try:
        case = case_of(document, folder / "case.yaml")
    except CaseError:
        return "stopped"
    except _TooLong:
        return "hangs"
    except Exception as error:
        return f"traceback {type(error).__name__}: {error}"
    finally:
        signal.setitimer(signal.ITIMER_VIRTUAL, 0.0)
    return "warned" if {f"{w.path} {w.message}" for w in case.warnings} - usual else "silent"


def slips(name: str, text: str, folder: Path, every: int = 1, first: int = 0) -> Iterator[Slip]:
    """Yield every ``every``-th slip of a case."""
    document = parse_yaml(text, name)
    case = case_of(document, folder / "case.yaml")
    usual = frozenset(f"{warning.path} {warning.message}" for warning in case.warnings)
    kind = case.kind
    if kind == "cage":
        kind = f"{case.model.structure.model} cage"
    tries = [(path, value, factor) for path, value in numbers(document.data) for factor in FACTORS]
    for path, value, factor in tries[first % every :: every]:
        said = outcome(with_value(document, path, slipped(value, factor)), folder, usual)
        yield Slip(kind, name, dotted(path), str(value), factor, said)


def table(found: list[Slip]) -> str:
    """Return the shares per structure, and what went wrong."""
    lines = []
    for kind in [*sorted({slip.structure for slip in found}), ""]:
        group = [slip for slip in found if not kind or slip.structure == kind]
        reported = sum(slip.reported for slip in group)
        stopped = sum(slip.outcome == "stopped" for slip in group)
        lines.append(
            f"{kind or 'all':16s} {reported:5d} of {len(group):5d} seen, {100 * reported / max(len(group), 1):5.1f} %, "
            f"{stopped} of them stopped"
        )
    lines += [f"{slip.outcome} {slip.file} {slip.path} {slip.value} x{slip.factor:g}" for slip in found
              if slip.outcome not in ("stopped", "warned", "silent")]  # fmt: skip
    return "\n".join(lines)


if __name__ == "__main__":
    wanted = [word for word in sys.argv[1:] if not word.startswith("--")]
    gathered: list[Slip] = []
    for file, content, place in [*sources(), *designs()]:
        if wanted and not any(word in file for word in wanted):
            continue
        start = time.time()
        some = list(slips(file, content, place))
        gathered += some
        reported_here = sum(slip.reported for slip in some)
        print(f"{file:40s} {reported_here:4d} of {len(some):4d} {time.time() - start:7.1f} s", flush=True)
        if "--list" in sys.argv:
            for slip in some:
                if not slip.reported:
                    print(f"    {slip.outcome} {slip.path} {slip.value} x{slip.factor:g}")
    print(table(gathered))
