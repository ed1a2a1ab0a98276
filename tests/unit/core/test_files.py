"""Files are complete under their final name, or not there."""

import os

import pytest

from moyai.core.errors import InputError
from moyai.core.files import partial_file, write_whole


def test_a_file_is_replaced_whole_and_nothing_is_left(tmp_path):
    path = tmp_path / "new" / "file.txt"
    assert write_whole(path, b"one") == path
    write_whole(path, b"two")
    assert path.read_bytes() == b"two"
    assert list(path.parent.iterdir()) == [path]


def test_an_interrupt_leaves_the_former_file(tmp_path):
    path = tmp_path / "file.txt"
    write_whole(path, b"one")
    with pytest.raises(KeyboardInterrupt), partial_file(path) as partial:
        partial.write_bytes(b"half")
        raise KeyboardInterrupt
    assert path.read_bytes() == b"one"
    assert list(tmp_path.iterdir()) == [path]


def test_rights_are_those_of_a_new_file(tmp_path):
    plain = tmp_path / "plain"
    plain.write_bytes(b"")
    assert write_whole(tmp_path / "whole", b"").stat().st_mode == plain.stat().st_mode


def test_what_cannot_be_written_is_an_error_that_names_the_option(tmp_path):
    (tmp_path / "file").write_bytes(b"")
    with pytest.raises(InputError, match="cannot write") as caught:
        write_whole(tmp_path / "file" / "below", b"", named="--csv")
    assert caught.value.fault.path == "--csv"


def test_a_full_disk_is_refused_before_anything_is_written(tmp_path):
    with pytest.raises(InputError, match="MB free"), partial_file(tmp_path / "file", size=10**18):
        pass
    assert not os.listdir(tmp_path)
