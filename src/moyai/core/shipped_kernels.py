"""Kernels in machine code that a wheel for one system and one version of Python brings along.

A wheel may hold the folder ``moyai/compiled_kernels``, for a family of processors: the kernels of the templates, and
those that runs of further cases compile. ``python -m moyai.core.shipped_kernels FOLDER CASE...`` writes it; without a
wheel, on a cluster for instance, ``MOYAI_COMPILED_KERNELS`` names it. It is used where the processor has their
instructions and system, version of numba, bytecode and content of the files are those of the build; else, and where a
file is damaged, kernels are compiled at first use, as without it. Numbers of both agree to rounding: other processors
add in another order.
"""

from __future__ import annotations

import hashlib
import os
import platform
import re
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Callable, Sequence
from contextlib import suppress
from functools import cache
from pathlib import Path
from typing import Any

PACKAGE = Path(__file__).parents[1]
FOLDER = Path(os.environ.get("MOYAI_COMPILED_KERNELS") or PACKAGE / "compiled_kernels")

#: By kind of machine: name of the processor for the compiler, and instructions that a machine needs to have.
_FAMILIES = {
    "x86_64": ("x86-64-v3", ("avx", "avx2", "bmi", "bmi2", "f16c", "fma", "lzcnt", "movbe", "popcnt", "sse4.2")),
    "arm64": ("generic", ()),
}
#: Digests of the files of the folder.
_DIGESTS = "sha256.txt"
_SAME_MACHINE = {"amd64": "x86_64", "aarch64": "arm64"}


def family() -> tuple[str, str] | None:
    """Return processor and instructions that kernels are shipped for on such a machine; ``None`` where none are."""
    machine = platform.machine().lower()
    found = _FAMILIES.get(_SAME_MACHINE.get(machine, machine))
    return None if found is None else (found[0], ",".join(f"+{name}" for name in found[1]))


@cache
def usable_family() -> tuple[str, str] | None:
    """Return the family of :func:`family` where there are shipped kernels and this processor has its instructions."""
    found = family() if os.path.isdir(FOLDER) else None
    if not found or not found[1]:
        return found
    from llvmlite.binding import get_host_cpu_features

    own = get_host_cpu_features()
    return found if all(own.get(name.lstrip("+"), False) for name in found[1].split(",")) else None


@cache
def _digests() -> dict[str, str]:
    """Return the digests of the files of the folder by their places in it."""
    lines = (FOLDER / _DIGESTS).read_text(encoding="utf-8").splitlines()
    return {place: digest for digest, place in (line.split(maxsplit=1) for line in lines)}


def _is_whole(file: Path) -> bool:
    # machine code that is damaged would end the process
    own = hashlib.sha256(file.read_bytes()).hexdigest()
    return _digests().get(file.relative_to(FOLDER).as_posix()) == own


def _system(triple: str) -> str:
    """Return machine and system of a target, without the version of the system."""
    return re.sub(r"[\d.]+$", "", triple)


def shipped(source: Path, key: tuple[Any, Any, Any], open_files: Callable[[Path], Any]) -> Any:
    """Return what is kept of a kernel in the shipped folder, ``None`` where it is not there.

    Parameters
    ----------
    source : Path
        File of the kernel.
    key : tuple
        Numba's key of the kernel on this machine: types, target, digests of the bytecode.
    open_files : callable
        Gives index and data of the kernel in a folder.
    """
    wanted = usable_family()
    if wanted is None or not source.is_relative_to(PACKAGE):
        return None
    place = FOLDER / source.parent.relative_to(PACKAGE)
    target = (_system(key[1][0]), *wanted)
    # whatever is wrong with the folder, kernels can be compiled
    with suppress(Exception):
        files = open_files(place)
        for (types, (triple, *own), digests), name in files._load_index().items():
            if (types, (_system(triple), *own), digests) == (key[0], target, key[2]) and _is_whole(place / name):
                return files._load_data(name)
    return None


def write_kernels(folder: Path, cases: Sequence[Path] = ()) -> int:
    """Compile kernels for the family of this machine into a folder; return the number of files.

    Parameters
    ----------
    folder : Path
    cases : sequence of Path
        Case files that are run, for the kernels that the templates of the structures do without.

    Raises
    ------
    SystemExit
        For machines without a family, and where the compiler fails.
    """
    from numba.core.caching import _CacheLocator

    wanted = family()
    if wanted is None:
        raise SystemExit(f"no kernels are shipped for {platform.machine()}")
    lines: list[str] = []
    with tempfile.TemporaryDirectory() as kept:
        target = {"NUMBA_CPU_NAME": wanted[0], "NUMBA_CPU_FEATURES": wanted[1], "NUMBA_CACHE_DIR": kept}
        # a library of the builder that users need not have
        target["NUMBA_DISABLE_INTEL_SVML"] = "1"
        moyai, environment = [sys.executable, "-m", "moyai"], os.environ | target
        subprocess.run([*moyai, "compile", "--quiet"], env=environment, check=True)
        for number, case in enumerate(cases):
            # what a run says of its design is no matter here
            subprocess.run([*moyai, "run", str(case), "-q", "-o", f"{kept}/run {number}"], env=environment)
        for source in {file.parent for file in PACKAGE.rglob("*.py")}:
            own = Path(kept) / _CacheLocator.get_suitable_cache_subpath(str(source / "any.py"))
            for file in sorted(own.glob("*.nb[ic]")):
                place = folder / source.relative_to(PACKAGE) / file.name
                place.parent.mkdir(parents=True, exist_ok=True)
                shutil.copyfile(file, place)
                digest = hashlib.sha256(file.read_bytes()).hexdigest()
                lines.append(f"{digest}  {place.relative_to(folder).as_posix()}\n")
    (folder / _DIGESTS).write_text("".join(lines), encoding="utf-8")
    return len(lines)


if __name__ == "__main__":
    sys.stdout.write(f"{write_kernels(Path(sys.argv[1]), [Path(name) for name in sys.argv[2:]])} files\n")
