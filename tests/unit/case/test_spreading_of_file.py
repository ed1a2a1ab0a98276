"""A case takes the directional spreading of its file of spectra."""

import math
from pathlib import Path

import numpy as np
from case_files import CASE, faults, read

from moyai.case.builder import build
from moyai.sea.spectrum_archives import read_archive

FREQUENCY = np.array([0.08, 0.1, 0.13, 0.2])


def swan(folder: Path) -> tuple[Path, np.ndarray]:
    """Return a file of SWAN in a sector of Cartesian directions and its densities [m2/Hz/degree]."""
    rng = np.random.default_rng(8)
    density = rng.integers(1, 500, (4, 9))
    directions = 40.0 + 12.0 * np.arange(9)
    lines = ["SWAN 1", "TIME", "1", "LOCATIONS", "1", "0.0 0.0", "AFREQ", "4", *map(str, FREQUENCY), "CDIR", "9"]
    lines += [*map(str, directions), "QUANT", "1", "VaDens", "m2/Hz/degr", "-99", "20240101.0000", "FACTOR", "1e-3"]
    (folder / "sea.spec").write_text("\n".join([*lines, *(" ".join(map(str, row)) for row in density)]) + "\n")
    return folder / "sea.spec", density * 1e-3


def test_a_case_takes_the_spreading_of_its_file(tmp_path):
    """Directions of SWAN's Cartesian convention are headings: their offsets from the mean are those of the sea."""
    file, density = swan(tmp_path)
    headings = np.radians(40.0 + 12.0 * np.arange(9))
    total = np.gradient(FREQUENCY) @ density
    mean = math.atan2(float(total @ np.sin(headings)), float(total @ np.cos(headings)))
    sea = (
        "waves:\n  - {name: measured, kind: spectrum_file, file: sea.spec, record: 0, heading_deg: 0, "
        "spreading: {kind: file}}\n"
    )
    begin, end = CASE.index("waves:"), CASE.index("\nstructure:") + 1
    text = CASE[:begin] + sea + CASE[end:]
    (state,) = build(read(text, tmp_path)).environment.sea_states
    omega = 2.0 * math.pi * FREQUENCY
    share = density / density.sum(axis=1, keepdims=True)
    for number, heading in enumerate(headings):
        ends = [state.spreading.cumulative(heading - mean + side * math.radians(6.0), omega) for side in (-1, 1)]
        assert np.allclose(ends[1] - ends[0], share[:, number], atol=1e-9)
    archive = read_archive(file)
    assert archive.energy is not None
    assert np.allclose(archive.energy.sum(axis=-1), archive.density)
    (tmp_path / "two.csv").write_text("0.1,1\n0.2,2\n")
    (found,) = faults(text.replace("sea.spec, record: 0", "two.csv"), tmp_path)
    assert "waves[0].spreading: a table of two columns holds no directions" in found
