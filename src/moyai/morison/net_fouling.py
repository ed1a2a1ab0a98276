"""Growth on a net: thicker twines, so more solidity, mass and drag."""

from __future__ import annotations

import dataclasses
import math
from dataclasses import dataclass

from moyai.core.errors import InputError
from moyai.core.validity import Notice
from moyai.morison.net_law_base import NetLaw
from moyai.morison.nets import Net
from moyai.tables.nets import net_fouling

#: Share of the aperture that growth may close before the net behaves like a wall rather than like a net
_CLOSED = 0.9


@dataclass(frozen=True)
class FouledNet:
    """A net under growth."""

    #: The net without the growth.
    clean: Net
    #: The net with the growth.
    net: Net
    #: Of the growth [kg/m3].
    density: float

    @property
    def growth_volume(self) -> float:
        """Volume of growth per outline area [m]: rings about the twines [eq:net-fouling]."""
        ring = math.pi / 4.0 * (self.net.twine_diameter**2 - self.clean.twine_diameter**2)
        return ring * self.clean.twine_length_per_area

    @property
    def added_mass_per_area(self) -> float:
        """Mass of the growth in air per outline area [kg/m2]."""
        return self.density * self.growth_volume

    def added_weight_per_area(self, water_density: float, gravity: float) -> float:
        """Return the submerged weight of the growth per outline area [N/m2], negative when it floats."""
        return (self.density - water_density) * gravity * self.growth_volume

    def drag_ratio(self, law: NetLaw, angle: float, speed: float, viscosity: float) -> float:
        """Return the drag of the fouled over that of the clean panel by a law.

        Parameters
        ----------
        law : NetLaw
        angle : float
            Between flow and normal [rad].
        speed, viscosity : float
            [m/s], kinematic [m2/s].
        """
        clean, _ = law.coefficients(angle, speed, self.clean, viscosity)
        fouled, _ = law.coefficients(angle, speed, self.net, viscosity)
        return float(fouled) / float(clean)


def foul(net: Net, diameter_factor: float, density: float) -> FouledNet:
    """Return a net whose twines have grown by a factor, its meshes unchanged [eq:net-fouling].

    A listed or measured solidity is raised in the ratio of the geometric ones, up to what is geometrically possible.

    Parameters
    ----------
    net : Net
    diameter_factor : float
        Fouled over clean twine diameter, 1 for none [-].
    density : float
        Of the growth [kg/m3].

    Raises
    ------
    InputError
        When the factor is below 1, or the growth closes the meshes.
    """
    if not (math.isfinite(diameter_factor) and diameter_factor >= 1.0):
        raise InputError(
            f"diameter_factor is {diameter_factor:g}",
            parameter="diameter_factor",
            allowed="at least 1, which is no growth",
        )
    if not (math.isfinite(density) and density > 0.0):
        raise InputError(f"density of the growth is {density:g} kg/m3", parameter="density", allowed="greater than 0")
    grown = diameter_factor * net.twine_diameter
    limit = net.mesh_pitch / net.twine_diameter
    if grown >= net.mesh_pitch:
        raise InputError(
            f"growth by a factor of {diameter_factor:g} closes the meshes",
            parameter="diameter_factor",
            allowed=f"below {limit:.4g} for this net",
            remedy="a closed net is a wall: give its drag as measured",
        )
    bare = dataclasses.replace(net, twine_diameter=grown, solidity_listed=None, solidity_measured=None)
    rise = bare.solidity_geometric / net.solidity_geometric
    listed, measured = (
        _raised(name, given, rise, diameter_factor)
        for name, given in (("solidity_listed", net.solidity_listed), ("solidity_measured", net.solidity_measured))
    )
    grown_net = dataclasses.replace(bare, solidity_listed=listed, solidity_measured=measured)
    return FouledNet(net, grown_net, density)


def _raised(name: str, given: float | None, rise: float, factor: float) -> float | None:
    if given is None or given * rise < 1.0:
        return None if given is None else given * rise
    raise InputError(
        f"growth by a factor of {factor:g} raises {name} to {given * rise:.3g}",
        parameter="diameter_factor",
        allowed="a solidity between 0 and 1",
    )


def foul_by_name(net: Net, name: str) -> FouledNet:
    """Return a net under the growth of an entry of the table that gives a twine diameter.

    Raises
    ------
    InputError
        For an unknown entry, or one that is for drag alone.
    """
    entry = net_fouling(name)
    if math.isnan(entry.diameter_factor):
        raise InputError(
            f"the growth '{name}' is given as a factor on drag",
            parameter="fouling",
            remedy=f"multiply the drag by {entry.drag_factor:g}, or use diameter_for_drag",
        )
    return foul(net, entry.diameter_factor, entry.density)


def diameter_for_drag(law: NetLaw, net: Net, drag_factor: float, *, speed: float, viscosity: float) -> float:
    """Return the diameter factor at which a law gives a panel so much more drag at normal flow.

    Parameters
    ----------
    law : NetLaw
    net : Net
    drag_factor : float
        Fouled over clean drag, at least 1 [-].
    speed, viscosity : float
        [m/s], kinematic [m2/s].

    Raises
    ------
    InputError
        When the law does not reach it before the meshes close.
    """
    from scipy.optimize import brentq

    if not (math.isfinite(drag_factor) and drag_factor >= 1.0):
        raise InputError(f"drag_factor is {drag_factor:g}", parameter="drag_factor", allowed="at least 1")
    plain = dataclasses.replace(net, solidity_listed=None, solidity_measured=None)
    clean = float(law.coefficients(0.0, speed, plain, viscosity)[0])
    most = 1.0 + _CLOSED * (net.mesh_pitch / net.twine_diameter - 1.0)

    def excess(factor: float) -> float:
        grown = foul(plain, factor, 1.0).net
        return float(law.coefficients(0.0, speed, grown, viscosity)[0]) / clean - drag_factor

    if excess(most) < 0.0:
        raise InputError(
            f"{law.name} does not reach {drag_factor:g} times the drag of {clean:.3g} before the meshes close",
            parameter="drag_factor",
            allowed=f"up to {excess(most) + drag_factor:.3g}",
        )
    return float(brentq(excess, 1.0, most, xtol=1e-12))


def check_fouling(name: str) -> tuple[Notice, ...]:
    """Tell when an entry of the table was not read in its source."""
    entry = net_fouling(name)
    if entry.confirmed:
        return ()
    return (
        Notice(
            "net-fouling-unconfirmed",
            f"the growth '{name}' was not read in its source",
            severity="information",
            remedy="check the standard or survey the site before design use",
            source=entry.source,
        ),
    )
