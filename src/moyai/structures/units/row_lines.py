"""All lines of a row at once: force, stiffness and tensions at a position, lines that are alike in one call."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np

from moyai.core.arrays import Array, IntArray
from moyai.mooring.lines import Line, LineElement, LineState
from moyai.mooring.rotations import cross_matrix, rotation_from_vector


@dataclass(frozen=True)
class LinesAt:
    """What the lines of a row do at a position."""

    #: On the units [N], [N m]; shape (m,).
    force: Array
    #: Tangent of the same (m, m).
    stiffness: Array
    #: At the fairleads (lines,) [N], of one copy.
    tension: Array
    #: Derivative of the tensions (lines, m) by the motions [N/m], [N].
    tension_gradient: Array


@dataclass(frozen=True, eq=False)
class RowLines:
    """Lines of all units."""

    #: Of every unit, counted from its centre of gravity.
    lines: tuple[tuple[LineElement, ...], ...]
    #: Below the centres of gravity [m].
    water_depth: float
    _last: dict[bytes, LinesAt] = field(default_factory=dict, repr=False)

    @cached_property
    def unit(self) -> IntArray:
        """Which unit every line holds, counted from 0."""
        return np.repeat(np.arange(len(self.lines)), [len(each) for each in self.lines])

    @cached_property
    def _places(self) -> tuple[Array, Array, Array]:
        """Fairleads and anchors (lines, 3) [m] and copies (lines,)."""
        every = [line for each in self.lines for line in each]
        fairlead = np.array([line.fairlead for line in every], dtype=float).reshape(-1, 3)
        anchor = np.array([line.anchor for line in every], dtype=float).reshape(-1, 3)
        return fairlead, anchor, np.array([line.count for line in every], dtype=float)

    @cached_property
    def _groups(self) -> tuple[tuple[LineElement, IntArray], ...]:
        """One line of each kind, its anchor at the middle, and which lines are of its kind."""
        kinds: dict[object, tuple[LineElement, list[int]]] = {}
        for number, line in enumerate(line for each in self.lines for line in each):
            level = line.anchor[2]
            if isinstance(line, Line):
                # places count by the distance alone
                of_kind = replace(line, anchor=(0.0, 0.0, level), fairlead=(0.0, 0.0, 0.0))
                kinds.setdefault(replace(of_kind, name=""), (of_kind, []))[1].append(number)
            else:
                kinds[number] = line, [number]
        return tuple((line, np.array(which)) for line, which in kinds.values())

    def at(self, position: Array) -> LinesAt:
        """Return what the lines do at a position (m,) from rest; the last one is kept."""
        key = position.tobytes()
        if key not in self._last:
            found = self._solved(position.reshape(-1, 6))
            self._last.clear()
            self._last[key] = found
        return self._last[key]

    def tensions_of(self, positions: Array) -> Array:
        """Return the tensions (..., lines) [N] of lines at rest, each with its unit at a position (..., lines, 6).

        Infinite where an inextensible line cannot reach.
        """
        out = np.zeros(positions.shape[:-1])
        for _, which, state in self._states(positions):
            out[..., which] = state.tension_fairlead.reshape(out[..., which].shape)
        return out

    def anchor_loads_of(self, positions: Array) -> Array:
        """Return horizontal pull and uplift at the anchors [N] and length on the bed [m] (3, ..., lines) at rest.

        Each line with its unit at a position (..., lines, 6); springs have no anchor: NaN.
        """
        out = np.full((3, *positions.shape[:-1]), np.nan)
        for line, which, state in self._states(positions):
            if isinstance(line, Line):
                loads = state.horizontal_tension, state.vertical_tension_anchor, state.grounded_length
                for row, load in zip(out, loads, strict=True):
                    row[..., which] = load.reshape(row[..., which].shape)
        return np.asarray(np.maximum(out, 0.0))

    def _states(self, positions: Array) -> Iterator[tuple[LineElement, IntArray, LineState]]:
        """Yield every kind of line, which lines are of it, and their states at positions (..., lines, 6)."""
        fairlead, anchor, _ = self._places
        points = positions[..., :3] + np.einsum("...ij,...j->...i", rotation_from_vector(positions[..., 3:]), fairlead)
        for line, which in self._groups:
            there = points[..., which, :] - anchor[which] + np.asarray(line.anchor)
            with np.errstate(invalid="ignore"):
                yield line, which, line.solve(there.reshape(-1, 3), self.water_depth)

    def spans(self, position: Array) -> tuple[Array, Array]:
        """Return how far every fairlead is from its anchor [m] at a position (m,), and that by the motions of its unit.

        Shapes are (lines,) and (lines, 6).
        """
        fairlead, anchor, _ = self._places
        place = position.reshape(-1, 6)[self.unit]
        arm = np.einsum("lij,lj->li", rotation_from_vector(place[:, 3:]), fairlead)
        span = place[:, :3] + arm - anchor
        length = np.linalg.norm(span, axis=1)
        away = span / np.maximum(length, 1e-300)[:, None]
        return length, np.concatenate([away, np.cross(arm, away)], axis=1)

    def _solved(self, position: Array) -> LinesAt:
        unit, size = self.unit, position.size
        fairlead, anchor, copies = self._places
        force, stiffness, tension = np.zeros((len(unit), 3)), np.zeros((len(unit), 3, 3)), np.zeros(len(unit))
        arm = np.einsum("lij,lj->li", rotation_from_vector(position[:, 3:])[unit], fairlead)
        points = position[unit, :3] + arm
        for line, which in self._groups:
            there = points[which] - anchor[which] + np.asarray(line.anchor)
            # where an inextensible line cannot reach, its force is infinite: a search turns back there
            with np.errstate(invalid="ignore"):
                state = line.solve(there, self.water_depth)
            force[which], stiffness[which], tension[which] = state.force, state.stiffness, state.tension_fairlead
        lever = cross_matrix(arm)
        # how a fairlead moves with its unit: turning it takes the arm along
        moved = np.concatenate([np.broadcast_to(np.eye(3), lever.shape), -lever], axis=2)
        own = moved.swapaxes(1, 2) @ stiffness @ moved
        # F x (d theta x r): the moment of the turning lever
        own[:, 3:, 3:] -= cross_matrix(force) @ lever
        span = points - anchor
        away = span / np.maximum(np.linalg.norm(span, axis=1), 1e-300)[:, None]
        pulled = tension != 0.0
        away[pulled] = -force[pulled] / (copies * tension)[pulled, None]
        rate = np.einsum("li,lij,ljk->lk", away, stiffness, moved) / copies[:, None]
        on_units, tangent = np.zeros((len(position), 6)), np.zeros((len(position), 6, 6))
        gradient = np.zeros((len(unit), len(position), 6))
        np.add.at(on_units, unit, np.einsum("lji,lj->li", moved, force))
        np.add.at(tangent, unit, own)
        gradient[np.arange(len(unit)), unit] = rate
        whole = np.zeros((len(position), 6, len(position), 6))
        whole[np.arange(len(position)), :, np.arange(len(position))] = tangent
        return LinesAt(on_units.ravel(), whole.reshape(size, size), tension, gradient.reshape(len(unit), size))


__all__ = ["LinesAt", "RowLines"]
