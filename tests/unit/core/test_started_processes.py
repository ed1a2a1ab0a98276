"""Processes that are started for work: in the environment of the moment, from one that has imported what they need."""

from __future__ import annotations

import os
import sys
import tempfile
from typing import Any

import pytest

from moyai.core.processes import LONGEST_FOLDER, Starter


def report(pipe: Any, name: str) -> None:
    pipe.send((os.environ.get(name), os.getppid(), os.getcwd()))


def reported(starter: Starter, name: str) -> tuple[Any, ...]:
    near, far = starter.context.Pipe()
    process = starter.start(report, far, name)
    found: tuple[Any, ...] = near.recv()
    process.join(timeout=10.0)
    assert process.exitcode == 0
    return found


def test_each_has_environment_and_folder_of_its_moment(monkeypatch: pytest.MonkeyPatch, tmp_path: Any) -> None:
    starter = Starter("moyai.core.progress")
    found = []
    for number in range(2):
        folder = tmp_path / str(number)
        folder.mkdir()
        monkeypatch.chdir(folder)
        monkeypatch.setenv("MOYAI_TEST_NUMBER", str(number))
        found.append(reported(starter, "MOYAI_TEST_NUMBER"))
        assert found[-1][0] == str(number) and found[-1][2] == str(folder)
    if sys.platform == "linux" and len(tempfile.gettempdir()) <= LONGEST_FOLDER:
        # both of one process, which is not this one
        assert found[0][1] == found[1][1] != os.getpid()


def test_where_the_folder_of_temporary_files_has_a_long_name_each_begins_afresh(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Any
) -> None:
    folder = tmp_path / ("long" * 20)
    folder.mkdir()
    monkeypatch.setattr(tempfile, "tempdir", str(folder))
    assert reported(Starter("moyai.core.progress"), "MOYAI_TEST_NUMBER")[1] == os.getpid()
