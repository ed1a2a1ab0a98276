"""Lines compared with a design code: utilisation, pass or fail, and what stands behind the factors.

Theory in docs/theory/design_checks.md.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Literal

from moyai.core.errors import InputError
from moyai.core.options import check_kind, check_word, checks_words
from moyai.core.validity import Notice
from moyai.tables.design_codes import (
    Analysis,
    CodeRule,
    Component,
    RuleName,
    applicable_rule,
    available_codes,
    code_rules,
)


@checks_words
@dataclass(frozen=True)
class LineLoad:
    """Tension of a line in one condition.

    Examples
    --------
    >>> from moyai.design import LineLoad
    >>> load = LineLoad("line 1", maximum_tension=1e6, mean_tension=4e5, breaking_load=2e6, component="chain")
    >>> load.maximum_tension / load.breaking_load                        # without the factors of a code [-]
    0.5
    """

    #: Name of the line.
    line: str
    #: Largest tension [N].
    maximum_tension: float
    #: Mean tension [N].
    mean_tension: float
    #: Minimum breaking load of the new line [N].
    breaking_load: float
    #: ``chain``, ``rope``, ``wire``, ``knotted_rope``, ``shackle`` or ``used_chain``.
    component: Component
    #: Name of the line that is lost, empty when intact; any name stands for one lost line.
    lost: str = ""


@checks_words
@dataclass(frozen=True)
class DesignCode:
    """A code as it is applied: which analysis, which class, which of its values the user has confirmed.

    Examples
    --------
    >>> from moyai.design import design_code
    >>> code = design_code("ISO 19901-7", analysis="dynamic")
    >>> code.value("safety_factor", "intact", "chain").value             # [-]
    1.67
    """

    #: Name of the code.
    name: str
    rules: tuple[CodeRule, ...]
    #: How the tensions were found: ``dynamic``, ``quasi_static`` or ``static``.
    analysis: Analysis
    #: Class of the code, empty where it has none.
    consequence: str = ""

    @checks_words
    def value(self, rule: RuleName, condition: Literal["intact", "one_lost"], component: Component) -> CodeRule | None:
        """Return the rule that applies, the most special first; ``None`` when the code has none.

        Parameters
        ----------
        rule : str
            Name of the rule.
        condition : {"intact", "one_lost"}
            All lines, or one of them lost.
        component : str
            What is judged, for instance ``chain``.
        """
        return applicable_rule(
            self.rules,
            rule,
            condition=condition,
            analysis=self.analysis,
            consequence=self.consequence,
            component=component,
        )


@checks_words
@dataclass(frozen=True)
class LineCheck:
    """Outcome of a line under a code."""

    load: LineLoad
    code: str
    #: Design tension over design strength; above 1 fails. NaN where the breaking load is unknown.
    utilisation: float
    #: After the corrosion allowance [N].
    breaking_load: float
    #: The factors in words.
    factors: str
    #: Whether every factor was confirmed.
    confirmed: bool

    @property
    def passed(self) -> bool:
        """Whether the line holds (an unknown breaking load never does)."""
        return bool(self.utilisation <= 1.0)


@checks_words
def design_code(
    name: str, *, analysis: Analysis, consequence: str = "", confirmed: Iterable[str] = (), own: Sequence[CodeRule] = ()
) -> DesignCode:
    """Return a code of the table, or the user's own [eq:checks-factor].

    Parameters
    ----------
    name : str
        Name in the table, or any name when ``own`` is given.
    analysis : str
        ``dynamic``, ``quasi_static`` or ``static``: how the tensions were found.
    consequence : str
        Class, for codes that have classes.
    confirmed : iterable of str
        Editions or names of codes whose values the user has compared with the standard.
    own : sequence of CodeRule
        Values of the user's own in place of the table's.

    Returns
    -------
    DesignCode
        For :func:`check_line`; its factors by ``value``.

    Raises
    ------
    InputError
        For an unknown code, analysis or class, or a confirmed code or edition that does not exist.

    Examples
    --------
    >>> from moyai.design import design_code
    >>> code = design_code("ISO 19901-7", analysis="dynamic")
    >>> code.name, code.analysis
    ('ISO 19901-7', 'dynamic')
    """
    rules = tuple(own) if own else code_rules(name)
    sure = set(confirmed)
    if sure:
        known = (*rules, *(rule for code in available_codes() for rule in code_rules(code)))
        for one in sorted(sure):
            check_word(one, dict.fromkeys(word for rule in known for word in (rule.code, rule.edition)), "confirmed")
        rules = tuple(
            CodeRule(**{**rule.__dict__, "confirmed": rule.confirmed or bool(sure & {rule.code, rule.edition})})
            for rule in rules
        )
    classes = sorted({rule.consequence for rule in rules} - {"any"})
    if classes and consequence not in classes:
        raise InputError(f"{name} needs a consequence class", parameter="consequence", allowed=", ".join(classes))
    if consequence and not classes:
        raise InputError(f"{name} has no consequence classes", parameter="consequence", remedy="leave it out")
    return DesignCode(name, rules, analysis, consequence)


def check_line(load: LineLoad, code: DesignCode, *, corrosion: float = 0.0, diameter: float = math.nan) -> LineCheck:
    """Compare a line with a code.

    Parameters
    ----------
    load : LineLoad
        Tensions [N] and what the line is made of.
    code : DesignCode
        From :func:`design_code`.
    corrosion : float
        Loss of diameter over the life [m]: rate times years.
    diameter : float
        Diameter of the new line [m]; needed when ``corrosion`` is not zero.

    Returns
    -------
    LineCheck
        Utilisation (above 1 does not hold) with the factors used and whether they are confirmed.

    Raises
    ------
    InputError
        When the code has no rule for the component or condition, or corrosion eats the line.

    Notes
    -----
    [eq:checks-factor] [eq:checks-partial] [eq:checks-material] [eq:checks-share] [eq:checks-corrosion]

    Examples
    --------
    >>> from moyai.design import LineLoad, check_line, design_code
    >>> load = LineLoad("line 1", maximum_tension=1e6, mean_tension=4e5, breaking_load=2e6, component="chain")
    >>> found = check_line(load, design_code("ISO 19901-7", analysis="dynamic"))
    >>> round(found.utilisation, 3)                                  # 1.67 times 1 MN over 2 MN
    0.835
    """
    check_kind(load, LineLoad, "load")
    check_kind(code, DesignCode, "code", "design_code(name, analysis=...) gives one")
    strength = load.breaking_load * _worn_share(corrosion, diameter)
    condition: Literal["intact", "one_lost"] = "one_lost" if load.lost else "intact"

    def value(rule: RuleName) -> CodeRule | None:
        return code.value(rule, condition, load.component)

    mean, dynamic = value("partial_mean"), value("partial_dynamic")
    factor, share = value("safety_factor"), value("share")
    load_factor, material = value("load_factor"), value("material_factor")
    used: tuple[CodeRule, ...]
    if mean is not None and dynamic is not None:
        varying = max(load.maximum_tension - load.mean_tension, 0.0)
        demand = mean.value * load.mean_tension + dynamic.value * varying
        utilisation = demand / (0.95 * strength)
        used, words = (mean, dynamic), f"{mean.value:g} mean + {dynamic.value:g} dynamic on 0.95 of the breaking load"
    elif factor is not None:
        utilisation = load.maximum_tension * factor.value / strength
        used, words = (factor,), f"safety factor {factor.value:g}"
    elif load_factor is not None and material is not None:
        utilisation = load.maximum_tension * load_factor.value * material.value / strength
        used, words = (load_factor, material), f"load factor {load_factor.value:g}, material {material.value:g}"
    elif share is not None:
        utilisation = load.maximum_tension / (share.value * strength)
        used, words = (share,), f"at most {100 * share.value:g} % of the breaking load"
    else:
        known = sorted({rule.component for rule in code.rules if rule.condition in (condition, "any")})
        raise InputError(
            f"{code.name} has no value for a {load.component}, {condition.replace('_', ' ')}, {code.analysis} analysis",
            parameter=f"checks.{load.line}",
            allowed="components: " + (", ".join(known) or "none in this condition"),
            remedy="choose another code or give values of your own",
        )
    return LineCheck(load, code.name, utilisation, strength, words, all(rule.confirmed for rule in used))


def _worn_share(corrosion: float, diameter: float) -> float:
    """Return the share of the breaking load that is left: it goes with the area of the worn bar."""
    if corrosion == 0.0:
        return 1.0
    if not (corrosion > 0.0 and math.isfinite(diameter)):
        raise InputError(
            f"a corrosion allowance of {corrosion:g} m needs the diameter of the line",
            parameter="corrosion",
            allowed="above 0",
        )
    if corrosion >= diameter:
        raise InputError(
            f"corrosion of {1000 * corrosion:g} mm is more than the diameter of the line, {1000 * diameter:g} mm",
            parameter="corrosion",
            remedy="shorten the life or choose a thicker line",
        )
    return (1.0 - corrosion / diameter) ** 2


def check_confirmation(code: DesignCode) -> tuple[Notice, ...]:
    """Return a notice for values that were not compared with the standard itself."""
    unsure = [rule for rule in code.rules if not rule.confirmed]
    if not unsure:
        return ()
    return (
        Notice(
            "code-unconfirmed",
            f"{len(unsure)} of {len(code.rules)} values of {code.name} ({unsure[0].edition}) were not compared with "
            "the standard itself",
            remedy="compare them with your copy and name the code under 'confirmed'",
            source=unsure[0].source,
        ),
    )
