"""The examples on flume records, snaps in seas and the field campaign run, with pinned numbers."""

import importlib.util
import sys
from pathlib import Path

import numpy as np
import pytest

FOLDER = Path(__file__).resolve().parents[3] / "examples" / "curtain"


def load(name):
    spec = importlib.util.spec_from_file_location(f"curtain_snap_example_{name}", FOLDER / f"{name}.py")
    module = importlib.util.module_from_spec(spec)
    sys.modules[spec.name] = module
    spec.loader.exec_module(module)
    return module


@pytest.mark.slow
def test_flume_record_example(tmp_path, monkeypatch, capsys):
    example = load("flume_record")
    monkeypatch.setattr("sys.argv", ["flume_record.py", str(tmp_path)])
    example.main()
    assert (tmp_path / "flume_record.png").stat().st_size > 20_000
    out = capsys.readouterr().out
    assert "A with memory" in out
    assert "snap-drift" in out
    found = example.read(*example.synthetic(500.0, 0.0, 0.0, 0))
    snap = example.snap_in_current(
        example.IMPACT, drag_coefficient=1.2, current=0.3, position=0.0, speed=0.0, duration=19.5, time_step=5e-4
    )
    assert found.sum.peak == pytest.approx(snap.peak_tension, rel=1e-3)
    assert found.taut_time - example.RELEASE == pytest.approx(snap.taut_time, abs=0.04 * found.rise_time)
    assert found.release_time == pytest.approx(example.RELEASE, abs=0.02)
    assert found.sum.plateau == pytest.approx(snap.plateau_tension, rel=1e-3)
    table = np.column_stack([*example.synthetic(500.0, 0.02, 0.1, 3)[:1], example.synthetic(500.0, 0.02, 0.1, 3)[1].T])
    np.savetxt(tmp_path / "own.csv", table, delimiter=",", header="s, N, N")
    monkeypatch.setattr("sys.argv", ["flume_record.py", str(tmp_path), str(tmp_path / "own.csv")])
    example.main()
    assert "impact" in capsys.readouterr().out


@pytest.mark.slow
def test_wave_snaps_example(tmp_path, monkeypatch, capsys):
    example = load("wave_snaps")
    monkeypatch.setattr(example, "HOURS", 1.0)
    monkeypatch.setattr("sys.argv", ["wave_snaps.py", str(tmp_path)])
    example.main()
    assert (tmp_path / "wave_snaps.png").stat().st_size > 20_000
    out = capsys.readouterr().out
    assert "current 0.00 m/s: 0 snaps an hour" in out
    assert "most probable in 24 h" in out


@pytest.mark.slow
def test_campaign_example(tmp_path, capsys):
    example = load("campaign")
    data = example.campaign(3, 12)
    example.draw(tmp_path / "campaign.png", data)
    assert (tmp_path / "campaign.png").stat().st_size > 20_000
    lines = example.report(data)
    assert sum(line.startswith("single waves: M = ") for line in lines) == 1
    assert sum("rule of the paper" in line for line in lines) == 3
