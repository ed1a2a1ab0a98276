"""The equations of Matsubara, Noda and Nishihira as they are printed, to see what their faults do.

Every fault is a change of the packed cage, so that one at a time, or all of them, can be put on the sound equations.
"""

from __future__ import annotations

from typing import Literal

import numpy as np

from moyai.sea.water import Water
from moyai.structures.cage.rigid.parts import RigidCage
from moyai.structures.cage.rigid.water_kernel import PackedCage

Fault = Literal[
    "submerged_mass",
    "enclosed_volume",
    "relative_acceleration",
    "line_signs",
    "moment",
    "constant_buoyancy",
    "single_force",
]

#: Fault: what the print says and what is wrong with it
FAULTS: dict[str, str] = {
    "submerged_mass": "(i) the mass of inertia is the weight in water over gravity; inertia needs the dry mass",
    "enclosed_volume": "(ii) the volume in the inertia force is that of the cage, water within included",
    "relative_acceleration": "(iii) C_m rho V (du/dt - x'') drops the Froude-Krylov force's own share",
    "line_signs": "(iv) H_A0 pulls towards +x, H_A towards -x, whichever way the lines run",
    "moment": "(v), (vi) the moment omits every vertical force: of lines, buoyancy and water",
    "constant_buoyancy": "(vii) U is a constant, although the floats pierce the surface",
    "single_force": "(viii) one force on the whole net at the middle of the cage: rotation is not damped",
}

#: C_m of a body whose volume is enclosed by net, C_m = 1 + C_a with C_a = 1, as for cylinders
ENCLOSED_INERTIA = 2.0


def literal_pack(
    packed: PackedCage, cage: RigidCage, water: Water, faults: tuple[str, ...] = tuple(FAULTS)
) -> PackedCage:
    """Return the packed cage with printed equations [eq:cage-literal].

    Parameters
    ----------
    packed : Packed
        The sound one.
    cage : RigidCage
    water : Water
    faults : tuple of str
        Among :data:`FAULTS`; all of them make the printed equations.
    """
    body, spheres, patches, rods = (
        packed.body.copy(),
        packed.spheres.copy(),
        packed.patches.copy(),
        packed.rods.copy(),
    )
    lines, blocks = packed.lines.copy(), packed.blocks
    x, z = cage.centre
    if "submerged_mass" in faults:
        body[0] = abs(cage.mass - water.density * cage.solid_volume)
        body[1] *= body[0] / cage.mass
    if "moment" in faults:
        body[4] = 0.0
    if "constant_buoyancy" in faults:
        body[5] = water.gravity * water.density * (cage.float_volume + cage.solid_volume)
    inertia = 1.0
    if "single_force" in faults:
        across = float(np.sum(patches[:, 4] * patches[:, 2] ** 2))
        level = float(np.sum(patches[:, 4] * patches[:, 3] ** 2))
        along = float(np.sum(patches[:, 4])) - across - level
        block = np.array([[-x, -z, cage.solid_volume, 1.0 + inertia, inertia, across + 0.5 * along, level]])
        blocks = np.ascontiguousarray(np.concatenate([blocks, block]))
        patches, rods = patches[:0].copy(), rods[:0].copy()
        if "constant_buoyancy" not in faults:
            # what the net and the frame displaced still carries
            body[2] -= water.gravity * water.density * cage.solid_volume
    if "enclosed_volume" in faults:
        if len(blocks):
            blocks[0, 2] = cage.enclosed_volume
        else:
            row = np.array([[-x, -z, cage.enclosed_volume, ENCLOSED_INERTIA, ENCLOSED_INERTIA - 1.0, 0.0, 0.0]])
            blocks = row
    if "relative_acceleration" in faults:
        spheres[:, 6] = spheres[:, 5]
        if len(blocks):
            blocks[:, 4] = blocks[:, 3]
        # C_m on the relative acceleration: no part of the force of the undisturbed water stands alone
        patches[:, 7], patches[:, 8] = 0.0, 1.0 + patches[:, 8]
        rods[:, 10], rods[:, 8] = 0.0, 1.0 + rods[:, 8]
    if "line_signs" in faults:
        for n in range(len(lines)):
            shore = lines[n, 0] > 0.0
            # the printed pull: of the shore line towards -x, of the offshore line towards +x
            runs = np.sign(lines[n, 2] - lines[n, 0])
            lines[n, 7] = (-1.0 if shore else 1.0) * (runs if runs != 0.0 else 1.0)
    return packed._replace(body=body, spheres=spheres, patches=patches, rods=rods, blocks=blocks, lines=lines)
