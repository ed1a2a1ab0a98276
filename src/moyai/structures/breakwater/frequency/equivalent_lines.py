"""Regular waves with the force of lines that are led along the motion, in place of their tangent."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from moyai.core.arrays import Array, ComplexArray
from moyai.core.errors import ConvergenceError
from moyai.core.mixing import Mixing
from moyai.core.progress import Progress
from moyai.core.validity import Notice
from moyai.floating.coefficients import Hydrodynamics
from moyai.floating.damping import QuadraticDamping
from moyai.floating.drift import DriftedMotions
from moyai.floating.far_field import drift_force_per_amplitude_squared, far_field
from moyai.floating.frequency import dynamic_stiffness, solve_scaled
from moyai.structures.breakwater.frequency.model import FrequencyModel, water_motion
from moyai.structures.breakwater.lines.drag import line_drag_rows
from moyai.structures.breakwater.lines.driven import DrivenLines, LinesOfUnit

#: Change of motion and offset, over the largest motion, at which the balance has settled.
TOLERANCE = 5e-4
MOST_TURNS = 40
#: Part of a plain step that is taken, earlier turns that a step learns from, and longest step over the motion.
PART, REMEMBERED, LONGEST = 0.5, 4, 0.1


@dataclass(frozen=True, eq=False)
class _Answer:
    offset: Array
    motion: ComplexArray
    #: Beyond radiation, drag of lines in motion through shapes at rest included; shape (3, 3).
    damping: Array
    #: Force of moving water, and of led lines beyond tangent, inertia and drag of shapes at rest, per wave amplitude.
    driven: ComplexArray
    tangent: Array
    drift: float


@dataclass(frozen=True, eq=False)
class _Wave:
    """One wave: what does not change from turn to turn."""

    model: FrequencyModel
    hydro: Hydrodynamics
    amplitude: float
    lines: DrivenLines

    def turn(self, offset: Array, motion: ComplexArray) -> tuple[Array, ComplexArray, _Answer]:
        """Return the steps of offset and motion that the balance of mean and first harmonic requires."""
        model, hydro, unit = self.model, self.hydro, self.model.unit
        omega = hydro.omega[0]
        tangent = unit.mooring.stiffness(offset)
        restoring = unit.statics.stiffness + tangent
        linear = model.damping.at(model.inertia, hydro.added_mass[0], restoring)
        of_moving, of_others, carried = self._drag(-1j * omega * motion)
        damping = hydro.radiation_damping[0] + linear + of_others
        without = dynamic_stiffness(omega, unit.inertia + hydro.added_mass[0], damping, unit.statics.stiffness)
        whole = dynamic_stiffness(omega, model.inertia + hydro.added_mass[0], damping + of_moving, restoring)
        mean, first = self.lines.harmonics(offset, motion)
        step = solve_scaled(whole, self.amplitude * hydro.excitation_force[0, 0] + carried + first - without @ motion)[
            0
        ]
        drift = self._drift(motion)
        load = model.steady + np.array([drift, 0.0, 0.0]) + mean
        shift = np.linalg.solve(restoring, load - unit.statics.stiffness @ offset)
        driven = (carried + first + (whole - without) @ motion) / self.amplitude
        return shift, step, _Answer(offset, motion, linear + of_others + of_moving, driven, tangent, drift)

    def _drag(self, velocity: ComplexArray) -> tuple[Array, Array, ComplexArray]:
        """Return the drag of lines in motion, all other quadratic damping, and the force of moving water."""
        model, none = self.model, np.zeros((3, 3))
        if model.quadratic is None:
            return none, none, np.zeros(3, dtype=complex)
        measure, moving = (
            model.quadratic.directions @ velocity,
            water_motion(model, self.hydro.omega, self.hydro.heading),
        )
        carried = np.zeros(3, dtype=complex)
        if moving is not None:
            water = self.amplitude * moving[0, 0]
            measure = measure - water
            carried = model.quadratic.carried_regular(np.abs(measure), water)
        still = QuadraticDamping(*line_drag_rows(model.unit, of_moving=False))
        count = model.rows_of_lines
        lines = QuadraticDamping(model.quadratic.directions[:count], model.quadratic.coefficients[:count])
        of_still = still.equivalent_regular(np.abs(still.directions @ velocity))
        of_moving = lines.equivalent_regular(np.abs(measure[:count])) - of_still
        return of_moving, model.quadratic.equivalent_regular(np.abs(measure)) - of_moving, carried

    def _drift(self, motion: ComplexArray) -> float:
        """Return the drift force of the motion [N]."""
        if not (self.model.with_drift and self.hydro.has_far_field):
            return 0.0
        far, hydro = far_field(self.hydro, motion[None, None, :] / self.amplitude), self.hydro
        water, length = self.model.unit.water, hydro.length
        per_square = drift_force_per_amplitude_squared(far, hydro.omega, hydro.heading, water, length)
        return float(per_square[0, 0]) * self.amplitude**2


def _balanced(wave: _Wave, offset: Array, motion: ComplexArray, scale: Array) -> _Answer | None:
    """Return the balance of mean and first harmonic that starts from an offset and a motion, ``None`` without one.

    Steps learn from earlier ones (Anderson 1965), since a hardening line may ask for more than the whole motion.
    """
    mixing = Mixing(REMEMBERED + 1)

    def joined(real: Array, harmonic: ComplexArray) -> Array:
        return np.concatenate([scale * real, scale * harmonic.real, scale * harmonic.imag])

    for _ in range(MOST_TURNS):
        try:
            shift, step, answer = wave.turn(offset, motion)
        except ConvergenceError:
            return None
        size = float(np.max(np.abs(scale * motion)))
        asked = joined(shift, step)
        if not np.isfinite(asked).all() or not size > 0.0:
            return None
        if float(np.max(np.abs(asked))) <= TOLERANCE * size:
            # the motion under the forces found: the balance of energy is then exact
            return replace(answer, motion=motion + step)
        here = joined(offset, motion)
        taken = mixing.step(here, asked, PART)
        there = here + taken * min(1.0, LONGEST * size / max(float(np.max(np.abs(taken))), 1e-300))
        offset = there[:3] / scale
        motion = np.asarray((there[3:6] + 1j * there[6:]) / scale, dtype=np.complex128)
    return None


def about_led_lines(
    model: FrequencyModel, hydro: Hydrodynamics, amplitude: Array, tangent: DriftedMotions, progress: Progress
) -> DriftedMotions:
    """Return the motions in regular waves with the first harmonic of the force of led lines [eq:breakwater-led-lines].

    Parameters
    ----------
    model : FrequencyModel
        With ``led_lines``.
    hydro : Hydrodynamics
        Of one heading.
    amplitude : ndarray (n,)
        Of the waves [m].
    tangent : DriftedMotions
        Of the same waves with the tangent of the lines, from which each wave starts and where it stays, with a notice,
        when no balance is found.
    progress : Progress
    """
    assert model.led_lines is not None
    dynamics, current = model.led_lines
    lines = LinesOfUnit.of(model.unit, dynamics, current)
    scale = np.array([1.0, 1.0, 0.5 * model.unit.breakwater.hull.beam])
    motions = tangent.motions
    displacement, damping = motions.displacement.copy(), motions.damping.copy()
    driven = np.zeros_like(displacement) if motions.drag_excitation is None else motions.drag_excitation.copy()
    offset, stiffness = tangent.offset.copy(), tangent.mooring_stiffness.copy()
    drift, failed = tangent.drift_force.copy(), []
    for index, height in enumerate(2.0 * amplitude):
        progress("lines led along the motion", index, len(amplitude))
        omega, start = float(hydro.omega[index]), displacement[index, 0] * amplitude[index]
        if not height > 0.0 or not np.isfinite(start).all():
            continue
        one = hydro.at(hydro.omega[index : index + 1])
        led = DrivenLines(lines, omega, float(height), float(hydro.heading[0]))
        found = _balanced(_Wave(model, one, float(amplitude[index]), led), offset[index], start, scale)
        if found is None:
            failed.append(omega)
            continue
        displacement[index, 0], driven[index, 0] = found.motion / amplitude[index], found.driven
        damping[index, 0], offset[index] = found.damping, found.offset
        stiffness[index], drift[index] = found.tangent, found.drift
    progress("lines led along the motion", len(amplitude), len(amplitude))
    moved = replace(motions, displacement=displacement, damping=damping, drag_excitation=driven)
    return replace(
        tangent,
        motions=moved,
        far=far_field(hydro, displacement) if hydro.has_far_field else tangent.far,
        offset=offset,
        mooring_stiffness=stiffness,
        drift_force=drift,
        notices=(*tangent.notices, *_unbalanced(failed)),
    )


def _unbalanced(omega: list[float]) -> tuple[Notice, ...]:
    if not omega:
        return ()
    return (
        Notice(
            "led-lines",
            "no balance with the first harmonic of the line force in waves of "
            f"{', '.join(f'{value:.4g}' for value in omega)} rad/s; their lines keep the tangent",
            value=float(len(omega)),
            severity="warning",
            remedy="take the time domain there: the motion may have several states or strong other harmonics",
        ),
    )
