"""The vocabulary of results: one declaration a concept, and the refusal of what is not declared.

Concepts that several kinds of result share are declared here. A kind adds its own in ``variables.py`` of its folder and
closes its groups through its :class:`Vocabulary`; reports and studies ask through the same declarations. A name without
a declaration is an error of the program, never of a case.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

from moyai.core.duck_arrays import look_for_imported_dask
from moyai.core.remembered import Remembered, key_of_objects
from moyai.core.validity import Notice

if TYPE_CHECKING:
    import xarray as xr

_COORDINATES: Remembered[xr.Coordinates] = Remembered(256)
_MOST_BYTES = 1 << 16
#: Unit of texts, and of numbers whose unit changes from row to row and stands in another variable.
NO_UNIT = ""
#: Group below which each set of measured points of a case stands: x and y in units of the user's file.
MEASURED_GROUP = "/measured_points"
_REMEDY = "an error of the program, not of the case: the numbers stand in the file as computed; please report it"


class Strictness:
    """Whether a name without a declaration is an error, as in the tests of the program.

    A user's run keeps what it computed and gets a warning (:meth:`Vocabulary.close`): hours of work are not lost for a
    missing word.
    """

    names = False


class VocabularyError(LookupError):
    """A name of a result that no vocabulary declares, or a declared one that a finished analysis did not write."""


@dataclass(frozen=True)
class Variable:
    """One concept of a result."""

    #: Name in the file.
    name: str
    #: SI unit; ``"1"`` without dimension, :data:`NO_UNIT` for texts.
    units: str
    #: What it is, in words.
    long_name: str
    #: Dimensions that it always has, in any order among others; empty where they are not fixed.
    dims: tuple[str, ...] = ()


LINE_TENSION_MAXIMUM = Variable("line_tension_maximum", "N", "largest tension of the line", ("line",))
LINE_TENSION_MINIMUM = Variable("line_tension_minimum", "N", "smallest tension of the line", ("line",))
LINE_TENSION_MEAN = Variable("line_tension_mean", "N", "mean tension of the line", ("line",))
LINE_TENSION_PEAK_SINCE_ROW = Variable(
    "line_tension_peak_since_row", "N", "highest tension of the line since the row before", ("line",)
)
BREAKING_LOAD = Variable("breaking_load", "N", "breaking load of the line", ("line",))
# of one line at its anchor; the pull of all lines that meet in a point is called point_load
ANCHOR_TENSION = Variable("anchor_tension", "N", "tension at the anchor")
ANCHOR_HORIZONTAL_TENSION = Variable("anchor_horizontal_tension", "N", "horizontal tension at the anchor")
ANCHOR_VERTICAL_TENSION = Variable(
    "anchor_vertical_tension", "N", "vertical tension at the anchor, upward on the anchor"
)
ANCHOR_TENSION_MAXIMUM = Variable("anchor_tension_maximum", "N", "largest tension at the anchor")
ANCHOR_HORIZONTAL_TENSION_MAXIMUM = Variable(
    "anchor_horizontal_tension_maximum", "N", "largest horizontal tension at the anchor"
)
ANCHOR_VERTICAL_TENSION_MAXIMUM = Variable("anchor_vertical_tension_maximum", "N", "largest uplift at the anchor")
LARGEST_OFFSET = Variable("largest_offset", "m", "largest horizontal distance of the body from its place at rest")
CONTACT_COUNT = Variable("contact_count", "1", "times that the slack line comes taut")
SNAP_COUNT = Variable("snap_count", "1", "contacts whose peak exceeds the threshold of a snap")
LARGEST_SNAP = Variable("largest_snap", "N", "highest peak of a snap")
SHORTEST_RISE_TIME = Variable(
    "shortest_rise_time", "s", "shortest rise of a snap from a tenth to nine tenths of its peak"
)
BOTH_CABLES_PEAK_TENSION = Variable("both_cables_peak_tension", "N", "largest sum of the tensions of both cables")
BOTH_CABLES_PLATEAU_TENSION = Variable(
    "both_cables_plateau_tension", "N", "sum of the tensions of both cables after the spike, the level of the drag"
)
BOTH_CABLES_IMPACT_TENSION = Variable(
    "both_cables_impact_tension",
    "N",
    "largest sum of the tensions of both cables above the level of the drag, which models of the impact alone lack",
)
FACTORED_UTILISATION = Variable("factored_utilisation", "1", "load times safety factor over strength")

_QUANTITIES = (
    LINE_TENSION_MAXIMUM,
    LINE_TENSION_MINIMUM,
    LINE_TENSION_MEAN,
    LINE_TENSION_PEAK_SINCE_ROW,
    BREAKING_LOAD,
    ANCHOR_TENSION,
    ANCHOR_HORIZONTAL_TENSION,
    ANCHOR_VERTICAL_TENSION,
    ANCHOR_TENSION_MAXIMUM,
    ANCHOR_HORIZONTAL_TENSION_MAXIMUM,
    ANCHOR_VERTICAL_TENSION_MAXIMUM,
    LARGEST_OFFSET,
    CONTACT_COUNT,
    SNAP_COUNT,
    LARGEST_SNAP,
    SHORTEST_RISE_TIME,
    BOTH_CABLES_PEAK_TENSION,
    BOTH_CABLES_PLATEAU_TENSION,
    BOTH_CABLES_IMPACT_TENSION,
    FACTORED_UTILISATION,
    Variable("time", "s", "time"),
    Variable("wavelength", "m", "wave length L"),
    Variable("wave_number", "1/m", "wave number k"),
    Variable("slack_share", "1", "share of the time that the line is slack"),
    Variable("snap_threshold", "N", "peak above which a contact is a snap"),
    Variable("solidity_listed", "1", "listed solidity of the net"),
    Variable("frequency", "Hz", "frequency"),
)
_LABELS = (
    Variable("line", NO_UNIT, "line"),
    Variable("dof", NO_UNIT, "degree of freedom"),
    Variable("axis", NO_UNIT, "axis"),
    Variable("law", NO_UNIT, "law of the net forces"),
    Variable("wave", NO_UNIT, "wave"),
    Variable("run", NO_UNIT, "run"),
    Variable("end", NO_UNIT, "end"),
    Variable("net", NO_UNIT, "net"),
    Variable("kind", NO_UNIT, "kind"),
    Variable("gauge", NO_UNIT, "wave gauge"),
)
#: Concepts and labels that several kinds of result share.
COMMON: Mapping[str, Variable] = {variable.name: variable for variable in (*_QUANTITIES, *_LABELS)}

#: Names of earlier versions and what they are called, for users of former names.
FORMER: Mapping[str, str] = {
    **dict.fromkeys(("tension_largest", "tension_maximum"), LINE_TENSION_MAXIMUM.name),
    "maximum_tension": f"{LINE_TENSION_MAXIMUM.name} or both_cables_tension_maximum",
    "peak_tension": f"{LINE_TENSION_MAXIMUM.name} or {BOTH_CABLES_PEAK_TENSION.name}",
    **dict.fromkeys(("minimum_tension", "tension_minimum", "line_least_tension"), LINE_TENSION_MINIMUM.name),
    "tension_mean": LINE_TENSION_MEAN.name,
    "mean_tension": f"{LINE_TENSION_MEAN.name} or both_cables_tension_mean",
    **dict.fromkeys(("tension_peak", "line_tension"), LINE_TENSION_PEAK_SINCE_ROW.name),
    **dict.fromkeys(("peak", "line_peak"), f"{LINE_TENSION_MAXIMUM.name} or {LINE_TENSION_PEAK_SINCE_ROW.name}"),
    "worst_tension": f"worst_{LINE_TENSION_MAXIMUM.name}",
    "line_breaking_load": BREAKING_LOAD.name,
    **dict.fromkeys(("anchor_tension_history", "anchor_pull", "anchor_line_tension"), ANCHOR_TENSION.name),
    **dict.fromkeys(("horizontal_tension", "line_horizontal_tension", "anchor_force"), ANCHOR_HORIZONTAL_TENSION.name),
    "end_anchor_force": "end_anchor_horizontal_tension",
    **dict.fromkeys(("anchor_uplift", "line_anchor_vertical_tension"), ANCHOR_VERTICAL_TENSION.name),
    "maximum_anchor_tension": ANCHOR_TENSION_MAXIMUM.name,
    "maximum_anchor_horizontal_tension": ANCHOR_HORIZONTAL_TENSION_MAXIMUM.name,
    **dict.fromkeys(("maximum_anchor_vertical_tension", "line_uplift_lower"), ANCHOR_VERTICAL_TENSION_MAXIMUM.name),
    "anchor_horizontal_tension_lines_at_rest": "anchor_horizontal_tension_maximum_lines_at_rest",
    "anchor_vertical_tension_lines_at_rest": "anchor_vertical_tension_maximum_lines_at_rest",
    "maximum_uplift": "anchor_vertical_tension_maximum_lines_in_motion",
    "anchor_peak": "anchor_line_tension_maximum",
    "law_anchor_pull": "law_anchor_tension_maximum",
    **dict.fromkeys(("tension_lower", "line_tension_lower"), "lower_end_tension"),
    "tension_upper": "upper_end_tension",
    "line_tension_maximum_lower": "lower_end_tension_maximum",
    "load": "point_load",
    "highest_load": "point_load_peak_since_row",
    "load_peak": "point_load_maximum",
    "load_of_realisation": "point_load_maximum_of_realisation",
    "load_horizontal": "point_horizontal_load_maximum",
    "load_upwards": "point_upward_load_maximum",
    "load_downwards": "point_downward_load_maximum",
    **{f"load_{check}": f"point_load_{check}" for check in ("of_mesh", "half_step", "double_mesh", "damped", "finest")},
    "offset": LARGEST_OFFSET.name,
    "law_offset": "law_largest_offset",
    "maximum_excursion": "largest_offset_by_dof",
    "excursion": "point_excursion or water_excursion",
    "excursion_of_realisation": "point_excursion_of_realisation",
    "threshold_excursion": "threshold_water_excursion",
    **dict.fromkeys(("contacts", "line_contacts"), CONTACT_COUNT.name),
    **dict.fromkeys(("snaps", "line_snaps"), SNAP_COUNT.name),
    "snap_peak": LARGEST_SNAP.name,
    **dict.fromkeys(("least_rise_time", "shortest_rise"), SHORTEST_RISE_TIME.name),
    "snap_rise_time": "median_rise_time",
    "both_peak": "both_cables_tension_maximum",
    "both_peak_time": "both_cables_peak_time",
    "both_tension": "both_cables_tension_peak_since_row",
    "sum_peak_tension": BOTH_CABLES_PEAK_TENSION.name,
    **dict.fromkeys(("plateau_tension", "sum_plateau_tension"), BOTH_CABLES_PLATEAU_TENSION.name),
    **dict.fromkeys(("impact_tension", "sum_impact_tension"), BOTH_CABLES_IMPACT_TENSION.name),
    "utilisation": FACTORED_UTILISATION.name,
    "utilisation_high": f"{FACTORED_UTILISATION.name}_high",
    "limit_utilisation": "limit_factored_utilisation",
    "component_utilisation": "component_factored_utilisation",
}
#: Former names that had more before or after them where a result holds the worst, an end of a band and the like.
_FORMER = re.compile(
    f"(worst_|steady_|cause_|direction_|)({'|'.join(name for name in FORMER if re.search('anchor_|maximum_', name))})"
    "(_low|_high|_of_realisation|)"
)


def former(name: str) -> str:
    """Say what a variable of an earlier version is called; empty where it was none."""
    called, found = FORMER.get(name, ""), _FORMER.fullmatch(name)
    if found and not called:
        called = " or ".join(f"{found[1]}{one}{found[3]}" for one in FORMER[found[2]].split(" or "))
    return f"'{name}' of earlier versions is called {called}" if called else ""


@dataclass(frozen=True)
class Vocabulary:
    """All names that the results of one kind may carry."""

    #: Kind of result, for messages.
    kind: str
    #: Declarations by their name.
    variables: Mapping[str, Variable]
    #: Units by a regular expression that names of the user's making match as a whole: channels of a record. Such a
    #: variable brings its own words; :data:`NO_UNIT` where it brings its own unit as well.
    patterns: Mapping[str, str] = field(default_factory=dict)
    #: Vocabularies of groups that have one of their own, by a regular expression of their path.
    parts: Mapping[str, Vocabulary] = field(default_factory=dict)
    #: Paths of groups whose variables the user's file names.
    open_groups: tuple[str, ...] = ()
    #: Names that a group holds whenever its analysis was run to its end, by a regular expression of its path.
    always: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
    #: Names that a run writes together, by the same: a group that holds one of such a set holds all of it.
    together: Mapping[str, tuple[tuple[str, ...], ...]] = field(default_factory=dict)

    @classmethod
    def of(
        cls,
        kind: str,
        own: Mapping[str, tuple[str, str]],
        *,
        labels: Mapping[str, str] | None = None,
        patterns: Mapping[str, str] | None = None,
        parts: Mapping[str, Vocabulary] | None = None,
        open_groups: tuple[str, ...] = (),
        always: Mapping[str, str | tuple[str, ...]] | None = None,
        together: Mapping[str, tuple[str, ...]] | None = None,
    ) -> Vocabulary:
        """Return a vocabulary of the common concepts and a kind's own.

        Parameters
        ----------
        kind : str
        own : mapping
            Unit and long name by name. A common concept may have closer words here, never another unit.
        labels : mapping, optional
            Long names of texts and of numbers that only count entries along a dimension.
        patterns, parts, open_groups
            As in the class.
        always, together
            As in the class; names are separated by blanks, or stand in a tuple.

        Raises
        ------
        ValueError
            When a common concept has another unit, or ``always`` or ``together`` name what is not declared.
        """
        variables = dict(COMMON)
        texts = {name: (NO_UNIT, words) for name, words in (labels or {}).items()}
        for name, (units, words) in {**own, **texts}.items():
            common = COMMON.get(name)
            if common is not None and units != common.units:
                raise ValueError(f"{kind}: '{name}' has the unit '{units}', the common concept '{common.units}'")
            variables[name] = Variable(name, units, words, () if common is None else common.dims)
        held = {
            path: tuple(names.split()) if isinstance(names, str) else names for path, names in (always or {}).items()
        }
        sets = {path: tuple(tuple(names.split()) for names in every) for path, every in (together or {}).items()}
        made = cls(kind, variables, patterns or {}, parts or {}, open_groups, held, sets)
        wanted = (*held.values(), *(names for every in sets.values() for names in every))
        undeclared = sorted({name for names in wanted for name in names} - variables.keys())
        if undeclared:
            raise ValueError(f"{kind}: {', '.join(undeclared)} must always be there and is not declared")
        return made

    def __contains__(self, name: object) -> bool:
        own = name in self.variables or any(re.fullmatch(pattern, str(name)) for pattern in self.patterns)
        return own or any(name in part for part in self.parts.values())

    def at(self, path: str) -> Vocabulary | None:
        """Return the vocabulary of a group, ``None`` where the user's file names its variables."""
        place = f"/{path.strip('/')}"
        if place in self.open_groups or place.startswith(MEASURED_GROUP):
            return None
        return next((part for pattern, part in self.parts.items() if re.fullmatch(pattern, place)), self)

    def require(self, name: str) -> None:
        """Refuse a name that is not declared, where names are held strictly.

        Raises
        ------
        VocabularyError
        """
        if Strictness.names and name not in self:
            raise VocabularyError(f"results of kind '{self.kind}' have no variable '{name}': it is not declared")

    def absent(self, path: str, held: xr.Dataset | xr.DataTree) -> tuple[str, ...]:
        """Return what a group must hold and does not.

        Nothing is missed in a run that did not converge, and nothing of lines where there are none.

        Parameters
        ----------
        path : str
        held : Dataset or DataTree
            The group.
        """
        place = f"/{path.strip('/')}"
        if not held.data_vars or held.attrs.get("status", "converged") != "converged":
            return ()
        wanted = [name for pattern, own in self.always.items() if re.fullmatch(pattern, place) for name in own]
        for names in (
            names for pattern, every in self.together.items() if re.fullmatch(pattern, place) for names in every
        ):
            wanted += names if any(name in held.variables for name in names) else ()
        return tuple(
            name
            for name in dict.fromkeys(wanted)
            if name not in held.variables and all(held.sizes.get(dim) for dim in self.variables[name].dims)
        )

    def describe(self, dataset: xr.Dataset) -> xr.Dataset:
        """Return the dataset with ``units`` and ``long_name`` on every declared variable.

        Words that a variable brings stay: those of one row of a table may be closer than the declaration.
        """
        said = {name: self._words(str(name), held.dtype) for name, held in dataset.variables.items()}
        if all(words.keys() <= dataset.variables[name].attrs.keys() for name, words in said.items()):
            return dataset
        out = dataset.copy()
        for name, words in said.items():
            out.variables[name].attrs = {**words, **out.variables[name].attrs}
        return out

    def _words(self, name: str, dtype: np.dtype[Any]) -> dict[str, str]:
        known = self.variables.get(name)
        if known is None:
            return {}
        units = {"units": known.units} if dtype.kind in "iufcb" else {}
        return {**units, "long_name": known.long_name}

    def dataset(
        self, data: Mapping[str, tuple[Any, Any]], coords: Mapping[str, Any], attrs: Mapping[str, Any] | None = None
    ) -> xr.Dataset:
        """Return a dataset with ``units`` and ``long_name`` on every declared variable.

        Parameters
        ----------
        data : mapping
            Dimensions and values by name.
        coords : mapping
            Labels of dimensions; dimensions and values of what stands along them. Labels met before cost nothing.
        attrs : mapping, optional
            Attributes of the dataset.
        """
        import xarray as xr

        look_for_imported_dask()

        def made(name: str, dims: Any, values: Any) -> xr.Variable:
            array = np.asarray(values)
            return xr.Variable(dims, array, self._words(name, array.dtype))

        labels = {name: np.asarray(held) for name, held in coords.items() if not isinstance(held, tuple)}
        few = sum(held.nbytes for held in labels.values()) <= _MOST_BYTES
        known = _COORDINATES.of(
            key_of_objects(self.kind, labels) if few else None,
            lambda: xr.Coordinates({name: made(name, name, held) for name, held in labels.items()}),
        )
        along = {name: made(name, *held) for name, held in coords.items() if isinstance(held, tuple)}
        own = {name: made(name, *held) for name, held in data.items()}
        out = xr.Dataset(own | along, coords=known, attrs=dict(attrs or {}))
        return out.set_coords(list(along)) if along else out

    def described(self, groups: Mapping[str, xr.Dataset]) -> tuple[dict[str, xr.Dataset], tuple[str, ...]]:
        """Return the groups of a result, described, and what is wrong with their variables: see :meth:`close`.

        Parameters
        ----------
        groups : mapping
            Datasets by their path.
        """
        owners = {path: self.at(path) for path in groups}
        faults = [fault for path, own in owners.items() if own for fault in own._faults(path, groups[path])]
        faults += [
            f"{path}: variable '{name}' is absent"
            for path, group in groups.items()
            for name in self.absent(path, group)
        ]
        out = {path: own.describe(groups[path]) if own else groups[path] for path, own in owners.items()}
        return out, tuple(faults)

    def close(self, groups: Mapping[str, xr.Dataset]) -> tuple[dict[str, xr.Dataset], tuple[Notice, ...]]:
        """Return the groups of a result, described, and a warning for each variable that does not fit its declaration.

        Such a variable is not declared, has another unit, lacks a dimension, or is absent where its group must hold it.

        Parameters
        ----------
        groups : mapping
            Datasets by their path.

        Raises
        ------
        VocabularyError
            With group and name of all such variables, where names are held strictly.
        """
        out, faults = self.described(groups)
        if faults and Strictness.names:
            raise VocabularyError(f"results of kind '{self.kind}': {'; '.join(faults)}")
        return out, tuple(Notice("undeclared-variable", fault, remedy=_REMEDY) for fault in faults)

    def _faults(self, path: str, dataset: xr.Dataset) -> Iterator[str]:
        for name, held in dataset.variables.items():
            if name not in self:
                yield f"{path}: variable '{name}' is not declared"
                continue
            known = self.variables.get(str(name))
            if known is None:
                continue
            units = held.attrs.get("units", known.units)
            if known.units != NO_UNIT and units != known.units:
                yield f"{path}: variable '{name}' has the unit '{units}', declared is '{known.units}'"
            missing = [dim for dim in known.dims if dim not in held.dims]
            if missing:
                yield f"{path}: variable '{name}' has no dimension {', '.join(missing)}"


def joined(kind: str, parts: Iterable[Vocabulary]) -> Vocabulary:
    """Return one vocabulary to read results of several models of a kind; of equal names the last declaration stands."""
    out = Vocabulary(kind, {})
    for part in parts:
        out = Vocabulary(
            kind,
            {**out.variables, **part.variables},
            {**out.patterns, **part.patterns},
            {**out.parts, **part.parts},
            (*out.open_groups, *part.open_groups),
            {**out.always, **part.always},
            {**out.together, **part.together},
        )
    return out
