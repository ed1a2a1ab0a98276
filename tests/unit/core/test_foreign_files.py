"""The border to files of others: one error with file and kind, sizes asked first."""

import pytest

from moyai.core.errors import ConvergenceError, InputError
from moyai.core.foreign_files import reading, reads, require_plausible_size


@pytest.mark.parametrize("error", [KeyError("a"), RuntimeError("b"), MemoryError(), OSError(5, "no"), IndexError()])
def test_every_error_becomes_one_with_the_file(tmp_path, error):
    with (
        pytest.raises(InputError, match=r"x\.mat cannot be read as a MATLAB file"),
        reading(tmp_path / "x.mat", "a MATLAB file"),
    ):
        raise error


def test_errors_raised_on_purpose_pass(tmp_path):
    with pytest.raises(ConvergenceError), reading(tmp_path / "x", "a table"):
        raise ConvergenceError("on purpose")


def test_generators_are_readers_too(tmp_path):
    @reads("a table")
    def rows(path):
        yield 1
        raise ValueError("two")

    taken = rows(tmp_path / "x.csv")
    assert next(taken) == 1
    with pytest.raises(InputError, match=r"x\.csv cannot be read as a table: ValueError, two"):
        next(taken)


def test_a_wrong_argument_is_no_fault_of_the_file(tmp_path):
    @reads("a table")
    def whole(path):
        return path

    with pytest.raises(TypeError):
        whole(tmp_path / "x", body=1)


def test_sizes_are_held_against_the_length_of_the_file(tmp_path):
    file = tmp_path / "x"
    file.write_bytes(b"0" * 2000)
    require_plausible_size(file, 1e6, "samples")
    with pytest.raises(InputError, match=r"x states 8,000 MB of samples and is 0\.002 MB long"):
        require_plausible_size(file, 8e9, "samples")
