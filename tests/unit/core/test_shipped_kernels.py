"""Kernels that came with the package: taken where processor and content are those of the build, else compiled."""

import os
import pickle
import shutil
import subprocess
import sys
from collections.abc import Callable
from hashlib import sha256
from pathlib import Path

import pytest
from numba.core.caching import _CacheLocator

from moyai.core.shipped_kernels import PACKAGE, family

SOURCE = PACKAGE / "sea" / "dispersion.py"
#: Prints a wave number, and how many kernels were compiled.
ASK = """
import sys
from numba.core import event
from moyai.core import shipped_kernels
if sys.argv[1] == "lacking":
    known = shipped_kernels._FAMILIES
    known.update({name: (cpu, (*own, "nosuch")) for name, (cpu, own) in known.items()})
if sys.argv[1] == "edited":
    from moyai.core import compiled
    compiled.kernel_stamp = lambda path: b"another"
compiled_ones = []
class Clock(event.Listener):
    def on_start(self, event): compiled_ones.append(event)
    def on_end(self, event): pass
with event.install_listener("numba:compile", Clock()):
    from moyai.sea.dispersion import wave_number
    print(float(wave_number(1.0, 10.0, 9.81)), len(compiled_ones))
"""


def ask(folder: Path, kept: Path, way: str = "as built", **target: str) -> tuple[float, int]:
    environment = os.environ | {"NUMBA_CACHE_DIR": str(kept), "MOYAI_COMPILED_KERNELS": str(folder)} | target
    command = [sys.executable, "-c", ASK, way]
    value, count = subprocess.run(command, env=environment, capture_output=True, text=True, check=True).stdout.split()
    return float(value), int(count)


@pytest.fixture(scope="module")
def built(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, float]:
    """Give a folder with the kernels of one file for the family of this machine, and what they return."""
    wanted = family()
    if wanted is None:
        pytest.skip("no kernels are shipped for this machine")
    kept, folder = tmp_path_factory.mktemp("kept"), tmp_path_factory.mktemp("shipped")
    value, count = ask(kept, kept, NUMBA_CPU_NAME=wanted[0], NUMBA_CPU_FEATURES=wanted[1])
    assert count > 0
    shutil.copytree(kept / _CacheLocator.get_suitable_cache_subpath(str(SOURCE)), folder / "sea")
    write_digests(folder)
    return folder, value


def write_digests(folder: Path) -> None:
    """Write the digests of all files of a folder."""
    lines = [f"{sha256(file.read_bytes()).hexdigest()}  {file.relative_to(folder).as_posix()}\n"
             for file in sorted(folder.rglob("*.nb[ic]"))]  # fmt: skip
    (folder / "sha256.txt").write_text("".join(lines), encoding="utf-8")


def other_code(folder: Path) -> None:
    """Change the middle of the machine code: what cannot be told from a kernel ends the process when it is loaded."""
    for file in folder.rglob("*.nbc"):
        content = bytearray(file.read_bytes())
        begin = content.find(b"\x7fELF")
        content[begin : begin + 64] = bytes(64)
        file.write_bytes(content)


def other_form(folder: Path) -> None:
    """Put another object into the data, with its digest."""
    for file in folder.rglob("*.nbc"):
        file.write_bytes(pickle.dumps((1, 2)))
    write_digests(folder)


def other_system(folder: Path) -> None:
    """Name another system in the index, with its digest."""
    for file in folder.rglob("*.nbi"):
        with file.open("rb") as opened:
            version, (stamp, known) = pickle.load(opened), pickle.load(opened)
        named = {(types, ("x86_64-pc-plan9", *own), digests): name
                 for (types, (_, *own), digests), name in known.items()}  # fmt: skip
        file.write_bytes(pickle.dumps(version, -1) + pickle.dumps((stamp, named), -1))
    write_digests(folder)


def no_digests(folder: Path) -> None:
    """Take the digests away."""
    (folder / "sha256.txt").unlink()


def a_file(folder: Path) -> None:
    """Put a file in the place of the folder."""
    shutil.rmtree(folder)
    folder.write_text("no folder", encoding="utf-8")


@pytest.mark.parametrize("way", ["as built", "lacking", "edited"])
def test_they_are_taken_where_they_fit(built: tuple[Path, float], tmp_path: Path, way: str) -> None:
    """Nothing is compiled and the number is the same; a processor that lacks instructions and an edit compile anew."""
    folder, value = built
    found, count = ask(folder, tmp_path / "kept", way)
    assert found == pytest.approx(value, rel=1e-14)
    assert (count == 0) == (way == "as built")


@pytest.mark.parametrize("change", [other_code, other_form, other_system, no_digests, a_file])
def test_what_does_not_fit_is_compiled_anew(
    built: tuple[Path, float], tmp_path: Path, change: Callable[[Path], None]
) -> None:
    folder, value = built
    changed = Path(shutil.copytree(folder, tmp_path / "changed"))
    change(changed)
    found, count = ask(changed, tmp_path / "kept")
    assert found == pytest.approx(value, rel=1e-14) and count > 0


@pytest.mark.parametrize("place", ["x" * 300, "x/" * 2500])
def test_a_folder_that_cannot_be_is_none(tmp_path: Path, place: str) -> None:
    assert ask(tmp_path / place, tmp_path / "kept")[1] > 0
