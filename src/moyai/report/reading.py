"""Read groups of a result: what was not run is blank, what was run and is absent is an error."""

from __future__ import annotations

import math
from collections.abc import Hashable, Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from moyai.core.arrays import Array
from moyai.core.errors import InputError
from moyai.core.kinds import vocabulary_of
from moyai.core.results import Result
from moyai.core.vocabulary import Vocabulary
from moyai.report.formatting import display_unit, largest_magnitude

if TYPE_CHECKING:
    import xarray as xr


class AbsentError(InputError):
    """A result lacks what its analysis always writes."""


def _absent(path: str, *names: str) -> AbsentError:
    words = ", ".join(f"'{name}'" for name in names)
    return AbsentError(
        f"group '{path.strip('/')}' of the result lacks {words}",
        path="result",
        remedy="it was written by another version of moyai, or changed since: run the case again",
    )


def root_of(result: Result) -> Group:
    """Return the root of a result, read through the vocabulary of its kind.

    Raises
    ------
    AbsentError
        When a group lacks what its analysis always writes.
    """
    own = vocabulary_of(result.held)
    for node in () if own is None else result.held.subtree:
        missing = () if own is None else own.absent(node.path, node)
        if missing:
            raise _absent(node.path, *missing)
    return Group("", result.held, own)


@dataclass(frozen=True)
class Group:
    """One group of a result.

    What depends on the options of a case may be absent and is blank then; :meth:`require` requires what is always
    there. A name that the vocabulary of the result does not declare is an error wherever it is asked for.
    """

    #: Last part of its path.
    name: str
    #: ``None`` where the group does not exist.
    node: xr.DataTree | None
    #: Names that the result may carry; ``None`` for a result of no known kind.
    vocabulary: Vocabulary | None = None

    @property
    def exists(self) -> bool:
        """Whether the group is there and holds anything."""
        return self.node is not None and bool(self.node)

    @property
    def attributes(self) -> dict[str, Any]:
        """Attributes of the group, empty where absent."""
        return {} if self.node is None else {str(key): value for key, value in self.node.attrs.items()}

    def number(self, name: str) -> float:
        """Return a number among the attributes, NaN where it is absent or no number."""
        try:
            return float(self.attributes[name])
        except (KeyError, TypeError, ValueError):
            return math.nan

    def child(self, path: str) -> Group:
        """Return a group below this one."""
        node: Any = self.node
        for part in path.split("/"):
            node = None if node is None or part not in node.children else node.children[part]
        return Group(path.rsplit("/", 1)[-1], node, self.vocabulary)

    @cached_property
    def _variables(self) -> Mapping[Hashable, xr.Variable]:
        """The variables and coordinates of the node, which xarray puts together anew whenever it is asked."""
        return {} if self.node is None else dict(self.node.variables)

    @cached_property
    def _declared(self) -> Vocabulary | None:
        """The vocabulary where names are held to it: columns of a file of the user's have names of the user's."""
        own = self.vocabulary
        return own if own is not None and (self.node is None or own.at(self.node.path) is not None) else None

    def children(self) -> tuple[Group, ...]:
        """Return the groups directly below."""
        return (
            ()
            if self.node is None
            else tuple(Group(name, node, self.vocabulary) for name, node in self.node.children.items())
        )

    def variable(self, name: str) -> xr.Variable | None:
        """Return a variable or coordinate, ``None`` where it is absent or not numeric.

        Raises
        ------
        VocabularyError
            When no result of this kind can have it, where names are held strictly (the tests).
        """
        if self._declared is not None:
            self._declared.require(name)
        # a variable as it stands: with its coordinates about it a report would take twice as long
        found = self._variables.get(name)
        if found is None:
            return None
        return found if np.issubdtype(found.dtype, np.number) or np.issubdtype(found.dtype, np.bool_) else None

    def selected(self, name: str, **choice: str) -> xr.Variable | None:
        """Return a variable at the labels of ``choice``; ``None`` where it is absent or lacks a dimension or label."""
        found = self.variable(name)
        for dim, label in choice.items():
            known = self._variables.get(dim)
            if found is None or known is None or dim not in found.dims:
                return None
            places = np.flatnonzero(known.values == label)
            found = found.isel({dim: int(places[0])}) if places.size else None
        return found

    def require(self, name: str, *dims: str, **choice: str) -> Array:
        """As :meth:`real`, for what the group holds whenever its analysis was run.

        Raises
        ------
        AbsentError
            When it is absent.
        """
        found = self.real(name, *dims, **choice)
        if found is None:
            raise _absent("" if self.node is None else self.node.path, name)
        return found

    def array(self, name: str, *dims: str, **choice: str) -> NDArray[Any] | None:
        """Return a variable with its dimensions in the order of ``dims``, after selecting the labels of ``choice``.

        ``None`` where the variable is absent, has other dimensions or lacks a label.
        """
        found = self.variable(name)
        if found is None or set(found.dims) != {*dims, *choice}:
            return None
        # By hand: with a variable made of every part a report would take twice as long
        at: dict[Hashable, int] = {}
        for dim, label in choice.items():
            known = self._variables.get(dim)
            places = np.flatnonzero(known.values == label) if known is not None else np.zeros(0, dtype=int)
            if not places.size:
                return None
            at[dim] = int(places[0])
        left = [dim for dim in found.dims if dim not in at]
        values = np.asarray(found.values)[tuple(at.get(dim, slice(None)) for dim in found.dims)]
        return np.asarray(values if left == list(dims) else values.transpose([left.index(dim) for dim in dims]))

    def real(self, name: str, *dims: str, **choice: str) -> Array | None:
        """As :meth:`array`, the modulus of complex values."""
        found = self.array(name, *dims, **choice)
        if found is None:
            return None
        return np.asarray(np.abs(found) if np.iscomplexobj(found) else found, dtype=float)

    def value(self, name: str, **choice: str) -> float:
        """Return a single number, NaN where it is not known."""
        found = self.real(name, **choice)
        return math.nan if found is None else float(found)

    def unit(self, name: str, otherwise: str = "") -> str:
        """Return the unit of a variable."""
        found = self.variable(name)
        return otherwise if found is None else str(found.attrs.get("units", otherwise))

    def long_name(self, name: str, otherwise: str = "") -> str:
        """Return the words of a variable."""
        found = self.variable(name)
        return (
            (otherwise or name.replace("_", " "))
            if found is None
            else str(found.attrs.get("long_name", otherwise or name.replace("_", " ")))
        )

    def labels(self, dim: str) -> tuple[str, ...]:
        """Return the labels along a dimension, their numbers where it has none."""
        if self.node is None or dim not in self.node.sizes:
            return ()
        known = self.node.variables.get(dim)
        if known is not None:
            return tuple(str(label) for label in known.values)
        return tuple(str(number + 1) for number in range(self.node.sizes[dim]))

    def dims(self, name: str) -> tuple[str, ...]:
        """Return the dimensions of a variable."""
        found = self.variable(name)
        return () if found is None else tuple(str(dim) for dim in found.dims)


@dataclass(frozen=True)
class Scaled:
    """Values in display units with the name of the unit."""

    values: Array
    unit: str


def scaled(values: Array, unit: str, like: float | None = None) -> Scaled:
    """Return values in their display unit; ``like`` [stored unit] makes several arrays share one.

    Parameters
    ----------
    values : ndarray
    unit : str
        Stored unit.
    like : float, optional
        Largest magnitude that chooses the unit.

    Returns
    -------
    Scaled
    """
    shown = display_unit(unit, values if like is None else like)
    return Scaled(np.asarray(values, dtype=float) * shown.factor, shown.name)


def common_scale(unit: str, *arrays: Array | None) -> tuple[float, str]:
    """Return factor and name of the display unit that suits all of ``arrays`` together."""
    largest = max((largest_magnitude(array) for array in arrays if array is not None), default=0.0)
    shown = display_unit(unit, largest)
    return shown.factor, shown.name


def walk(group: Group, path: str = "") -> Iterator[tuple[str, Group]]:
    """Yield every group below with its path."""
    for child in group.children():
        below = f"{path}/{child.name}"
        yield below, child
        yield from walk(child, below)
