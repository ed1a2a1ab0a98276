"""A study, read and checked before anything runs."""

from __future__ import annotations

import hashlib
import json
import math
import os
from dataclasses import replace
from pathlib import Path
from typing import Any

from moyai.case.paths import resolve
from moyai.case.reader import Case, case_of, read_block
from moyai.case.yaml_reader import CaseDocument, KeyPath, dotted, read_yaml
from moyai.core.errors import CaseError, Fault, InputError
from moyai.core.progress import Progress, silent
from moyai.core.version import VERSION
from moyai.study import schema
from moyai.study.axes import Axis, Combination, Point, StudyBase, combinations, varied, without
from moyai.study.definition import RunCase, Study
from moyai.study.extremes_over_seeds import fault_of, wanted_of
from moyai.study.fatigue_of_lines import curves_of
from moyai.study.plan_faults import check_kind, check_names, check_search, place_of, unknown_keys
from moyai.study.responses import Wanted
from moyai.study.variations import axes_of, wrong_paths

LARGEST = 1_000_000
"""Number of cases above which a study is refused as a slip."""

_CHECKED_ALL = 500


def _one_realisation_a_seed(base: CaseDocument, axes: list[Axis]) -> CaseDocument:
    """Return the base case of a breakwater with one realisation a case where the study itself varies seeds.

    The maxima over the seeds are then maxima, not means of several, unless the case requires realisations itself.
    """
    paths = [path for axis in axes for point in axis.points for path, _ in point.assignments]
    data = base.data
    if data.get("structure", {}).get("kind") != "breakwater" or not any(
        path.split(".")[-1] == "seed" for path in paths
    ):
        return base
    settings = dict(data.get("settings") or {})
    time = dict(settings.get("time") or {})
    if "realisations" in time:
        return base
    changed = {**settings, "time": {**time, "realisations": 1}}
    return varied(base, Combination(-1, (), (("settings", changed),)))


def load_study(path: str | os.PathLike[str], progress: Progress = silent) -> Study:
    """Read a study file and check every case that it describes.

    Up to 500 cases are all checked one by one. Of more, every point of every axis is checked, with the other axes at
    their first point, and 500 cases spread over the study; what is left shows as a labelled failure when it runs.

    Parameters
    ----------
    path : path-like
        YAML file.
    progress : Progress
        Called after every case that was checked.

    Returns
    -------
    Study
        What :func:`moyai.study.run_study` takes.

    Raises
    ------
    CaseError
        With every error of the study file, or of the cases, at once.

    Examples
    --------
    >>> from pathlib import Path
    >>> from tempfile import mkdtemp
    >>> import moyai
    >>> from moyai.study import load_study
    >>> folder = Path(mkdtemp())
    >>> _ = (folder / "base.yaml").write_text(moyai.template("network"), encoding="utf-8")
    >>> text = "{base: base.yaml, set: {analyses: [statics]}, variations: [{grid: {current.speed: [0.5, 1.0]}}]}"
    >>> _ = (folder / "study.yaml").write_text(f"moyai: 1\\nstudy: {text}\\n", encoding="utf-8")
    >>> load_study(folder / "study.yaml").shape
    (2,)
    """
    document = read_yaml(path)
    check_kind(document)
    root = read_block(document, schema.StudyFile)
    block: schema.StudyBlock = root.study
    folder = Path(path).parent
    base_path = folder / block.base
    base = _read_base(document, base_path)
    faults: list[Fault] = []
    try:
        base = varied(base, Combination(-1, (), tuple(block.set.items())))
    except InputError as error:
        changed: KeyPath = ("study", "set", error.fault.path)
        faults.append(document.fault(changed, error.fault.message, remedy=error.fault.remedy, of_key=True))
    axes: list[Axis] = []
    ground = StudyBase(base.data, folder, base_path.parent)
    wrong: list[str] = []
    for number, variation in enumerate(block.variations):
        where: KeyPath = ("study", "variations", number)
        if isinstance(document.data["study"]["variations"], dict):
            where = ("study", "variations")
        try:
            found = axes_of(variation, ground)
            errors = wrong_paths(found, base.data)
        except InputError as error:
            found, errors = (), [error]
        wrong += [error.fault.path for error in errors]
        sound = without(found, wrong)
        axes.extend(sound)
        for fault in [*(error.fault for error in errors), *(unknown_keys(sound, base, base_path) if wrong else ())]:
            place = place_of(document, where, fault.path)
            faults.append(document.fault(place, fault.message, allowed=fault.allowed, remedy=fault.remedy, of_key=True))
    if faults:
        raise CaseError(faults)
    search = block.limit if block.limit is not None else block.optimise
    check_search(document, base, base_path, search)
    if block.optimise is not None and block.optimise.trade_off is not None:
        trade = block.optimise.trade_off
        axes.append(Axis(trade.name, tuple(Point(f"{value:g}", (("@at_most", value),)) for value in trade.at_most)))
    if not axes and search is None:
        raise CaseError([document.fault(("study", "variations"), "the study varies nothing", remedy="give variations")])
    check_names(document, axes)
    count = math.prod(len(axis.points) for axis in axes)
    if count > LARGEST:
        message = f"the study has {count} cases"
        raise CaseError([document.fault(("study", "variations"), message, allowed=f"at most {LARGEST}")])
    base = _one_realisation_a_seed(base, axes)
    cases = combinations(axes)
    wanted = [Wanted(item.variable, item.reduce, item.over, item.exponent or 0.0) for item in block.responses]
    for number, item in enumerate(block.responses):
        if item.reduce == "rainflow" and item.exponent is None:
            place = ("study", "responses", number)
            raise CaseError([document.fault(place, "rainflow needs the 'exponent' of the endurance curve")])
    wanted += _wanted_of_assessment(document, block.assess)
    watch = _watched(document, block, search)
    keep = block.keep == "results"
    study = Study(
        block.title, base, base_path, tuple(axes), cases, tuple(dict.fromkeys(wanted)), watch, keep, "", search
    )
    skips = block.on_refused == "skip"
    study = replace(study, assessment=block.assess, replays=block.replays, skips_refused=skips)
    named, refused = check_cases(study, progress)
    return replace(study, key=_key(study, named), refused=refused)


def _watched(document: CaseDocument, block: schema.StudyBlock, search: Any) -> str:
    """Return the response that is shown on the way; a search is watched by what it finds."""
    if search is None:
        return block.watch
    found = ("limit/limit", "limit/runs") if block.limit is not None else ("optimum/objective", "optimum/runs")
    if block.watch and block.watch not in found:
        message = f"'{block.watch}' is no result of a search"
        raise CaseError([document.fault(("study", "watch"), message, allowed=", ".join(found), remedy="leave it out")])
    return block.watch or found[0]


def _wanted_of_assessment(document: CaseDocument, assess: schema.Assessment | None) -> list[Wanted]:
    """Return what every case must keep for the assessment; refuse settings that contradict each other."""
    wanted: list[Wanted] = []
    for one in assess.fatigue if assess is not None else ():
        try:
            exponents = {curve.exponent for curve in curves_of(one).values()}
        except InputError as error:
            fault = error.fault
            place = ("study", "assess", "fatigue")
            reported = document.fault(place, fault.message, allowed=fault.allowed, remedy=fault.remedy)
            raise CaseError([reported]) from None
        wanted += [Wanted(one.response, "rainflow", (), exponent) for exponent in sorted(exponents)]
    for extreme in assess.extremes if assess is not None else ():
        message = fault_of(extreme)
        if message:
            raise CaseError([document.fault(("study", "assess", "extremes"), message, remedy="leave it out")])
        wanted += wanted_of(extreme)
    return wanted


def case_at(study: Study, combination: Combination) -> Case:
    """Return one case of a study.

    Raises
    ------
    CaseError
        When its values are refused.
    """
    return case_of(varied(study.base, combination), study.base_path)


def check_cases(study: Study, progress: Progress = silent) -> tuple[str, tuple[int, ...]]:
    """Check the cases of a study without running them; return the hash of their content and who was refused.

    Raises
    ------
    CaseError
        With the faults of the cases, each once, with the first case that shows it. Where the study skips refused cases:
        only when all are refused.
    """
    chosen = _to_check(study)
    found: dict[tuple[str, str], Fault] = {}
    refused: dict[tuple[str, str], int] = {}
    hashes = hashlib.sha256()
    left_out: list[int] = []
    for done, index in enumerate(chosen):
        combination = study.cases[index]
        try:
            hashes.update(case_at(study, combination).case_hash.encode())
        except CaseError as error:
            left_out.append(index)
            hashes.update(b"refused")
            for fault in error.faults:
                key = (fault.path, fault.message)
                refused[key] = refused.get(key, 0) + 1
                changed = {dotted(place) for path, _ in combination.assignments for place in _places(study, path)}
                here = replace(fault, file="", line=0, column=0) if fault.path in changed else fault
                found.setdefault(key, replace(here, message=f"case {_name(study, combination)}: {fault.message}"))
        progress("check", done + 1, len(chosen))
    some = len(left_out) < len(chosen)
    if found and not (study.skips_refused and some):
        faults = []
        for key, fault in list(found.items())[:20]:
            more = refused[key] - 1
            faults.append(replace(fault, message=fault.message + (f" (and {more} more cases)" if more else "")))
        if some:
            skip = "to continue without such cases: 'on_refused: skip' in the study"
            faults[-1] = replace(faults[-1], remedy="; ".join(part for part in (faults[-1].remedy, skip) if part))
        raise CaseError(faults)
    return hashes.hexdigest(), tuple(left_out)


def _places(study: Study, path: str) -> tuple[KeyPath, ...]:
    return resolve(study.base.data, path)


def _name(study: Study, combination: Combination) -> str:
    pairs = [f"{axis.name} {label}" for axis, label in zip(study.axes, combination.labels)]
    return f"{combination.index + 1} of {len(study.cases)} ({', '.join(pairs)})"


def _to_check(study: Study) -> list[int]:
    count = len(study.cases)
    if count <= _CHECKED_ALL:
        return list(range(count))
    chosen = set(range(0, count, math.ceil(count / _CHECKED_ALL)))
    stride = count
    for length in study.shape:
        stride //= length
        chosen.update(position * stride for position in range(length))
    return sorted(chosen)


def with_search(study: Study, run: RunCase) -> RunCase:
    """Return what runs one case of the study: ``run`` itself, or a search around it."""
    from moyai.study.search import LimitRun, OptimiseRun, ResponseLimit

    def limit(one: schema.Condition) -> ResponseLimit:
        if one.at_most is not None:
            return ResponseLimit(one.response, one.at_most, 1)
        assert one.at_least is not None
        return ResponseLimit(one.response, one.at_least, -1)

    search = study.search
    if isinstance(search, schema.LimitSearch):
        conditions = tuple(limit(one) for one in search.conditions)
        return LimitRun(run, search.path, search.first, search.last, conditions, search.tolerance)
    if isinstance(search, schema.Optimisation):
        return OptimiseRun(
            run,
            tuple((path, low, high) for path, (low, high) in search.variables.items()),
            search.minimise,
            tuple(limit(one) for one in search.subject_to),
            "" if search.trade_off is None else search.trade_off.response,
            search.starts,
            search.evaluations,
            search.seed,
        )
    return run


def _read_base(document: CaseDocument, base_path: Path) -> CaseDocument:
    """Read the base case; every fault of its own is reported with its own lines."""
    if not base_path.exists():
        raise CaseError([document.fault(("study", "base"), f"no such file: {base_path}", remedy="name the base case")])
    base = read_yaml(base_path)
    case_of(base, base_path)
    return base


def _key(study: Study, hashes: str) -> str:
    """Return the hash of the study: cases in their order, what is kept, the version of the program."""
    content = {
        "version": VERSION,
        "cases": hashes,
        "points": [[axis.name, [[point.label, point.assignments, point.removals] for point in axis.points]]
                   for axis in study.axes],
        "wanted": [[item.variable, item.reduce, item.over, item.exponent] for item in study.wanted],
        "search": None if study.search is None else study.search.model_dump(mode="json"),
    }  # fmt: skip
    return hashlib.sha256(json.dumps(content, sort_keys=True, default=str).encode()).hexdigest()
