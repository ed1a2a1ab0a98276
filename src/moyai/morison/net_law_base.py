"""What every law of net forces answers, and the notices where it leaves the range that it was found in.

A law is a frozen object. Its coefficients refer to the area of the panel's outline and to the speed of the water:
``drag`` along the flow, ``lift`` across it in the plane of flow and normal, positive towards the normal that points
downstream, so that a force along the normal has both positive [eq:net-panel-force].
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass
from typing import ClassVar

import numpy as np
from numpy.typing import ArrayLike

from moyai.core.arrays import Array
from moyai.core.errors import InputError
from moyai.core.options import check_kind
from moyai.core.validity import Notice
from moyai.morison.nets import Net


@dataclass(frozen=True)
class NetLaw(ABC):
    """A law of the force of flowing water on a panel of net."""

    #: Name in case files.
    name: ClassVar[str]
    #: ``screen`` (the panel as one surface) or ``twine`` (its twines one by one).
    kind: ClassVar[str]
    #: Who found it, where.
    source: ClassVar[str]
    #: Reynolds numbers that the source covers; outside them the law is continued as ``outside`` says, with a notice.
    reynolds_range: ClassVar[tuple[float, float]]
    #: Solidities that the source covers; outside them the law is continued with a notice.
    solidity_range: ClassVar[tuple[float, float]]
    #: Definition of the Reynolds number of the range.
    reynolds_name: ClassVar[str] = "Re = U d / nu"
    #: What is done outside the range of Reynolds numbers.
    outside: ClassVar[str] = "the coefficients do not depend on Re"
    #: What is left when the solidity goes to zero, or the flow is parallel to the panel.
    skin: ClassVar[str]
    #: What it was fitted to: ``nets`` (panels of fibre net of several solidities), ``one net``, ``wire nets`` (metal),
    #: ``round twines`` (a cylinder in the faster flow between the twines, of any material), ``single twine`` (a
    #: cylinder alone, without the faster flow between the twines of a net).
    basis: ClassVar[str] = "nets"
    #: Whether formula and numbers were read in the source itself; otherwise in the works that use it.
    confirmed: ClassVar[bool] = False

    @abstractmethod
    def _coefficients(self, angle: Array, speed: Array, net: Net, kinematic_viscosity: float) -> tuple[Array, Array]:
        """Return drag and lift for angles of 0 to pi/2 and speeds of the same shape."""

    def reynolds(self, speed: ArrayLike, net: Net, kinematic_viscosity: float) -> Array:
        """Return the Reynolds number (...) that the law is for [-].

        Parameters
        ----------
        speed : array_like (...)
            Of the water towards the panel [m/s].
        net : Net
            Twine and mesh.
        kinematic_viscosity : float
            [m2/s].
        """
        return np.asarray(speed, dtype=float) * net.twine_diameter / kinematic_viscosity

    def range_solidity(self, net: Net) -> float:
        """Return the solidity that the law is for [-].

        Parameters
        ----------
        net : Net
            Twine and mesh.
        """
        return net.solidity

    def coefficients(
        self, angle: ArrayLike, speed: ArrayLike, net: Net, kinematic_viscosity: float
    ) -> tuple[Array, Array]:
        """Return drag and lift coefficients on the outline area.

        Parameters
        ----------
        angle : array_like
            Between flow and normal of the panel [rad]. A panel has no front: angles beyond a right angle are those of
            the opposite normal, and the lift then points towards that one.
        speed : array_like
            Of the water relative to the panel [m/s], broadcast against the angle; its sign does not matter.
        net : Net
        kinematic_viscosity : float
            [m2/s].

        Returns
        -------
        drag, lift : ndarray
            Force along and across the flow over rho/2 A U^2, A the outline area [-].

        Raises
        ------
        InputError
            For a viscosity that is not positive or values that are not finite.
        """
        if not (np.isfinite(kinematic_viscosity) and kinematic_viscosity > 0.0):
            raise InputError(
                f"kinematic_viscosity is {kinematic_viscosity:g} m2/s",
                parameter="kinematic_viscosity",
                allowed="greater than 0 m2/s",
            )
        turned, fast = np.broadcast_arrays(np.asarray(angle, dtype=float), np.abs(np.asarray(speed, dtype=float)))
        if not (np.isfinite(turned).all() and np.isfinite(fast).all()):
            raise InputError("angle or speed is not a finite number", parameter="angle")
        # fold: the cosine keeps its size, the sine too
        folded = np.arctan2(np.abs(np.sin(turned)), np.abs(np.cos(turned)))
        drag, lift = self._coefficients(folded, fast, net, kinematic_viscosity)
        # the lift vanishes along both symmetries of the panel: no rounding of sin 2 theta is left there
        return drag, np.where((folded < 1e-12) | (np.abs(folded - 0.5 * np.pi) < 1e-12), 0.0, lift)

    def check(self, net: Net, speed_range: tuple[float, float], kinematic_viscosity: float) -> tuple[Notice, ...]:
        """Tell where a net or its speeds leave the range of the law, with the number and the limit.

        Parameters
        ----------
        net : Net
        speed_range : tuple of float
            Smallest and largest speed that matter [m/s].
        kinematic_viscosity : float
            [m2/s].
        """
        notices = []
        solidity = self.range_solidity(net)
        low, high = self.solidity_range
        if not low <= solidity <= high:
            limit = low if solidity < low else high
            notices.append(
                Notice(
                    "net-solidity-range",
                    f"{self.name}: the solidity {solidity:.3g} is {'below' if solidity < low else 'above'} the "
                    f"{limit:g} of its source; the law is extrapolated",
                    solidity,
                    limit,
                    remedy="use a law whose range holds the net, or measured coefficients",
                    source=self.source,
                )
            )
        slow, fast = (float(value) for value in self.reynolds(np.abs(speed_range), net, kinematic_viscosity))
        low, high = self.reynolds_range
        for number, limit, word in ((min(slow, fast), low, "below"), (max(slow, fast), high, "above")):
            if (number < limit) if word == "below" else (number > limit):
                notices.append(
                    Notice(
                        "net-reynolds-range",
                        f"{self.name}: {self.reynolds_name} = {number:.4g} is {word} {limit:.4g}; {self.outside}",
                        number,
                        limit,
                        remedy="take its forces there as an estimate",
                        source=self.source,
                    )
                )
        return tuple(notices)


def panel_force(
    law: NetLaw, net: Net, normal: ArrayLike, velocity: ArrayLike, *, area: float, density: float, viscosity: float
) -> Array:
    """Return the force on a plane panel [N] as a vector [eq:net-panel-force].

    Parameters
    ----------
    law : NetLaw
        From :func:`net_law`.
    net : Net
        Twine and mesh [m].
    normal : array_like, shape (3,)
        Unit normal of the panel, either side.
    velocity : array_like, shape (..., 3)
        Of the water relative to the panel [m/s].
    area : float
        Of the outline [m2].
    density, viscosity : float
        [kg/m3], kinematic [m2/s].

    Returns
    -------
    ndarray, shape (..., 3)
        Drag along the velocity and lift across it [N], in the axes of ``normal`` and ``velocity``.

    Raises
    ------
    InputError
        When the normal has no length, or the law is not for such a net.

    Examples
    --------
    >>> from moyai.morison import Net, net_law, panel_force
    >>> net = Net(twine_diameter=0.003, mesh_pitch=0.04)
    >>> flow = [0.5, 0.0, 0.0]
    >>> force = panel_force(net_law("loland"), net, [1.0, 0.0, 0.0], flow, area=10.0, density=1025.0, viscosity=1.2e-6)
    >>> force.round().tolist()
    [217.0, 0.0, 0.0]
    """
    check_kind(law, NetLaw, "law", "net_law(name) gives one")
    check_kind(net, Net, "net")
    flow = np.asarray(velocity, dtype=float)
    across = np.asarray(normal, dtype=float)
    length = float(np.linalg.norm(across))
    if not (np.isfinite(length) and length > 0.0):
        raise InputError(
            "the normal of the panel has no length", parameter="normal", allowed="a vector that is not zero"
        )
    across = across / length
    speed = np.linalg.norm(flow, axis=-1)
    along = flow / np.where(speed > 0.0, speed, 1.0)[..., None]
    cosine = along @ across
    downstream = np.where(cosine < 0.0, -1.0, 1.0)[..., None] * across
    aside = downstream - np.abs(cosine)[..., None] * along
    sine = np.linalg.norm(aside, axis=-1)
    aside = aside / np.where(sine > 0.0, sine, 1.0)[..., None]
    drag, lift = law.coefficients(np.arctan2(sine, np.abs(cosine)), speed, net, viscosity)
    head = (0.5 * density * area * speed**2)[..., None]
    return np.asarray(head * (drag[..., None] * along + lift[..., None] * aside))
