"""The law of a polyester rope that depends on its highest mean tension (Syrope) [eq:flexible-worn]."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal

import numpy as np

from moyai.core.arrays import Array
from moyai.core.errors import InputError
from moyai.core.options import checks_words

#: Pieces of a working curve.
PIECES = 50
#: Tension at the strain that is left without tension, over the highest one: rope curves rise everywhere.
TRACE = 1e-6
Form = Literal["linear", "quadratic", "exponential"]


@checks_words
@dataclass(frozen=True, eq=False)
class WornRope:
    """Curves at rest, quick stiffness and slow dashpot of such a rope.

    Raises
    ------
    InputError
        For parameters out of their range, a highest tension beyond the curve, and a rope that is stiffer at rest than
        to quick changes.
    """

    #: Strain [-] and tension [N] of the new rope, both rising from 0.
    new_strain: Array
    new_tension: Array
    #: Shape of the working curve.
    form: Form
    #: Strain left without tension over the strain at the highest tension [-]; above 1 the stiffness of a linear
    #: working curve [N].
    k1: float
    #: 1 for the parabola, the exponent of the exponential; without meaning for a line [-].
    k2: float
    #: Stiffness of quick changes without tension [N], and what it grows with per mean tension [-].
    stiffness: float
    growth: float
    #: Of the dashpot parallel to the slow spring [N s].
    viscosity: float
    #: Highest mean tension so far [N]; 0 for a new rope.
    highest: float = 0.0

    def __post_init__(self) -> None:
        end = float(self.new_tension[-1])
        if not 0.0 <= self.highest <= end:
            raise InputError(
                f"a highest mean tension of {self.highest:g} N",
                parameter="highest",
                allowed=f"0 to {end:g} N, the curve",
            )
        if self.form == "quadratic" and self.k2 != 1.0:
            raise InputError(f"{self.form} with k2 = {self.k2:g}", parameter="k2", allowed="1: the parabola")
        tops = np.array([self.highest or 0.5 * end, end])
        left, top = self._ends(tops)
        ok = np.all(left >= 0.0) and np.all(left < top) and (self.form == "linear" or self.k1 < 1.0)
        if not ok or (self.form == "exponential" and not 1e-6 <= self.k2 <= 700.0):
            words = f"{self.form} with k1 = {self.k1:g} and k2 = {self.k2:g}"
            raise InputError(words, parameter="k1", allowed="0 to 1 of the strain")
        for name in ("stiffness", "viscosity"):
            if not (math.isfinite(value := getattr(self, name)) and value > 0.0):
                raise InputError(f"{name} of a worn rope is {value:g}", parameter=name, allowed="greater than 0")
        if not (math.isfinite(self.growth) and self.growth >= 0.0):
            raise InputError(f"growth is {self.growth:g}", parameter="growth", allowed="0 or more")

    @property
    def least(self) -> float:
        """Mean tension below which nothing is distinguished [N]."""
        return TRACE * float(self.new_tension[-1])

    def quick(self, mean: Array) -> Array:
        """Return the stiffness of quick changes about mean tensions, tension over strain (...) [N].

        Parameters
        ----------
        mean : ndarray (...)
            Mean tensions [N].
        """
        return np.asarray(self.stiffness + self.growth * mean)

    def _ends(self, highest: Array) -> tuple[Array, Array]:
        """Return the strains of the working curve without tension and at the highest one."""
        top = np.interp(highest, self.new_tension, self.new_strain)
        absolute = self.form == "linear" and self.k1 >= 1.0
        return np.asarray(top - highest / self.k1 if absolute else self.k1 * top), top

    def strain(self, mean: Array, highest: Array) -> Array:
        """Return the strain [-] at rest under mean tensions of ropes that have carried the highest ones.

        Parameters
        ----------
        mean : ndarray (...)
            Mean tensions [N].
        highest : ndarray (...)
            Highest mean tensions so far [N].
        """
        left, top = self._ends(highest)
        part = np.clip(mean / np.maximum(highest, 1e-300), 0.0, 1.0)
        if self.form == "quadratic":
            part = np.sqrt(part)
        elif self.form == "exponential":
            part = np.log1p(part * math.expm1(self.k2)) / self.k2
        return np.where(mean < highest, left + (top - left) * part, np.interp(mean, self.new_tension, self.new_strain))

    def energy(self, mean: Array, highest: Array) -> Array:
        """Return the area under the working curve up to mean tensions [N].

        Parameters
        ----------
        mean : ndarray (...)
            Mean tensions [N].
        highest : ndarray (...)
            Highest mean tensions so far [N].
        """
        left, top = self._ends(highest)
        part = (self.strain(mean, highest) - left) / np.maximum(top - left, 1e-300)
        if self.form == "linear":
            area = 0.5 * part**2
        elif self.form == "quadratic":
            area = part**3 / 3.0
        else:
            area = (np.expm1(self.k2 * part) / self.k2 - part) / math.expm1(self.k2)
        return np.asarray((top - left) * highest * area)

    def curve_at_rest(self) -> tuple[Array, Array]:
        """Return strain [-] and tension [N] at rest: the working curve, beyond the highest tension the new one."""
        if self.highest == 0.0:
            return self.new_strain, self.new_tension
        left, top = (float(value) for value in self._ends(np.asarray(self.highest)))
        part = np.linspace(0.0, 1.0, PIECES + 1)
        shape = {
            "linear": lambda x: x, "quadratic": lambda x: x**2,
            "exponential": lambda x: np.expm1(self.k2 * x) / math.expm1(self.k2),
        }[self.form](part)  # fmt: skip
        beyond = self.new_tension > self.highest
        start = [0.0] if left > 0.0 else []
        strain = np.concatenate([start, left + (top - left) * part, self.new_strain[beyond]])
        pull = np.concatenate([start, self.highest * np.maximum(shape, TRACE), self.new_tension[beyond]])
        if left == 0.0:
            pull[0] = 0.0
        return strain, pull
