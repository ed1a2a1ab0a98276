"""A design code of mooring lines as a limit on the utilisation of the lines."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from typing import Any

from moyai.core.errors import InputError
from moyai.core.headline import UNCONFIRMED, Criterion
from moyai.tables.design_codes import CodeRule, applicable_rule, code_rules

_WORDS = "factor of safety of the lines"
#: Share of the breaking load that counts as the characteristic strength where a code has partial factors.
_CHARACTERISTIC = 0.95
#: Analyses whose factors stand in where a code has none for the analysis given: the safer one.
_STAND_IN = {"static": "quasi_static"}


def code_criteria(given: Any, names: Iterable[str | None], *, assumed: bool = False) -> tuple[Criterion, ...]:
    """Return the criteria of a code for tensions of either analysis, each for the numbers that its analysis gave.

    Parameters are those of :func:`code_criterion`; a code block that names its ``analysis`` has one criterion.
    """
    names = tuple(names)
    if not isinstance(given, str) and given.analysis:
        return (code_criterion(given, given.analysis, names, assumed=assumed),)
    still = code_criterion(given, "quasi_static", names, assumed=assumed)
    try:
        moving = code_criterion(given, "dynamic", names, assumed=assumed)
    except InputError:
        # a code without a value for dynamic analysis: that of the quasi-static one asks no less
        return (still,)
    return tuple(
        replace(criterion, analysis=analysis, label=f"{criterion.label}, {analysis.replace('_', '-')} analysis")
        for criterion, analysis in ((moving, "dynamic"), (still, "quasi_static"))
    )


def code_criterion(given: Any, analysis: str, names: Iterable[str | None], *, assumed: bool = False) -> Criterion:
    """Return the criterion of a code: the strictest of its limits on the materials of the lines.

    Parameters
    ----------
    given : str or LineCode
        Name of the code, or block with what it needs to know.
    analysis : str
        How the case finds the tensions: ``dynamic``, ``quasi_static`` or ``static``.
    names : iterable of str or None
        What segments are made of, as :func:`make_of` gives it; ``None`` may be of any material.
    assumed : bool
        Whether the program chose the code.

    Raises
    ------
    InputError
        When the code needs a class, or has no value for the material and the analysis.
    """
    name = given if isinstance(given, str) else given.name
    block = None if isinstance(given, str) else given
    rules = code_rules(name)
    consequence = (block and block.consequence) or ""
    classes = sorted({rule.consequence for rule in rules} - {"any"})
    if classes and consequence not in classes:
        raise InputError(
            f"{name} needs a consequence class",
            path="criteria.code",
            allowed=", ".join(classes),
            remedy=f"code: {{name: {name}, consequence: ...}}",
        )
    chosen = (block and block.analysis) or analysis
    materials = {block.component} if block and block.component else _materials(rules, names)
    found = []
    for material in sorted(materials):
        value, judged_as = _limit(rules, chosen, consequence, material), material
        if value is None and assumed:
            # nobody asked for this code: a material that it does not know is judged as its strictest one
            others = [(_limit(rules, chosen, consequence, other), other) for other in _materials(rules, [None])]
            known = [(limit, other) for limit, other in others if limit is not None]
            value, judged_as = min(known, key=lambda item: item[0][0], default=(None, material))
        if value is None:
            raise _no_value(name, rules, chosen, material)
        found.append((value, material if judged_as == material else f"{material} judged as {judged_as}"))
    (limit, weight, used, words), _ = min(found, key=lambda item: item[0][0])
    strictest = [made_of for value, made_of in found if value[0] == limit]
    # a rule for whatever a line is made of says nothing of materials
    material = "" if all(rule.component == "any" for rule in used) else f", {' or '.join(strictest)}"
    sure = all(rule.confirmed for rule in used) or bool(block and name in block.confirmed)
    doubt = "" if sure else f", {UNCONFIRMED}"
    said = f"{name} ({used[0].edition}), {words}{material}, {chosen.replace('_', '-')} analysis{doubt}"
    return Criterion(
        "line_safety_factor" if assumed else "code",
        "line_utilisation",
        limit,
        "at most",
        f"default of moyai: {said}" if assumed else said,
        _WORDS,
        as_factor=True,
        mean_weight=weight,
        assumed=assumed,
    )


def make_of(part: Any) -> str | None:
    """Return what a line or a segment says it is made of: its name in the catalogue, or its component."""
    return getattr(part, "catalogue", None) or getattr(part, "component", None)


def component_of(name: str) -> str:
    """Return what a line of the catalogue is made of: chain, wire or rope."""
    return "chain" if "chain" in name else "wire" if "wire" in name else "rope"


def _materials(rules: tuple[CodeRule, ...], names: Iterable[str | None]) -> set[str]:
    """Return what lines are made of; where a line does not say it, any new material that the code knows."""
    found: set[str] = set()
    for name in names:
        if name is None:
            known = {rule.component for rule in rules} - {"any", "knotted_rope", "used_chain", "shackle"}
            found |= known or {"line"}
        else:
            found.add(component_of(name))
    return found or {"line"}


def _limit(
    rules: tuple[CodeRule, ...], analysis: str, consequence: str, component: str
) -> tuple[float, float, tuple[CodeRule, ...], str] | None:
    """Return limit on the utilisation, weight of the mean, the rules and their words; ``None`` without a value."""

    def value(rule: str) -> CodeRule | None:
        return next(
            (
                one
                for kind in (analysis, _STAND_IN.get(analysis, analysis))
                if (
                    one := applicable_rule(
                        rules, rule, condition="intact", analysis=kind, consequence=consequence, component=component
                    )
                )
            ),
            None,
        )

    mean, dynamic = value("partial_mean"), value("partial_dynamic")
    factor, share = value("safety_factor"), value("share")
    load, material = value("load_factor"), value("material_factor")
    if mean and dynamic:
        words = f"{mean.value:g} mean + {dynamic.value:g} varying part on {_CHARACTERISTIC:g} of the breaking load"
        return _CHARACTERISTIC / dynamic.value, mean.value / dynamic.value, (mean, dynamic), words
    if factor:
        return 1.0 / factor.value, 1.0, (factor,), f"factor {factor.value:g} on the breaking load"
    if load and material:
        words = f"load factor {load.value:g}, material factor {material.value:g}"
        return 1.0 / (load.value * material.value), 1.0, (load, material), words
    if share:
        return share.value, 1.0, (share,), f"at most {share.value:g} of the breaking load"
    return None


def _no_value(name: str, rules: tuple[CodeRule, ...], analysis: str, material: str) -> InputError:
    known = sorted({rule.component for rule in rules} - {"any"}) or ["any"]
    return InputError(
        f"{name} has no value for a {material}, intact, {analysis.replace('_', '-')} analysis",
        path="criteria.code",
        allowed="components: " + ", ".join(known),
        remedy="choose another code, name 'component' and 'analysis' in the block, or give 'line_safety_factor'",
    )
