"""Messages of commands in Japanese that hold words of the operating system or of parts put together."""

from __future__ import annotations

import errno
import os
import re
from pathlib import Path

import pytest
from typer.testing import CliRunner

from moyai.case.templates import template
from moyai.cli.main import app
from moyai.language import said, spoken_in
from moyai.language.words import latin_words

EXAMPLES = Path(__file__).resolve().parents[3] / "examples"


def message(*arguments: str) -> str:
    """Return what a command that fails says in Japanese."""
    found = CliRunner().invoke(app, ["--language", "ja", *arguments])
    assert found.exit_code != 0
    return found.output


def without_names(text: str, *names: str) -> list[str]:
    """Return the words in Latin letters of a message but those of files and of keys: runs[0].file."""
    text = re.sub(r"\b\w+\[\d+\]\.\w+", "", text)
    for name in names:
        text = text.replace(name, "")
    return latin_words(text)


@pytest.mark.parametrize(
    "number",
    [errno.ENOENT, errno.EACCES, errno.EISDIR, errno.ENOTDIR, errno.EEXIST, errno.ENOSPC, errno.EROFS, errno.EDQUOT,
     errno.EINVAL, errno.ENAMETOOLONG, errno.EIO, errno.EMFILE, errno.ELOOP, errno.EPERM, errno.EBUSY, errno.ENOTEMPTY],
)  # fmt: skip
def test_what_the_operating_system_says(number: int) -> None:
    with spoken_in("ja"):
        assert latin_words(said(os.strerror(number))) == []


def test_a_file_that_is_not_there(tmp_path: Path) -> None:
    text = message("measure", "snaps", str(tmp_path / "no.yaml"))
    assert not without_names(text, str(tmp_path / "no.yaml")), text


def test_records_that_are_not_there(tmp_path: Path) -> None:
    snaps = (EXAMPLES / "curtain" / "flume" / "snaps.yaml").read_text(encoding="utf-8")
    (tmp_path / "snaps.yaml").write_text(snaps, encoding="utf-8")
    text = message("measure", "snaps", str(tmp_path / "snaps.yaml"), "-o", str(tmp_path / "o"))
    assert not without_names(text, str(tmp_path), "case.yaml", "snaps.yaml"), text


def test_a_full_width_colon(tmp_path: Path) -> None:
    text = template("member").replace("water_depth: 20 m", "water_depth：20 m", 1)
    assert "：" in text
    (tmp_path / "m.yaml").write_text(text, encoding="utf-8")
    said_of_it = message("check", str(tmp_path / "m.yaml"))
    assert "全角コロン" in said_of_it
    assert not without_names(said_of_it, str(tmp_path / "m.yaml")), said_of_it
