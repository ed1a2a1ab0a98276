"""Laws of net forces by name; every law is a file of its own in :mod:`moyai.morison.net_laws`."""

from __future__ import annotations

import difflib

from moyai.core.errors import InputError
from moyai.morison.net_law_base import NetLaw, panel_force
from moyai.morison.net_laws.aarsnes import Aarsnes
from moyai.morison.net_laws.balash import Balash
from moyai.morison.net_laws.bessonneau import Bessonneau
from moyai.morison.net_laws.bi import Bi
from moyai.morison.net_laws.choo_casarella import ChooCasarella
from moyai.morison.net_laws.kristiansen_faltinsen import KristiansenFaltinsen
from moyai.morison.net_laws.loland import Loland
from moyai.morison.net_laws.matsubara import Matsubara
from moyai.morison.net_laws.milne import Milne
from moyai.morison.net_laws.power import PowerLawNet, read_power_law
from moyai.morison.net_laws.takagi import Takagi
from moyai.morison.net_laws.wan import Wan
from moyai.morison.nets import Net

_LAWS: dict[str, type[NetLaw]] = {
    law.name: law
    for law in (
        Matsubara,
        Loland,
        Aarsnes,
        KristiansenFaltinsen,
        Balash,
        Bi,
        Milne,
        Takagi,
        ChooCasarella,
        Bessonneau,
        Wan,
    )
}


def available_net_laws() -> tuple[str, ...]:
    """Return the names of all laws; a power law of one's own is written out, ``11.4 Re^-0.40``.

    Returns
    -------
    tuple of str
        Names that :func:`net_law` takes.

    Examples
    --------
    >>> from moyai.morison import available_net_laws
    >>> available_net_laws()[:3]
    ('matsubara', 'loland', 'aarsnes')
    """
    return tuple(_LAWS)


def known_net_law(name: str) -> bool:
    """Whether :func:`net_law` knows a name, or reads it as a power law."""
    return name in _LAWS or read_power_law(name) is not None


def net_law(name: str, **options: object) -> NetLaw:
    """Return a law by its name.

    Parameters
    ----------
    name : str
        One of :func:`available_net_laws`, or a power law as a fit gives it: ``11.4 Re^-0.40``, with the range that it
        was found in ``11.4 Re^-0.40 from 120 to 1100``.
    **options
        Fields of that law, such as ``cap`` of ``matsubara``.

    Returns
    -------
    NetLaw
        For :func:`panel_force`; says its source and range.

    Raises
    ------
    InputError
        For an unknown name or option.

    Examples
    --------
    >>> from moyai.morison import net_law
    >>> net_law("loland").name
    'loland'
    >>> net_law("11.4 Re^-0.40 from 120 to 1100").reynolds_range         # a power law of a fit [eq:net-power-law]
    (120.0, 1100.0)
    """
    numbers = read_power_law(name)
    if numbers is None and name not in _LAWS:
        near = difflib.get_close_matches(name, available_net_laws(), 1, 0.3)
        raise InputError(
            f"unknown net law '{name}'",
            parameter="law",
            allowed=", ".join(available_net_laws()),
            remedy=f"did you mean '{near[0]}'?" if near else "or a power law such as '11.4 Re^-0.40'",
        )
    law: type[NetLaw] = PowerLawNet if numbers is not None else _LAWS[name]
    known = tuple(law.__dataclass_fields__)
    unknown = [key for key in options if key not in known]
    if unknown:
        raise InputError(
            f"the net law '{name}' has no option '{unknown[0]}'",
            parameter=unknown[0],
            allowed=", ".join(known) or "none",
        )
    return law(**{**(numbers or {}), **options})


__all__ = ["Net", "NetLaw", "PowerLawNet", "available_net_laws", "known_net_law", "net_law", "panel_force"]
