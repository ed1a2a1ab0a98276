"""The kinds of structures and of records: one object each, found by name.

A kind is one folder. Its ``__init__`` exports one object ``KIND`` that imports its parts when they are asked for;
case files, reports and the command line reach a structure through that object only. A structure of another package is
found by the entry-point group ``moyai.structures``: name of the kind = "package.module:KIND".
"""

from __future__ import annotations

import re
from abc import ABC, abstractmethod
from collections.abc import Collection, Iterable, Mapping
from dataclasses import replace
from functools import cache
from importlib import import_module
from importlib.metadata import entry_points
from importlib.resources import files
from pathlib import Path
from typing import TYPE_CHECKING, Any

from moyai.core.errors import InputError

if TYPE_CHECKING:
    import xarray as xr

    from moyai.core.progress import Progress
    from moyai.core.results import Result
    from moyai.core.vocabulary import Vocabulary

GROUP = "moyai.structures"

_STRUCTURES = ("breakwater", "curtain", "cage", "network", "member", "units")
_FURTHER = {
    "records": "moyai.records.survey",
    "nets": "moyai.records.nets",
    "streaks": "moyai.records.streaks",
    "snap_runs": "moyai.records.snaps",
    "force_record": "moyai.records.forces",
    "comparison": "moyai.records.comparison",
    "study": "moyai.study.report",
    "fit": "moyai.study.report.fit",
    "reproduction": "moyai.reproduce.stored",
}


class Kind(ABC):
    """What produces results of one kind: they carry its name as attribute ``structure``."""

    name: str
    #: Module that holds the templates
    package: str
    #: Commented files to start from: name for ``moyai new`` and file within the package
    templates: tuple[tuple[str, str], ...] = ()

    def vocabulary(self) -> Vocabulary | None:
        """Return the names that results of this kind may carry; None where the user's file makes them."""
        return None

    def vocabulary_of(self, root: Mapping[Any, Any]) -> Vocabulary | None:
        """Return the names that one result may carry, by its root attributes, where the kind has several models.

        Parameters
        ----------
        root : mapping
            Attributes of the root of the result's tree.
        """
        return self.vocabulary()

    @abstractmethod
    def compose(self, result: Result) -> Any:
        """Return the report of a result, a :class:`moyai.report.document.Document`.

        Parameters
        ----------
        result : Result
            Of this kind.
        """

    def file_schema(self, name: str) -> Any:
        """Return the root schema of the user's file that :attr:`templates` holds under this name.

        A subclass of :class:`moyai.case.schema_types.Block`.

        Parameters
        ----------
        name : str
            Key of :attr:`templates`.

        Raises
        ------
        NotImplementedError
            For a kind that does not say it.
        """
        raise NotImplementedError(name)

    def template(self, name: str) -> str:
        """Return the text of one of :attr:`templates`.

        Parameters
        ----------
        name : str
            Key of :attr:`templates`.

        Raises
        ------
        KeyError
            When there is none of that name.
        """
        return (files(self.package) / dict(self.templates)[name]).read_text(encoding="utf-8")


class StructureKind(Kind):
    """A kind of structure: from the keys of its case file to its report.

    Types of :mod:`moyai.case` stand above this module; they are named in the docstrings.
    """

    #: Path in the case file and name of the numbers that a design is tried with, the most wanted first; those of site,
    #: current and sea follow of themselves
    numbers: tuple[tuple[str, str], ...] = ()
    #: Analyses of a draft, those of a case among them: the first that give what is on the screen, then the last
    drafts: tuple[tuple[str, ...], ...] = ()
    #: Whether drafts leave irregular seas out where there are regular ones
    drafts_of_regular_seas = False

    @abstractmethod
    def schema(self) -> Any:
        """Return the root schema of the case files, a subclass of :class:`moyai.case.schema_types.Block`."""

    def file_schema(self, name: str) -> Any:
        """Return :meth:`schema`: all templates of a structure are case files.

        Parameters
        ----------
        name : str
            Plays no part.
        """
        return self.schema()

    def keys(self) -> Mapping[str, str]:
        """Return where parameters of the physics stand in the case file (:data:`moyai.case.findings.KEYS`)."""
        return {}

    def criteria(self, model: Any, given: Any) -> Any:
        """Yield what the headlines are judged against (:class:`moyai.core.headline.Criterion`); nothing by default.

        Parameters
        ----------
        model : Block
            The case, as its schema holds it.
        given : Any
            Block ``criteria`` of the case.
        """
        return ()

    def add_sizes(self, model: Any, sizes: Any, periods: Any) -> None:
        """Add sizes that numbers of a case are compared with (:mod:`moyai.case.plausible_sizes`); none by default.

        Parameters
        ----------
        model : Block
            The case, as its schema holds it.
        sizes : Any
            Values in SI units with the keys that each follows from, by path; added to.
        periods : Any
            Periods [s] with their keys; added to.
        """

    @abstractmethod
    def check(self, model: Any, findings: Any, folder: Path) -> None:
        """Record errors and warnings beyond the schema in a :class:`moyai.case.findings.Findings`.

        Parameters
        ----------
        model : Block
            The case, as its schema holds it.
        findings : Findings
            What the errors and warnings are added to.
        folder : Path
            That paths in the case are relative to.
        """

    @abstractmethod
    def build(self, model: Any, folder: Path, *, case_text: str, case_hash: str) -> Any:
        """Return the problem of a case, in SI units and radians, frozen.

        Parameters
        ----------
        model : Block
            The case, as its schema holds it.
        folder : Path
            That paths in the case are relative to.
        case_text : str
            Of the file, for the provenance.
        case_hash : str
            Of that text.
        """

    @abstractmethod
    def derived(self, case: Any) -> Any:
        """Return the numbers that ``moyai check`` shows, a tuple of :class:`moyai.case.derived.Number`.

        Parameters
        ----------
        case : Case
            Checked.
        """

    def nominal(self, problem: Any, shown: Collection[str] = ()) -> Any | None:
        """Return a problem without what only states how far its answer varies: ranges, bands, other laws, other speeds.

        For a first draft, marked as such; ``shown`` names the sections of the report that are looked at, all where it
        is empty. None where there is nothing to leave out.

        Parameters
        ----------
        problem : Any
            As :meth:`build` returns it.
        shown : collection of str
            Sections of the report.
        """
        return None

    def at_level(self, problem: Any, level: str) -> Any | None:
        """Return a problem with one of its water levels alone, for a first draft; None where it has no more than one.

        ``level`` is its name or words of a report that begin with it; the first where it has no such level.

        Parameters
        ----------
        problem : Any
            As :meth:`build` returns it.
        level : str
            Name of a water level.
        """
        levels = dict(getattr(getattr(problem, "environment", None), "water_levels", ()))
        if len(levels) < 2:
            return None
        name = level_of_words(levels, level)
        return replace(problem, environment=replace(problem.environment, water_levels=((name, levels[name]),)))

    @abstractmethod
    def run(self, problem: Any, progress: Progress, keep: Path | None) -> Result:
        """Run all analyses of a problem; what took long is kept in the folder ``keep`` for the next run.

        Parameters
        ----------
        problem : Any
            As :meth:`build` returns it.
        progress : Progress
            Called with how far the run is.
        keep : Path or None
            Nothing is kept without it.
        """


def level_of_words(names: Iterable[str], words: str) -> str:
    """Return the water level with whose name some words begin, the first where there is none."""
    known = list(names)
    fitting = [name for name in known if re.match(rf"{re.escape(name)}(?!\w)", words)]
    return max(fitting, key=len) if fitting else known[0]


class FolderKind(StructureKind):
    """A kind of structure in a folder of the usual shape, whose parts are imported when they are asked for.

    A kind in which a part stands elsewhere, or needs more, brings its own method for it.
    """

    #: Class in ``case/schema.py``.
    root_schema: str

    def part(self, module: str, name: str) -> Any:
        """Return what a module of the folder defines."""
        return getattr(import_module(f"{self.package}.{module}"), name)

    def vocabulary(self) -> Vocabulary:
        found: Vocabulary = self.part("variables", "VOCABULARY")
        return found

    def compose(self, result: Result) -> Any:
        return self.part("report.page", "compose")(result)

    def schema(self) -> Any:
        return self.part("case.schema", self.root_schema)

    def keys(self) -> Mapping[str, str]:
        found: Mapping[str, str] = self.part("case.keys", "KEYS")
        return found

    def criteria(self, model: Any, given: Any) -> Any:
        return self.part("case.criteria", "criteria")(model, given)

    def add_sizes(self, model: Any, sizes: Any, periods: Any) -> None:
        self.part("case.sizes", "add_sizes")(model, sizes, periods)

    def check(self, model: Any, findings: Any, folder: Path) -> None:
        self.part("case.check", "check")(model, findings, folder)

    def build(self, model: Any, folder: Path, *, case_text: str, case_hash: str) -> Any:
        return self.part("case.build", "build_problem")(model, folder, case_text=case_text, case_hash=case_hash)

    def derived(self, case: Any) -> Any:
        return self.part("case.derived", "derived_numbers")(case)

    def run(self, problem: Any, progress: Progress, keep: Path | None) -> Result:
        found: Result = self.part("run", "run")(problem, progress)
        return found


@cache
def _foreign() -> dict[str, Any]:
    """Return the entry points of structures of other packages by their kind."""
    return {point.name: point for point in entry_points(group=GROUP)}


def structure_kinds() -> tuple[str, ...]:
    """Return the names of all kinds of structure."""
    return (*_STRUCTURES, *sorted(set(_foreign()) - set(_STRUCTURES)))


def kind_named(data: Any) -> str:
    """Return the kind of structure that the content of a case names, empty where it names none that is known."""
    structure = data.get("structure") if isinstance(data, dict) else None
    kind = structure.get("kind") if isinstance(structure, dict) else None
    return kind if isinstance(kind, str) and kind in structure_kinds() else ""


@cache
def structure_kind(name: str) -> StructureKind:
    """Return a kind of structure.

    Raises
    ------
    KeyError
        When there is no such kind.
    InputError
        When the package that brings it cannot be imported, or names something else than a kind of structure.
    """
    if name in _STRUCTURES:
        kind: StructureKind = import_module(f"moyai.structures.{name}").KIND
        return kind
    point = _foreign()[name]
    try:
        found = point.load()
    except (ImportError, AttributeError) as error:
        raise InputError(
            f"the structure '{name}' cannot be loaded from {point.value}: {error}",
            path="structure.kind",
            remedy="repair or remove the package that brings it",
        ) from error
    if not isinstance(found, StructureKind):
        raise InputError(
            f"{point.value} is no kind of structure",
            path="structure.kind",
            allowed="an object of a class derived from moyai.core.kinds.StructureKind",
        )
    return found


def _templates_of(name: str) -> tuple[str, ...]:
    """Return the templates of a structure; none of one of another package that cannot be loaded."""
    try:
        return tuple(template for template, _ in structure_kind(name).templates)
    except InputError:
        return ()


@cache
def kind_of_result(name: str) -> Kind | None:
    """Return the kind whose results carry this name, or None."""
    if name in _FURTHER:
        kind: Kind = import_module(_FURTHER[name]).KIND
        return kind
    return structure_kind(name) if name in structure_kinds() else None


def kinds_of_results() -> tuple[str, ...]:
    """Return the names of all kinds of result."""
    return (*structure_kinds(), *_FURTHER)


def vocabulary_of(tree: xr.DataTree) -> Vocabulary | None:
    """Return the vocabulary of a result by its root; None for a result of no known kind."""
    kind = kind_of_result(str(tree.attrs.get("structure", "")))
    return None if kind is None else kind.vocabulary_of(tree.attrs)


def groups_of(tree: xr.DataTree) -> dict[str, xr.Dataset]:
    """Return the groups of a result by their path, with unit and words of its vocabulary on every variable."""
    groups = {node.path: node.to_dataset() for node in tree.subtree}
    own = vocabulary_of(tree)
    return groups if own is None else own.described(groups)[0]


def templates() -> dict[str, Kind]:
    """Return who has the template of each name, structures first."""
    cases = {template: structure_kind(name) for name in structure_kinds() for template in _templates_of(name)}
    return cases | further_files()


def further_files() -> dict[str, Kind]:
    """Return who reads each file of a user that is no case of a structure: records, tests, studies, fits."""
    found: dict[str, Kind] = {}
    for module in _FURTHER.values():
        kind: Kind = import_module(module).KIND
        found |= {template: kind for template, _ in kind.templates}
    return found
