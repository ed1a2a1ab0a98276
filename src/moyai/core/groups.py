"""The groups of a run as they stand: what reports read of them, without the tree that users and files get."""

from __future__ import annotations

from collections.abc import Hashable, Iterator, Mapping
from functools import cached_property
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    import xarray as xr


class Groups:
    """One group of a result and those below it, read as an :class:`xarray.DataTree` is.

    A tree costs more than many a draft: it copies every dataset and holds the labels of each against those above it.

    Parameters
    ----------
    dataset : Dataset
    path : str
    above : Groups or None
        ``None`` for the root.
    """

    def __init__(self, dataset: xr.Dataset, path: str = "/", above: Groups | None = None) -> None:
        self.dataset = dataset
        self.path = path
        self.above = above
        self.children: dict[str, Groups] = {}

    @classmethod
    def of(cls, datasets: Mapping[str, xr.Dataset]) -> Groups:
        """Return the root of groups by their path; ``"/"`` is that of the root."""
        import xarray as xr

        root = cls(datasets["/"])
        for path in datasets:
            node = root
            for name in filter(None, path.split("/")):
                if name not in node.children:
                    below = f"{node.path.rstrip('/')}/{name}"
                    node.children[name] = cls(datasets[below] if below in datasets else xr.Dataset(), below, node)
                node = node.children[name]
        return root

    def tree(self) -> xr.DataTree:
        """Return the tree."""
        import xarray as xr

        return xr.DataTree.from_dict({node.path: node.dataset for node in self.subtree})

    @property
    def subtree(self) -> Iterator[Groups]:
        """This group and all below it."""
        yield self
        for child in self.children.values():
            yield from child.subtree

    @property
    def attrs(self) -> dict[Any, Any]:
        """Attributes."""
        return self.dataset.attrs

    @property
    def data_vars(self) -> Mapping[Any, xr.DataArray]:
        """The variables of the group that are no coordinates."""
        return self.dataset.data_vars

    @cached_property
    def variables(self) -> Mapping[Hashable, xr.Variable]:
        """Variables and coordinates; labels come from the groups above where the group has none of its own."""
        labels = {} if self.above is None else {k: v for k, v in self.above.variables.items() if v.dims == (k,)}
        return {**labels, **self.dataset.variables}

    @cached_property
    def sizes(self) -> Mapping[Hashable, int]:
        """Lengths of all dimensions."""
        return {dim: size for one in self.variables.values() for dim, size in one.sizes.items()}

    def __bool__(self) -> bool:
        return bool(self.dataset.data_vars) or bool(self.children)


__all__ = ["Groups"]
