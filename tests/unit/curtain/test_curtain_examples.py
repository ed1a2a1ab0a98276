"""The examples of curtain statics and anchor loads run, with a pinned number each."""

from __future__ import annotations

import importlib.util
from pathlib import Path

import numpy as np
import pytest

FOLDER = Path(__file__).resolve().parents[3] / "examples" / "curtain"


def load(name: str):
    spec = importlib.util.spec_from_file_location(f"curtain_example_{name}", FOLDER / f"{name}.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@pytest.mark.slow
def test_anchor_loads_example(tmp_path, monkeypatch, capsys) -> None:
    example = load("anchor_loads")
    monkeypatch.setattr("sys.argv", ["anchor_loads.py", str(tmp_path)])
    example.main()
    assert (tmp_path / "anchor_loads.png").stat().st_size > 20_000
    assert capsys.readouterr().out.count("95 %") == 3
    # H = 1.8 x 3.06 m at 60 degrees and the period that goes with it
    load_found, _ = example.tension(np.array([3.06]), np.radians(60.0), "paper")
    assert load_found[0] / 1e3 == pytest.approx(14.8, abs=0.3)
    # planted 0.2, two standard errors of 200 observations with 15 % scatter
    fit = example.fits(*example.campaign(7, 200))[0]
    assert fit.energy_factor(518.0, 890e3) == pytest.approx(0.2, rel=0.045)


@pytest.mark.slow
def test_load_laws_example(tmp_path, monkeypatch, capsys) -> None:
    example = load("load_laws")
    monkeypatch.setattr("sys.argv", ["load_laws.py", str(tmp_path)])
    example.main()
    assert (tmp_path / "load_laws.png").stat().st_size > 10_000
    out = capsys.readouterr().out
    assert "catenary 0.72182, circular 0.45465, rigid 0.78615" in out
