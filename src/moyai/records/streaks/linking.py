"""Link streaks into chains of one particle each, by where a streak says its particle will be next.

Positions are in the light sheet [m]. A streak gives its two ends but not which came first; both are tried, and the
chain's direction follows from the order of the frames or from the light of the pulses.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from moyai.core.arrays import Array, IntArray
from moyai.records.streaks.drift_velocity import StreakChain
from moyai.records.streaks.timing import LEAST_EVIDENCE, PulseTrain, direction_evidence


@dataclass(frozen=True, eq=False)
class WorldStreaks:
    """Streaks of one picture in the light sheet."""

    #: x, z of both ends [m]; shape (streaks, 2, 2).
    ends: Array
    #: Unit vectors of motion at both ends when going from the first to the second; shape (streaks, 2, 2).
    tangents: Array
    #: Logarithm of the light; shape (streaks,).
    light: Array

    @property
    def count(self) -> int:
        """Number of streaks."""
        return len(self.light)

    @property
    def middle(self) -> Array:
        """Midpoints [m]."""
        return np.asarray(self.ends.mean(axis=1))

    @property
    def vector(self) -> Array:
        """From the first to the second end [m]."""
        return np.asarray(self.ends[:, 1] - self.ends[:, 0])


@dataclass(frozen=True)
class LinkingSettings:
    """How far a streak may lie from where it is expected."""

    #: Share of the way between two streaks.
    relative: float = 0.2
    #: Further distance [m].
    absolute: float = 3e-4
    #: Most pulses in a row that a chain may lack.
    missing: int = 1


@dataclass(frozen=True, eq=False)
class LinkedChain:
    """A chain and the streaks that it is made of."""

    chain: StreakChain
    #: Picture of every streak, in the order of time.
    picture: IntArray
    #: Number of every streak in its picture.
    streak: IntArray
    #: Pulse that made it.
    pulse: IntArray
    #: Log-likelihood by which the direction is surer than its reverse; infinite where frames tell it.
    evidence: float


def link_frames(pictures: list[WorldStreaks], train: PulseTrain, settings: LinkingSettings) -> list[LinkedChain]:
    """Link streaks of successive frames, one pulse a frame [eq:streaks-link].

    Between two streaks a particle travels the mean of their velocities times the time between their middles; the sign
    of each velocity is free until a link fixes it. Each pair of frames is one assignment of least cost.
    """
    middle_time = train.start + 0.5 * train.duration
    sign = [np.zeros(item.count, dtype=np.int64) for item in pictures]
    next_of = [np.full((item.count, 2), -1, dtype=np.int64) for item in pictures]
    taken = [np.zeros(item.count, dtype=bool) for item in pictures]
    for reach in range(1, settings.missing + 2):
        for k in range(len(pictures) - reach):
            later = k + reach
            first = np.nonzero(next_of[k][:, 0] < 0)[0]
            second = np.nonzero(~taken[later])[0]
            if not first.size or not second.size:
                continue
            gap = middle_time[later] - middle_time[k]
            cost, signs = _frame_costs(
                pictures[k], pictures[later], first, second, train.duration[k], train.duration[later], gap,
                sign[k][first], sign[later][second], settings,
            )  # fmt: skip
            for i, j in _assign(cost):
                a, b = first[i], second[j]
                next_of[k][a] = (later, b)
                taken[later][b] = True
                sign[k][a], sign[later][b] = signs[i, j]
    chains = []
    for k in range(len(pictures)):
        for a in np.nonzero(~taken[k] & (next_of[k][:, 0] >= 0))[0]:
            steps = [(k, int(a))]
            while next_of[steps[-1][0]][steps[-1][1], 0] >= 0:
                last = next_of[steps[-1][0]][steps[-1][1]]
                steps.append((int(last[0]), int(last[1])))
            flips = [sign[f][s] < 0 for f, s in steps]
            ends = np.stack(
                [pictures[f].ends[s][::-1] if flip else pictures[f].ends[s] for (f, s), flip in zip(steps, flips)]
            )
            frame = np.array([f for f, _ in steps])
            chain = StreakChain(train.start[frame], train.end[frame], ends[:, 0], ends[:, 1])
            chains.append(LinkedChain(chain, frame, np.array([s for _, s in steps]), frame, np.inf))
    return chains


def _frame_costs(
    one: WorldStreaks,
    two: WorldStreaks,
    first: IntArray,
    second: IntArray,
    on_one: float,
    on_two: float,
    gap: float,
    known_one: IntArray,
    known_two: IntArray,
    settings: LinkingSettings,
) -> tuple[Array, IntArray]:
    """Return cost (infinite: impossible) and signs of every pair of streaks of two frames."""
    step = two.middle[second][None] - one.middle[first][:, None]
    way = np.hypot(step[..., 0], step[..., 1])
    v1, v2 = one.vector[first] / on_one, two.vector[second] / on_two
    best = np.full(way.shape, np.inf)
    signs = np.zeros((*way.shape, 2), dtype=np.int64)
    for s in (1, -1):
        for t in (1, -1):
            expected = 0.5 * gap * (s * v1[:, None] + t * v2[None])
            miss = np.hypot(*(step - expected).transpose(2, 0, 1))
            # The mean of the speeds is the way's true scale; turning orbits make the way itself short at times
            scale = 0.5 * gap * (np.hypot(*v1.T)[:, None] + np.hypot(*v2.T)[None])
            cost = miss / (settings.relative * scale + settings.absolute)
            allowed = (known_one[:, None] * s >= 0) & (known_two[None] * t >= 0)
            better = allowed & (cost < best)
            best[better] = cost[better]
            signs[better] = (s, t)
    light = np.abs(one.light[first][:, None] - two.light[second][None])
    total = best + 0.15 * np.minimum(light, 4.0)
    return np.where(best < 1.0, total, np.inf), signs


def _assign(cost: Array) -> list[tuple[int, int]]:
    """Return pairs of least total cost (the Hungarian method); impossible ones are left out."""
    from scipy.optimize import linear_sum_assignment

    finite = np.where(np.isfinite(cost), cost, 1e3)
    rows, columns = linear_sum_assignment(finite)
    return [(int(i), int(j)) for i, j in zip(rows, columns) if np.isfinite(cost[i, j])]


def link_exposure(streaks: WorldStreaks, train: PulseTrain, settings: LinkingSettings) -> tuple[list[LinkedChain], int]:
    """Link the streaks of one picture that holds all pulses, and give each chain its direction by the light.

    Returns
    -------
    chains : list of LinkedChain
    undecided : int
        Chains of four streaks and more whose direction the light does not give.
    """
    partner = _join_ends(streaks, train, settings)
    chains: list[LinkedChain] = []
    undecided = 0
    for path, entries, steps in _paths(partner, streaks.count):
        if len(path) < 4:
            continue
        light = streaks.light[path]
        evidence, first, forward = direction_evidence(light, steps, train)
        if evidence < LEAST_EVIDENCE:
            undecided += 1
            continue
        place = np.concatenate([[0], np.cumsum(steps)]).astype(np.int64)
        ends = np.stack([streaks.ends[s] if e == 0 else streaks.ends[s][::-1] for s, e in zip(path, entries)])
        index = np.array(path)
        if not forward:
            index, ends, place = index[::-1], ends[::-1, ::-1], place[-1] - place[::-1]
        pulse = first + place
        chain = StreakChain(train.start[pulse], train.end[pulse], ends[:, 0], ends[:, 1])
        chains.append(LinkedChain(chain, np.zeros(len(index), dtype=np.int64), index, pulse, evidence))
    return chains, undecided


def _join_ends(
    streaks: WorldStreaks, train: PulseTrain, settings: LinkingSettings
) -> dict[int, tuple[int, int, float]]:
    """Return for joined ends (2 * streak + end) their partner, the pulses between, and the cost [eq:streaks-link]."""
    count = streaks.count
    if count == 0:
        return {}
    from scipy.spatial import cKDTree

    points = streaks.ends.reshape(-1, 2)
    length = np.repeat(np.hypot(*streaks.vector.T), 2)
    # Leaving through the second end keeps the tangent, leaving through the first one turns it round
    outward = (streaks.tangents * np.array([-1.0, 1.0])[None, :, None]).reshape(-1, 2)
    tree = cKDTree(points)
    partner: dict[int, tuple[int, int, float]] = {}
    for reach in range(1, settings.missing + 2):
        rules = _gap_rules(train, reach)
        free = np.array([end not in partner for end in range(2 * count)])
        ratio = max(rule[0] / min(rule[1], rule[2]) for rule in rules)
        farthest = 1.3 * ratio * float(np.percentile(length, 98.0)) + settings.absolute
        pairs = tree.query_pairs(farthest, output_type="ndarray")
        if not len(pairs):
            continue
        pairs = pairs[(pairs[:, 0] // 2 != pairs[:, 1] // 2) & free[pairs[:, 0]] & free[pairs[:, 1]]]
        i, j = pairs[:, 0], pairs[:, 1]
        gap = points[j] - points[i]
        cost = np.full(len(pairs), np.inf)
        for off, on_i, on_j in rules:
            speed_i, speed_j = length[i] / on_i, length[j] / on_j
            expected = 0.5 * off * (speed_i[:, None] * outward[i] - speed_j[:, None] * outward[j])
            scale = 0.5 * off * (speed_i + speed_j)
            miss = np.hypot(*(gap - expected).T) / (1.5 * settings.relative * scale + settings.absolute)
            # A particle changes its speed little from one pulse to the next
            uneven = np.abs(np.log(speed_i / speed_j)) / 0.8
            cost = np.minimum(cost, miss + 0.3 * uneven**2)
        likely = cost < 1.0
        partner.update(_match(i[likely], j[likely], cost[likely], reach))
    return partner


def _gap_rules(train: PulseTrain, reach: int) -> set[tuple[float, float, float]]:
    """Return every (dark time, on-time before, on-time after) between pulses ``reach`` apart, both ways round."""
    rules = set()
    for k in range(train.count - reach):
        dark = round(float(train.start[k + reach] - train.end[k]), 9)
        before, after = round(float(train.duration[k]), 9), round(float(train.duration[k + reach]), 9)
        rules |= {(dark, before, after), (dark, after, before)}
    return rules


def _match(i: IntArray, j: IntArray, cost: Array, reach: int) -> dict[int, tuple[int, int, float]]:
    """Return partners: the assignment of least cost in every group of ends, kept where it is mutual."""
    from scipy.optimize import linear_sum_assignment
    from scipy.sparse import coo_matrix
    from scipy.sparse.csgraph import connected_components

    if not len(i):
        return {}
    size = int(max(i.max(), j.max())) + 1
    graph = coo_matrix((np.ones(len(i)), (i, j)), shape=(size, size))
    label = connected_components(graph, directed=False)[1]
    found: dict[int, tuple[int, int, float]] = {}
    order = np.argsort(label[i], kind="stable")
    for group in np.split(order, np.nonzero(np.diff(label[i][order]))[0] + 1):
        ends = np.unique(np.concatenate([i[group], j[group]]))
        table = np.full((len(ends), len(ends)), 2.0)
        a, b = np.searchsorted(ends, i[group]), np.searchsorted(ends, j[group])
        table[a, b] = table[b, a] = cost[group]
        # Staying alone costs a little more than the worst link that is allowed
        np.fill_diagonal(table, 1.05)
        chosen = linear_sum_assignment(table)[1]
        for k, other in enumerate(chosen):
            if k < other and chosen[other] == k and table[k, other] < 1.0:
                found[int(ends[k])] = (int(ends[other]), reach, float(table[k, other]))
                found[int(ends[other])] = (int(ends[k]), reach, float(table[k, other]))
        for item in group[np.argsort(cost[group])]:
            # A ring of choices that is not mutual is settled from its best link down
            first, second = int(i[item]), int(j[item])
            if first not in found and second not in found:
                found[first] = (second, reach, float(cost[item]))
                found[second] = (first, reach, float(cost[item]))
    return found


def _paths(partner: dict[int, tuple[int, int, float]], count: int) -> list[tuple[list[int], list[int], IntArray]]:
    """Return open chains: streaks, the end each is entered by, pulses between; rings are cut at their worst link."""
    joined = dict(partner)
    seen = np.zeros(count, dtype=bool)

    def walk(end: int) -> tuple[list[int], list[int], list[int], list[int]]:
        path, entries = [end // 2], [end % 2]
        steps: list[int] = []
        exits: list[int] = []
        while True:
            leave = 2 * path[-1] + 1 - entries[-1]
            if leave not in joined:
                return path, entries, steps, exits
            other, reach, _ = joined[leave]
            if other // 2 == path[0]:
                return path, entries, steps, [*exits, leave]
            exits.append(leave)
            steps.append(reach)
            path.append(other // 2)
            entries.append(other % 2)

    for streak in range(count):
        path, _, _, exits = walk(2 * streak)
        if len(exits) == len(path) and len(path) > 1:
            worst = max(exits, key=lambda leave: joined[leave][2])
            other = joined.pop(worst)[0]
            joined.pop(other, None)
    found = []
    for streak in range(count):
        for entry in (0, 1):
            end = 2 * streak + entry
            if end in joined or seen[streak]:
                continue
            path, entries, steps, _ = walk(end)
            if seen[path[-1]]:
                continue
            seen[path] = True
            found.append((path, entries, np.array(steps, dtype=np.int64)))
    return found
