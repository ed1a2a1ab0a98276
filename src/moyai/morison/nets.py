"""A net: twine, mesh and the different things that are called its solidity."""

from __future__ import annotations

import math
from dataclasses import dataclass

from moyai.core.errors import InputError
from moyai.core.options import checks_words


@checks_words
@dataclass(frozen=True)
class Net:
    """Square meshes of twine.

    Raises
    ------
    InputError
        For lengths that are not positive, or a solidity that is not between 0 and 1.

    Examples
    --------
    >>> from moyai.morison import Net
    >>> net = Net(twine_diameter=2.5e-3, mesh_pitch=25e-3)
    >>> round(net.solidity, 3), round(net.aperture, 4)                   # 2 d / l - (d / l)^2 [-], [m]
    (0.19, 0.0225)
    """

    #: d [m].
    twine_diameter: float
    #: p, from centre to centre of neighbouring twines: the bar length of a mesh, half of the stretched mesh [m]. The
    #: clear aperture is p - d.
    mesh_pitch: float
    #: Shading ratio as a paper or a maker lists it, by whatever definition; None takes 2 d / p, which counts the
    #: crossings twice. Kept apart from the geometric one: only laws that were fitted to listed values use it.
    solidity_listed: float | None = None
    #: Whether the crossings are knots, which shade more than the twines that they join.
    knotted: bool = False
    #: Shaded share of the outline area found by measurement (a picture of the net, say), crossings counted once; takes
    #: the place of the formula in ``solidity``.
    solidity_measured: float | None = None

    def __post_init__(self) -> None:
        for name in ("twine_diameter", "mesh_pitch"):
            value = getattr(self, name)
            if not (math.isfinite(value) and value > 0.0):
                raise InputError(f"{name} is {value:g} m", parameter=name, allowed="greater than 0 m")
        for name in ("solidity_listed", "solidity_measured"):
            value = getattr(self, name)
            if value is not None and not (math.isfinite(value) and 0.0 < value < 1.0):
                remedy = f"a percentage is written as a share: {value / 100.0:g}" if 1.0 < value < 100.0 else ""
                raise InputError(f"{name} is {value:g}", parameter=name, allowed="between 0 and 1", remedy=remedy)
        if self.twine_diameter >= self.mesh_pitch:
            raise InputError(
                f"twines of {self.twine_diameter * 1e3:.4g} mm close meshes of {self.mesh_pitch * 1e3:.4g} mm pitch",
                parameter="mesh_pitch",
                allowed="greater than the twine diameter",
                remedy="the pitch is the aperture plus the diameter, the bar length of a mesh",
            )
        if self.solidity_geometric >= 1.0:
            raise InputError(
                f"knots of this net shade {self.solidity_geometric:.3g} of its area",
                parameter="knotted",
                allowed="a solidity between 0 and 1",
                remedy="use a thinner twine or a wider mesh",
            )

    @classmethod
    @checks_words
    def from_aperture(
        cls, twine_diameter: float, aperture: float, *, solidity_listed: float | None = None, knotted: bool = False
    ) -> Net:
        """Return a net from twine diameter and clear aperture [m].

        Parameters
        ----------
        twine_diameter : float
            [m].
        aperture : float
            Clear width between twines [m].
        solidity_listed : float, optional
            As the maker gives it [-].
        knotted : bool
            Whether the twines are knotted.

        Raises
        ------
        InputError
            For sizes of which no net can be made.
        """
        return cls(twine_diameter, twine_diameter + aperture, solidity_listed, knotted)

    @classmethod
    def from_solidity(cls, twine_diameter: float, solidity: float) -> Net:
        """Return the knotless net of a geometric solidity [-], its pitch found from it [m].

        Parameters
        ----------
        twine_diameter : float
            [m].
        solidity : float
            Between 0 and 1 [-].

        Raises
        ------
        InputError
            For a solidity that is not between 0 and 1.
        """
        if not (math.isfinite(solidity) and 0.0 < solidity < 1.0):
            raise InputError(f"solidity is {solidity:g}", parameter="solidity", allowed="between 0 and 1")
        return cls(twine_diameter, twine_diameter / (1.0 - math.sqrt(1.0 - solidity)))

    @property
    def aperture(self) -> float:
        """Clear opening between twines [m]."""
        return self.mesh_pitch - self.twine_diameter

    @property
    def solidity_geometric(self) -> float:
        """Shaded share by the geometry [eq:net-solidity-geometric]: 2 d/p - (d/p)^2; knotted 2 d/p + (d/p)^2 / 2."""
        ratio = self.twine_diameter / self.mesh_pitch
        return 2.0 * ratio + (0.5 if self.knotted else -1.0) * ratio**2

    @property
    def solidity(self) -> float:
        """Solidity that modern laws use [-]: the measured one where there is one, else that of the geometry."""
        return self.solidity_geometric if self.solidity_measured is None else self.solidity_measured

    @property
    def solidity_doubled(self) -> float:
        """Ratio 2 d / p, crossings counted twice, as older papers list it [eq:net-solidity-doubled]."""
        return 2.0 * self.twine_diameter / self.mesh_pitch

    @property
    def listed(self) -> float:
        """The listed solidity, 2 d / p where none is listed [-]."""
        return self.solidity_doubled if self.solidity_listed is None else self.solidity_listed

    @property
    def twine_area_per_area(self) -> float:
        """Area of twines across the flow per outline area, crossings counted once: the solidity [-]."""
        return self.solidity

    @property
    def twine_length_per_area(self) -> float:
        """Length of twine per outline area, both families [1/m]."""
        return 2.0 / self.mesh_pitch

    @property
    def volume_per_area(self) -> float:
        """Volume of twine material per outline area [m], of round, solid twines without their crossings."""
        return self.twine_length_per_area * math.pi / 4.0 * self.twine_diameter**2
