"""The draft of a case: its errors, its sliders, and the report of its cheap analyses. Runs in the worker process."""

from __future__ import annotations

import hashlib
import time
from collections.abc import Callable, Iterator, Mapping
from dataclasses import asdict, dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from moyai.app.edits import with_number
from moyai.app.folder import refuse_foreign_files
from moyai.app.sliders import sliders_of
from moyai.case.builder import build
from moyai.case.reader import case_of, like_checked
from moyai.case.yaml_reader import Document, parse_yaml
from moyai.core.errors import CaseError, Fault, MoyaiError
from moyai.core.kinds import structure_kind
from moyai.core.progress import Progress
from moyai.core.validity import Notice
from moyai.language.faults import spoken_fault

if TYPE_CHECKING:
    from moyai.case.reader import Case
    from moyai.core.results import Result
    from moyai.report.differences import Other

VERSION = 1
"""Version of the messages between server and page (docs/tutorial/app.md)."""
CHEAP: dict[str, tuple[tuple[str, ...], ...]] = {
    "breakwater": (("statics", "mooring"), ("statics", "frequency"), ("statics", "mooring", "frequency")),
    "curtain": (("statics",), ("impact",), ("statics", "impact")),
    "cage": (("statics",),),
    "network": (("statics",),),
    "units": (("statics",), ("statics", "frequency")),
    "member": (("forces",), ("sweep", "forces", "surface")),
}
"""Analyses of a draft by kind, of those of the case: the first that give what is on the screen, then the last."""
REGULAR_ONLY = ("member",)
"""Kinds whose drafts leave irregular seas out, where there are regular ones."""
PINNED = "pinned"
NOMINAL = (
    "nominal numbers only, at one water level, without drift, ranges, bands, other laws or speeds: "
    "the whole answer may judge otherwise"
)
ONE_LEVEL = "one water level only: the whole answer may judge otherwise"
_TEXT_LIMIT = 2_000_000

Run = Callable[..., "Result"]


@dataclass(frozen=True)
class Wish:
    """What is asked of the worker."""

    #: The case.
    text: str
    #: Where the case stands, or would stand.
    file: Path
    #: Folder out of which no file is read.
    root: Path
    #: Numbers to put at paths, in the unit as written.
    edits: Mapping[str, str] = field(default_factory=dict)
    #: Text of the case that is drawn faint under this one; empty for none.
    pinned: str = ""
    #: Other analyses than the cheap ones.
    analyses: tuple[str, ...] = ()
    #: Sections and figures of the report that are on the screen: the first draft has them.
    shown: tuple[str, ...] = ()
    #: Water level that is chosen there.
    level: str = ""


class Drafts:
    """Makes drafts; keeps pinned ones and coefficients that took long.

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
        self._pinned: dict[str, Other] = {}
        self._lacking: dict[str, set[str]] = {}

    def answer(self, wish: Wish, progress: Progress) -> Iterator[dict[str, Any]]:
        """Yield the case as read and checked, then its draft where it has no errors."""
        started = time.perf_counter()
        text, checked, document = wish.text, False, None
        try:
            if len(text) > _TEXT_LIMIT:
                raise CaseError([Fault(f"the text is longer than {_TEXT_LIMIT // 1_000_000} million characters")])
            document = parse_yaml(text, wish.file.name)
            for path, number in wish.edits.items():
                document = with_number(document, path, number)
            text = document.text
            refuse_foreign_files(wish.root, wish.file.parent, document.data)
            case = case_of(document, wish.file)
            drafts = stages_of(document, case.kind, wish.analyses)
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
                known = {} if document is None else {"sliders": _sliders_by_keys(document)}
                yield _checked(text, faults, (), **known)
            else:
                yield {"message": "not drawn", "faults": [asdict(spoken_fault(fault)) for fault in faults]}

    def _stages(self, drafts: list[Document], whole: Case, wish: Wish) -> Iterator[_Stage]:
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
                yield _Stage(
                    draft, case, nominal if alone is None else alone, ONE_LEVEL if nominal is None else NOMINAL
                )
            elif not last:
                yield _Stage(draft, case)
        yield _Stage(draft, case, last=True)

    def _drawn(self, stage: _Stage, whole: Document, wish: Wish, progress: Progress) -> dict[str, Any]:
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
        if wish.pinned and wish.pinned != whole.text:
            other = self._other(wish, document, progress)
            if other is not None:
                composed = _laid_over(composed, result, other)
        html, data = render_parts(composed)
        here = {*(slug(section.key) for section in composed.sections), *data["figures"]}
        if stage.last:  # what the whole report has not either is no want of its first drafts
            self._lacking = {key: names & here for key, names in self._lacking.items()}
        else:
            self._lacking.setdefault(_key_of(document), set()).update(shown - here)
        return {
            "message": "drawn",
            "analyses": list(document.data["analyses"]),
            "nominal": bool(stage.words),
            "left_out": document.data.get("waves") != whole.data.get("waves"),
            "status": result.status,
            "headlines": [headline.as_dict() for headline in result.headlines],
            "html": html,
            "data": data,
        }

    def _other(self, wish: Wish, shown: Document, progress: Progress) -> Other | None:
        from moyai.report.differences import Other
        from moyai.report.writer import compose_document

        mark = hashlib.sha256(repr((wish.pinned, wish.file, shown.data["analyses"])).encode()).hexdigest()
        if mark not in self._pinned:
            try:
                document = parse_yaml(wish.pinned, wish.file.name)
                refuse_foreign_files(wish.root, wish.file.parent, document.data)
                kind = case_of(document, wish.file).kind
                pinned = replace(document, data=_like(document, shown, kind, wish.analyses))
                result = self._run(case_of(pinned, wish.file), progress, keep=self._keep)
            except MoyaiError:
                return None
            while len(self._pinned) > 8:
                self._pinned.pop(next(iter(self._pinned)))
            self._pinned[mark] = Other(PINNED, result, compose_document(result))
        return self._pinned[mark]


@dataclass(frozen=True)
class _Stage:
    """What is run and drawn at once."""

    document: Document
    case: Case
    #: None for that of the case.
    problem: Any = None
    #: What is said of a problem that leaves something out.
    words: str = ""
    #: Whether it is the whole answer.
    last: bool = False


def _key_of(document: Document) -> str:
    return f"{document.data['structure']['kind']} {document.data['analyses']}"


def _like(document: Document, shown: Document, kind: str, analyses: tuple[str, ...]) -> dict[str, Any]:
    """Return the keys of a pinned case with the analyses of the draft that it is shown with."""
    return {**stages_of(document, kind, analyses)[-1].data, "analyses": shown.data["analyses"]}


def _laid_over(composed: Any, result: Result, other: Other) -> Any:
    """Return the report with the pinned one drawn faint in its figures, and the differences of the first page."""
    from moyai.report.differences import DIFFERENCES, headline_table
    from moyai.report.document import Section
    from moyai.report.overlay import lay_over, with_figures

    laid, _ = lay_over(composed, other.document, other.name)
    faint = f"({other.name})"
    laid = with_figures(
        laid,
        lambda figure: replace(
            figure, series=tuple(replace(one, faint=one.faint or one.label.endswith(faint)) for one in figure.series)
        ),
    )
    table = headline_table(result, other)
    if table is None:
        return laid
    first, *rest = laid.sections
    return replace(laid, sections=(first, Section(DIFFERENCES, "Differences", (table,)), *rest))


def stages_of(document: Document, kind: str, analyses: tuple[str, ...] = ()) -> list[Document]:
    """Return a case with its own cheap analyses, stage by stage; where it has none, with the first of its kind.

    Parameters
    ----------
    document : Document
    kind : str
    analyses : tuple of str
        Taken in place of the cheap ones, with all seas.
    """
    data = document.data
    if analyses:
        return [replace(document, data={**data, "analyses": list(analyses)})]
    stages = CHEAP.get(kind, ())
    own = data.get("analyses", [name for stage in stages[-1:] for name in stage])
    own = [own] if isinstance(own, str) else list(own)
    chosen: list[list[str]] = []
    for stage in stages:
        names = [name for name in own if name in stage]
        if names and names not in chosen:
            chosen.append(names)
    if not chosen:
        chosen = [[stages[0][0]]] if stages else [own[:1]]
    if kind in REGULAR_ONLY and isinstance(data.get("waves"), list):
        regular = [sea for sea in data["waves"] if isinstance(sea, dict) and sea.get("kind") == "regular"]
        data = {**data, "waves": regular or data["waves"]}
    return [replace(document, data={**data, "analyses": names}) for names in chosen]


def _sliders_by_keys(document: Document) -> list[dict[str, Any]]:
    """Return the sliders of a case that has errors, by the kind that it names."""
    structure = document.data.get("structure") if isinstance(document.data, dict) else None
    kind = structure.get("kind") if isinstance(structure, dict) else None
    return sliders_of(document, kind) if isinstance(kind, str) else []


def _checked(text: str, faults: Any, warnings: Any, **more: Any) -> dict[str, Any]:
    return {
        "message": "checked",
        "text": text,
        "faults": [asdict(spoken_fault(fault)) for fault in faults],
        "warnings": [asdict(spoken_fault(fault)) for fault in warnings],
        **more,
    }
