"""The draft of a case: its errors, its sliders, and the report of its cheap analyses. Runs in the worker process."""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Iterator
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from moyai.app.folder import refuse_foreign_files
from moyai.app.messages import Wish
from moyai.app.pins import Pinned, Run
from moyai.app.stages import stages_of
from moyai.case.builder import build
from moyai.case.reader import case_of, like_checked
from moyai.case.sliders import sliders_of
from moyai.case.text_numbers import with_number
from moyai.case.yaml_reader import CaseDocument, parse_yaml
from moyai.core.errors import CaseError, Fault, MoyaiError
from moyai.core.kinds import kind_named, structure_kind
from moyai.core.progress import Progress
from moyai.core.validity import Notice
from moyai.language.faults import spoken_fault

if TYPE_CHECKING:
    from moyai.case.reader import Case

NOMINAL = (
    "nominal numbers only, at one water level, without drift, ranges, bands, other laws or speeds: "
    "the whole answer may judge otherwise"
)
ONE_LEVEL = "one water level only: the whole answer may judge otherwise"
_TEXT_LIMIT = 2_000_000


class Drafts:
    """Makes drafts; keeps pinned states and coefficients that took long.

    Parameters
    ----------
    run : callable
        ``run(case, progress, keep=folder, problem=problem)`` gives the result of a case, or of a problem in its place.
    keep : Path
        Folder of coefficients.
    rest : callable
        Called before every stage but the first; raises KeyboardInterrupt where something newer is waiting.
    """

    def __init__(self, run: Run, keep: Path, rest: Callable[[], None] = lambda: None) -> None:
        self._run = run
        self._keep = keep
        self._rest = rest
        self._pinned = Pinned(run, keep)
        self._last: CaseDocument | None = None
        self._lacking: dict[str, set[str]] = {}
        self._complete: dict[str, set[str]] = {}

    def answer(self, wish: Wish, progress: Progress) -> Iterator[dict[str, Any]]:
        """Yield the case as read and checked, then its draft where it has no errors."""
        started = time.perf_counter()
        text, checked = wish.text, False
        document: CaseDocument | None = None
        try:
            if len(text) > _TEXT_LIMIT:
                raise CaseError([Fault(f"the text is longer than {_TEXT_LIMIT // 1_000_000} million characters")])
            document = self._last
            if document is None or (document.text, document.file) != (text, wish.file.name):
                document = parse_yaml(text, wish.file.name)
            for path, number in wish.edits.items():
                document = with_number(document, path, number)
            self._last, text = document, document.text
            refuse_foreign_files(wish.root, wish.file.parent, document)
            case = case_of(document, wish.file)
            drafts = stages_of(document, case.kind)
            sliders = sliders_of(document, case.kind, drafts[-1].data)
            yield _checked(text, (), case.warnings, sliders=sliders, kind=case.kind, title=case.title)
            checked = True
            for place, stage in enumerate(self._stages(drafts, case, wish)):
                if place > 0:
                    self._rest()
                report = self._drawn(stage, document, wish, progress)
                yield {**report, "last": stage.last, "seconds": round(time.perf_counter() - started, 4)}
        except MoyaiError as error:
            faults = error.faults if isinstance(error, CaseError) else (error.fault,)
            if not checked:
                # The sliders stay, so that a number that went too far can be moved back
                kind = "" if document is None else kind_named(document.data)
                more = {"sliders": sliders_of(document, kind)} if document is not None and kind else {}
                yield _checked(text, faults, (), **more)
            else:
                yield {"message": "not drawn", "faults": [asdict(spoken_fault(fault)) for fault in faults]}

    def _stages(self, drafts: list[CaseDocument], whole: Case, wish: Wish) -> Iterator[_DraftStage]:
        """Yield what is drawn one after the other: a draft of what is on the screen, at last the whole answer."""
        first = next(
            (one for one in drafts if not self._lacking.get(_key_of(one), set()) & set(wish.shown)), drafts[-1]
        )
        for draft in [first] if first is drafts[-1] else [first, drafts[-1]]:
            case, last = like_checked(whole, draft), draft is drafts[-1]
            if last and wish.shown and first is not draft:
                break  # what is on the screen is drawn; the whole follows at once
            kind, problem = structure_kind(case.kind), build(case)
            nominal = kind.nominal(problem, wish.shown)
            alone = kind.at_level(problem if nominal is None else nominal, wish.level)
            if alone is not None or nominal is not None:
                words = ONE_LEVEL if nominal is None else NOMINAL
                yield _DraftStage(draft, case, drafts[-1], nominal if alone is None else alone, words)
            elif not last:
                yield _DraftStage(draft, case, drafts[-1])
        yield _DraftStage(draft, case, draft, last=True)

    def _drawn(self, stage: _DraftStage, whole: CaseDocument, wish: Wish, progress: Progress) -> dict[str, Any]:
        from moyai.report.differences import with_pinned
        from moyai.report.encoding import slug
        from moyai.report.html import render_parts
        from moyai.report.writer import compose_document

        document = stage.document
        result = self._run(stage.case, progress, keep=self._keep, problem=stage.problem)
        if result.status == "interrupted":
            raise KeyboardInterrupt
        if stage.words:
            result = result.with_notices(Notice("draft", stage.words, severity="warning"))
        shown = set(wish.shown)
        composed = compose_document(result, only=None if stage.last or not shown else shown)
        pins = [pin for pin in wish.pins if pin.text != whole.text]
        others = self._pinned.of(pins, wish, stage.whole, progress if stage.last else None)
        if others:
            composed = with_pinned(composed, result, others)
            if shown and not stage.last:
                composed = replace(composed, sections=tuple(one for one in composed.sections if one.key in shown))
        html, data = render_parts(composed)
        self._learn(
            _key_of(document), {*(slug(one.key) for one in composed.sections), *data["figures"]}, shown, stage.last
        )
        return {
            "message": "drawn",
            "analyses": list(document.data["analyses"]),
            "nominal": bool(stage.words),
            "left_out": document.data.get("waves") != whole.data.get("waves"),
            "status": result.status,
            "headlines": [_finite(headline.as_dict()) for headline in result.headlines],
            "html": html,
            "data": data,
        }

    def _learn(self, key: str, here: set[str], shown: set[str], last: bool) -> None:
        """Remember which sections and figures of the whole report the analyses of a draft do not give."""
        if last:
            for draft, own in self._complete.items():
                self._lacking[draft] = here - own
            # what the whole report has not either is no want of its first drafts
            self._lacking = {draft: names & here for draft, names in self._lacking.items()}
        elif shown:
            self._lacking.setdefault(key, set()).update(shown - here)
        else:
            self._complete[key] = here


@dataclass(frozen=True)
class _DraftStage:
    """What is run and drawn at once."""

    document: CaseDocument
    case: Case
    #: With the analyses of the whole answer.
    whole: CaseDocument
    #: None for that of the case.
    problem: Any = None
    #: What is said of a problem that leaves something out.
    words: str = ""
    #: Whether it is the whole answer.
    last: bool = False


def _key_of(document: CaseDocument) -> str:
    return f"{document.data['structure']['kind']} {document.data['analyses']}"


def _checked(text: str, faults: Any, warnings: Any, **more: Any) -> dict[str, Any]:
    return {
        "message": "checked",
        "text": text,
        "faults": [asdict(spoken_fault(fault)) for fault in faults],
        "warnings": [asdict(spoken_fault(fault)) for fault in warnings],
        **more,
    }


def _finite(value: Any) -> Any:
    """Return a value with None where a number is not finite."""
    if isinstance(value, dict):
        return {key: _finite(item) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [_finite(item) for item in value]
    return None if isinstance(value, float) and not math.isfinite(value) else value
