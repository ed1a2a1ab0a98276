"""Lists of kernels: they come back as types, name what exists, and hold what a first run calls."""

import subprocess
import sys
from importlib import import_module
from pathlib import Path

import numpy as np
import pytest
from numba import typeof, types

from moyai.core.compile_ahead import ListedKernel, listed_kernels, parts_of, signature_text, signature_types
from moyai.core.kinds import structure_kind

KINDS = ("breakwater", "curtain", "cage", "network", "member")

#: A short sea, few periods and few realisations call what all of a template call
SHORTER = (
    ("duration: 30 min", "duration: 1 min"), ("duration: 3 h", "duration: 10 min"), ("count: 11", "count: 3"),
    ("realisations: 5}", "realisations: 2}"),
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


def test_parts_share_the_time() -> None:
    kernels = tuple(ListedKernel(1.0 + 0.1 * number, "m", str(number), "()") for number in range(40))
    parts = parts_of(kernels, 3)
    assert tuple(kernel for part in parts for kernel in part) == kernels
    whole = sum(kernel.seconds for kernel in kernels)
    for part in parts:
        assert sum(kernel.seconds for kernel in part) == pytest.approx(whole / 3.0, abs=5.0)


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
def test_further_processes_compile_what_a_first_run_needs(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The last part of the list lands in the cache of the run, which goes on by itself."""
    from moyai.core import compile_ahead

    monkeypatch.setenv("NUMBA_CACHE_DIR", str(tmp_path))
    kernels = listed_kernels("member")
    last = compile_ahead.parts_of(kernels, len(kernels))[-1][-1]
    process = compile_ahead.started_process(len(kernels) - 1, len(kernels), ["member"], subprocess.PIPE)
    lines = process.communicate(timeout=120)[0].splitlines()
    assert process.returncode == 0
    assert float(lines[-1]) == last.seconds
    assert list(tmp_path.rglob(f"*{last.name}*.nbi"))
