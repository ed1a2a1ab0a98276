"""Lists of kernels: they come back as types, name what exists, and hold what a first run calls."""

import os
import subprocess
import sys
import threading
from importlib import import_module
from pathlib import Path

import numpy as np
import pytest
from numba import typeof, types

from moyai.core import compile_ahead
from moyai.core.compile_ahead import ListedKernel, SharedList, listed_kernels, signature_text, signature_types
from moyai.core.kinds import structure_kind

KINDS = ("breakwater", "curtain", "cage", "network", "member")

#: A short sea, few periods and realisations and a coarse mesh call what all of a template call
SHORTER = (
    ("duration: 30 min", "duration: 1 min"), ("duration: 3 h", "duration: 10 min"), ("count: 11", "count: 3"),
    ("realisations: 5}", "realisations: 2}"), ("realisations: auto", "realisations: 2"),
    ("around: 32, down: 6, bottom: 4", "around: 16, down: 3, bottom: 3"),
)  # fmt: skip

# What a run loads into an empty process, at the outermost calls
CALLED = """
import sys
from pathlib import Path
from moyai.case.reader import load_case
from moyai.cli.runner import run
from moyai.core.compile_ahead import signature_text
run(load_case(Path(sys.argv[1])))
for module in [m for name, m in sys.modules.items() if name.startswith("moyai.")]:
    for name, kernel in vars(module).items():
        if hasattr(kernel, "overloads") and kernel.py_func.__module__ == module.__name__:
            for arguments in kernel.overloads:
                try:
                    print(module.__name__, name, signature_text(arguments))
                except ValueError:
                    pass
"""


# A run that calls all kernels of a list; prints what it compiled itself
SHARED = """
from moyai.core.compile_ahead import compile_kernel, compiling_ahead, listed_kernels
with compiling_ahead("member"):
    for kernel in listed_kernels("member"):
        compile_kernel(kernel)
from importlib import import_module
for listed in listed_kernels("member"):
    kernel = getattr(import_module(listed.module), listed.name)
    if kernel.stats.cache_misses:
        print(listed.name)
"""


def test_types_come_back() -> None:
    read_only = np.zeros((2, 3))
    read_only.flags.writeable = False
    values = (1, 2.0, True, np.zeros(3), read_only, np.zeros((2, 2), order="F"), (np.zeros(1, int), 1.0), (1.0, 2.0))
    arguments = (*(typeof(value) for value in values), types.literal(-3), types.none)
    text = signature_text(arguments)
    assert signature_types(text) == arguments
    assert "f2Cr" in text


def test_types_without_a_text_are_refused() -> None:
    with pytest.raises(ValueError, match="Function"):
        signature_text((types.FunctionType(types.float64(types.float64)),))


@pytest.mark.parametrize("kind", KINDS)
def test_every_listed_kernel_exists(kind: str) -> None:
    kernels = listed_kernels(kind)
    assert len(kernels) > 5
    for kernel in kernels:
        assert hasattr(getattr(import_module(kernel.module), kernel.name), "overloads"), kernel
        assert signature_types(kernel.signature)


def test_a_kernel_of_two_kinds_is_compiled_once() -> None:
    both = listed_kernels("network", "cage")
    assert len(both) < len(listed_kernels("network")) + len(listed_kernels("cage"))
    assert len({(one.module, one.name, one.signature) for one in both}) == len(both)


def shared_list(monkeypatch: pytest.MonkeyPatch, *seconds: float) -> SharedList:
    kernels = tuple(ListedKernel(took, "m", str(number), "()") for number, took in enumerate(seconds))
    monkeypatch.setattr(compile_ahead, "listed_kernels", lambda *kinds: kernels)
    return SharedList("network")


def test_a_process_begins_with_what_takes_long_and_is_called_late(monkeypatch: pytest.MonkeyPatch) -> None:
    shared = shared_list(monkeypatch, 9.0, 1.0, 4.0, 12.0, 2.0)
    shared.claim(0)  # the run is at it
    # 12 s with 5 s before it: the run would wait for longer than it is at its own; 4 s have 1 s before them
    assert [shared._next() for _ in range(5)] == [4, 3, 2, 1, None]


def test_the_largest_is_taken_first_where_the_run_is_long_in_coming(monkeypatch: pytest.MonkeyPatch) -> None:
    shared = shared_list(monkeypatch, 9.0, 1.0, 4.0, 12.0, 2.0)
    assert shared._next() == 3
    assert shared._next() == 2
    shared.claim(4)
    assert [shared._next() for _ in range(3)] == [1, 0, None]


def test_threads_of_the_run_do_not_wait_for_what_it_took(monkeypatch: pytest.MonkeyPatch) -> None:
    shared = shared_list(monkeypatch, 9.0, 1.0)
    monkeypatch.setattr(shared, "_processes", [object()])
    shared.claim(0)
    second = threading.Thread(target=shared.claim, args=(0,), daemon=True)
    second.start()
    second.join(timeout=10.0)
    assert not second.is_alive()


def test_a_process_that_hangs_is_not_waited_for(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(compile_ahead, "PATIENCE", 0.2)
    shared = shared_list(monkeypatch, 0.0)
    monkeypatch.setattr(shared, "_processes", [object()])
    assert shared._next() == 0
    shared.claim(0)


# In place of the process that compiles: answers for each place, or ends without an answer
ANSWERS = "import sys\nfor line in sys.stdin:\n    sys.stdout.write(line)\n    sys.stdout.flush()\n"
ENDS = "import sys\nsys.stdin.readline()\n"


@pytest.mark.parametrize(("script", "done"), [(ANSWERS, 28.0), (ENDS, 12.0)])
def test_the_run_waits_for_what_another_process_compiles(
    script: str, done: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    shared = shared_list(monkeypatch, 9.0, 1.0, 4.0, 12.0, 2.0)
    pipe = subprocess.PIPE
    process = subprocess.Popen([sys.executable, "-c", script], stdin=pipe, stdout=pipe, text=True)
    monkeypatch.setattr(compile_ahead, "_started", lambda kinds: process)
    shared.start(1)
    process.wait(timeout=60)
    shared.claim(3)  # the process has it, or had it
    assert shared.seconds_done == done
    for place in range(5):
        shared.claim(place)
    shared.stop()


@pytest.mark.slow
@pytest.mark.parametrize("kind", KINDS)
def test_the_list_holds_what_a_template_calls(kind: str, tmp_path: Path) -> None:
    case = tmp_path / "case.yaml"
    text = structure_kind(kind).template(kind)
    for long, short in SHORTER:
        text = text.replace(long, short)
    case.write_text(text, encoding="utf-8")
    answer = subprocess.run([sys.executable, "-c", CALLED, str(case)], capture_output=True, text=True, check=True)
    called = set(answer.stdout.splitlines())
    listed = {f"{kernel.module} {kernel.name} {kernel.signature}" for kernel in listed_kernels(kind)}
    assert called
    missing = called - listed
    assert not missing, "write the list again: moyai compile KIND --record TEMPLATE.yaml with an empty NUMBA_CACHE_DIR"


def test_an_unknown_kind_is_refused_with_the_kinds_that_exist() -> None:
    answer = subprocess.run([sys.executable, "-m", "moyai", "compile", "breakwaters"], capture_output=True, text=True)
    assert answer.returncode == 2
    assert "breakwaters" in answer.stderr
    assert "allowed: breakwater, curtain" in answer.stderr


@pytest.mark.slow
def test_run_and_further_process_share_the_kernels(tmp_path: Path) -> None:
    """Every kernel is compiled once, by one of both, and lands in the cache."""
    environment = {**os.environ, "NUMBA_CACHE_DIR": str(tmp_path), "MOYAI_COMPILE_PROCESSES": "1"}
    answer = subprocess.run([sys.executable, "-c", SHARED], capture_output=True, text=True, check=True, env=environment)
    own = answer.stdout.split()
    kernels = listed_kernels("member")
    assert 0 < len(own) < len(kernels)
    for kernel in kernels:
        assert len(list(tmp_path.rglob(f"*.{kernel.name}-*.nbi"))) == 1
