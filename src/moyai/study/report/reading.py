"""What the report of a study reads from its result."""

from __future__ import annotations

import json
import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from moyai.core.arrays import Array
from moyai.core.results import Result
from moyai.study.responses import in_stated_unit, selected, split_response


@dataclass(frozen=True)
class AxisLabels:
    """An axis of the study."""

    name: str
    #: Of its points, as the study file names them.
    labels: tuple[str, ...]
    #: Numbers of its points in ``unit``, ``None`` where they are no numbers.
    values: Array | None
    unit: str

    @property
    def sign(self) -> str:
        """Sign of the unit that the name of a key has in it, degrees; else empty."""
        return "°" if self.name.endswith("_deg") else ""

    @property
    def words(self) -> str:
        """The name as words."""
        return self.name.removesuffix("_deg").replace("_", " ")

    @property
    def head(self) -> str:
        """The name as words, with its unit where the points do not have it."""
        return f"{self.words} [{self.sign}]" if self.sign else self.words


@dataclass(frozen=True)
class GoverningCase:
    """The case that governs a component."""

    component: str
    #: Number of the case.
    index: int
    #: Utilisation, or the watched response.
    value: float
    #: Where its own report lies, relative to that of the study; empty where there is none.
    folder: str


@dataclass(frozen=True)
class StudyPages:
    """A study's result, made ready for tables and figures."""

    result: Result
    axes: tuple[AxisLabels, ...]
    #: Status of every case, flat.
    status: NDArray[Any]
    #: Message of every case, flat.
    message: NDArray[Any]
    governing: tuple[GoverningCase, ...]
    watch: str

    @property
    def shape(self) -> tuple[int, ...]:
        """Points on every axis."""
        return tuple(len(axis.labels) for axis in self.axes)

    def labels(self, index: int) -> tuple[str, ...]:
        """Return the place of a case on every axis."""
        place = np.unravel_index(index, self.shape)
        return tuple(axis.labels[at] for axis, at in zip(self.axes, place))

    def case_words(self, index: int) -> str:
        """Return the place of a case in words."""
        return ", ".join(f"{axis.words} {label}{axis.sign}" for axis, label in zip(self.axes, self.labels(index)))

    def response(self, name: str) -> tuple[Array, str, str] | None:
        """Return a response by case (the largest entry of an array), its unit, and its words with its group.

        The name may hold labels, ``LWL/frequency/storm/significant_motion[dof=roll]``.
        """
        group, variable, labels = split_response(name)
        try:
            node: Any = self.result.tree[f"/{group}"]
            found = node[variable] if variable in node.data_vars else None
        except KeyError:
            found = None
        if found is None:
            return None
        found = in_stated_unit(selected(found, labels, name))
        dims = [axis.name for axis in self.axes]
        if not set(dims) <= set(found.dims):
            return None
        values = np.asarray(found.transpose(*dims, ...).values, dtype=float).reshape(len(self.status), -1)
        known = np.isfinite(values).any(axis=1)
        largest = np.where(known, np.where(np.isfinite(values), values, -math.inf).max(axis=1), math.nan)
        words = str(found.attrs.get("long_name", variable))
        at = [label for _, label in labels]
        place = ", ".join([*at, *(part for part in group.split("/") if part)])
        return largest, str(found.attrs.get("units", "1")), f"{words} ({place})" if place else words


def read_study(result: Result) -> StudyPages:
    """Return the pages' view of a study's result."""
    attributes = result.tree.attrs
    axes = []
    for item in json.loads(attributes.get("axes", "[]")):
        values = np.array(item["values"], dtype=float) if item["values"] is not None else None
        axes.append(AxisLabels(item["name"], tuple(item["labels"]), values, item["unit"]))
    root: Any = result.tree.to_dataset(inherit=False)
    count = math.prod(len(axis.labels) for axis in axes)
    status = root["case_status"].values.reshape(count)
    message = root["case_message"].values.reshape(count)
    governing = tuple(GoverningCase(*item) for item in json.loads(attributes.get("governing", "[]")))
    return StudyPages(result, tuple(axes), status, message, governing, str(attributes.get("watch", "")))
