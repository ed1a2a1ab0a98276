"""Potential and surface elevation at points of the fluid, for figures, animation and gauges.

Between the outermost points of the section, and deeper than the distance from there, Green's representation over body
and free surface holds as it stands. Elsewhere it would need the surface potential off the ray; there the wave and the
evanescent modes of the depth are summed instead, each with the coefficient that Green's identity over the body gives it
[eq:potential-outer-modes].
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike

from moyai.core.arrays import Array, ComplexArray
from moyai.core.errors import InputError
from moyai.potential.checks import check_solution
from moyai.potential.oblique_quadrature import add_helmholtz
from moyai.potential.panels import GAP, PLATE, Panels, gauss_rule, make_panels
from moyai.potential.quadrature import add_rankine
from moyai.potential.solution import RadiationDiffraction
from moyai.potential.waves import depth_profile, incident_wave
from moyai.sea.dispersion import evanescent_wave_numbers


def surface_elevation(
    solution: RadiationDiffraction,
    x: ArrayLike,
    index: int,
    *,
    motions: ArrayLike | None = None,
    amplitude: complex = 1.0,
) -> ComplexArray:
    """Return the complex elevation [m] at places x [m] at one frequency [eq:potential-outer-modes].

    Parameters
    ----------
    solution : RadiationDiffraction
        The solved section; the wave travels along +x.
    x : array_like, shape (n,)
        Places; NaN is returned where the section cuts the surface.
    index : int
        Number of the frequency.
    motions : array_like of complex, shape (modes,), optional
        Amplitudes of the modes [m, rad]; none is the section held fixed.
    amplitude : complex
        Amplitude of the incident wave [m]; 0 shows the radiated waves alone.

    Returns
    -------
    ndarray of complex, shape (n,)
        Amplitude and phase [m]; the elevation is its real part times exp(-i omega t).

    Raises
    ------
    InputError
        For motions of another shape or not finite, and for what is no solution.
    IndexError
        For a number of no frequency.

    Examples
    --------
    >>> from moyai.potential import rigid_modes, shapes, solve, surface_elevation
    >>> from moyai.sea import Water
    >>> section = shapes.rectangle(beam=4.0, height=2.0).immersed(draught=1.0)
    >>> water = Water(depth=10.0, density=1025.0, gravity=9.81)
    >>> found = solve(section, water, [1.5], modes=rigid_modes(centre=(0.0, -0.2)))
    >>> far = surface_elevation(found, [60.0], 0)                        # behind the section held fixed
    >>> round(float(abs(far[0])), 2)                                     # its transmission coefficient [m]
    0.73
    """
    check_solution(solution)
    places = np.atleast_1d(np.asarray(x, dtype=float))
    points = np.stack([places, np.zeros_like(places)], axis=1)
    omega = float(solution.omega[index])
    values = potential_at(solution, points, index, motions=motions, amplitude=amplitude)
    out = np.asarray(1j * omega / solution.water.gravity * values, dtype=np.complex128)
    for left, right in solution.section.waterlines:
        out[(places > left) & (places < right)] = np.nan
    return out


def potential_at(
    solution: RadiationDiffraction,
    points: ArrayLike,
    index: int,
    *,
    motions: ArrayLike | None = None,
    amplitude: complex = 1.0,
) -> ComplexArray:
    """Return the complex velocity potential [m2/s] at points (n, 2) of the fluid at frequency number ``index``.

    Parameters are those of :func:`surface_elevation`. Points within the section give numbers without meaning.
    """
    place = np.atleast_2d(np.asarray(points, dtype=float))
    if place.ndim != 2 or place.shape[1] != 2 or not np.isfinite(place).all():
        raise InputError(f"points have shape {place.shape} or are not finite", parameter="points", allowed="(n, 2)")
    part = solution.normal
    states, water = part.states, solution.water
    omega = float(states.omega[index])
    speed = np.zeros(len(solution.modes), dtype=complex)
    if motions is not None:
        speed = -1j * omega * np.asarray(motions, dtype=complex)
        if speed.shape != (len(solution.modes),):
            raise InputError(
                f"motions have shape {speed.shape}", parameter="motions", allowed=f"({len(solution.modes)},)"
            )

    unit = -1j * water.gravity / omega * amplitude
    one = slice(index, index + 1)
    _, gradient = incident_wave(part.body.points, states.wave_number[one], states.along[one], water.depth)
    displacement = solution.modes.normal_displacement(
        part.body.points, part.body.normal, part.body.body.astype(np.intp)
    )
    flux = speed @ displacement - unit * np.einsum("nc,nc->n", gradient[0], part.body.normal)
    # A plate is no source: the flux is the same on both faces, and its potential is the jump over it
    flux = np.where(part.body.kind == PLATE, 0.0, flux)
    on_body = part.radiation[index] @ speed + amplitude * part.scattered[index]
    on_surface = part.radiation_surface[index] @ speed + amplitude * part.scattered_surface[index]

    out: ComplexArray = unit * incident_wave(place, states.wave_number[one], states.along[one], water.depth)[0][0]
    left, right = solution.section.bounds[0], solution.section.bounds[1]
    # A point sees the surface at x + i |z|: where that lies above the ray, the representation still holds
    reach = 1.2 * np.maximum(0.0, np.maximum(place[:, 0] - right, left - place[:, 0]))
    inside = ((place[:, 0] < right) & (place[:, 0] > left)) | (-place[:, 1] > reach)
    beyond, before = ~inside & (place[:, 0] >= right), ~inside & (place[:, 0] <= left)
    if inside.any():
        out[inside] += _between(solution, place[inside], index, on_body, flux, on_surface, unit)
    lid = _lid_source(solution, index, on_surface, unit)
    for chosen, side, limit in ((beyond, 1.0, right), (before, -1.0, left)):
        if chosen.any():
            out[chosen] += _outside(solution, place[chosen], index, on_body, flux, lid, side, limit)
    return out


def _lid_source(
    solution: RadiationDiffraction, index: int, on_surface: ComplexArray, unit: complex
) -> tuple[Array, ComplexArray]:
    """Points of the lid and what it gives there, i eps K phi times the weight."""
    part = solution.normal
    gap = part.surface.kind == GAP
    points = part.surface.points[gap]
    if solution.lid == 0.0 or not len(points):
        return np.empty((0, 2)), np.empty(0, dtype=complex)
    one = slice(index, index + 1)
    known = incident_wave(points, part.states.wave_number[one], part.states.along[one], solution.water.depth)[0][0]
    strength = 1j * solution.lid * part.states.deep_wave_number[index]
    return points, strength * (on_surface[gap] + unit * known) * part.surface.weight[gap].real


def _between(
    solution: RadiationDiffraction,
    points: Array,
    index: int,
    on_body: ComplexArray,
    flux: ComplexArray,
    on_surface: ComplexArray,
    unit: complex,
) -> ComplexArray:
    """Green's representation of the disturbance at points between the outermost points of the section."""
    part, depth = solution.normal, solution.water.depth
    # On the surface itself half a solid angle belongs to the point: stand just below it
    size = solution.section.bounds[1] - solution.section.bounds[0]
    u = points[:, 0] + 1j * np.minimum(points[:, 1], -1e-9 * size)
    lid_points, lid_flux = _lid_source(solution, index, on_surface, unit)
    total = np.zeros(len(u), dtype=np.complex128)
    surface_flux = part.states.deep_wave_number[index] * on_surface
    if len(lid_points):
        gap = part.surface.kind == GAP
        surface_flux[gap] += lid_flux / part.surface.weight[gap].real
    for panels, value, rate in ((part.body, on_body, -flux), (part.surface, on_surface, surface_flux)):
        single, double = _influence_at(u, panels, depth)
        total -= double @ value + single @ rate
    return np.asarray(total / (2.0 * math.pi))


def _influence_at(
    u: ComplexArray, panels: Panels, depth: float, crest_wave_number: float = 0.0
) -> tuple[ComplexArray, ComplexArray]:
    """S and D at real points, bed image included."""
    rule = gauss_rule(panels.order)
    tables = panels.kernel_panels, panels.kernel_nodes, (rule.nodes, rule.weights, rule.projection)
    single, double = np.zeros((2, len(u), len(panels.u)), dtype=complex)
    nobody, real = np.full(len(u), -1), np.ones(len(u), dtype=bool)
    images = [u] if math.isinf(depth) else [u, u.conj() - 2j * depth]
    for image in images:
        if crest_wave_number > 0.0:
            add_helmholtz((image, image.conj(), real), nobody, *tables, crest_wave_number, single, double)
        else:
            add_rankine((image, image.conj(), real), nobody, *tables, single, double)
    return single, double


def _outside(
    solution: RadiationDiffraction,
    points: Array,
    index: int,
    on_body: ComplexArray,
    flux: ComplexArray,
    lid: tuple[Array, ComplexArray],
    side: float,
    limit: float,
) -> ComplexArray:
    """Wave and evanescent modes of the disturbance on one side (+1 right, -1 left) of the section."""
    part, depth = solution.normal, solution.water.depth
    body, states = part.body, part.states
    k, deep = float(states.wave_number[index]), float(states.deep_wave_number[index])
    # The panels' polynomials on a finer rule, so that modes shorter than a panel integrate well
    fine = make_panels(body.pieces, 4 * body.order)
    value, rate = (_on_finer_rule(body, fine, item) for item in (on_body, flux))
    away = side * (fine.points[:, 0] - limit)
    normal = fine.normal * np.array([side, 1.0])
    weight = fine.weight.real
    distance = side * (points[:, 0] - limit)

    def coefficients(rate_x: ComplexArray, profile: Array, slope: Array, lid_profile: Array) -> ComplexArray:
        """Integral of phi d(psi)/dn - psi dphi/dn for psi = exp(-rate_x away) profile; modes first."""
        decay = np.exp(-rate_x[:, None] * away[None, :])
        flow = decay * (-rate_x[:, None] * normal[:, 0] * profile + normal[:, 1] * slope)
        out = (flow * (weight * value)).sum(axis=1) - (decay * profile * (weight * rate)).sum(axis=1)
        if len(lid[1]):
            lid_away = side * (lid[0][:, 0] - limit)
            out += (np.exp(-rate_x[:, None] * lid_away[None, :]) * lid_profile * lid[1]).sum(axis=1)
        return np.asarray(out)

    z, lid_z = fine.points[:, 1], lid[0][:, 1]
    profile, slope = depth_profile(z[None, :], np.array([[k]]), depth)
    lid_profile = depth_profile(lid_z[None, :], np.array([[k]]), depth)[0]
    propagating = coefficients(np.array([1j * k]), profile, slope, lid_profile)
    total = -propagating[0] / (2j * k * float(states.profile[index])) * np.exp(1j * k * distance)
    total = total * depth_profile(points[:, 1], np.array(k), depth)[0]

    longest = float(np.abs([piece.step for piece in body.pieces]).max())
    largest = 3.0 * body.order / longest
    if math.isfinite(depth):
        rates = evanescent_wave_numbers(
            float(states.omega[index]), depth, solution.water.gravity, _count(largest, depth)
        )
        norms = 0.5 * depth * (1.0 + np.sin(2.0 * rates * depth) / (2.0 * rates * depth))
        scale = 1.0 / (2.0 * rates * norms)

        def mode(at: Array) -> tuple[Array, Array]:
            phase = rates[:, None] * (at[None, :] + depth)
            return np.cos(phase), -rates[:, None] * np.sin(phase)
    else:
        # A continuous spectrum: Gauss rule in the logarithm of the rate
        nodes, weights = np.polynomial.legendre.leggauss(160)
        low, high = math.log(1e-4 * min(deep, 1.0 / longest)), math.log(max(largest, 10.0 * deep))
        rates = np.exp(0.5 * (low + high) + 0.5 * (high - low) * nodes)
        scale = 0.5 * (high - low) * weights / (math.pi * (rates**2 + deep**2))

        def mode(at: Array) -> tuple[Array, Array]:
            m = rates[:, None]
            cosine, sine = np.cos(m * at[None, :]), np.sin(m * at[None, :])
            return m * cosine + deep * sine, m * (deep * cosine - m * sine)

    profile, slope = mode(z)
    local = coefficients(-rates.astype(complex), profile, slope, mode(lid_z)[0]) * scale
    return np.asarray(total + np.exp(-distance[:, None] * rates[None, :]) * mode(points[:, 1])[0].T @ local)


def _count(largest: float, depth: float) -> int:
    return int(min(400, max(4, math.ceil(largest * depth / math.pi))))


def _on_finer_rule(coarse: Panels, fine: Panels, values: ComplexArray) -> ComplexArray:
    """Evaluate the panels' polynomials on the nodes of a finer rule."""
    rule = gauss_rule(coarse.order)
    table = np.polynomial.legendre.legvander(gauss_rule(fine.order).nodes, coarse.order - 1) @ rule.projection
    return np.asarray((values.reshape(-1, coarse.order) @ table.T).ravel())
