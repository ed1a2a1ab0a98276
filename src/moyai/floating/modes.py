"""Natural periods, shapes and damping of a floating body, added mass at the natural frequency of each mode."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike, NDArray

from moyai.core.arrays import Array
from moyai.core.curves import Spline, crossing
from moyai.core.errors import InputError
from moyai.core.remembered import Remembered
from moyai.core.store import key_of
from moyai.core.validity import Notice
from moyai.floating.arrays import square_matrix
from moyai.floating.coefficients import Hydrodynamics

if TYPE_CHECKING:
    import xarray as xr

    from moyai.potential.solution import RadiationDiffraction

_KNOWN: Remembered[NaturalModes] = Remembered(16)


@dataclass(frozen=True)
class NaturalModes:
    """Undamped modes, sorted by the motion that leads each of them."""

    #: Name of the leading motion of each mode, in the order of the coefficients.
    modes: tuple[str, ...]
    #: Natural periods [s]; ``inf`` without restoring, NaN when restoring is negative (unstable); shape (m,).
    period: Array
    #: [rad/s]; 0 without restoring; shape (m,).
    omega: Array
    #: Row j is mode j, leading motion 1 (so sway per roll is in m/rad); shape (m, m).
    shape: Array
    #: Radiation and given damping over critical at the natural frequency; shape (m,).
    damping_ratio: Array
    notices: tuple[Notice, ...] = ()


def natural_modes(
    hydrodynamics: Hydrodynamics | RadiationDiffraction | xr.Dataset,
    inertia: ArrayLike,
    stiffness: ArrayLike,
    *,
    damping: ArrayLike | None = None,
) -> NaturalModes:
    """Find the undamped modes of ``(K - w^2 (M + A(w))) phi = 0`` [eq:floating-natural].

    Parameters
    ----------
    hydrodynamics : Hydrodynamics, RadiationDiffraction or xarray.Dataset
        Coefficients of the whole unit; a solution or its dataset is taken per metre. Below and above the computed
        frequencies the end values are held, above with the infinite-frequency added mass when it is known; a notice
        says when a mode lies there.
    inertia, stiffness : array_like (m, m)
        M and K_H + K_M, in kg, m and s per radian; the free body has K_M = 0.
    damping : array_like (m, m) or None
        Linear damping beyond radiation, for the damping ratios.

    Returns
    -------
    NaturalModes
        Periods [s], frequencies [rad/s], shapes and damping ratios [-], one row a mode, and notices.

    Raises
    ------
    InputError
        When a matrix has another shape or is not finite, or the inertia has no positive diagonal.

    Notes
    -----
    A mode is a frequency at which the symmetric matrix K - w^2 (M + A(w)) is singular. Its sorted eigenvalues (modes
    scaled by their inertia) start as those of K and fall, one through zero at each natural frequency; the first
    crossing of each is bracketed on the grid of the coefficients and found by interpolation. So modes do not change
    places, and the added mass may even be negative, as it is near a gap resonance.

    Examples
    --------
    >>> import numpy as np
    >>> from moyai.floating import Hydrodynamics, natural_modes
    >>> omega = np.linspace(0.5, 2.0, 4)
    >>> one = np.ones((4, 1, 1))
    >>> heave = Hydrodynamics(omega, 1e5 * one, 5e3 * one, one.astype(complex), np.zeros(1), ("heave",))
    >>> found = natural_modes(heave, [[2e5]], [[4e5]])
    >>> found.modes, round(float(found.period[0]), 3)                    # 2 pi sqrt(3e5 / 4e5) [s]
    (('heave',), 5.441)
    """
    hydro = Hydrodynamics.of(hydrodynamics)
    size = hydro.size
    inertia = square_matrix(inertia, size, "inertia")
    stiffness = square_matrix(stiffness, size, "stiffness")
    if np.any(np.diag(inertia) <= 0.0):
        raise InputError("a mode has no inertia", parameter="inertia", allowed="a positive diagonal")
    extra = np.zeros((size, size)) if damping is None else square_matrix(damping, size, "damping")
    known = (hydro.modes, hydro.omega, hydro.added_mass, hydro.radiation_damping, hydro.infinite_frequency_added_mass)
    return _KNOWN.of(
        key_of(*known, inertia, stiffness, extra), lambda: _natural_modes(hydro, inertia, stiffness, extra)
    )


def _natural_modes(hydrodynamics: Hydrodynamics, inertia: Array, stiffness: Array, extra: Array) -> NaturalModes:
    size, restoring = hydrodynamics.size, 0.5 * (stiffness + stiffness.T)
    added = added_mass_function(hydrodynamics)

    scale = 1.0 / np.sqrt(np.diag(inertia))

    def spectrum(omega: float) -> tuple[Array, Array]:
        matrix = added(omega)
        dynamic = restoring - omega**2 * (inertia + 0.5 * (matrix + matrix.T))
        values, columns = np.linalg.eigh(dynamic * scale[:, None] * scale[None, :])
        return values, columns

    omega, vectors, outside = np.zeros(size), np.zeros((size, size)), []
    known = 0.5 * (hydrodynamics.added_mass + np.swapaxes(hydrodynamics.added_mass, -1, -2))
    dynamic = restoring - hydrodynamics.omega[:, None, None] ** 2 * (inertia + known)
    table = np.asarray(np.linalg.eigvalsh(dynamic * scale[:, None] * scale[None, :]), dtype=np.float64)
    for number in range(size):
        root = _mode_frequency(spectrum, number, hydrodynamics, table[:, number])
        omega[number] = root
        vectors[number] = scale * spectrum(root if np.isfinite(root) else 0.0)[1][:, number]
        if np.isfinite(root) and root > 0.0 and not hydrodynamics.omega[0] <= root <= hydrodynamics.omega[-1]:
            outside.append(root)
    order, shapes = _lead(vectors, inertia)
    omega = omega[order]
    radiation = damping_function(hydrodynamics)
    ratio = np.zeros(size)
    for number in range(size):
        if np.isfinite(omega[number]) and omega[number] > 0.0:
            phi = shapes[number]
            mass = phi @ (inertia + added(omega[number])) @ phi
            ratio[number] = phi @ (radiation(omega[number]) + extra) @ phi / (2.0 * omega[number] * mass)
    with np.errstate(divide="ignore"):
        period = np.where(omega > 0.0, 2.0 * np.pi / np.where(omega > 0.0, omega, 1.0), np.inf)
    period = np.where(np.isnan(omega), np.nan, period)
    notices = tuple(
        Notice(
            code="natural-frequency-outside",
            message=f"a natural frequency, {root:.4g} rad/s, lies outside the computed coefficients",
            value=float(root),
            limit=float(hydrodynamics.omega[0] if root < hydrodynamics.omega[0] else hydrodynamics.omega[-1]),
            severity="information",
            remedy="compute coefficients there",
        )
        for root in outside
    )
    return NaturalModes(hydrodynamics.modes, period, omega, shapes, ratio, notices)


def _held(hydrodynamics: Hydrodynamics, values: Array, above: Array | None) -> Callable[[float | Array], Array]:
    """Return ``values`` as a function of frequency, ends held; ``above`` approached like 1/omega^2 beyond the last."""
    low, high = float(hydrodynamics.omega[0]), float(hydrodynamics.omega[-1])
    several = len(hydrodynamics.omega) > 1
    spline = Spline(hydrodynamics.omega, values) if several else None

    def function(omega: float | Array) -> Array:
        inside = np.minimum(np.maximum(omega, low), high)
        value = np.broadcast_to(values[0], (*inside.shape, *values[0].shape)) if spline is None else spline(inside)
        if above is None:
            return value
        share = np.minimum(high / np.maximum(omega, high), 1.0) ** 2
        return np.asarray(above + (value - above) * np.asarray(share)[..., None, None], dtype=float)

    return function


def added_mass_function(hydrodynamics: Hydrodynamics) -> Callable[[float | Array], Array]:
    """Return A(omega) as a function, ends held (above: towards the infinite-frequency value where known)."""
    return _held(hydrodynamics, hydrodynamics.added_mass, hydrodynamics.infinite_frequency_added_mass)


def damping_function(hydrodynamics: Hydrodynamics) -> Callable[[float | Array], Array]:
    """Return B(omega) as a function, ends held (above: towards zero)."""
    return _held(hydrodynamics, hydrodynamics.radiation_damping, np.zeros((hydrodynamics.size,) * 2))


def _mode_frequency(
    spectrum: Callable[[float], tuple[Array, Array]], number: int, hydrodynamics: Hydrodynamics, table: Array
) -> float:
    """Return where eigenvalue ``number`` passes zero: 0 without restoring, NaN with negative restoring.

    ``table`` holds that eigenvalue at the frequencies of the coefficients.
    """
    values = spectrum(0.0)[0]
    largest = float(np.max(np.abs(values)))
    if largest == 0.0 or abs(values[number]) <= 1e-12 * largest:
        return 0.0
    if values[number] < 0.0:
        return float("nan")

    def eigenvalue(omega: float) -> float:
        return float(spectrum(omega)[0][number])

    top = 2.0 * max(float(np.sqrt(largest)), float(hydrodynamics.omega[-1]))
    for _ in range(60):
        if eigenvalue(top) < 0.0:
            break
        top *= 2.0
    inside = hydrodynamics.omega < top
    grid = np.append(hydrodynamics.omega[inside], top)
    crossed = np.flatnonzero(np.append(table[inside], eigenvalue(top)) <= 0.0)
    if not len(crossed):
        return float("nan")
    below, above = float(grid[crossed[0] - 1]) if crossed[0] else 0.0, float(grid[crossed[0]])
    if eigenvalue(below) * eigenvalue(above) >= 0.0:
        return above if abs(eigenvalue(above)) < abs(eigenvalue(below)) else below  # one of them is it, to rounding
    return crossing(eigenvalue, below, above, tolerance=1e-13 * top)


def _lead(vectors: Array, inertia: Array) -> tuple[NDArray[np.intp], Array]:
    """Give every mode the motion that carries most of its kinetic energy, each motion once; scale it to 1 there."""
    share = vectors**2 * np.diag(inertia)
    share = share / np.sum(share, axis=1, keepdims=True)
    column = np.argmax(share, axis=1)
    if len(set(column.tolist())) < len(column):
        from scipy.optimize import linear_sum_assignment  # slow to load, and seldom asked for

        column = linear_sum_assignment(-share)[1]
    order = np.argsort(column)
    shapes = vectors[order]
    return order, shapes / np.diagonal(shapes)[:, None]
