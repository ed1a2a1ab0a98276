"""The cache of compiled kernels: an edit of an inner kernel makes every kernel that calls it new."""

import importlib.util
import pickle
from pathlib import Path

import numba
import numpy as np
import pytest
from numba.core import event

from moyai.core import compiled
from moyai.core.compiled import kernel_stamp, njit, when_compiling
from moyai.flexible import explicit_kernel, ring_kernel, sheet_kernel


def test_an_inner_kernel_of_another_file_belongs_to_the_key(monkeypatch: pytest.MonkeyPatch) -> None:
    caller, other = Path(explicit_kernel.__file__), Path(ring_kernel.__file__)
    before = kernel_stamp(caller), kernel_stamp(other)
    assert explicit_kernel.march._cache._impl.locator.get_source_stamp() == before[0]
    source = compiled._source

    def edited(path: Path) -> tuple[bytes, frozenset[Path]]:
        content, files = source(path)
        return content + b"#" * (path == Path(sheet_kernel.__file__)), files

    monkeypatch.setattr(compiled, "_source", edited)
    kernel_stamp.cache_clear()
    after = kernel_stamp(caller), kernel_stamp(other)
    kernel_stamp.cache_clear()
    assert after[0] != before[0]
    assert after[1] == before[1]


def test_the_first_compilation_is_reported_once() -> None:
    calls = []

    @njit(error_model="numpy")
    def twice(x):
        return x / 0.0

    with when_compiling(lambda: calls.append(1)):
        assert twice(1.0) == np.inf
        assert twice(np.float32(1.0)) == np.inf
    assert calls == [1]


@njit(error_model="numpy")
def _half(x):
    return 0.5 * x


@njit(error_model="numpy")
def _quarter(x):
    return _half(_half(x))


@njit(error_model="numpy")
def _eighths(values):
    total = 0.0
    for value in values:
        total += _quarter(_half(value)) + 0.0 * _half(1)
    return total


def test_kernels_within_a_kernel_are_parts_and_have_a_form_of_their_own_for_python() -> None:
    assert _eighths(np.array([8.0, 16.0])) == 3.0
    assert not _half.overloads and not _quarter.overloads
    assert len(_eighths.overloads) == 1
    assert _quarter(2.0) == 0.5
    assert len(_quarter.overloads) == 1
    # what is compiled already serves other types and callers too
    assert _eighths(np.array([8, 16])) == 3.0


def test_functions_of_numpy_are_parts_of_the_kernel_that_calls_them() -> None:
    compiled_ones = []

    class Heard(event.Listener):  # type: ignore[misc]
        def on_start(self, event) -> None:
            compiled_ones.append(event.data["dispatcher"].py_func.__name__)

        def on_end(self, event) -> None:
            pass

    @njit(error_model="numpy")
    def spread(values):
        room = np.zeros((values.size, 2))
        room[:, 1] = np.cumsum(values) + max(values[0], values[1])
        return room.sum() + np.median(values)

    with event.install_listener("numba:compile", Heard()):
        assert spread(np.array([1.0, 2.0, 4.0])) == 1.0 + 3.0 + 7.0 + 3.0 * 2.0 + 2.0
    assert compiled_ones == ["spread"]


def test_functions_of_numba_itself_compile_as_before() -> None:
    _half(1.0)  # a kernel of the package has changed how numba compiles

    @numba.njit(parallel=True)
    def spread(rows):
        total = 0.0
        for number in numba.prange(len(rows)):
            total += np.linalg.norm(rows[number]) + np.median(rows[number]) + np.sort(rows[number])[0]
        return total + np.linalg.svd(rows)[1].sum()

    @numba.njit
    def counted(values):
        found = {1: 2.0}
        found[2] = np.percentile(values, 30.0)
        return found[2] + len(str(values.size)) + sorted([3, 1])[0] + np.histogram(values, 5)[0].sum()

    rows = np.random.default_rng(0).uniform(size=(6, 6))
    expected = np.linalg.norm(rows, axis=1) + np.median(rows, axis=1) + rows.min(axis=1)
    assert spread(rows) == pytest.approx(expected.sum() + np.linalg.svd(rows)[1].sum())
    assert counted(rows[0]) == pytest.approx(np.percentile(rows[0], 30.0) + 1 + 1 + 6)


def test_a_fault_in_a_part_comes_through() -> None:
    @njit()
    def refuse(x):
        if x > 0.0:
            raise ValueError("too large")
        return x

    @njit()
    def call(x):
        return refuse(x) + 1.0

    assert call(-1.0) == 0.0
    with pytest.raises(ValueError, match="too large"):
        call(1.0)


def test_types_that_a_part_cannot_take_are_reported() -> None:
    @njit()
    def part(x):
        return x.no_such_thing

    @njit()
    def call(x):
        return part(x)

    with pytest.raises(Exception, match="no_such_thing"):
        call(1.0)


@pytest.mark.parametrize("damage", [b"", b"no pickle", b"\x80\x04cmoyai.core.compiled\nGoneWithAnUpgrade\n."])
def test_a_kept_kernel_that_cannot_be_read_is_compiled_anew(tmp_path: Path, damage: bytes) -> None:
    (tmp_path / "kept_kernel.py").write_text(
        "from moyai.core.compiled import njit\n\n\n@njit(cache=True)\ndef thrice(x):\n    return 3.0 * x\n"
    )

    def fresh() -> object:
        spec = importlib.util.spec_from_file_location("kept_kernel", tmp_path / "kept_kernel.py")
        module = importlib.util.module_from_spec(spec)
        spec.loader.exec_module(module)
        return module.thrice

    assert fresh()(2.0) == 6.0
    again = fresh()
    assert again(2.0) == 6.0 and sum(again.stats.cache_hits.values()) == 1
    kept = Path(again._cache.cache_path)
    (index,) = kept.glob("kept_kernel.thrice-*.nbi")
    whole = index.read_bytes()
    for file in (index, *kept.glob("kept_kernel.thrice-*.nbc")):
        if file == index and damage:
            # as after an upgrade: the version is good, what follows cannot be read
            with file.open("rb") as stream:
                pickle.load(stream)
                head = whole[: stream.tell()]
            file.write_bytes(head + damage)
        else:
            file.write_bytes(damage)
    damaged = fresh()
    assert damaged(2.0) == 6.0 and not damaged.stats.cache_hits
    healed = fresh()
    assert healed(2.0) == 6.0 and sum(healed.stats.cache_hits.values()) == 1
