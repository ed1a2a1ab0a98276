"""The command: one clear message where the extra is absent, or where there is nothing to open."""

from __future__ import annotations

import socket
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import pytest
from typer.testing import CliRunner

from moyai.app import serve
from moyai.cli.main import app
from moyai.core.errors import InputError


def run(*arguments: str) -> Any:
    return CliRunner().invoke(app, ["app", *arguments, "--no-browser"])


def test_without_the_extra_one_message_says_what_to_install(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setattr(serve, "find_spec", lambda name: None if name == "uvicorn" else find_spec(name))
    answer = run(str(tmp_path))
    assert answer.exit_code == 2
    assert answer.output.count("\n") == 1
    assert 'pip install ".[app]"' in answer.output and "uvicorn" in answer.output


@pytest.mark.parametrize("name", ["absent.yaml", "notes.txt"])
def test_what_is_no_case_is_refused(tmp_path: Path, name: str) -> None:
    (tmp_path / "notes.txt").write_text("notes")
    answer = run(str(tmp_path / name))
    assert answer.exit_code == 2
    assert name in answer.output


def test_the_folder_of_a_file_is_chosen(tmp_path: Path) -> None:
    (tmp_path / "pile.yaml").write_text("a: 1\n")
    folder, first = serve.chosen_folder(tmp_path / "pile.yaml", None)
    assert (folder.root, folder.output, first) == (tmp_path.resolve(), tmp_path.resolve() / "out", "pile.yaml")
    (tmp_path / "out").symlink_to("/tmp")
    with pytest.raises(InputError, match="outside"):
        serve.chosen_folder(tmp_path, None)


def test_a_port_that_is_taken_is_reported() -> None:
    with socket.socket() as taken:
        taken.bind(("127.0.0.1", 0))
        taken.listen()
        with pytest.raises(InputError, match="cannot be used"):
            serve.open_socket(taken.getsockname()[1])
    listener = serve.open_socket(0)
    assert listener.getsockname()[0] == "127.0.0.1"
    listener.close()
