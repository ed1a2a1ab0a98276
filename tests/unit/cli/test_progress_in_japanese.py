"""What is said while a run or study goes on, in Japanese: by threads of their own, which begin without a language."""

from __future__ import annotations

import io
import sys
import time
from pathlib import Path

import pytest

from moyai.cli import console
from moyai.language import spoken_in
from moyai.language.missing import all_texts, is_translated
from moyai.language.words import latin_words


def shown(monkeypatch: pytest.MonkeyPatch, *, terminal: bool) -> str:
    """Return what progress shows on standard error of a run with two stages, one within the other."""
    stream = io.StringIO()
    monkeypatch.setattr(stream, "isatty", lambda: terminal, raising=False)
    monkeypatch.setattr(sys, "stderr", stream)
    monkeypatch.setattr(console, "LINE_EVERY", 0.05)
    with spoken_in("ja"), console.progress_bars(quiet=False) as listen:
        listen("water levels", 0, 2)
        for done in range(6):
            listen("time domain", done, 10)
            time.sleep(0.06)
    return stream.getvalue()


def test_lines_in_a_pipe(monkeypatch: pytest.MonkeyPatch) -> None:
    text = shown(monkeypatch, terminal=False)
    assert "水位：0 %" in text and "時間領域" in text and "残り" in text and "経過" in text
    assert latin_words(text) == []


def test_bars_on_a_terminal(monkeypatch: pytest.MonkeyPatch) -> None:
    text = shown(monkeypatch, terminal=True)
    assert "水位" in text and "時間領域" in text and "残り" in text
    assert "left" not in text and "water" not in text


@pytest.mark.slow
def test_every_stage_has_a_japanese_name() -> None:
    stages = [text for text in all_texts() if "progress(" in source_line(text.place)]
    assert len(stages) > 40
    assert [f"{text.place}: {text.template}" for text in stages if not is_translated(text.template, "ja")] == []


def source_line(place: str) -> str:
    """Return a line of the source of the package."""
    name, _, line = place.rpartition(":")
    path = Path(console.__file__).parents[1] / name
    return path.read_text(encoding="utf-8").splitlines()[int(line) - 1] if path.suffix == ".py" else ""
