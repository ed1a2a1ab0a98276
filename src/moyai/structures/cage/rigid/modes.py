"""Natural periods of a moored rigid cage at rest."""

from __future__ import annotations

import math

import numpy as np

from moyai.core.arrays import Array
from moyai.structures.cage.rigid import load_kernel
from moyai.structures.cage.rigid.statics import RigidCageEquilibrium
from moyai.structures.cage.rigid.water_kernel import PackedCage


def mass_matrix(packed: PackedCage, place: Array) -> Array:
    """Return mass with added mass at a place in still water, 3 x 3 [kg], [kg m], [kg m2] [eq:cage-added-mass]."""
    force, mass, work = np.empty(3), np.empty((3, 3)), np.empty(6)
    taut = np.full(len(packed.lines), -1.0)
    load_kernel.loads(packed, 0.0, np.concatenate([place, np.zeros(3)]), taut, force, mass, work)
    return mass


def natural_modes(packed: PackedCage, rest: RigidCageEquilibrium, size: float) -> tuple[Array, Array]:
    """Return natural periods [s] and shapes (sway, heave over ``size``, rotation), longest first [eq:cage-modes].

    A direction without restoring force has an infinite period.
    """
    units = np.array([1.0, 1.0, size])
    mass = mass_matrix(packed, rest.place) / np.outer(units, units)
    stiffness = rest.stiffness / np.outer(units, units)
    stiffness = 0.5 * (stiffness + stiffness.T)
    factor = np.linalg.cholesky(mass)
    inverse = np.linalg.inv(factor)
    squares, vectors = np.linalg.eigh(inverse @ stiffness @ inverse.T)
    floor = 1e-7 * float(packed.water[1]) / size
    periods = np.array([2.0 * math.pi / math.sqrt(value) if value > floor else math.inf for value in squares])
    shapes = (inverse.T @ vectors).T
    shapes /= np.abs(shapes).max(axis=1)[:, None]
    return periods, shapes
