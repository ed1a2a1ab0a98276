"""Diagonally implicit Runge-Kutta methods: coefficients as frozen records that check their own mathematics."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from moyai.core.arrays import Array


@dataclass(frozen=True, eq=False)
class Tableau:
    """An implicit method whose first stage is explicit and whose last stage is the step, with one diagonal value."""

    #: As the user calls it.
    name: str
    #: Order of the step.
    order: int
    #: Order of the solution that estimates its error.
    embedded_order: int
    #: Lower triangular; the last row is the step; shape (s, s).
    stages: Array
    #: Weights of the embedded solution; shape (s,).
    embedded: Array
    #: Where the coefficients stand.
    source: str

    def __post_init__(self) -> None:
        for name in ("stages", "embedded"):
            array = np.array(getattr(self, name), dtype=np.float64)
            array.setflags(write=False)
            object.__setattr__(self, name, array)
        diagonal = np.diag(self.stages)
        assert diagonal[0] == 0.0 and np.allclose(diagonal[1:], diagonal[1], atol=1e-15)
        for weights, order in ((self.stages[-1], self.order), (self.embedded, self.embedded_order)):
            assert order_residual(self.stages, weights, order) < 1e-12, self.name

    @property
    def times(self) -> Array:
        """Stage times as parts of the step."""
        return np.asarray(self.stages.sum(axis=1))


def order_residual(stages: Array, weights: Array, order: int) -> float:
    """Return the largest violation of the order conditions up to ``order`` (at most 4) [eq:flexible-order]."""
    c = stages.sum(axis=1)
    conditions = [weights.sum() - 1.0]
    if order >= 2:
        conditions.append(weights @ c - 1.0 / 2.0)
    if order >= 3:
        conditions += [weights @ c**2 - 1.0 / 3.0, weights @ stages @ c - 1.0 / 6.0]
    if order >= 4:
        conditions += [
            weights @ c**3 - 1.0 / 4.0,
            (weights * c) @ stages @ c - 1.0 / 8.0,
            weights @ stages @ c**2 - 1.0 / 12.0,
            weights @ stages @ stages @ c - 1.0 / 24.0,
        ]
    return float(np.max(np.abs(conditions)))


def _tr_bdf2() -> Tableau:
    w, d = math.sqrt(2.0) / 4.0, 1.0 - math.sqrt(2.0) / 2.0
    return Tableau(
        "tr_bdf2", 2, 3, np.array([[0.0, 0.0, 0.0], [d, d, 0.0], [w, w, d]]),
        np.array([(1.0 - w) / 3.0, (3.0 * w + 1.0) / 3.0, d / 3.0]),
        "Hosea and Shampine 1996, Appl. Numer. Math. 20",
    )  # fmt: skip


def _esdirk4() -> Tableau:
    a = np.zeros((6, 6))
    a[1, :2] = 1 / 4, 1 / 4
    a[2, :3] = 8611 / 62500, -1743 / 31250, 1 / 4
    a[3, :4] = 5012029 / 34652500, -654441 / 2922500, 174375 / 388108, 1 / 4
    a[4, :5] = 15267082809 / 155376265600, -71443401 / 120774400, 730878875 / 902184768, 2285395 / 8070912, 1 / 4
    a[5] = 82889 / 524892, 0.0, 15625 / 83664, 69875 / 102672, -2260 / 8211, 1 / 4
    b = [
        4586570599 / 29645900160,
        0.0,
        178811875 / 945068544,
        814220225 / 1159782912,
        -3700637 / 11593932,
        61727 / 225920,
    ]
    return Tableau(
        "esdirk4",
        4,
        3,
        a,
        np.array(b),
        "Kennedy and Carpenter 2003, Appl. Numer. Math. 44: implicit part of ARK4(3)6L[2]SA",
    )


#: The methods by name.
TABLEAUS: dict[str, Tableau] = {tableau.name: tableau for tableau in (_tr_bdf2(), _esdirk4())}
