"""The writer and the reader of results against xarray's own, down to the objects of the HDF5 file."""

from pathlib import Path
from typing import Any

import h5py
import numpy as np
import pytest
import xarray as xr

from moyai.core.netcdf_reader import read_tree
from moyai.core.netcdf_writer import can_write, write_tree

NUMBERED = {"_Netcdf4Dimid", "_Netcdf4Coordinates", "_NCProperties"}


def a_tree(seed: int) -> xr.DataTree:
    random = np.random.default_rng(seed)

    def variable(*dims: str) -> tuple[tuple[str, ...], Any, dict[str, Any]]:
        sizes = {"omega": 4, "line": 2, "point": 3, "none": 0}
        values = random.normal(size=[sizes[dim] for dim in dims])
        return dims, values, {"units": "m", "long_name": "a wäy", "limits": [1.0, 2.5], "count": 3, "ways": ["a", "ß"]}

    omega, names = np.arange(1.0, 5.0), np.array(["seaward", "リ"])
    upper = xr.Dataset(
        {"a": variable("omega", "line"), "b": variable(), "c": variable("point"), "text": ((), "a\nb")},
        coords={"omega": ("omega", omega, {"units": "rad/s"}), "line": names, "period": ("omega", 6.28 / omega)},
        attrs={"title": "T", "empty": "", "number": 2},
    )
    lower = xr.Dataset(
        {
            "a": variable("line", "none")[:2],
            "single": ("line", np.array([1.5, np.nan], dtype=np.float32)),
            "whole": ("line", np.array([1, -2])),
            "held": ("line", np.array([True, False])),
            "words": ("line", np.array(["x", ""], dtype=object)),
        }
        if seed % 2
        else {"z": ("line", [1.0, 2.0])}
    )
    root = xr.Dataset(attrs={"status": "converged"})
    return xr.DataTree.from_dict({"/": root, "/u": upper, "/u/l": lower, "/e": xr.Dataset()})


def objects(path: Path) -> dict[str, Any]:
    """Return all that a file holds, references by the names of what they lead to."""
    found: dict[str, Any] = {}

    def attributes(item: Any, file: h5py.File) -> dict[str, Any]:
        rows = {}
        for name in set(item.attrs) - NUMBERED:
            value, place = item.attrs[name], item.attrs.get_id(name)
            if name == "DIMENSION_LIST":
                value = [[file[one].name for one in row] for row in value]
            elif name == "REFERENCE_LIST":
                value = sorted((file[one].name, int(axis)) for one, axis in value)
            rows[name] = str(value), place.shape, str(place.dtype)
        return rows

    with h5py.File(path) as file:

        def visit(name: str, item: Any) -> None:
            if isinstance(item, h5py.Dataset):
                plan = item.id.get_create_plist()
                found[name] = (
                    str(item.dtype), item.shape, item.maxshape, str(item.fillvalue), str(item[()]),
                    plan.get_attr_creation_order(), attributes(item, file),
                )  # fmt: skip
                if item.shape and (numbers := item.attrs.get("_Netcdf4Coordinates")) is not None:
                    assert len(numbers) == item.ndim
                    assert numbers[0] == item.attrs["_Netcdf4Dimid"]
            else:
                found[name] = sorted(item), item.id.get_create_plist().get_link_creation_order(), attributes(item, file)

        file.visititems(visit)
        found["/"] = attributes(file, file)
        numbers = [item.attrs["_Netcdf4Dimid"] for item in scales(file)]
        assert len(set(numbers)) == len(numbers)
    return found


def scales(file: h5py.File) -> list[h5py.Dataset]:
    found: list[h5py.Dataset] = []
    file.visititems(lambda _, item: found.append(item) if isinstance(item, h5py.Dataset) and item.is_scale else None)
    return found


@pytest.mark.slow
@pytest.mark.parametrize("seed", [0, 1])
def test_file_is_that_of_xarray(seed: int, tmp_path: Path) -> None:
    tree = a_tree(seed)
    assert can_write(tree)
    write_tree(tree, tmp_path / "own.nc")
    tree.to_netcdf(tmp_path / "other.nc", engine="h5netcdf")
    assert objects(tmp_path / "own.nc") == objects(tmp_path / "other.nc")
    own, other = (xr.open_datatree(tmp_path / name, engine="h5netcdf").load() for name in ("own.nc", "other.nc"))
    assert own.identical(other)
    assert np.isnan(own["/u"].ds["a"].encoding["_FillValue"])


@pytest.mark.parametrize("seed", [0, 1])
def test_what_was_written_is_read_as_xarray_reads_it(seed: int, tmp_path: Path) -> None:
    write_tree(a_tree(seed), tmp_path / "own.nc")
    found = read_tree(tmp_path / "own.nc")
    with xr.open_datatree(tmp_path / "own.nc", engine="h5netcdf") as stored:
        xr.testing.assert_identical(found, stored.load())
        for node in stored.subtree:
            for name, variable in node.variables.items():
                own = found[node.path].variables[name]
                assert own.dtype.kind == variable.dtype.kind
                assert own.attrs.keys() == variable.attrs.keys()
                assert [type(value) for value in own.attrs.values()] == [type(v) for v in variable.attrs.values()]
            assert list(found[node.path].data_vars) == list(node.data_vars)


def test_what_it_does_not_know_is_left_to_xarray() -> None:
    assert not can_write(xr.DataTree(xr.Dataset({"a": ("t", np.array(["2026-01-01"], dtype="datetime64[ns]"))})))
    assert not can_write(xr.DataTree(xr.Dataset({"a": ("t", np.array(["a", None], dtype=object))})))
    assert not can_write(xr.DataTree(xr.Dataset({"a": ("t", np.array([1.0 + 2.0j]))})))
