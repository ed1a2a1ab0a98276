"""The examples that redraw the figures of the impact paper run, with a pinned number each."""

from __future__ import annotations

import importlib.util
import sys
from pathlib import Path

import pytest

FOLDER = Path(__file__).resolve().parents[3] / "examples" / "curtain"


def load(name: str):
    spec = importlib.util.spec_from_file_location(f"curtain_sweep_{name}", FOLDER / f"{name}.py")
    module = importlib.util.module_from_spec(spec)
    sys.modules[spec.name] = module  # dataclasses look their module up
    spec.loader.exec_module(module)
    return module


def run(name, pictures, tmp_path, monkeypatch, capsys, *further):
    example = load(name)
    monkeypatch.setattr("sys.argv", [f"{name}.py", str(tmp_path), *map(str, further)])
    example.main()
    printed = capsys.readouterr().out
    for picture in pictures:
        assert (tmp_path / picture).stat().st_size > 20_000
        assert f"wrote {tmp_path / picture}" in printed
    return printed


@pytest.mark.slow
def test_tension_coefficient_example(tmp_path, monkeypatch, capsys) -> None:
    points = tmp_path / "observed.csv"
    header = "froude_number,depth_ratio,span_ratio,cauchy_number,tension_coefficient"
    points.write_text(f"{header}\n0.15,0.375,0.875,0.49,2.0\n", encoding="utf-8")
    pictures = ("tension_coefficient.png", "tension_of_impact.png")
    printed = run("tension_coefficient", pictures, tmp_path, monkeypatch, capsys, points)
    assert "log C_T over log Fr: -1.013" in printed
    assert "over that at 0.5: 1.0107" in printed


@pytest.mark.slow
def test_snap_example(tmp_path, monkeypatch, capsys) -> None:
    printed = run("snap_in_current", ("snap_in_current.png",), tmp_path, monkeypatch, capsys)
    assert "spike 7.538 N" in printed and "plateau 2.917 N" in printed
    assert load("snap_in_current").release(39000.0).rise == pytest.approx(0.016, rel=0.05)


@pytest.mark.slow
def test_added_mass_example(tmp_path, monkeypatch, capsys) -> None:
    printed = run("added_mass", ("added_mass.png",), tmp_path, monkeypatch, capsys)
    assert "1.4609 M0 of the chord, 0.5921 of the arc" in printed
    assert "plate, Kd = 2: M/M0 = 0.2068" in printed
