"""Kernels that came with the package: taken where processor and content are those of the build, else compiled."""

import os
import shutil
import subprocess
import sys
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
    return folder, value


@pytest.mark.parametrize("way", ["as built", "lacking", "edited", "damaged"])
def test_they_are_taken_where_they_fit(built: tuple[Path, float], tmp_path: Path, way: str) -> None:
    """Nothing is compiled and the number is the same; a processor that lacks instructions and an edit compile anew."""
    folder, value = built
    if way == "damaged":
        folder = Path(shutil.copytree(folder, tmp_path / "damaged"))
        for file in folder.rglob("*.nbc"):
            file.write_bytes(b"no kernel")
    found, count = ask(folder, tmp_path / "kept", way)
    assert found == pytest.approx(value, rel=1e-14)
    assert (count == 0) == (way == "as built")
