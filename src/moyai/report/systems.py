"""Systems of units that reports are shown in: SI, or forces in tonnes-force and kilograms-force."""

from __future__ import annotations

import re
from collections.abc import Iterator
from contextlib import contextmanager
from contextvars import ContextVar

from moyai.core.errors import InputError
from moyai.core.units import parse_unit

SYSTEMS = ("SI", "tf")
UNITS_NOTES = {
    "tf": "Units: forces in tf or kgf (1 tf is 9806.65 newtons), moments, stiffness and pressures accordingly. "
    "The case and results.nc are in SI."
}
"""What a page says of units that are not SI."""
_system: ContextVar[str] = ContextVar("system", default="SI")
_LEAST_TONNE = 0.1  # forces whose largest is smaller are shown in kgf [tf]
# a force or a pressure among the factors of a unit, with its prefix
_FORCE = re.compile(r"\b[kMG]?(N|Pa)\b")


def require_system(name: str) -> None:
    """Refuse a name that is none of :data:`SYSTEMS`.

    Raises
    ------
    InputError
    """
    if name not in SYSTEMS:
        raise InputError(f"'{name}' is no system of units", path="units", allowed=" or ".join(SYSTEMS))


@contextmanager
def displayed_in(system: str) -> Iterator[str]:
    """Show what is composed and written inside in one of :data:`SYSTEMS`; see :func:`require_system`."""
    require_system(system)
    mark = _system.set(system)
    try:
        yield system
    finally:
        _system.reset(mark)


def in_tonnes_force(unit: str, largest: float) -> tuple[str, float] | None:
    """Return a unit with its forces in tf, ``tf m`` for ``N m`` and ``tf/m2`` for ``Pa``, where that is shown.

    Parameters
    ----------
    unit : str
        Unit of the stored values.
    largest : float
        Their largest magnitude; kgf where it is small.

    Returns
    -------
    (str, float) or None
        Unit shown and what a stored value is multiplied by; None in SI, and for what is no force.
    """
    if _system.get() != "tf" or not _FORCE.search(unit):
        return None
    found = []
    for force in ("kgf", "tf"):
        name = _FORCE.sub(lambda match, word=force: word if match[1] == "N" else f"{word}/m2", unit)  # type: ignore[misc]
        try:
            found.append((name, float(parse_unit(unit).factor / parse_unit(name).factor)))
        except InputError:
            return None  # a unit of the user's own file
    small, large = found
    return large if largest * large[1] >= _LEAST_TONNE else small


#: A number, or a range of two, with a force, moment, load per length or pressure behind it, as remarks have it.
_NUMBER = r"-?\d+(?:\.\d+)?(?:e[+-]?\d+)?"
_QUANTITY = re.compile(
    rf"(?<![\w.])(?:({_NUMBER})( to | ± | or )|(?<=between )({_NUMBER})( and ))?({_NUMBER}) "
    r"([kMG]?(?:N|Pa)(?:/m2|/m²|/m| m)?)(?![\w/·^])"
)


def words_in_system(text: str) -> str:
    """Return a remark with its forces in the system of units that is shown, to the digits that it has."""
    return text if _system.get() == "SI" else _QUANTITY.sub(_in_system, text)


def _in_system(match: re.Match[str]) -> str:
    first, joint = match[1] or match[3], match[2] or match[4] or ""
    unit = match[6].replace("²", "2")
    factor = float(parse_unit(unit).factor)
    stored = "N m" if unit.endswith(" m") else re.sub("^[kMG]", "", unit)
    texts = [text for text in (first, match[5]) if text]
    found = in_tonnes_force(stored, max(abs(float(text)) for text in texts) * factor)
    if found is None:
        return match[0]
    shown, share = found
    numbers = [_plain(float(text) * factor * share, _digits(text)) for text in texts]
    return f"{joint.join(numbers)} {shown}"


def _digits(text: str) -> int:
    return max(len(text.lstrip("-").partition("e")[0].replace(".", "").strip("0")), 3)


def _plain(value: float, digits: int) -> str:
    text = f"{value:.{digits}g}"
    return f"{value:.0f}" if "e" in text and abs(value) >= 1.0 else text
