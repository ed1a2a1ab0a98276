"""Eddies at the edges of units: the quadratic drag of the section on strips along every unit [eq:units-eddies].

The measures of velocity are those of a section [eq:viscous-edge], taken where heave, sway, roll, pitch and yaw carry
each strip, against the undisturbed wave there. Ends of units and surge shed nothing here.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache, lru_cache

import numpy as np

from moyai.core.arrays import Array, ComplexArray
from moyai.core.validity import Notice
from moyai.floating.damping import QuadraticDamping
from moyai.floating.viscous import measures
from moyai.floating.viscous_section import section_edges
from moyai.sea.dispersion import wave_number
from moyai.structures.units.assembly import RowAtLevel

#: Strips of a unit, at Gauss's points: |v| v of yaw and pitch within 4 %.
STRIPS = 3


@dataclass(frozen=True, eq=False)
class Eddies:
    """Quadratic drag of all edges on all strips of a row."""

    #: Rows (k, m) in all motions of all units, row axes.
    drag: QuadraticDamping
    #: Where a measure takes the velocity [m], row axes; z from still water; shape (k, p, 3).
    points: Array
    #: Its weighted directions there; shape (k, p, 3).
    directions: Array

    def water_motion(self, omega: Array, heading: Array, depth: float, gravity: float) -> ComplexArray:
        """Return the undisturbed wave in the measures (..., k) per metre of amplitude [eq:viscous-water].

        ``omega`` [rad/s] and ``heading`` [rad] broadcast; phases are those of a wave at the origin of the row.
        """
        w, beta = np.broadcast_arrays(np.asarray(omega, dtype=float), np.asarray(heading, dtype=float))
        number = np.asarray(wave_number(w, depth, gravity), dtype=float)
        out = np.zeros((*w.shape, len(self.points)), dtype=complex)
        for part in range(self.points.shape[1]):
            x, y, z = np.moveaxis(self.points[:, part], -1, 0)
            towards = np.moveaxis(self.directions[:, part], -1, 0)
            k, along = number[..., None], np.cos(beta)[..., None]
            across = np.sin(beta)[..., None]
            down, mirrored = np.exp(k * z), np.exp(-k * (z + 2.0 * depth))
            wave = w[..., None] * np.exp(1j * k * (x * along + y * across)) / (1.0 - np.exp(-2.0 * k * depth))
            level = wave * (down + mirrored) * (along * towards[0] + across * towards[1])
            out += level - 1j * wave * (down - mirrored) * towards[2]
        return out


@lru_cache(maxsize=8)
def eddies_of(at: RowAtLevel) -> Eddies | None:
    """Return the edges of a row that shed eddies; ``None`` where they are not computed or there are none."""
    factor = at.row.viscous_factor
    edges = section_edges(at.section) if factor else None
    found = measures(edges.corners, edges.plates) if edges is not None else ()
    if not found:
        return None
    most = max(len(item.weights) for item in found)
    nodes, weights = _gauss()
    rows, coefficients = [], []
    points, directions = [], []
    for unit, place in enumerate(at.row.placements):
        for node, weight in zip(nodes, weights, strict=True):
            for item in found:
                spot = np.zeros((most, 3))
                towards = np.zeros((most, 3))
                count = len(item.weights)
                spot[:count] = [[x, 0.5 * at.row.length * node, z] for x, z in item.points]
                towards[:count, 0] = item.weights * item.directions[:, 0]
                towards[:count, 2] = item.weights * item.directions[:, 1]
                spot, towards = place.to_row(spot), towards @ place.rotation.T
                row = np.zeros(at.size)
                row[6 * unit : 6 * unit + 3] = towards.sum(axis=0)
                row[6 * unit + 3 : 6 * unit + 6] = np.cross(spot - at.centres[unit], towards).sum(axis=0)
                rows.append(row)
                points.append(spot)
                directions.append(towards)
                coefficients.append(factor * at.water.density * item.coefficient * 0.5 * weight * at.row.length)
    drag = QuadraticDamping(np.array(rows), np.array(coefficients))
    return Eddies(drag, np.array(points), np.array(directions))


@dataclass(frozen=True, eq=False)
class LinearEddies:
    """The drag of eddies linearised for one sea."""

    eddies: Eddies
    #: Amplitude (regular waves) or standard deviation (a sea) of each measure [m/s, with weights]; shape (k,).
    size: Array
    regular: bool

    @property
    def damping(self) -> Array:
        """Equivalent damping (m, m)."""
        drag = self.eddies.drag
        return drag.equivalent_regular(self.size) if self.regular else drag.equivalent_irregular(self.size)

    def carried(self, water: ComplexArray) -> ComplexArray:
        """Return the force (n, h, m) of water that moves by (n, h, k) in the measures, per metre of wave amplitude."""
        drag = self.eddies.drag
        return drag.carried_regular(self.size, water) if self.regular else drag.carried_irregular(self.size, water)

    def measured(self, omega: Array, water: ComplexArray, motion: ComplexArray) -> ComplexArray:
        """Return the measures (n, h, k) of the velocity against the water, motions (n, h, m) of unit amplitude."""
        return np.asarray((-1j * omega[:, None, None] * motion) @ self.eddies.drag.directions.T - water)


@cache
def _gauss() -> tuple[Array, Array]:
    nodes, weights = np.polynomial.legendre.leggauss(STRIPS)
    return np.asarray(nodes, dtype=float), np.asarray(weights, dtype=float)


def eddy_notices(at: RowAtLevel) -> tuple[Notice, ...]:
    """Say what no law of the edges covers; nothing where they are not computed."""
    return section_edges(at.section).notices if at.row.viscous_factor else ()


__all__ = ["STRIPS", "Eddies", "LinearEddies", "eddies_of", "eddy_notices"]
