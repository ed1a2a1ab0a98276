"""Seas over the row: frequencies and headings that are solved, and the answer to each sea."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from moyai.core.arrays import Array, ComplexArray, IntArray
from moyai.core.errors import InputError
from moyai.core.mixing import Mixing
from moyai.floating.irregular import response_statistics
from moyai.sea.environment import Environment
from moyai.sea.states import IrregularSea, RegularSea, SeaState
from moyai.structures.units.assembly import RowAtLevel, RowPosition, steady_position
from moyai.structures.units.drift import near_drift, reconciled
from moyai.structures.units.hydrodynamics import RowHydrodynamics
from moyai.structures.units.links import Work
from moyai.structures.units.model import UnitSettings
from moyai.structures.units.response import (
    FarWaves,
    RowModel,
    RowResponse,
    RowWaves,
    far_drift,
    far_waves,
    gaussian_stiffness,
    harmonic_stiffness,
    moved,
    respond,
)
from moyai.structures.units.viscous import LinearEddies, eddies_of

#: Share of the energy of a spectrum beyond the highest frequency that is solved
ENERGY_LEFT_OUT = 0.02
#: Frequencies of the statistics of a sea, within the band that is solved
FINE = 161
#: Headings of a spread sea
HEADINGS = 13
_TURNS, _PATIENCE, _SLOW = 400, 60, 0.1
_SETTLED = 1e-3


def band_of(sea: IrregularSea) -> tuple[float, float]:
    """Return the lowest and the highest frequency [rad/s] that a spectrum is solved at."""
    low, high = sea.spectrum.quantile(np.array([1e-3, 1.0 - ENERGY_LEFT_OUT]))
    return float(low), float(high)


#: Step of the frequencies of a draft [rad/s], and the fewest of them in a sea
ROUND, LEAST_ROUND = 0.1, 5


def frequencies_of(environment: Environment, settings: UnitSettings) -> Array:
    """Return the frequencies [rad/s] of the coefficients: regular waves exactly, spectra evenly over their energy.

    Of a draft spectra take the round frequencies within, which they share with other seas.
    """
    parts: list[Array] = [np.zeros(0)]
    if settings.frequencies is not None:
        parts.append(np.asarray(settings.frequencies, dtype=float))
    for sea in environment.sea_states:
        if isinstance(sea, RegularSea):
            parts.append(2.0 * math.pi / np.asarray(sea.periods))
        elif settings.frequencies is None:
            low, high = band_of(sea)
            parts.append(np.linspace(low, high, settings.frequency_count))
            round_ones: Array = np.asarray(
                ROUND * np.arange(math.ceil(low / ROUND), math.floor(high / ROUND) + 1), dtype=float
            )
            if settings.nominal and len(round_ones) >= LEAST_ROUND:
                parts[-1] = round_ones
    omega = np.unique(np.round(np.concatenate(parts), 9))
    keep = [0] if len(omega) else []
    for index in range(1, len(omega)):
        if omega[index] - omega[keep[-1]] > 1e-6 * omega[-1]:
            keep.append(index)
    return np.asarray(omega[keep])


def headings_of(environment: Environment) -> Array:
    """Return all headings [rad] that are solved, each once."""
    every = [spread_of(sea, np.ones(1))[0] for sea in environment.sea_states] or [np.zeros(1)]
    return np.unique(np.round(np.concatenate(every), 12))


def spread_of(sea: SeaState, omega: Array) -> tuple[Array, Array]:
    """Return headings [rad] of a sea and the share of energy (n, h) of each: even cells over all but 1e-3 of it."""
    spreading = getattr(sea, "spreading", None)
    if not isinstance(sea, IrregularSea) or spreading is None:
        return np.round(np.array([sea.heading]), 12), np.ones((len(omega), 1))
    peaks = np.asarray(sea.spectrum.quantile(np.array([0.02, 0.5, 0.98])), dtype=float)
    ends = np.asarray(spreading.quantile(np.array([[5e-4], [1.0 - 5e-4]]), peaks[None, :]))
    low, high = max(float(ends[0].min()), -math.pi), min(float(ends[1].max()), math.pi)
    edges = np.linspace(low, high, HEADINGS + 1)
    below = np.broadcast_to(np.asarray(spreading.cumulative(edges[None, :], omega[:, None])), (len(omega), len(edges)))
    share = np.diff(below, axis=1)
    share = share / share.sum(axis=1, keepdims=True)
    middle = sea.heading + 0.5 * (edges[1:] + edges[:-1])
    return np.asarray(np.round(np.arctan2(np.sin(middle), np.cos(middle)), 12), dtype=float), share


def columns_of(hydro: RowHydrodynamics, headings: Array) -> IntArray:
    """Return where headings stand among those that were solved."""
    return np.array([int(np.argmin(np.abs(hydro.headings - heading))) for heading in headings])


@dataclass(frozen=True, eq=False)
class SeaAnswer:
    """A sea over the row."""

    #: Under wind, current and mean drift.
    rest: RowPosition
    #: Mean drift of the whole row [N, N, N m]; shape (3,).
    drift: Array
    #: The same as loads on the units; shape (m,).
    pushed: Array
    #: Of the units per amplitude squared, at the frequencies and headings of ``coarse``; empty of regular waves; shape
    #: (f, h, m).
    unit_drift: Array
    #: At the frequencies of the coefficients; of regular waves in all headings that were solved, of an irregular sea in
    #: its own.
    coarse: RowResponse
    #: Of ``coarse``.
    far: FarWaves
    #: At the frequencies of the statistics, headings of the sea; of regular waves at their period.
    fine: RowResponse
    #: Of the sea at the fine frequencies [m2 s/rad]; empty for regular waves; shape (n, h).
    density: Array
    #: Of the sea [rad]; shape (h,).
    headings: Array
    #: That stands for the curves of connectors [N/m]; shape (joints,).
    curve_stiffness: Array
    #: How curves are worked about ``rest``.
    work: Work
    converged: bool


def regular_answer(
    at: RowAtLevel, hydro: RowHydrodynamics, sea: RegularSea, steady: Array, settings: UnitSettings
) -> list[SeaAnswer]:
    """Return the answer to each period of regular waves of one height."""
    answers = []
    column = columns_of(hydro, np.array([sea.heading]))
    eddies = eddies_of(at)
    for period in sea.periods:
        row = int(np.argmin(np.abs(hydro.omega - 2.0 * math.pi / period)))
        drift, pushed = np.zeros(3), np.zeros(at.size)
        rest, work = steady_position(at, steady), Work(at.rounding, np.zeros(len(at.links)), True)
        converged, mixed = False, _Mixed()
        amplitude = 0.5 * sea.height
        linear = None if eddies is None else LinearEddies(eddies, np.zeros(len(eddies.points)), True)
        every = RowWaves.of(at, hydro, hydro.omega, eddies)
        if linear is not None:
            # as of units that lie still
            linear = replace(linear, size=amplitude * np.abs(every.water[row, column[0]]))
        for _ in range(_TURNS):
            model, curves = RowModel(at, hydro, rest.position), _curve_stiffness(at, rest, work)
            motion = moved(model, every, curves, linear)
            drawn = amplitude * np.abs(_drawn(at, rest, motion[row, column])[0])
            speeds = np.zeros(0)
            if linear is not None:
                speeds = amplitude * np.abs(linear.measured(every.omega, every.water, motion)[row, column[0]])
            pushes = pushed
            if settings.drift:
                whole = far_drift(model, motion)
                drift = amplitude**2 * whole[row, column[0]]
                near = near_drift(model, motion, np.array([row]), column)
                pushes = amplitude**2 * reconciled(at, near, whole[[row]][:, column])[0, 0]
            last = _sizes(linear)
            if _near(drawn, work.sizes) and _near(speeds, last) and _near(pushes, pushed):
                pushed, converged = pushes, True
                break
            worked, last, pushed = mixed.towards((work.sizes, last, pushed), (drawn, speeds, pushes))
            linear, work = linear and replace(linear, size=last), replace(work, sizes=worked)
            rest = steady_position(at, steady + pushed, work)
        model, curves = RowModel(at, hydro, rest.position), _curve_stiffness(at, rest, work)
        coarse = respond(model, hydro.omega, curves, linear, every)
        far = far_waves(model, coarse)
        answers.append(
            SeaAnswer(
                rest, drift, pushed, np.zeros((0, 0, at.size)), coarse, far, _response_at(coarse, row, column),
                np.zeros((0, 0)), hydro.headings[column], curves, work, converged,
            )
        )  # fmt: skip
    return answers


def _response_at(response: RowResponse, row: int, columns: IntArray) -> RowResponse:
    where = np.ix_(np.array([row]), columns)
    return RowResponse(
        response.omega[[row]], response.motion[where], response.relative[where], response.load[where],
        response.tension[where], response.dissipated[where],
    )  # fmt: skip


class _Mixed:
    """Fixed-point iteration of elongations, speeds at edges and drift together, mixed after Anderson.

    Each is measured by its largest; elongations and speeds never fall below zero.
    """

    def __init__(self) -> None:
        self._mixing, self._turn = Mixing(), 0

    def forget(self) -> None:
        """Start anew, where the map itself has changed."""
        self._mixing.forget()

    def towards(self, old: tuple[Array, Array, Array], new: tuple[Array, Array, Array]) -> tuple[Array, Array, Array]:
        """Return the next elongations, speeds and drift from the last and what they lead to.

        Where mixing has not settled by :data:`_PATIENCE` turns it starts again from rest in small plain steps, which
        follow the branch of small motions where curves that come tight make several.
        """
        self._turn += 1
        if self._turn == _PATIENCE:
            return np.zeros_like(old[0]), new[1], np.zeros_like(old[2])
        if self._turn > _PATIENCE:
            slow = [last + _SLOW * (ahead - last) for last, ahead in zip(old, new, strict=True)]
            return slow[0], slow[1], slow[2]
        parts = [np.full(len(part), max(float(np.max(np.abs(part), initial=0.0)), 1e-12)) for part in new]
        scale, point = np.concatenate(parts), np.concatenate(old)
        step = np.concatenate(new) - point
        first, second = len(old[0]), len(old[0]) + len(old[1])
        # half a step of elongations alone, where there is nothing to mix: a curve that comes tight turns back
        plain = point + np.where(np.arange(len(step)) < first, 0.5, 1.0) * step
        mixed = self._mixing.step(point, step, scale=scale)
        if self._mixing.knows < 2:
            return plain[:first], plain[first:second], plain[second:]
        found = point + mixed
        # a mixture that leaves what it is mixed from far behind is none: nothing may halve or double beyond both ends
        low, high = 0.5 * np.minimum(point, point + step)[:second], 2.0 * np.maximum(point, point + step)[:second]
        if np.any(found[:second] < low) or np.any(found[:second] > high):
            self.forget()
            found = plain
        return found[:first], found[first:second], found[second:]


def _drawn(at: RowAtLevel, rest: RowPosition, motion: ComplexArray) -> ComplexArray:
    """Return the elongation (..., links) of every curve by small motions (..., m) about rest."""
    along = np.array([link.along(rest.position) for link in at.links]).reshape(len(at.links), at.size)
    return np.asarray(motion @ along.T)


def _curve_stiffness(at: RowAtLevel, rest: RowPosition, work: Work) -> Array:
    """Return the linear stiffness (joints,) that stands for the curves of every connector."""
    out = np.zeros(len(at.joints))
    law = harmonic_stiffness if work.regular else gaussian_stiffness
    for link in at.links:
        out[link.joint] += law(link.curve, float(link.elongation(rest.position)), work.size_of(link.number))
    return out


def _sizes(linear: LinearEddies | None) -> Array:
    return np.zeros(0) if linear is None else linear.size


def _near(new: Array, old: Array) -> bool:
    size = float(np.max(np.abs(new), initial=0.0))
    return float(np.max(np.abs(new - old), initial=0.0)) <= _SETTLED * max(size, 1e-12)


def irregular_answer(
    at: RowAtLevel, hydro: RowHydrodynamics, sea: IrregularSea, steady: Array, settings: UnitSettings
) -> SeaAnswer:
    """Return the answer to an irregular sea, curves of connectors linearised for the whole of it."""
    low, high = band_of(sea)
    low, high = max(low, float(hydro.omega[0])), min(high, float(hydro.omega[-1]))
    if not low < high:
        raise InputError(
            f"{sea.name}: the frequencies that were computed do not reach into this sea",
            parameter="settings.frequencies",
            allowed=f"{low:.3g} to {high:.3g} rad/s",
        )
    omega = np.linspace(low, high, FINE)
    headings, share = spread_of(sea, omega)
    columns = columns_of(hydro, headings)
    density = np.asarray(sea.spectrum.density_at(omega), dtype=float)[:, None] * share
    coarse_share = spread_of(sea, hydro.omega)[1]
    coarse_density = np.asarray(sea.spectrum.density_at(hydro.omega), dtype=float)[:, None] * coarse_share
    weights = cell_weights(hydro.omega, low, high)
    one = hydro.among(columns)
    drift, pushed = np.zeros(3), np.zeros(at.size)
    unit_drift = np.zeros((len(hydro.omega), len(headings), at.size))
    converged, mixed = False, _Mixed()
    rest, work = steady_position(at, steady), Work(at.rounding, np.zeros(len(at.links)))
    near, fresh = None, False
    eddies = eddies_of(at)
    linear = None if eddies is None else LinearEddies(eddies, np.zeros(len(eddies.points)), False)
    every, own = RowWaves.of(at, one, omega, eddies), RowWaves.of(at, one, one.omega, eddies)
    if linear is not None:
        # as of units that lie still
        linear = replace(linear, size=response_statistics(omega, every.water, density).standard_deviation)
    for turn in range(_TURNS):
        model, curves = RowModel(at, one, rest.position), _curve_stiffness(at, rest, work)
        motion = moved(model, every, curves, linear)
        drawn = response_statistics(omega, _drawn(at, rest, motion), density).standard_deviation
        speeds = np.zeros(0)
        if linear is not None:
            measured = linear.measured(omega, every.water, motion)
            speeds = response_statistics(omega, measured, density).standard_deviation
        pushes = pushed
        if settings.drift:
            motion = moved(model, own, curves, linear)
            whole = far_drift(model, motion)
            # pressures cost most: those of the first turn serve until the rest settles
            if not (turn and near is not None):
                near, fresh = near_drift(model, motion), True
            unit_drift = reconciled(at, near, whole)
            drift = np.einsum("f,fh,fhc->c", 2.0 * weights, coarse_density, whole)
            pushes = np.einsum("f,fh,fhm->m", 2.0 * weights, coarse_density, unit_drift)
        last = _sizes(linear)
        settled = _near(drawn, work.sizes) and _near(speeds, last) and _near(pushes, pushed)
        if settled and (fresh or near is None):
            pushed, converged = pushes, True
            break
        if fresh:
            mixed.forget()
        worked, last, pushed = mixed.towards((work.sizes, last, pushed), (drawn, speeds, pushes))
        linear, work = linear and replace(linear, size=last), replace(work, sizes=worked)
        near, fresh = (None if settled else near), False
        rest = steady_position(at, steady + pushed, work)
    model, curves = RowModel(at, one, rest.position), _curve_stiffness(at, rest, work)
    coarse = respond(model, own.omega, curves, linear, own)
    return SeaAnswer(
        rest, drift, pushed, unit_drift, coarse, far_waves(model, coarse),
        respond(model, omega, curves, linear, every), density, headings, curves, work, converged,
    )  # fmt: skip


def cell_weights(omega: Array, low: float, high: float) -> Array:
    """Return the weights of the trapezoidal rule on a grid, of its part from ``low`` to ``high`` [rad/s]."""
    inside = (omega >= low * (1.0 - 1e-9)) & (omega <= high * (1.0 + 1e-9))
    weights = np.zeros(len(omega))
    grid = omega[inside]
    if len(grid) < 2:
        weights[inside] = high - low
        return weights
    step = np.diff(grid)
    weights[inside] = 0.5 * np.concatenate([step[:1], step[1:] + step[:-1], step[-1:]])
    return weights
