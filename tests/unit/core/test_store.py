"""Kept datasets: the same back, nothing for another key or a damaged file, no harm from an unwritable folder."""

from __future__ import annotations

import numpy as np
import xarray as xr

from moyai.core.store import DatasetStore, key_of


def test_complex_dataset_comes_back(tmp_path):
    store = DatasetStore(tmp_path / "kept")
    data = xr.Dataset(
        {"force": ("omega", np.arange(3) * (1 + 2j))}, coords={"omega": [1.0, 2.0, 3.0]}, attrs={"a": "b"}
    )
    key = key_of("version", np.arange(3.0), 0.5)
    assert store.get(key) is None
    store.put(key, data)
    back = store.get(key)
    assert np.array_equal(back.force.values, data.force.values) and back.attrs["a"] == "b"
    assert [path.suffix for path in (tmp_path / "kept").iterdir()] == [".nc"]
    (tmp_path / "kept" / f"{key}.nc").write_bytes(b"half")
    assert store.get(key) is None


def test_key_tells_every_change_apart():
    parts = (1.0, 2.0, "1.0", np.array([1.0]), np.array([1.0 + 2.3e-16]), np.array([[1.0]]), None)
    assert len({key_of(part) for part in parts}) == len(parts)
    assert key_of(np.array([1.0, 2.0])) != key_of(np.array([1.0]), np.array([2.0]))
    assert key_of(np.arange(4.0)) == key_of(np.arange(4.0))


def test_unwritable_folder_keeps_nothing(tmp_path):
    blocked = tmp_path / "file"
    blocked.write_text("not a folder")
    DatasetStore(blocked).put("key", xr.Dataset())
    assert DatasetStore(blocked).get("key") is None
