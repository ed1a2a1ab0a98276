"""Which laws were measured on nets like the one given, and how far apart they are there.

How the answer is made: docs/answer/cage.md, section on the laws of nets.
"""

from __future__ import annotations

from dataclasses import dataclass

from moyai.core.validity import Notice
from moyai.morison.net_law_base import NetLaw
from moyai.morison.net_law_names import available_net_laws, net_law
from moyai.morison.nets import Net

#: Density from which a twine counts as metal [kg/m3].
METAL = 4000.0
_BASES = {"nets": "fibre nets", "one net": "one net", "wire nets": "wire nets", "single twine": "single cylinders"}


@dataclass(frozen=True)
class LawChoice:
    """The laws that were measured on nets like this one, by their drag at normal flow."""

    #: That of the case.
    chosen: NetLaw
    #: Its C_D at normal flow [-].
    drag: float
    #: Those that are valid here and the chosen one, by their C_D.
    laws: tuple[NetLaw, ...]
    #: Their C_D [-]. The loads of a net that gives way follow their angles too: all of them are run.
    drags: tuple[float, ...]
    #: Why each other law is left out.
    reasons: dict[str, str]
    #: U d / nu [-].
    reynolds: float

    @property
    def named(self) -> str:
        """The valid laws in words."""
        return ", ".join(law.name for law in self.laws)

    @property
    def others(self) -> tuple[NetLaw, ...]:
        """The laws next to the chosen one."""
        return tuple(law for law in self.laws if law is not self.chosen)

    @property
    def measured(self) -> bool:
        """Whether the chosen law is one of those measured on nets like this one."""
        return self.chosen.name not in self.reasons


def law_choice(chosen: NetLaw, net: Net, speed: float, kinematic_viscosity: float, *, metal: bool = False) -> LawChoice:
    """Return the laws valid for a net at a speed.

    A law is valid where solidity and Reynolds number lie in the range of its source, and where it was fitted to panels
    of such nets: laws of single twines leave out the faster flow between them, a law of one net is for that net,
    laws of wire nets of metal.

    Parameters
    ----------
    chosen : NetLaw
        Law of the case; it counts in any case.
    net : Net
    speed : float
        Design speed of the water [m/s].
    kinematic_viscosity : float
        [m2/s].
    metal : bool
        Whether the twines are of metal.
    """

    def drag(law: NetLaw) -> float:
        return float(law.coefficients(0.0, speed, net, kinematic_viscosity)[0])

    reasons: dict[str, str] = {}
    laws: dict[str, NetLaw] = {}
    for name in available_net_laws():
        law = chosen if name == chosen.name else net_law(name)
        why = _left_out(law, net, speed, kinematic_viscosity, metal)
        if why:
            reasons[name] = why
        else:
            laws[name] = law
    why = _left_out(chosen, net, speed, kinematic_viscosity, metal)
    if why:
        reasons[chosen.name] = why
    laws[chosen.name] = chosen
    ordered = sorted(laws.values(), key=drag)
    return LawChoice(
        chosen,
        drag(chosen),
        tuple(ordered),
        tuple(drag(law) for law in ordered),
        reasons,
        speed * net.twine_diameter / kinematic_viscosity,
    )


def _left_out(law: NetLaw, net: Net, speed: float, kinematic_viscosity: float, metal: bool) -> str:
    """Return why a law is not valid for a net, empty where it is."""
    if law.basis == "wire nets" and not metal:
        return "measured on wire nets"
    if law.basis == "nets" and metal:
        return "measured on fibre nets"
    if law.basis in ("single twine", "one net"):
        return f"measured on {_BASES[law.basis]}"
    solidity = law.range_solidity(net)
    low, high = law.solidity_range
    if not low <= solidity <= high:
        return f"solidity {solidity:.3g} outside {low:g} to {high:g}"
    number = float(law.reynolds(speed, net, kinematic_viscosity))
    slow, fast = law.reynolds_range
    if not slow <= number <= fast:
        return f"Re = {number:.3g} outside {slow:.3g} to {fast:.3g}; {law.outside}"
    return ""


def choice_notice(choice: LawChoice, net: Net) -> Notice:
    """Say which laws were measured on nets like this one, and what they give."""
    spread = f"C_D = {choice.drags[0]:.2f} to {choice.drags[-1]:.2f} at normal flow"
    like = f"solidity {net.solidity:.2g}, {'knotted' if net.knotted else 'knotless'}, Re = {choice.reynolds:.2g}"
    if choice.measured:
        return Notice(
            "net-law-choice",
            f"laws measured on nets like this one ({like}): {choice.named}, {spread}; {choice.chosen.name} is used "
            f"with {choice.drag:.2f}",
            choice.drag, severity="information", remedy="take measured coefficients of this net where there are any",
        )  # fmt: skip
    others = [law.name for law in choice.others]
    return Notice(
        "net-law-choice",
        f"the law {choice.chosen.name} (C_D = {choice.drag:.2f}) was not measured on nets like this one ({like}): "
        f"{choice.reasons[choice.chosen.name]}",
        choice.drag, severity="warning",
        remedy=f"take one of: {', '.join(others)}" if others else "take measured coefficients of this net",
    )  # fmt: skip
