"""The joint of bodies and network: both try the same step until they agree on the reaction."""

from __future__ import annotations

import itertools
from collections.abc import Sequence

import numpy as np

from moyai.core.arrays import Array
from moyai.core.attachment import PointCarrier, PointNetwork
from moyai.core.errors import ConvergenceError

#: Passes of one step before it is cut in two, and how often a step is cut.
MOST_PASSES, MOST_CUTS = 12, 10
#: Differences of passes that the quasi-Newton step looks back on.
MEMORY = 6
#: Bodies that are lighter than what hangs on their points: once a step was cut so often, so many passes that look back
#: on all of their step.
PATIENT_CUTS, PATIENT_PASSES = 3, 40


class Joint:
    """Bodies and network held together.

    A step is tried with a reaction continued from the last ones; the network gives the reaction that the bodies' path
    really gives, and so on until both agree within ``tolerance`` of the largest reaction so far. From the third pass
    on a quasi-Newton step (Anderson 1965) replaces the plain repetition, which converges like stiffness times step
    squared over mass. What disagreement is left is added to the next step's reaction, so that no impulse is lost
    [eq:coupled-carry].

    Parameters
    ----------
    carriers : sequence of PointCarrier
    network : PointNetwork
    tolerance : float
        Disagreement over the largest reaction so far.
    least : float
        Reaction that the tolerance refers to at least [N] (slack lines pull with nothing).
    """

    def __init__(
        self, carriers: Sequence[PointCarrier], network: PointNetwork, tolerance: float, *, least: float = 0.0
    ) -> None:
        self.carriers, self.network, self.tolerance = list(carriers), network, tolerance
        self.sizes = [len(carrier.points) for carrier in carriers]
        self.ends = np.cumsum(self.sizes)
        count = int(sum(self.sizes))
        self.reaction, self.before, self.carry = np.zeros((2, count, 3)), np.zeros((2, count, 3)), np.zeros((count, 3))
        self.largest, self.passes, self.steps = least, 0, 0
        self.length = 0.0
        #: Passes that a step is given, and those that the last one took
        self.patience, self.last_passes = MOST_PASSES, 0
        #: Work exchanged at the points, all of it positive, work given and not taken [J], impulse owed [N s]
        self.work, self.lost, self.impulse = 0.0, 0.0, 0.0
        self.oldest, self.slips = np.zeros((2, count, 3)), np.zeros(2)
        #: How guesses moved and misses changed in the last passes, the newest in the last row, and how many are known
        self.differences, self.known = np.zeros((2, MEMORY, 6 * count)), 0

    @property
    def lost_impulse(self) -> float:
        """Impulse that is owed at the end, over the largest reaction times a step."""
        return self.impulse / max(self.largest * self.length, 1e-300)

    @property
    def lost_work(self) -> float:
        """Work that was given and not taken at the points, over the work exchanged."""
        return abs(self.lost) / max(self.work, 1e-300)

    def _bodies_try(self, end: float, reaction: Array) -> tuple[Array, Array]:
        moved = []
        first = 0
        for carrier, last in zip(self.carriers, self.ends, strict=True):
            moved.append(carrier.try_step(end, reaction[:, first:last]))
            first = int(last)
        if not moved:
            return np.zeros((0, 3)), np.zeros((0, 3))
        return np.concatenate([place for place, _ in moved]), np.concatenate([speed for _, speed in moved])

    def places(self) -> tuple[Array, Array]:
        """Return place and velocity of all points now."""
        found = [carrier.place_and_velocity() for carrier in self.carriers]
        if not found:
            return np.zeros((0, 3)), np.zeros((0, 3))
        return np.concatenate([place for place, _ in found]), np.concatenate([speed for _, speed in found])

    def advance(self, end: float, cuts: int = 0) -> None:
        """Move everything to ``end`` [s].

        Raises
        ------
        ConvergenceError
            When bodies and network do not agree even in the smallest steps.
        """
        begin = self.network.time
        length = end - begin
        patient = PATIENT_PASSES if cuts >= PATIENT_CUTS else self.patience
        agreed = self._agree(end, length, patient)
        if agreed and patient > self.patience and self.last_passes > MOST_PASSES:
            # more would have been needed before the cuts: the next steps are given them at once
            self.patience = patient
        if not agreed:
            if cuts >= MOST_CUTS:
                raise ConvergenceError(
                    "bodies and network do not agree on their reaction",
                    remedy="a shorter step of the bodies, or lighter points where lines meet a body",
                )
            middle = begin + 0.5 * length
            self.advance(middle, cuts + 1)
            self.advance(end, cuts + 1)

    def _agree(self, end: float, length: float, patience: int) -> bool:
        """Try one step in so many passes; accept it and return whether both sides agree."""
        guess = self.reaction.copy()
        forecasts: list[Array] = []
        if self.length > 0.0:
            forecasts = self._forecasts(length)
            guess[0] = forecasts[int(np.argmin(self.slips))]
            guess[1] *= length / self.length
            owed = self.carry * self.length / length
        else:
            owed = np.zeros_like(self.carry)
        start = self.places()
        inputs: list[Array] = []
        misses: list[Array] = []
        settled = False
        for self.last_passes in range(1, patience + 1):
            given = guess.copy()
            given[0] += owed
            place, speed = self._bodies_try(end, given)
            answer = self.network.try_step(end, place, speed)
            self.passes += 1
            miss = answer - guess
            size = float(np.max(np.abs(answer[0]), initial=0.0))
            wanted = self.tolerance * max(self.largest, size)
            if not np.isfinite(miss).all():
                return False
            if float(np.max(np.abs(miss), initial=0.0)) <= wanted:
                settled = True
                break
            inputs.append(guess.ravel().copy())
            misses.append(miss.ravel().copy())
            guess = self._better(inputs, misses).reshape(guess.shape)
        if not settled:
            return False
        if forecasts:
            # which forecast was better of late: smooth reactions like the curved one, ringing ones the straight one
            slips = np.array([float(np.max(np.abs(answer[0] - item), initial=0.0)) for item in forecasts])
            self.slips = 0.7 * self.slips + 0.3 * slips
        self._remember(inputs, misses, guess, miss)
        self._book(start, (place, speed), given, answer, length)
        self.impulse = float(np.max(np.abs(miss[0]), initial=0.0)) * length
        for carrier in self.carriers:
            carrier.accept()
        self.network.accept()
        self.oldest, previous, self.reaction = self.before, self.reaction, answer
        self.before = previous if self.length > 0.0 else answer.copy()
        if self.length == 0.0:
            self.oldest = answer.copy()
        self.carry = miss[0]
        self.largest, self.length, self.steps = max(self.largest, size), length, self.steps + 1
        return True

    def _forecasts(self, length: float) -> list[Array]:
        """Return means of the reaction continued straight and along a parabola."""
        last, before, oldest = self.reaction[0], self.before[0], self.oldest[0]
        share = length / self.length
        straight = last + (last - before) * 0.5 * (1.0 + share)
        return [straight, straight + (last - 2.0 * before + oldest) * 0.5 * (1.0 + share) * share]

    def _remember(self, inputs: list[Array], misses: list[Array], guess: Array, miss: Array) -> None:
        """Keep how the misses answered to the guesses of this step, for the next one."""
        found = np.array([[*inputs, guess.ravel()], [*misses, miss.ravel()]])
        steps = np.diff(found, axis=1)
        self.differences = np.concatenate([self.differences, steps], axis=1)[:, -MEMORY:]
        self.known = min(self.known + steps.shape[1], MEMORY)

    def _better(self, inputs: list[Array], misses: list[Array]) -> Array:
        """Return the next guess: the step that would cancel the miss if misses were linear, as far as known."""
        moved = [b - a for a, b in itertools.pairwise(inputs)]
        change = [b - a for a, b in itertools.pairwise(misses)]
        if len(inputs) < 4:
            # what earlier steps taught, until this one has taught enough
            known = self.differences[:, MEMORY - self.known :]
            moved, change = [*known[0], *moved], [*known[1], *change]
        if not moved:
            return inputs[-1] + misses[-1]
        look = MEMORY if len(inputs) <= MOST_PASSES else len(inputs)
        steps, answers = np.stack(moved[-look:], axis=1), np.stack(change[-look:], axis=1)
        weight, *_ = np.linalg.lstsq(answers, misses[-1], rcond=1e-6)
        return np.asarray(inputs[-1] + misses[-1] - (steps + answers) @ weight)

    def _book(
        self, start: tuple[Array, Array], end: tuple[Array, Array], given: Array, answer: Array, length: float
    ) -> None:
        """Add up the work of both reactions along the cubic of the points, and the impulse that is owed."""
        moved, turned = end[0] - start[0], length / 6.0 * (end[1] - start[1])
        taken = np.sum(given[0] * moved + given[1] * turned)
        offered = np.sum(answer[0] * moved + answer[1] * turned)
        self.lost += float(offered - taken)
        self.work += 0.5 * float(np.sum(np.abs(answer[0] * moved)))
