"""Mean second-order force of regular waves, from the far field and by integrating the pressure over the section.

Forces are per unit wave amplitude squared and per metre of structure, [N/m per m2].
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from moyai.core.arrays import Array, ComplexArray
from moyai.core.errors import InputError
from moyai.potential.checks import check_solution
from moyai.potential.heading import HeadingSolution
from moyai.potential.modes import Rigid
from moyai.potential.panels import GAP, PLATE, Panels, gauss_rule
from moyai.potential.plate_faces import mean_of_faces, plate_tips, surface_ends, surface_rate
from moyai.potential.solution import RadiationDiffraction
from moyai.potential.waves import incident_wave


@dataclass(frozen=True, eq=False)
class FarFieldDrift:
    """Mean force from the momentum of the waves far off."""

    #: Along x, per unit amplitude squared [N/m per m2]; shape (omega,).
    horizontal: Array
    #: Along y; only energy that is taken from the waves pushes that way; shape (omega,).
    along_crest: Array
    #: Reflection coefficient of the moving section; shape (omega,).
    reflection_coefficient: ComplexArray
    #: Transmission coefficient of the moving section; shape (omega,).
    transmission_coefficient: ComplexArray
    #: 1 - |R|^2 - |T|^2; shape (omega,).
    loss: Array


@dataclass(frozen=True, eq=False)
class NearFieldDrift:
    """Mean force from the pressure on the section, per unit amplitude squared."""

    #: Force along x [N/m per m2]; shape (omega,).
    horizontal: Array
    #: Force along z [N/m per m2]; counts the mean pressure from zero Bernoulli constant; shape (omega,).
    vertical: Array
    #: About the centre of roll, positive as roll [N m/m per m2]; shape (omega,).
    moment: Array


def _amplitudes(solution: RadiationDiffraction, motions: ComplexArray | None) -> ComplexArray:
    """Return motion amplitudes (omega, modes) per unit wave amplitude; none given means held fixed."""
    shape = len(solution.omega), len(solution.modes)
    if motions is None:
        return np.zeros(shape, dtype=complex)
    values = np.asarray(motions, dtype=complex)
    if values.shape != shape or not np.isfinite(values).all():
        raise InputError(
            f"motions have shape {values.shape} or are not finite", parameter="motions", allowed=f"shape {shape}"
        )
    return values


def mean_drift_far_field(
    solution: RadiationDiffraction, motions: ComplexArray | None = None, heading: float = 0.0
) -> FarFieldDrift:
    """Return the mean force by conservation of momentum [eq:potential-drift-far].

    F_x = E (C_g / C) cos^2(beta) (1 + |R|^2 - |T|^2) with E = rho g / 2 holds in any depth: the part of the radiation
    stress that does not depend on direction is balanced by the set-down. Along the crests,
    F_y = E (C_g / C) sin(beta) cos(beta) (1 - |R|^2 - |T|^2).

    Parameters
    ----------
    solution : RadiationDiffraction
        The solved section.
    motions : ndarray of complex, shape (omega, modes), optional
        Amplitudes of the modes per unit wave amplitude (as exp(i k sin(beta) y) at an oblique heading); default fixed.
    heading : float
        One of the headings of the solution [rad].

    Returns
    -------
    FarFieldDrift
        Forces along x and along the crests per unit amplitude squared [N/m per m2], and what is reflected, transmitted
        and lost [-], each of shape (omega,).

    Raises
    ------
    InputError
        For motions of another shape or not finite, and a heading that was not solved; for what is no solution.

    References
    ----------
    M. S. Longuet-Higgins (1977), The mean forces exerted by waves on floating or submerged bodies, Proc. R. Soc. Lond.
    A 352, 463-480; H. Maruo (1960), The drift of a body floating on waves, J. Ship Res. 4.

    Examples
    --------
    >>> from moyai.potential import mean_drift_far_field, rigid_modes, shapes, solve
    >>> from moyai.sea import Water
    >>> section = shapes.rectangle(beam=4.0, height=2.0).immersed(draught=1.0)
    >>> water = Water(depth=10.0, density=1025.0, gravity=9.81)
    >>> found = solve(section, water, [1.5], modes=rigid_modes(centre=(0.0, -0.2)))
    >>> drift = mean_drift_far_field(found)                              # of the section held fixed
    >>> round(float(drift.horizontal[0]) / 1000.0, 2)                    # [kN/m per m2]
    2.59
    >>> abs(float(drift.loss[0])) < 1e-3                                 # no energy is lost
    True
    """
    check_solution(solution)
    part = solution.at_heading(heading)
    velocity = -1j * part.states.omega[:, None] * _amplitudes(solution, motions)
    waves = np.einsum("wj,wjs->ws", velocity, part.radiated_wave)
    reflection, transmission = part.reflection_coefficient + waves[:, 0], part.transmission_coefficient + waves[:, 1]
    back, on = np.abs(reflection) ** 2, np.abs(transmission) ** 2
    ratio = part.states.group_velocity * part.states.wave_number / part.states.omega
    scale = 0.5 * solution.water.density * solution.water.gravity * ratio * np.cos(heading)
    return FarFieldDrift(
        horizontal=scale * np.cos(heading) * (1.0 + back - on),
        along_crest=scale * np.sin(heading) * (1.0 - back - on),
        reflection_coefficient=reflection,
        transmission_coefficient=transmission,
        loss=1.0 - back - on,
    )


def _rigid_centre(solution: RadiationDiffraction) -> tuple[tuple[int, int, int], tuple[float, float]]:
    """Return the numbers of sway, heave and roll among the modes and the centre of roll.

    Raises
    ------
    InputError
        When the modes are not rigid motions of the whole section.
    """
    found: dict[str, int] = {}
    centre = (0.0, 0.0)
    for index, (function, bodies) in enumerate(zip(solution.modes.functions, solution.modes.bodies)):
        if isinstance(function, Rigid) and bodies is None:
            found[function.kind] = index
            if function.kind == "roll":
                centre = (function.x, function.z)
    if len(found) != 3 or len(solution.modes) != 3:
        raise InputError(
            "pressure integration needs sway, heave and roll of the whole section and no other mode",
            parameter="modes",
            remedy="solve with rigid_modes(centre); the far-field drift works with any modes",
        )
    return (found["sway"], found["heave"], found["roll"]), centre


def mean_drift_near_field(
    solution: RadiationDiffraction, motions: ComplexArray | None = None, heading: float = 0.0
) -> NearFieldDrift:
    """Return the mean force by integration of the second-order pressure [eq:potential-drift-near].

    Five terms: relative elevation at the waterlines, velocity squared, first-order pressure gradient times motion,
    rotation of the first-order force, and second-order change of the hydrostatic pressure by roll. Corners add nothing
    of their own: their panels are graded so that the squared velocity is smooth in the panel's parameter. On thin
    plates the terms are differences of the two faces, and every free edge adds its suction [eq:plate-suction].

    Parameters
    ----------
    solution : RadiationDiffraction
        Solved with :func:`moyai.potential.modes.rigid_modes`.
    motions : ndarray of complex, shape (omega, 3), optional
        Amplitudes of the modes per unit wave amplitude; fixed by default.
    heading : float
        One of the headings of the solution [rad].

    Returns
    -------
    NearFieldDrift
        Forces along x and z [N/m per m2] and moment about the centre of roll, positive as roll [N m/m per m2], per unit
        amplitude squared; each of shape (omega,).

    Raises
    ------
    InputError
        For motions of another shape or not finite, a heading that was not solved, a solution of other modes than those
        of a rigid section, and thin plates at an oblique heading; for what is no solution.

    References
    ----------
    J. A. Pinkster and G. van Oortmerssen (1977), Computation of the first and second order wave forces on oscillating
    bodies in regular waves, 2nd Int. Conf. Num. Ship Hydrodynamics, Berkeley.

    Examples
    --------
    >>> from moyai.potential import mean_drift_far_field, mean_drift_near_field, rigid_modes, shapes, solve
    >>> from moyai.sea import Water
    >>> section = shapes.rectangle(beam=4.0, height=2.0).immersed(draught=1.0)
    >>> water = Water(depth=10.0, density=1025.0, gravity=9.81)
    >>> found = solve(section, water, [1.5], modes=rigid_modes(centre=(0.0, -0.2)))
    >>> near, far = mean_drift_near_field(found), mean_drift_far_field(found)   # of the section held fixed
    >>> abs(float(near.horizontal[0] / far.horizontal[0]) - 1.0) < 0.01  # both ways agree
    True
    """
    check_solution(solution)
    part = solution.at_heading(heading)
    (sway, heave, roll), centre = _rigid_centre(solution)
    amplitude = _amplitudes(solution, motions)
    body = part.body
    water, omega = solution.water, part.states.omega[:, None]
    points, normal, weight = body.points, body.normal, body.weight.real

    wave, gradient = incident_wave(points, part.states.wave_number, part.states.along, water.depth)
    unit = -1j * water.gravity / omega
    moving = np.einsum("wnj,wj->wn", part.radiation, -1j * omega * amplitude)
    disturbed = part.scattered + moving
    tangent = body.du / np.abs(body.du)
    # On a plate all these are jumps: the incident wave has none
    closed = np.where(body.kind == PLATE, 0.0, 1.0)
    known = unit * (gradient[:, :, 0] * tangent.real + gradient[:, :, 1] * tangent.imag)
    along = closed * known + _along(body, disturbed)
    potential = closed * unit * wave + disturbed
    arm_x, arm_z = points[:, 0] - centre[0], points[:, 1] - centre[1]
    theta = amplitude[:, roll : roll + 1]
    shift_x = amplitude[:, sway : sway + 1] + theta * arm_z
    shift_z = amplitude[:, heave : heave + 1] - theta * arm_x
    shift_n = shift_x * normal[:, 0] + shift_z * normal[:, 1]
    shift_s = shift_x * tangent.real + shift_z * tangent.imag
    through = -1j * omega * shift_n
    crest = (part.states.wave_number * np.sin(heading))[:, None]

    def mean(a: ComplexArray, b: ComplexArray) -> Array:
        return np.asarray(0.5 * (a * np.conj(b)).real)

    square = 0.5 * (mean(along, along) + mean(through, through) + crest**2 * mean(potential, potential))
    carried = closed * mean(shift_n, -1j * omega * through) + mean(shift_s, -1j * omega * along)
    hydrostatic = -0.5 * water.gravity * mean(theta, theta) * arm_z
    faces = _Faces.of(solution, part, wave, gradient, disturbed, through, amplitude) if not closed.all() else None
    if faces is not None:
        plate = closed == 0.0
        square[:, plate] = mean(faces.along, along[:, plate])
    level = square + carried + closed * hydrostatic
    first = -1j * omega * potential + closed * water.gravity * shift_z
    lever = arm_z * normal[:, 0] - arm_x * normal[:, 1]
    x, z, m = (water.density * (level * weight * direction).sum(axis=1) for direction in (*normal.T, lever))
    # The first-order force turns with the section; the still pressure turns with it in second order
    force_x, force_z = (water.density * (first * weight * direction).sum(axis=1) for direction in normal.T)
    still = water.density * water.gravity * points[:, 1] * weight * closed
    turned = 0.5 * mean(theta, theta)[:, 0]
    x += mean(theta[:, 0], force_z) - turned * float((still * normal[:, 0]).sum())
    z += -mean(theta[:, 0], force_x) - turned * float((still * normal[:, 1]).sum())

    for place, direction, on_plate, values in _waterline(body):
        # Incident wave exactly, the rest from the polynomial of the panel at the still water
        known = unit * incident_wave(place[None, :], part.states.wave_number, part.states.along, water.depth)[0]
        lift = amplitude[:, heave : heave + 1] - theta * (place[0] - centre[0])
        faced = [(1.0, disturbed @ values)] if not on_plate else []
        if on_plate and faces is not None:
            left, right = surface_ends(part.surface, float(place[0]))
            towards = np.sign(direction[0])
            faced = [(-towards, faces.surface @ left), (towards, faces.surface @ right)]
        for side, value in faced:
            relative = (1j * omega / water.gravity) * (known + value[:, None]) - lift
            push = 0.5 * water.density * water.gravity * mean(relative, relative)[:, 0] / abs(direction[0])
            push = side * push
            x -= push * direction[0]
            z -= push * direction[1]
            m -= push * ((place[1] - centre[1]) * direction[0] - (place[0] - centre[0]) * direction[1])
    for tip in plate_tips(body):
        strength = (disturbed @ tip.strength)[:, None]
        pull = math.pi * water.density / 16.0 * mean(strength, strength)[:, 0]
        x += pull * tip.outward[0]
        z += pull * tip.outward[1]
        m += pull * ((tip.place[1] - centre[1]) * tip.outward[0] - (tip.place[0] - centre[0]) * tip.outward[1])
    return NearFieldDrift(horizontal=x, vertical=z, moment=m)


@dataclass(frozen=True, eq=False)
class _Faces:
    """Mean tangential velocity of the two faces of plates (omega, plate nodes), disturbance on the free surface."""

    along: ComplexArray
    surface: ComplexArray

    @classmethod
    def of(
        cls,
        solution: RadiationDiffraction,
        part: HeadingSolution,
        wave: ComplexArray,
        gradient: ComplexArray,
        disturbed: ComplexArray,
        through: ComplexArray,
        amplitude: ComplexArray,
    ) -> _Faces:
        """Evaluate Green's representation on the plates."""
        if part.heading != 0.0:
            raise InputError(
                "drift by pressure on thin plates is for normal incidence only",
                parameter="heading",
                remedy="take mean_drift_far_field, which holds for any heading",
            )
        body, omega = part.body, part.states.omega[:, None]
        depth, unit = solution.water.depth, -1j * solution.water.gravity / omega
        plate = np.flatnonzero(body.kind == PLATE)
        speed = -1j * omega * amplitude
        surface = part.scattered_surface + np.einsum("wnj,wj->wn", part.radiation_surface, speed)
        incident_flux = unit * np.einsum("wnc,nc->wn", gradient, body.normal)
        gap = part.surface.kind == GAP
        known = incident_wave(part.surface.points[gap], part.states.wave_number, part.states.along, depth)[0]
        rate = surface_rate(part, solution.lid, surface, unit * known)
        on_faces = mean_of_faces(part, depth, disturbed, through - incident_flux, surface, rate)
        whole = np.zeros_like(disturbed)
        whole[:, plate] = on_faces
        tangent = body.du[plate] / np.abs(body.du[plate])
        known = unit * (gradient[:, plate, 0] * tangent.real + gradient[:, plate, 1] * tangent.imag)
        return cls(known + _along(body, whole)[:, plate], surface)


def _along(body: Panels, potential: ComplexArray) -> ComplexArray:
    """Derivative of the potential along the boundary, from the polynomial of each panel."""
    rule = gauss_rule(body.order)
    values = potential.reshape(len(potential), len(body.pieces), body.order)
    return np.asarray((values @ rule.derivative.T).reshape(potential.shape) / np.abs(body.du))


def _waterline(body: Panels) -> list[tuple[Array, Array, bool, Array]]:
    """Return (point, unit normal, whether on a plate, weights that give the value there) of every waterline point."""
    rule = gauss_rule(body.order)
    found = []
    for number, piece in enumerate(body.pieces):
        for end, values in ((0, rule.first), (1, rule.last)):
            place = piece.start + end * piece.step
            if abs(place.imag) <= 1e-12 * abs(piece.step):
                slope = piece.step * np.exp(1j * piece.sweep * (end - 0.5))
                normal = -1j * slope / abs(slope)
                weights = np.zeros(len(body.u))
                weights[number * body.order : (number + 1) * body.order] = values
                direction = np.array([normal.real, normal.imag])
                found.append((np.array([place.real, 0.0]), direction, piece.kind == PLATE, weights))
    return found
