"""The cache of compiled kernels: an edit of an inner kernel makes every kernel that calls it new."""

from pathlib import Path

import numpy as np
import pytest

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


def test_the_first_compilation_is_told_once() -> None:
    calls = []

    @njit(error_model="numpy")
    def twice(x):
        return x / 0.0

    with when_compiling(lambda: calls.append(1)):
        assert twice(1.0) == np.inf
        assert twice(np.float32(1.0)) == np.inf
    assert calls == [1]
