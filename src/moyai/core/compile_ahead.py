"""Compile the kernels of a structure in further processes, while the first run continues.

A kernel is compiled once on a machine and kept by numba. The lists ``structures/<kind>/kernels.txt`` name the kernels
that the templates of a structure compile, in the order in which they are done and with the seconds that they took:
further processes begin with those that take long and that the run calls late. A list that is out of date costs time,
never a number: what it lacks is compiled by the run.
"""

from __future__ import annotations

import os
import re
import subprocess
import sys
import threading
import time
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
#: Seconds that a run waits for a kernel of another process, beyond twenty times what it takes.
PATIENCE = 60.0
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
    seconds = [kernel.seconds for kernel in listed_kernels(kind)]
    return max(sum(seconds) / min(further_processes() + 1, EFFECTIVE_PROCESSES), *seconds, 0.0)


class SharedList:
    """Kernels that several processes compile, each kernel in one of them.

    Parameters
    ----------
    *kinds : str
        Kinds of structure.
    """

    def __init__(self, *kinds: str) -> None:
        self.kinds, self.kernels = kinds, listed_kernels(*kinds)
        self._places = {(one.module, one.name, one.signature): place for place, one in enumerate(self.kernels)}
        #: ``None`` as long as nobody has taken a kernel.
        self._taken: list[threading.Event | None] = [None] * len(self.kernels)
        self._lock = threading.Lock()
        self._processes: list[Process] = []

    def place_of(self, kernel: Any, arguments: Sequence[Any]) -> int | None:
        """Return the place of a kernel for arguments of given types; ``None`` when the list lacks it."""
        with suppress(ValueError):
            function = kernel.py_func
            return self._places.get((function.__module__, function.__name__, signature_text(arguments)))
        return None

    def claim(self, place: int) -> None:
        """Take a kernel for this process; wait until it is done where another process has it."""
        with self._lock:
            taken = self._taken[place]
            if taken is None:
                # threads of this process wait for each other by numba's own lock
                self._taken[place] = own = threading.Event()
                own.set()
        # in short turns, so that Ctrl-C is heard on every system; who hangs is not waited for
        until = time.monotonic() + PATIENCE + 20.0 * self.kernels[place].seconds
        while taken is not None and self._processes and not taken.wait(0.1) and time.monotonic() < until:
            pass

    def start(self, count: int) -> None:
        """Start processes that compile what nobody has taken."""
        self._processes += [_started(self.kinds) for _ in range(count)]
        for process in self._processes:
            threading.Thread(target=self._feed, args=(process,), daemon=True).start()

    def _feed(self, process: Process) -> None:
        """Give a process one kernel after the other."""
        assert process.stdin is not None and process.stdout is not None
        with suppress(OSError, ValueError):
            while (place := self._next()) is not None:
                done = self._taken[place]
                assert done is not None
                try:
                    process.stdin.write(f"{place}\n")
                    process.stdin.flush()
                    if not process.stdout.readline():
                        return
                finally:
                    done.set()
            process.stdin.close()

    def _next(self) -> int | None:
        """Return what to compile next: the kernel that takes longest, of those that the run does not call soon.

        What it calls soon it compiles itself: to wait for it takes as long.
        """
        with self._lock:
            before, best, last = 0.0, None, None
            for place, kernel in enumerate(self.kernels):
                if self._taken[place] is None:
                    if before >= 0.5 * kernel.seconds and (best is None or kernel.seconds > self.kernels[best].seconds):
                        best = place
                    before, last = before + kernel.seconds, place
            found = last if best is None else best
            if found is not None:
                self._taken[found] = threading.Event()
            return found

    @property
    def seconds_done(self) -> float:
        """Seconds that the kernels that are done, or that this process took, need where the list was written."""
        pairs = zip(self.kernels, self._taken, strict=True)
        return sum(kernel.seconds for kernel, taken in pairs if taken is not None and taken.is_set())

    @property
    def codes(self) -> list[int | None]:
        """Codes of the processes, ``None`` while they go on."""
        return [process.poll() for process in self._processes]

    def stop(self) -> None:
        """End the processes."""
        for process in self._processes:
            process.kill()
            process.wait()
        self._processes.clear()


def _started(kinds: Sequence[str]) -> Process:
    """Start a process that compiles the kernels whose places in the list come in, and writes each back when done."""
    command = [sys.executable, "-m", "moyai.core.compile_ahead", *kinds]
    hidden = getattr(subprocess, "CREATE_NO_WINDOW", 0)
    pipe = subprocess.PIPE
    return subprocess.Popen(
        command, stdin=pipe, stdout=pipe, stderr=subprocess.DEVNULL, text=True, creationflags=hidden
    )


@contextmanager
def compiling_ahead(kind: str) -> Iterator[None]:
    """Start further processes at the first kernel of the list that has to be compiled; end them with the block."""
    from numba.core import event

    from moyai.core.compiled import before_compiling

    count = further_processes() if sys.executable else 0
    shared = SharedList(kind)
    started: list[bool] = []

    def claim(kernel: Any, arguments: Sequence[Any]) -> None:
        if started and (place := shared.place_of(kernel, arguments)) is not None:
            shared.claim(place)

    class First(event.Listener):  # type: ignore[misc]
        def on_start(self, event: Any) -> None:
            if started or not count:
                return
            place = shared.place_of(event.data["dispatcher"], event.data["args"])
            if place is not None:
                started.append(True)
                shared.claim(place)
                shared.start(count)

        def on_end(self, event: Any) -> None:
            pass

    with event.install_listener("numba:compile", First()), before_compiling(claim):
        try:
            yield
        finally:
            shared.stop()


if __name__ == "__main__":
    collect_rarely()
    kernels = listed_kernels(*sys.argv[1:])
    for line in sys.stdin:
        compile_kernel(kernels[int(line)])
        sys.stdout.write(line)
        sys.stdout.flush()
