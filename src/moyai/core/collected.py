"""What a run has gathered so far, and the one way in which every structure closes it into a result."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any, Self

from moyai.core.at_once import at_once, threads
from moyai.core.groups import Groups
from moyai.core.headline import Criterion, Headline, judge
from moyai.core.progress import Progress
from moyai.core.results import Result, Status, make_provenance
from moyai.core.validity import IdentityCheck, Notice
from moyai.core.vocabulary import Vocabulary

if TYPE_CHECKING:
    import xarray as xr

STOPPED = "stopped by the user; groups that were finished are here"

_RANK = {"error": 0, "warning": 1, "information": 2}


class Collected:
    """What a run has so far; kept whole at every moment so that an interrupt loses only the step in hand.

    It grows while the run continues and is closed once, into the immutable :class:`~moyai.core.results.Result`.

    Attributes
    ----------
    groups : dict
        Datasets by their path in the result.
    checks, notices : list
        Identities and validity notices in the order in which they were found.
    failures : list of str
        What did not converge, one sentence each.
    on_the_safe_side : list of str
        Those of the failures that leave numbers which can only be smaller: a design that holds with them holds.
    interrupted : str
        Why the run ended early; empty when it did not.
    """

    def __init__(self) -> None:
        self.groups: dict[str, xr.Dataset] = {}
        self.checks: list[IdentityCheck] = []
        self.notices: list[Notice] = []
        self.failures: list[str] = []
        self.on_the_safe_side: list[str] = []
        self.interrupted = ""

    def take(self, steps: Iterable[None], stopped: str = STOPPED) -> None:
        """Go through the steps of a run; KeyboardInterrupt ends it with what there is.

        Parameters
        ----------
        steps : iterable of None
            One for each piece of work that stands in the groups when it is done.
        stopped : str
            What is said of a run that was interrupted.
        """
        try:
            for _ in steps:
                pass
        except KeyboardInterrupt:
            self.interrupted = self.interrupted or stopped

    def take_together(
        self, parts: Sequence[Callable[[Self, Progress], Iterator[None]]], progress: Progress, what: str
    ) -> Iterator[None]:
        """Go through the steps of parts that need nothing of each other, on all cores.

        What they gather stands in the order of the parts, as if they had been run one after the other.

        Parameters
        ----------
        parts : sequence of callable
            Each takes what it gathers into, and a listener; it gives its steps.
        progress : Progress
            Listener for all.
        what : str
            Name of the parts in reports of progress.
        """
        count = len(parts)
        progress(what, 0, count)
        if count < 2 or threads() < 2:
            for index, part in enumerate(parts):
                yield from part(self, progress)
                progress(what, index + 1, count)
            return
        own, ended = [type(self)() for _ in parts], []

        def work(number: int, heard: Progress) -> None:
            own[number].take(parts[number](own[number], heard))
            ended.append(number)
            heard(what, len(ended), count)

        try:
            at_once(work, count, progress)
        finally:
            for one in own:
                self.join(one)
        if any(one.interrupted for one in own):
            raise KeyboardInterrupt
        yield

    def join(self, other: Self) -> None:
        """Take over what a part of the run has gathered."""
        self.groups.update(other.groups)
        self.checks.extend(other.checks)
        self.notices.extend(other.notices)
        self.failures.extend(other.failures)
        self.on_the_safe_side.extend(other.on_the_safe_side)

    def status(self, fulfilled: str) -> tuple[Status, str]:
        """Return the status of the run and the sentence behind it.

        Parameters
        ----------
        fulfilled : str
            The sentence of a run of which nothing is to be said.
        """
        if self.interrupted:
            return "interrupted", self.interrupted
        broken = [f"identity fails: {check.name}" for check in self.checks if not check.passed]
        if self.failures or broken:
            return "not_converged", "; ".join([*self.failures, *broken])
        outside = [notice.message for notice in self.notices if notice.severity == "error"]
        if outside:
            return "outside_validity", outside[0]
        return "converged", fulfilled

    def _safe(self, status: Status) -> bool:
        """Whether what did not converge leaves numbers on the safe side alone."""
        sound = all(check.passed for check in self.checks)
        return status == "not_converged" and sound and set(self.failures) <= set(self.on_the_safe_side)

    def close(
        self,
        vocabulary: Vocabulary,
        attributes: Mapping[str, Any],
        seeds: Iterable[int] = (),
        *,
        notices: Iterable[Notice] | None = None,
        fulfilled: str = "all identities hold",
        headlines: Iterable[Headline] = (),
        criteria: Iterable[Criterion] = (),
        left_out: str = "",
    ) -> Result:
        """Close the run: names, status, message, notices by their weight, provenance.

        A variable that does not fit its declaration gives a notice, see :meth:`.Vocabulary.close`.

        Parameters
        ----------
        vocabulary : Vocabulary
            Names that the groups may carry.
        attributes : mapping
            Of the root group: ``title``, ``structure``, ``case_hash``, ``case_text`` and what the structure adds.
        seeds : iterable of int
            Seeds of the irregular seas.
        notices : iterable of Notice, optional
            In place of those that were collected, where the structure words them anew.
        fulfilled : str
            The sentence of a run of which nothing is to be said.
        headlines : iterable of Headline
            The numbers of the first page, the governing one first.
        criteria : iterable of Criterion
            What they are judged against.
        left_out : str
            What the case names and was not run; see :func:`moyai.core.headline.judge`.

        Raises
        ------
        VocabularyError
            When a group holds a name that is not declared, where names are held strictly.
        """
        import xarray as xr

        groups, undeclared = vocabulary.close(self.groups)
        status, message = self.status(fulfilled)
        numbers = tuple(headlines)
        known = {name: attributes[name] for name in ("title", "case_hash", "structure")}
        return Result(
            tree=Groups.of({"/": xr.Dataset(attrs=dict(attributes)), **groups}),  # type: ignore[arg-type]
            status=status,
            message=message,
            checks=tuple(self.checks),
            notices=by_weight([*(self.notices if notices is None else notices), *undeclared]),
            provenance=make_provenance(**known, seeds=list(seeds)),
            headlines=numbers,
            verdict=judge(numbers, criteria, computed=status == "converged" or self._safe(status), left_out=left_out),
        )


def by_weight(notices: Iterable[Notice]) -> tuple[Notice, ...]:
    """Return the first of equal messages, grave ones first."""
    seen: dict[str, Notice] = {}
    for notice in notices:
        seen.setdefault(notice.message, notice)
    return tuple(sorted(seen.values(), key=lambda item: _RANK.get(item.severity, len(_RANK))))


def most_severe(notices: Iterable[Notice]) -> list[Notice]:
    """Keep of each kind the notice farthest beyond its limit, or of largest value: one a sea, not one a wave."""
    kept: dict[str, Notice] = {}
    for notice in notices:
        known = kept.get(notice.code)
        if known is None or _excess(notice) > _excess(known):
            kept[notice.code] = notice
    return list(kept.values())


def _excess(notice: Notice) -> tuple[float, float]:
    limited = notice.value > 0.0 and notice.limit > 0.0
    return abs(math.log(notice.value / notice.limit)) if limited else 0.0, abs(notice.value)
