"""Motions: free decay, response functions from irregular tests with coherence, video markers to rigid motion."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike, NDArray

from moyai.core.arrays import Array, ComplexArray
from moyai.core.errors import InputError
from moyai.core.validity import Notice
from moyai.core.wording import counted
from moyai.floating.decay import Decay, fit_decay
from moyai.series.detrend import slow_part
from moyai.series.spectra import CrossSpectra, WelchOptions, cross_spectra

#: Samples of a period below which crests and the period itself are doubtful
_FEW_SAMPLES = 8.0


@dataclass(frozen=True, eq=False)
class DecayFit:
    """A free decay in a record."""

    #: Period, damping ratio and quadratic damping.
    decay: Decay
    #: Position at rest [m or rad].
    equilibrium: float
    #: Start of the part of the record that was used [s].
    start: float
    #: End of that part [s].
    end: float
    #: Standard error of the period over the half cycles left out one by one.
    period_error: float
    #: Standard error of the damping ratio, by the same.
    damping_error: float
    #: Standard error of the quadratic damping, by the same.
    quadratic_error: float
    notices: tuple[Notice, ...] = ()


def fit_decay_record(
    time: ArrayLike,
    values: ArrayLike,
    *,
    start: float | None = None,
    end: float | None = None,
    equilibrium: float | None = None,
    smallest: float = 0.05,
    quadratic: bool = True,
) -> DecayFit:
    """Find period, linear and quadratic damping of a free decay; equation [eq:records-decay].

    Parameters
    ----------
    time, values : array_like
        Evenly stepped record [s], [m or rad].
    start, end : float, optional
        Part to use [s]; by default from the largest departure from rest on.
    equilibrium : float, optional
        Position at rest; by default the one about which the swings of both sides decay alike, near the median of the
        last fifth.
    smallest : float
        Extremes below this share of the first are left out.
    quadratic : bool
        Fit both parts, or the linear one alone.

    Returns
    -------
    DecayFit

    Raises
    ------
    InputError
        For gaps, fewer than three extremes, or motions that grow.
    """
    t, v = np.asarray(time, dtype=float), np.asarray(values, dtype=float)
    if t.shape != v.shape or t.size < 8:
        raise InputError(f"{v.size} samples for {t.size} instants", parameter="values", allowed="8 or more, equal")
    if not np.isfinite(v).any():
        raise InputError("the record holds no value", parameter="values", remedy="check the column")
    level = float(np.nanmedian(v[-max(t.size // 5, 3) :])) if equilibrium is None else float(equilibrium)
    chosen = _used_part(t, v - level, start, end)
    t, v = t[chosen], v[chosen]
    if not np.isfinite(v).all():
        raise InputError(
            "the decay has gaps", parameter="values", remedy="choose 'start' and 'end' inside a sound stretch"
        )
    if t.size > 1 and np.ptp(np.diff(t)) > 0.01 * float(np.median(np.diff(t))):
        # Stamps with few decimals scatter about even steps; anything more is a gap
        even, step = np.linspace(t[0], t[-1], t.size), float(np.median(np.diff(t)))
        if float(np.max(np.abs(t - even))) > 0.6 * step:
            worst = int(np.argmax(np.abs(np.diff(t) - step)))
            raise InputError(
                f"the decay is not evenly stepped: {t[worst + 1] - t[worst]:.4g} s after {t[worst]:.6g} s, "
                f"{step:.4g} s usually",
                parameter="time",
                remedy="choose 'start' and 'end' inside a stretch without gaps",
            )
        t = even
    notices = []
    v, smoothed = _without_ripple(t, v, level)
    if smoothed:
        message = f"ripple between the swings was smoothed over {smoothed:.3g} s before extremes were read"
        notices.append(Notice("decay-ripple", message, smoothed, severity="information"))
    found = fit_decay(t, v, mean=level, smallest=smallest, quadratic=quadratic)
    if equilibrium is None and found.ratios.size >= 4:
        for _ in range(3):  # another rest may bring further swings in
            level += _rest_shift(t, v, level, found, quadratic)
            found = fit_decay(t, v, mean=level, smallest=smallest, quadratic=quadratic)
    samples = found.period / float(np.median(np.diff(t)))
    if samples < _FEW_SAMPLES:
        message = f"a period holds {samples:.3g} samples: a shorter one would look the same, and crests are missed"
        notices.append(Notice("decay-sampling", message, samples, _FEW_SAMPLES, remedy="sample faster"))
    if found.damping_ratio < 0.0:
        message = (
            f"the linear damping ratio comes out as {found.damping_ratio:.3g}: the extremes do not decay like this"
        )
        notices.append(
            Notice("decay-damping", message, found.damping_ratio, 0.0, remedy="check equilibrium, start and end")
        )
    if found.ratios.size < 6 and quadratic:
        message = f"{found.ratios.size} half cycles hardly determine two damping coefficients"
        notices.append(Notice("few-cycles", message, float(found.ratios.size), 6.0))
    errors = _jackknife(found, quadratic)
    return DecayFit(found, level, float(t[0]), float(found.extreme_times[-1]), *errors, tuple(notices))


def _used_part(t: Array, departure: Array, start: float | None, end: float | None) -> NDArray[np.bool_]:
    """Return which samples are used: from the largest departure from rest on where no start is given."""
    first, last = float(t[0]) if start is None else start, float(t[-1]) if end is None else end
    chosen = (t >= first) & (t <= last)
    if start is None and np.isfinite(departure[chosen]).any():
        first = float(t[chosen][int(np.nanargmax(np.abs(departure[chosen])))])
        chosen &= t >= first
    if np.count_nonzero(chosen) < 8:
        raise InputError(
            f"the part from {first:.5g} to {last:.5g} s holds {counted(int(np.count_nonzero(chosen)), 'sample')}",
            parameter="end" if start is None else "start",
            allowed=f"8 or more, within {t[0]:.5g} to {t[-1]:.5g} s",
        )
    return chosen


def _rest_shift(t: Array, v: Array, level: float, decay: Decay, quadratic: bool) -> float:
    """Return how far the rest lies from ``level``: about it the decrements of both sides follow one law best."""
    from scipy.optimize import minimize_scalar

    first = float(np.interp(decay.extreme_times[0], t, v)) - level
    signs = np.sign(first) * (-1.0) ** np.arange(decay.extremes.size)

    def misfit(shift: float) -> float:
        extremes = decay.extremes - signs * shift
        decrement = np.log(extremes[:-1] / extremes[1:])
        ratios = decrement / np.hypot(math.pi, decrement)
        amplitude = 0.5 * (extremes[:-1] + extremes[1:])
        basis = np.column_stack([amplitude, amplitude**2])[:, : 2 if quadratic else 1]
        rest = ratios * amplitude - basis @ np.linalg.lstsq(basis, ratios * amplitude, rcond=None)[0]
        return float(rest @ rest)

    reach = 0.8 * float(decay.extremes.min())
    found = minimize_scalar(misfit, bounds=(-reach, reach), method="bounded", options={"xatol": 1e-6 * reach})
    return float(found.x)


def _without_ripple(t: Array, v: Array, level: float) -> tuple[Array, float]:
    """Return the record, smoothed over an eighth of a swing where it has more extremes than swings, and that length."""
    above = v - level
    band = 0.02 * float(np.max(np.abs(above)))
    side = np.sign(np.where(np.abs(above) > band, above, 0.0))
    side = side[side != 0.0]
    swings = int(np.count_nonzero(np.diff(side)))
    large = np.abs(above[1:-1]) > band
    slope = np.diff(v)
    turns = int(np.count_nonzero((slope[1:] * slope[:-1] <= 0.0) & large))  # steps of a coarse resolution count too
    crossings = np.flatnonzero(above[1:] * above[:-1] < 0.0)
    if swings < 2 or turns <= swings + 2 or crossings.size < 2:
        return v, 0.0
    length = 2.0 * float(t[crossings[-1]] - t[crossings[0]]) / max(swings - 1, 1) / 8.0
    step = float(np.median(np.diff(t)))
    if length < 5.0 * step:
        return v, 0.0
    return slow_part(t, v, length), length


def _jackknife(decay: Decay, quadratic: bool) -> tuple[float, float, float]:
    halves = np.diff(decay.extreme_times)
    count = halves.size
    if count < 4:
        return math.nan, math.nan, math.nan
    period = 2.0 * float(np.std(halves, ddof=1)) / math.sqrt(count)
    amplitude = 0.5 * (decay.extremes[:-1] + decay.extremes[1:])
    basis = np.column_stack([np.ones(count), 4.0 / (3.0 * math.pi) * amplitude])[:, : 2 if quadratic else 1]
    solutions = []
    for out in range(count):
        kept = np.arange(count) != out
        weight = amplitude[kept, None]
        solutions.append(np.linalg.lstsq(basis[kept] * weight, decay.ratios[kept] * weight[:, 0], rcond=None)[0])
    spread = np.sqrt((count - 1.0) / count * np.sum((np.array(solutions) - np.mean(solutions, axis=0)) ** 2, axis=0))
    return period, float(spread[0]), float(spread[1]) if quadratic else 0.0


@dataclass(frozen=True, eq=False)
class ResponseFunction:
    """Linear response to the waves at each frequency; equation [eq:records-response]."""

    #: [Hz].
    frequency: Array
    #: Complex, ``Re(X exp(-i omega t))`` per unit wave amplitude; NaN outside the band or without coherence.
    response: ComplexArray
    #: Squared coherence [-].
    coherence: Array
    #: Standard error of the modulus.
    error: Array
    #: Standard error of the phase [rad].
    phase_error: Array
    degrees_of_freedom: float
    #: Where the coherence exceeds what chance gives in 95 of 100 records, and the limit asked for.
    coherent: NDArray[np.bool_]
    notices: tuple[Notice, ...] = ()

    @property
    def modulus(self) -> Array:
        """Response amplitude operator [unit of the motion per m]."""
        return np.abs(self.response)

    def moved(self, distance: float, wave_number: ArrayLike) -> ResponseFunction:
        """Return the response to the wave at another place.

        Parameters
        ----------
        distance : float
            From the gauge to the reference of the motion, along the waves [m].
        wave_number : array_like
            At each frequency [1/m].
        """
        shift = np.exp(-1j * np.asarray(wave_number, dtype=float) * distance)
        return replace(self, response=self.response * shift)


def response_function(
    step: float,
    wave: ArrayLike,
    motion: ArrayLike,
    options: WelchOptions,
    *,
    lowest: float,
    highest: float,
    least_coherence: float = 0.0,
) -> ResponseFunction:
    """Estimate a response function from an irregular test [eq:records-response].

    The cross spectrum over the wave spectrum: noise in the motion does not bias it, noise in the wave lowers it.

    Parameters
    ----------
    step : float
        Time step [s].
    wave, motion : array_like
        Records on one clock; NaN where missing.
    options : WelchOptions
        Several segments: a single one always has coherence 1.
    lowest, highest : float
        Band [Hz].
    least_coherence : float
        Frequencies with less are left out (NaN), next to those where chance gives as much.

    Returns
    -------
    ResponseFunction

    Raises
    ------
    InputError
        With fewer than two segments.
    """
    matrix = cross_spectra(step, np.column_stack([np.asarray(wave, float), np.asarray(motion, float)]), options)
    return response_of(matrix, lowest=lowest, highest=highest, least_coherence=least_coherence)


def _blur(response: ComplexArray, error: Array, resolution: float, frequency: Array) -> list[Notice]:
    """Return a notice where the response bends within the resolution more than its errors explain."""
    if frequency.size < 3:
        return []
    bins = resolution / float(frequency[1] - frequency[0])
    # A Hann window sees two ninths of the square of its width (1.5 lines) about the line: 1/6 of the second difference
    bend = np.abs(response[2:] - 2.0 * response[1:-1] + response[:-2]) * (bins / 1.5) ** 2 / 6.0
    known = np.isfinite(bend)
    blurred = known & (bend > 2.0 * error[1:-1])
    count, of = int(np.count_nonzero(blurred)), int(np.count_nonzero(known))
    if not count:
        return []
    share = float(np.max(bend[blurred] / np.abs(response[1:-1][blurred])))
    message = (
        f"at {count} of {of} frequencies the response bends within the resolution of {resolution:.3g} Hz: it is off "
        f"there by up to {100.0 * share:.2g} %, beyond its stated error"
    )
    return [Notice("response-resolution", message, float(count), 0.0, remedy="take longer segments")]


def response_of(
    matrix: CrossSpectra,
    *,
    lowest: float,
    highest: float,
    least_coherence: float = 0.0,
    channel: int = 1,
) -> ResponseFunction:
    """Return the response of ``channel`` to channel 0 of a spectral matrix; see :func:`response_function`."""
    freedom = matrix.degrees_of_freedom
    if freedom < 3.9:
        raise InputError(
            f"{freedom:.3g} degrees of freedom: one segment always has coherence 1",
            parameter="segment",
            remedy="take shorter segments or average bands",
        )
    wave = matrix.auto(0)
    with np.errstate(invalid="ignore", divide="ignore"):
        response = matrix.matrix[:, channel, 0] / wave
    coherence = matrix.coherence(0, channel)
    # Largest coherence of two unrelated records in 95 of 100 cases
    chance = 1.0 - 0.05 ** (2.0 / (freedom - 2.0))
    inside = (matrix.frequency >= lowest) & (matrix.frequency <= highest) & (wave > 0.0)
    coherent = inside & (coherence > max(chance, least_coherence))
    with np.errstate(invalid="ignore", divide="ignore"):
        relative = np.sqrt(np.maximum(1.0 - coherence, 0.0) / (np.maximum(coherence, 1e-12) * freedom))
    notices = []
    lost = int(np.count_nonzero(inside & ~coherent))
    if lost:
        message = (
            f"{lost} of {int(np.count_nonzero(inside))} frequencies are left out: their coherence is below "
            f"{max(chance, least_coherence):.2g}"
        )
        notices.append(Notice("coherence", message, float(lost), 0.0))
    estimate = np.where(coherent, response, np.nan)
    notices += _blur(estimate, relative * np.abs(response), matrix.resolution, matrix.frequency)
    return ResponseFunction(
        matrix.frequency,
        np.where(coherent, response, np.nan),
        coherence,
        np.where(coherent, relative * np.abs(response), np.nan),
        np.where(coherent, relative, np.nan),
        freedom,
        coherent,
        tuple(notices),
    )


@dataclass(frozen=True, eq=False)
class RigidMotion:
    """Planar motion of a body from its markers; equation [eq:records-markers]."""

    #: Sway of the reference point [m].
    sway: Array
    #: Heave of the reference point [m].
    heave: Array
    #: Rotation [rad], positive about +y: moves a point above the centre towards +x.
    roll: Array
    #: Root mean square distance of the markers from the rigid body [m]; NaN with two markers or fewer.
    residual: Array
    #: Markers seen at each instant; with fewer than two the motion is NaN.
    seen: NDArray[np.int64]
    notices: tuple[Notice, ...] = ()


def rigid_motion(markers: ArrayLike, reference: ArrayLike, *, centre: tuple[float, float]) -> RigidMotion:
    """Return sway, heave and roll from marker tracks by least squares over the markers seen; no small angles assumed.

    Parameters
    ----------
    markers : array_like, shape (instants, markers, 2)
        x and z of each marker [m]; NaN while it is hidden.
    reference : array_like, shape (markers, 2)
        Where the markers are with the body at rest [m].
    centre : tuple of float
        x and z of the reference point of the motion at rest, for instance the centre of gravity [m].

    Returns
    -------
    RigidMotion

    Raises
    ------
    InputError
        With fewer than two different markers.
    """
    q, p = np.asarray(markers, dtype=float), np.asarray(reference, dtype=float)
    if q.ndim != 3 or p.shape != q.shape[1:] or p.shape[-1] != 2:
        raise InputError(f"tracks of shape {q.shape} for markers of shape {p.shape}", parameter="markers")
    if p.shape[0] < 2 or float(np.ptp(p, axis=0).max()) == 0.0:
        raise InputError(f"{p.shape[0]} markers", parameter="markers", allowed="two or more at different places")
    good = np.isfinite(q).all(axis=2)
    seen = good.sum(axis=1)
    weight = np.where(good, 1.0, 0.0)[:, :, None]
    filled = np.where(good[:, :, None], q, 0.0)
    with np.errstate(invalid="ignore", divide="ignore"):
        mean_q = (filled * weight).sum(axis=1) / seen[:, None]
        mean_p = (p * weight).sum(axis=1) / seen[:, None]
        dq = np.where(good[:, :, None], q - mean_q[:, None], 0.0)
        dp = np.where(good[:, :, None], p - mean_p[:, None], 0.0)
        sine = np.sum(dq[:, :, 0] * dp[:, :, 1] - dq[:, :, 1] * dp[:, :, 0], axis=1)
        cosine = np.sum(dq[:, :, 0] * dp[:, :, 0] + dq[:, :, 1] * dp[:, :, 1], axis=1)
        roll = np.unwrap(np.where(seen >= 2, np.arctan2(sine, cosine), 0.0))
        c, s = np.cos(roll), np.sin(roll)
        arm = np.asarray(centre, dtype=float) - mean_p
        moved_x = mean_q[:, 0] + c * arm[:, 0] + s * arm[:, 1]
        moved_z = mean_q[:, 1] - s * arm[:, 0] + c * arm[:, 1]
        turned_x = c[:, None] * dp[:, :, 0] + s[:, None] * dp[:, :, 1]
        turned_z = -s[:, None] * dp[:, :, 0] + c[:, None] * dp[:, :, 1]
        misfit = np.where(good, (dq[:, :, 0] - turned_x) ** 2 + (dq[:, :, 1] - turned_z) ** 2, 0.0)
        residual = np.where(seen > 2, np.sqrt(misfit.sum(axis=1) / seen), np.nan)
    lost = seen < 2
    notices: tuple[Notice, ...] = ()
    if lost.any():
        message = (
            f"fewer than two markers are seen at {int(lost.sum())} of {seen.size} instants: the motion is missing there"
        )
        notices = (Notice("markers-hidden", message, float(lost.sum()), 0.0),)

    def known(values: Array) -> Array:
        return np.where(lost, np.nan, values)

    return RigidMotion(
        known(moved_x - centre[0]), known(moved_z - centre[1]), known(roll), residual, seen.astype(np.int64), notices
    )
