"""Closed forms of Sawaragi, Aoki and Liu (1991): cable of constant tension, inextensible or not, and arc of the skirt.

Each shape is the single positive root of a convex (cable) or concave (arc) function. Newton's method that starts on the
far side of such a root never crosses it, so no start has to be guessed and no case fails; small differences like
sinh b - b come from their series, so that the nearly straight cable keeps all its digits.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from moyai.core.arrays import Array
from moyai.core.compiled import njit
from moyai.core.errors import InputError

_ITERATIONS = 200
_TINY = 4e-16


@njit(cache=True, error_model="numpy")
def sinh_excess(b: float) -> float:
    """Return sinh(b)/b - 1 without cancellation."""
    if b > 1.0:
        return math.sinh(b) / b - 1.0
    square = b * b
    total = 0.0
    for n in range(10, 0, -1):
        total = square / ((2 * n) * (2 * n + 1)) * (1.0 + total)
    return total


@njit(cache=True, error_model="numpy")
def sine_deficit(angle: float) -> float:
    """Return 1 - sin(angle)/angle without cancellation."""
    if angle > 1.0:
        return 1.0 - math.sin(angle) / angle
    square = angle * angle
    total = 0.0
    for n in range(10, 0, -1):
        total = square / ((2 * n) * (2 * n + 1)) * (1.0 - total)
    return total


@njit(cache=True, error_model="numpy")
def taut_shape_scalar(span_ratio: float) -> float:
    """Return b of the just-taut cable, sinh(b)/b = 1/R, for 0 < R < 1 [eq:curtain-cable-inextensible].

    log(sinh(b)/b) is convex and below b^2/6: the first step from sqrt(-6 log R) lands beyond the root, all later ones
    come back to it.
    """
    goal = -math.log(span_ratio)
    b = math.sqrt(6.0 * goal)
    for count in range(_ITERATIONS):
        if b < 1.0:
            excess = sinh_excess(b)
            value = math.log1p(excess)
        else:
            value = b - math.log(2.0 * b) + math.log1p(-math.exp(-2.0 * b))
        # Langevin's function coth b - 1/b
        slope = 1.0 / math.tanh(b) - 1.0 / b if b > 0.1 else b / 3.0 * (1.0 - b * b / 15.0)
        step = (value - goal) / slope
        b -= step
        if count > 0 and abs(step) <= _TINY * b:
            break
    return b


@njit(cache=True, error_model="numpy")
def elastic_shape_scalar(span_ratio: float, stiffness_ratio: float) -> float:
    """Return b = R/(2 tau) of the cable with stretch, sinh b - b/R = 1/(2 R_E) [eq:curtain-cable-elastic].

    Any R > 0: below 1 the cable is longer than the span, above 1 it is pretensioned.
    """
    lack = (1.0 - span_ratio) / span_ratio
    stretch = 0.5 / stiffness_ratio
    taut = taut_shape_scalar(span_ratio) if span_ratio < 1.0 else 0.0
    if stretch == 0.0:
        return taut
    # above the root: the third derivative is at least 1, the slope at the taut shape is positive, and the root obeys
    # b = arsinh(b/R + 1/(2 R_E)), whose right side falls towards it from above
    b = taut + (6.0 * stretch) ** (1.0 / 3.0)
    slope = math.cosh(taut) - 1.0 / span_ratio
    if slope > 0.0:
        b = min(b, taut + stretch / slope)
    for _ in range(8):
        b = min(b, math.asinh(b / span_ratio + stretch))
    for _ in range(_ITERATIONS):
        half = math.sinh(0.5 * b)
        step = (b * (sinh_excess(b) - lack) - stretch) / (2.0 * half * half - lack)
        b -= step
        if abs(step) <= _TINY * b:
            break
    return b


@njit(cache=True, error_model="numpy")
def arc_half_angle_scalar(chord_ratio: float, stiffness_ratio: float) -> float:
    """Return the half angle of the arc, sin(alpha) = R (alpha - 1/(2 R_E)), in (0, pi) [eq:curtain-skirt-arc]."""
    stretch = 0.5 / stiffness_ratio
    angle = math.pi
    for _ in range(_ITERATIONS):
        value = angle * ((1.0 - chord_ratio) - sine_deficit(angle)) + chord_ratio * stretch
        half = math.sin(0.5 * angle)
        step = value / ((1.0 - chord_ratio) - 2.0 * half * half)
        angle -= step
        if abs(step) <= _TINY * angle:
            break
    return angle


@njit(cache=True, error_model="numpy")
def _elastic_shapes(span_ratio: Array, stiffness_ratio: Array, out: Array) -> None:
    for i in range(span_ratio.size):
        out[i] = elastic_shape_scalar(span_ratio[i], stiffness_ratio[i])


@njit(cache=True, error_model="numpy")
def _arc_half_angles(chord_ratio: Array, stiffness_ratio: Array, out: Array) -> None:
    for i in range(chord_ratio.size):
        out[i] = arc_half_angle_scalar(chord_ratio[i], stiffness_ratio[i])


def _ratios(ratio: ArrayLike, stiffness_ratio: ArrayLike, name: str) -> tuple[Array, Array]:
    r, e = np.broadcast_arrays(np.asarray(ratio, dtype=np.float64), np.asarray(stiffness_ratio, dtype=np.float64))
    if not (np.all(np.isfinite(r)) and np.all(r > 0.0)):
        raise InputError(f"{name} is {np.min(r):g}", parameter=name, allowed="greater than 0, finite")
    if not np.all(e > 0.0):
        raise InputError(
            f"stiffness ratio is {np.min(e):g}",
            parameter="stiffness_ratio",
            allowed="greater than 0; infinite: no stretch",
        )
    if np.any(np.isinf(e) & (r >= 1.0)):
        raise InputError(
            f"{name} is {np.max(r[np.isinf(e)]):g} without stretch: the tension has no bound",
            parameter=name,
            allowed="less than 1 where nothing stretches",
            remedy="give more length than the straight line, or the stiffness",
        )
    return r, e


def cable_shape_number(span_ratio: ArrayLike, stiffness_ratio: ArrayLike = np.inf) -> Array:
    """Return the shape number b = B/(2a) of a cable of constant tension.

    Parameters
    ----------
    span_ratio : array_like
        R = B/l, span over unstretched length [-]; below 1 without stretch, any positive number with it.
    stiffness_ratio : array_like
        R_E = EA/(sigma l), stiffness over load times length [-]; infinite for a cable that does not stretch.

    Returns
    -------
    ndarray
        b [-]; the slope at the supports is sinh b, the sag over the span (cosh b - 1)/(2 b).

    Raises
    ------
    InputError
        When a ratio is not positive, or the cable can neither hang nor stretch.
    """
    r, e = _ratios(span_ratio, stiffness_ratio, "span_ratio")
    out = np.empty(r.size)
    _elastic_shapes(np.ascontiguousarray(r).ravel(), np.ascontiguousarray(e).ravel(), out)
    return out.reshape(r.shape)


def cable_tension_ratio(span_ratio: ArrayLike, stiffness_ratio: ArrayLike = np.inf) -> Array:
    """Return tau = T/(sigma l) of a cable: equation (4) of the paper, (6) where nothing stretches.

    See :func:`cable_shape_number` for the arguments; tau = R/(2 b) [eq:curtain-cable-elastic].
    """
    return np.asarray(span_ratio) / (2.0 * cable_shape_number(span_ratio, stiffness_ratio))


def arc_half_angle(chord_ratio: ArrayLike, stiffness_ratio: ArrayLike = np.inf) -> Array:
    """Return the half angle [rad] of the arc of a skirt under uniform normal pressure, in (0, pi).

    Parameters
    ----------
    chord_ratio : array_like
        R_s = d0/d, straight distance of the edges over unstretched length [-].
    stiffness_ratio : array_like
        R_E = EA/(sigma d), stiffness per span over pressure times length [-]; infinite without stretch.

    Raises
    ------
    InputError
        As :func:`cable_shape_number`; and when the pressure blows the skirt up beyond a full circle, R_E <= 1/(2 pi).
    """
    r, e = _ratios(chord_ratio, stiffness_ratio, "chord_ratio")
    if np.any(e <= 0.5 / math.pi):
        raise InputError(
            f"stiffness ratio is {np.min(e):g}: the skirt stretches beyond a full circle and holds no pressure",
            parameter="stiffness_ratio",
            allowed=f"greater than {0.5 / math.pi:.4f}",
            remedy="give a stiffer skirt or a lower pressure",
        )
    out = np.empty(r.size)
    _arc_half_angles(np.ascontiguousarray(r).ravel(), np.ascontiguousarray(e).ravel(), out)
    return out.reshape(r.shape)


def arc_tension_ratio(chord_ratio: ArrayLike, stiffness_ratio: ArrayLike = np.inf) -> Array:
    """Return tau_s = T_s/(sigma_s d) of the skirt: equation (2) of the paper; arguments as :func:`arc_half_angle`.

    2 tau_s = 1/x with x = alpha - 1/(2 R_E) = sin(alpha)/R_s [eq:curtain-skirt-arc].
    """
    return np.asarray(chord_ratio) / (2.0 * np.sin(arc_half_angle(chord_ratio, stiffness_ratio)))


@dataclass(frozen=True, eq=False)
class CableSolution:
    """A cable at rest under the load sigma cos^2 of its slope; arrays of one shape."""

    #: Distance of the supports B [m].
    span: Array
    #: Unstretched length l [m].
    length: Array
    #: sigma [N/m], load per length where the cable lies across the current.
    line_load: Array
    #: EA [N].
    axial_stiffness: Array
    #: T [N], the same everywhere along the cable.
    tension: Array
    #: b [-].
    shape_number: Array

    @property
    def sag(self) -> Array:
        """Deflection at mid-span, downstream of the line between the supports [m] [eq:curtain-cable-shape]."""
        values: Array = self.span / self.shape_number * np.sinh(0.5 * self.shape_number) ** 2
        return values

    @property
    def stretched_length(self) -> Array:
        """Length under load, B sinh(b)/b [m]."""
        return self.span * np.sinh(self.shape_number) / self.shape_number

    @property
    def strain(self) -> Array:
        """T/EA [-]."""
        return self.tension / self.axial_stiffness

    @property
    def end_angle(self) -> Array:
        """Angle at the supports between cable and span [rad], arctan(sinh b)."""
        return np.arctan(np.sinh(self.shape_number))

    @property
    def downstream_end_force(self) -> Array:
        """Downstream force on each support, T tanh b [N]."""
        return self.tension * np.tanh(self.shape_number)

    @property
    def inward_end_force(self) -> Array:
        """Force along the span on each support, T / cosh b [N]."""
        return self.tension / np.cosh(self.shape_number)

    def deflection(self, position: ArrayLike) -> Array:
        """Return the downstream deflection [m] at distances from mid-span [m] [eq:curtain-cable-shape].

        The difference of the two hyperbolic cosines is written as a product, exact for the flattest cable. Positions
        are a last axis behind the axes of the solution.
        """
        x = np.asarray(position, dtype=np.float64)
        lead = [np.asarray(part)[(...,) + (None,) * x.ndim] for part in (self.span, self.shape_number)]
        span, b = lead
        along = 2.0 * b * x / span
        return span / b * np.sinh(0.5 * (b + along)) * np.sinh(0.5 * (b - along))


def solve_cable(
    span: ArrayLike, length: ArrayLike, line_load: ArrayLike, axial_stiffness: ArrayLike = np.inf
) -> CableSolution:
    """Return the cable of constant tension between two supports, equations (4) to (6) of the paper.

    Parameters
    ----------
    span, length : array_like
        Distance of the supports and unstretched length [m].
    line_load : array_like
        sigma [N/m] of the load law p_n = sigma cos^2(theta) per length.
    axial_stiffness : array_like
        EA [N], infinite for a cable that does not stretch.

    Raises
    ------
    InputError
        When a number is not positive, or a cable without stretch is not longer than the span.

    Notes
    -----
    Source: Sawaragi, Aoki and Liu (1991). What load makes the equations exact: see [eq:curtain-cable-load].
    """
    given = {"span": span, "length": length, "line_load": line_load, "axial_stiffness": axial_stiffness}
    parts = dict(zip(given, np.broadcast_arrays(*(np.asarray(v, dtype=np.float64) for v in given.values()))))
    _require_positive(parts)
    size = parts["line_load"] * parts["length"]
    shape = cable_shape_number(parts["span"] / parts["length"], parts["axial_stiffness"] / size)
    tension = parts["line_load"] * parts["span"] / (2.0 * shape)
    return CableSolution(**parts, tension=tension, shape_number=shape)


@dataclass(frozen=True, eq=False)
class SkirtArc:
    """A skirt between two held edges under uniform normal pressure: an arc of a circle; arrays of one shape."""

    #: Straight distance of the edges d0 [m].
    chord: Array
    #: Unstretched length d [m].
    length: Array
    #: sigma_s [N/m2].
    pressure: Array
    #: E_s A_s per span [N/m].
    stiffness: Array
    #: T_s per span [N/m].
    tension: Array
    #: alpha [rad].
    half_angle: Array

    @property
    def radius(self) -> Array:
        """T_s / sigma_s [m]."""
        return self.tension / self.pressure

    @property
    def sagitta(self) -> Array:
        """Deflection at mid-depth from the chord [m]."""
        values: Array = self.radius * 2.0 * np.sin(0.5 * self.half_angle) ** 2
        return values

    @property
    def edge_load(self) -> Array:
        """Load per span on each of the two cables, half of pressure times chord [N/m] [eq:curtain-edge-load]."""
        return 0.5 * self.pressure * self.chord

    @property
    def stretched_length(self) -> Array:
        """Length of the arc [m]."""
        return 2.0 * self.radius * self.half_angle


def solve_skirt_arc(
    chord: ArrayLike, length: ArrayLike, pressure: ArrayLike, stiffness: ArrayLike = np.inf
) -> SkirtArc:
    """Return the arc of a skirt whose edges are held, equations (2) and (3) of the paper.

    Parameters
    ----------
    chord, length : array_like
        Straight distance of the edges and unstretched length [m].
    pressure : array_like
        Uniform normal pressure [N/m2].
    stiffness : array_like
        Per span [N/m], modulus times thickness; infinite without stretch.

    Raises
    ------
    InputError
        As :func:`arc_half_angle`, and when a number is not positive.
    """
    given = {"chord": chord, "length": length, "pressure": pressure, "stiffness": stiffness}
    parts = dict(zip(given, np.broadcast_arrays(*(np.asarray(v, dtype=np.float64) for v in given.values()))))
    _require_positive(parts)
    angle = arc_half_angle(parts["chord"] / parts["length"], parts["stiffness"] / (parts["pressure"] * parts["length"]))
    tension = parts["pressure"] * parts["chord"] / (2.0 * np.sin(angle))
    return SkirtArc(**parts, tension=tension, half_angle=angle)


def _require_positive(parts: dict[str, Array]) -> None:
    for name, values in parts.items():
        if not np.all(values > 0.0):
            raise InputError(f"{name} is {np.min(values):g}", parameter=name, allowed="greater than 0")
