"""The model cage of Matsubara, Noda and Nishihira, with the moorings that its paper leaves open.

Cube of 20 cm, sides and bottom of net F (twine 0.45 mm, aperture 2.09 mm), twelve floats of 4.01 cm on the top frame.
The 291.05 gf of its table are net and frame: 0.983 kg/m2 on 0.2 m2 make 197 g, rods of 2.5 mm along twelve edges the
rest; the 72.5 gf of its text are the floats. Anchors, attachments and pull are missing in the paper.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Literal

from moyai.core.options import checks_words
from moyai.morison.net_law_names import Net, net_law
from moyai.sea.water import Water
from moyai.structures.cage.rigid.lines import CageLine
from moyai.structures.cage.rigid.model import RigidLinePlan
from moyai.structures.cage.rigid.parts import Floats, RigidCage
from moyai.structures.cage.rigid.setup import resolve
from moyai.structures.cage.rigid.shapes import box_floats, box_patches, box_rods

SIDE = 0.20  # m
WEIGHED = 0.29105  # kg, net and frame (table 2)
FLOAT_DIAMETER, FLOAT_MASS = 0.0401, 6.04e-3  # m, kg (table 2)
NET_MASS, STEEL = 0.983, 7850.0  # kg/m2 (table 2), kg/m3
VISCOSITY = 1.14e-6  # m2/s, 15 degrees Celsius
WATER = Water(0.45, 1000.0, 9.81)  # depth of the tests


@checks_words
def model_cage(*, patches: int = 3, weighed_with_floats: bool = False, drag: bool = True) -> RigidCage:
    """Return the cage.

    Parameters
    ----------
    patches : int
        Along each edge of a face.
    weighed_with_floats : bool
        Read the 291.05 gf as the whole cage; its frame then is lighter than any metal.
    drag : bool
        False leaves all drag out.

    Returns
    -------
    RigidCage
        The model cage of the paper.

    Raises
    ------
    InputError
        Where ``weighed_with_floats`` or ``drag`` is neither true nor false.

    Examples
    --------
    >>> from moyai.structures import model_cage
    >>> round(model_cage().mass, 3)                                  # net, frame and floats [kg]
    0.364
    """
    faces = box_patches(SIDE, SIDE, SIDE, ("sides", "bottom"), patches)
    floats = Floats(box_floats(SIDE, SIDE, 0.5 * SIDE, 3), FLOAT_DIAMETER, FLOAT_MASS, 0.6 if drag else 0.0, 0.5)
    rods = box_rods(SIDE, SIDE, SIDE, 2.5e-3)
    frame = WEIGHED - NET_MASS * faces.area - (FLOAT_MASS * len(floats.points) if weighed_with_floats else 0.0)
    return RigidCage(
        floats=floats,
        patches=faces,
        net=Net.from_aperture(0.45e-3, 2.09e-3, solidity_listed=0.355),
        law=net_law("matsubara") if drag else net_law("matsubara", cap=1e-12),
        net_mass=NET_MASS,
        net_volume=NET_MASS / STEEL,
        net_added_mass=1.0,
        rods=tuple(replace(rod, mass=frame / len(rods)) for rod in rods),
        rod_drag=1.2 if drag else 0.0,
        rod_added_mass=1.0,
        extent=(SIDE, SIDE, SIDE),
    )


@checks_words
def taut_lines(
    cage: RigidCage,
    *,
    kind: Literal["crossed_top", "outward_bottom"] = "crossed_top",
    anchor_distance: float = 0.30,
    pull_down: float = 0.011,
    stiffness: float = 2000.0,
) -> tuple[CageLine, ...]:
    """Return the offshore (-x) and the shore line.

    Parameters
    ----------
    cage : RigidCage
        Of :func:`moyai.structures.model_cage`.
    kind : str
        From the top corners to the opposite anchors, or from the bottom corners outward.
    anchor_distance, pull_down : float
        [m].
    stiffness : float
        [N/m].

    Returns
    -------
    tuple of CageLine
        Offshore and shore line.

    Raises
    ------
    InputError
        For another kind.

    Examples
    --------
    >>> from moyai.structures import model_cage, taut_lines
    >>> len(taut_lines(model_cage()))
    2
    """
    crossed = kind == "crossed_top"
    plans = tuple(
        RigidLinePlan(
            name,
            cage.attachment("top" if crossed else "bottom", side),
            (-side if crossed else side) * anchor_distance,
            0.0,
            "pull_down",
            pull_down,
            stiffness,
        )
        for name, side in (("offshore line", -1.0), ("shore line", 1.0))
    )
    return resolve(cage, plans, WATER, VISCOSITY)
