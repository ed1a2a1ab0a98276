"""Compile the kernels of a structure in further processes, while the first run goes on.

A kernel is compiled once on a machine and kept by numba. The lists ``structures/<kind>/kernels.txt`` name the kernels
that the templates of a structure compile, in the order in which they are done and with the seconds that they took:
further processes start in the middle and at the end of the list, where the run itself arrives late. A list that is out
of date costs time, never a number: what it lacks is compiled by the run.
"""

from __future__ import annotations

import os
import re
import subprocess
import sys
from collections.abc import Iterator, Sequence
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from importlib import import_module
from importlib.resources import files
from typing import Any

from moyai.core.processes import collect_rarely

#: Name of the environment variable with the number of further processes; 0 compiles in the run alone.
PROCESSES = "MOYAI_COMPILE_PROCESSES"
#: Further processes that pay: their kernels call each other.
MOST_PROCESSES = 3
#: Processes beyond which the time of all is no shorter.
EFFECTIVE_PROCESSES = 2
LIST = "kernels.txt"
Process = subprocess.Popen[str]

_LETTERS = {"float64": "f", "float32": "e", "int64": "i", "complex128": "z", "bool": "b"}
_ARRAY = re.compile(r"Array\((\w+), (\d), '(\w)', (True|False), aligned=True\)")
_LITERAL = re.compile(r"Literal\[\w+\]\((-?\w+)\)")
_SHORT = re.compile(r"\b([feizb])(\d)([CFA])(r?)\b")


@dataclass(frozen=True)
class ListedKernel:
    """A kernel for arguments of given types."""

    #: What it took on the machine that wrote the list, without the kernels that it calls [s].
    seconds: float
    module: str
    name: str
    #: Types of the arguments, see :func:`signature_text`.
    signature: str


def signature_text(arguments: Sequence[Any]) -> str:
    """Return types of numba as text: its own words, arrays as letter of the type, dimensions, layout, r for read-only.

    Raises
    ------
    ValueError
        For types that the text does not bring back.
    """
    text = _LITERAL.sub(r"literal(\1)", repr(tuple(arguments)))
    text = _ARRAY.sub(lambda m: f"{_LETTERS.get(m[1], '?')}{m[2]}{m[3]}{'r' * (m[4] == 'True')}", text)
    try:
        same = signature_types(text) == tuple(arguments)
    except (SyntaxError, NameError, TypeError, AttributeError, KeyError):
        same = False
    if not same:
        raise ValueError(text)
    return text


def signature_types(text: str) -> tuple[Any, ...]:
    """Return the types of :func:`signature_text`."""
    from numba import types

    scalars = {value: key for key, value in _LETTERS.items()}
    known: dict[str, Any] = {name: getattr(types, name) for name in ("Tuple", "UniTuple", "literal", "none", *_LETTERS)}
    for match in _SHORT.finditer(text):
        dtype = getattr(types, scalars[match[1]])
        known[match[0]] = types.Array(dtype, int(match[2]), match[3], readonly=bool(match[4]))
    # a file of the package, and no names but these
    return tuple(eval(text, {"__builtins__": {}}, known))


def listed_kernels(*kinds: str) -> tuple[ListedKernel, ...]:
    """Return the lists of kinds of structure, one after the other, each kernel once; a kind without a list has none."""
    from moyai.core.kinds import structure_kind, structure_kinds

    found: dict[tuple[str, str, str], ListedKernel] = {}
    for kind in kinds:
        file = files(structure_kind(kind).package) / LIST if kind in structure_kinds() else None
        if file is None or not file.is_file():
            continue
        for line in file.read_text(encoding="utf-8").splitlines():
            seconds, module, name, text = line.split(" ", 3)
            found.setdefault((module, name, text), ListedKernel(float(seconds), module, name, text))
    return tuple(found.values())


def parts_of(kernels: Sequence[ListedKernel], count: int) -> list[tuple[ListedKernel, ...]]:
    """Return the list cut into parts that take about the same time."""
    total, done = sum(kernel.seconds for kernel in kernels), 0.0
    parts: list[list[ListedKernel]] = [[] for _ in range(count)]
    for kernel in kernels:
        parts[min(int(count * done / total), count - 1) if total > 0.0 else 0].append(kernel)
        done += kernel.seconds
    return [tuple(part) for part in parts]


def compile_kernel(listed: ListedKernel) -> None:
    """Compile a kernel that the cache does not hold yet."""
    kernel = getattr(import_module(listed.module), listed.name, None)
    # a kernel that takes other arguments than when the list was written is left to the run
    with suppress(Exception):
        kernel.compile(signature_types(listed.signature))  # type: ignore[union-attr]


def further_processes() -> int:
    """Return how many processes compile next to a run: a core each, up to :data:`MOST_PROCESSES`."""
    given = os.environ.get(PROCESSES, "")
    if given.isdigit():
        return int(given)
    cores = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
    return min(cores - 1, MOST_PROCESSES)


def expected_seconds(kind: str) -> float:
    """Return about how long the first run of a structure compiles [s], as on the machine that wrote its list."""
    total = sum(kernel.seconds for kernel in listed_kernels(kind))
    return total / min(further_processes() + 1, EFFECTIVE_PROCESSES)


def started_process(place: int, count: int, kinds: Sequence[str], output: int = subprocess.DEVNULL) -> Process:
    """Start a process that compiles one of ``count`` parts of the lists, and then the parts behind it.

    It writes a line for every kernel that is done.
    """
    command = [sys.executable, "-m", "moyai.core.compile_ahead", str(place), str(count), *kinds]
    silence, hidden = subprocess.DEVNULL, getattr(subprocess, "CREATE_NO_WINDOW", 0)
    return subprocess.Popen(command, stdin=silence, stdout=output, stderr=silence, text=True, creationflags=hidden)


@contextmanager
def compiling_ahead(kind: str) -> Iterator[None]:
    """Start further processes at the first kernel of the list that has to be compiled; end them with the block."""
    from numba.core import event

    processes: list[Process] = []
    count = further_processes() if sys.executable else 0
    names = {(listed.module, listed.name) for listed in listed_kernels(kind)}
    open_ones = [True]

    class First(event.Listener):  # type: ignore[misc]
        def on_start(self, event: Any) -> None:
            function = event.data["dispatcher"].py_func
            if open_ones and (function.__module__, function.__name__) in names:
                open_ones.clear()
                processes.extend(started_process(place, count + 1, [kind]) for place in range(1, count + 1))

        def on_end(self, event: Any) -> None:
            pass

    with event.install_listener("numba:compile", First()):
        try:
            yield
        finally:
            for process in processes:
                process.kill()
                process.wait()


if __name__ == "__main__":
    collect_rarely()
    place, count, *kinds = sys.argv[1:]
    lists = parts_of(listed_kernels(*kinds), int(count))
    # who is done early goes on with the parts behind his own
    for kernel in (kernel for part in lists[int(place) :] for kernel in part):
        compile_kernel(kernel)
        sys.stdout.write(f"{kernel.seconds}\n")
        sys.stdout.flush()
