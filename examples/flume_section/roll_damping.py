"""Roll damping of a bare section by Ikeda's component method: eddies at the bilges and skin friction.

    python roll_damping.py

prints the two coefficients that section.yaml takes as input. Only geometry, mass and viscosity enter; no test in waves.

Eddy component: Ikeda, Himeno and Tanaka (1978), as in ITTC Recommended Procedure 7.5-02-07-04.5 (2011), section 2.2.4.
Friction: Kato (1957), laminar, same procedure, section 2.2.3. The section is described by its Lewis form, which has no
flat bottom; half beam over draught, area coefficient and bilge radius are those of the model.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class BareSection:
    """Section whose roll is damped.

    Parameters
    ----------
    beam, draught, bilge_radius : float
        [m].
    area : float
        Immersed area [m2].
    centre_of_gravity_above_keel : float
        Roll axis [m].
    length : float
        Length of the unit [m].
    """

    beam: float
    draught: float
    bilge_radius: float
    area: float
    centre_of_gravity_above_keel: float
    length: float


MODEL = BareSection(
    beam=0.40,
    draught=0.20,
    bilge_radius=0.0512,
    area=0.40 * 0.20 - 2.0 * (1.0 - 0.25 * math.pi) * 0.0512**2,
    centre_of_gravity_above_keel=0.106,
    length=0.586,
)
DENSITY = 1000.0
VISCOSITY = 1.1e-6  # kinematic, fresh water near 17 degrees [m2/s]
ROLL_PERIOD = 1.26  # natural period of the source's own decay tests [s]


def lewis_parameters(half_beam_over_draught: float, area_coefficient: float) -> tuple[float, float]:
    """Return a1 and a3 of the Lewis form with this ratio and area."""
    ratio = (half_beam_over_draught - 1.0) / (half_beam_over_draught + 1.0)
    c = 4.0 * area_coefficient / math.pi
    d = 3.0 + c + (1.0 - c) * ratio**2
    a3 = (3.0 - d + math.sqrt(9.0 - 2.0 * d)) / d
    return (1.0 + a3) * ratio, a3


def eddy_coefficient(section: BareSection) -> float:
    """Return Ikeda's C_R: the moment per length is C_R rho d^4 |theta'| theta' / 2."""
    d, radius = section.draught, section.bilge_radius / section.draught
    og = 1.0 - section.centre_of_gravity_above_keel / d  # roll axis below still water, over draught
    h0 = section.beam / (2.0 * d)
    sigma = section.area / (section.beam * d)
    f1 = 0.5 * (1.0 + math.tanh(20.0 * (sigma - 0.7)))
    f2 = (
        0.5 * (1.0 - math.cos(math.pi * sigma))
        - 1.5 * (1.0 - math.exp(-5.0 * (1.0 - sigma))) * math.sin(math.pi * sigma) ** 2
    )
    f3 = 1.0 + 4.0 * math.exp(-1.65e5 * (1.0 - sigma) ** 2)
    # The flow about the roll axis is that about a section cut off at the axis
    h0_axis, sigma_axis = h0 / (1.0 - og), (sigma - og) / (1.0 - og)
    a1, a3 = lewis_parameters(h0_axis, sigma_axis)
    scale = section.beam / (2.0 * (1.0 + a1 + a3))

    def distance(psi: float) -> float:
        across = (1.0 + a1) * math.sin(psi) - a3 * math.sin(3.0 * psi)
        down = (1.0 - a1) * math.cos(psi) + a3 * math.cos(3.0 * psi)
        return scale * math.hypot(across, down)

    turning = a1 * (1.0 + a3) / (4.0 * a3)
    candidates = [0.0] + ([0.5 * math.acos(turning)] if abs(turning) <= 1.0 else [])
    psi = max(candidates, key=distance)
    farthest = distance(psi)
    h = 1.0 + a1**2 + 9.0 * a3**2 + 2.0 * a1 * (1.0 - 3.0 * a3) * math.cos(2.0 * psi) - 6.0 * a3 * math.cos(4.0 * psi)
    a = (
        -2.0 * a3 * math.cos(5.0 * psi)
        + a1 * (1.0 - a3) * math.cos(3.0 * psi)
        + ((6.0 - 3.0 * a1) * a3**2 + (a1**2 - 3.0 * a1) * a3 + a1**2) * math.cos(psi)
    )
    b = (
        -2.0 * a3 * math.sin(5.0 * psi)
        + a1 * (1.0 - a3) * math.sin(3.0 * psi)
        + ((6.0 + 3.0 * a1) * a3**2 + (3.0 * a1 + a1**2) * a3 + a1**2) * math.sin(psi)
    )
    gamma = (
        math.sqrt(math.pi)
        * f3
        / (2.0 * d * (1.0 - og) * math.sqrt(h0_axis * sigma_axis))
        * (farthest + 2.0 * scale / h * math.hypot(a, b))
    )
    pressure = 0.5 * (0.87 * math.exp(-gamma) - 4.0 * math.exp(-0.187 * gamma) + 3.0)
    lever = (1.0 - f1 * radius) * (1.0 - og - f1 * radius) + f2 * (h0 - f1 * radius) ** 2
    return lever * pressure * (farthest / d) ** 2


def quadratic_roll_damping(section: BareSection, density: float) -> float:
    """Return b2 of the whole unit in b2 |theta'| theta' [N m s2]."""
    return 0.5 * density * section.draught**4 * eddy_coefficient(section) * section.length


def friction_roll_damping(section: BareSection, density: float, viscosity: float, period: float) -> float:
    """Return b1 of the whole unit in b1 theta' [N m s], Kato's laminar skin friction without its amplitude term."""
    omega = 2.0 * math.pi / period
    wetted = section.length * (1.7 * section.draught + section.area / section.draught)
    og = section.draught - section.centre_of_gravity_above_keel
    block = section.area / (section.beam * section.draught)
    radius = ((0.887 + 0.145 * block) * (1.7 * section.draught + block * section.beam) - 2.0 * og) / math.pi
    return 0.787 * density * wetted * radius**2 * math.sqrt(omega * viscosity)


def main() -> None:
    """Print the coefficients for the model."""
    quadratic = quadratic_roll_damping(MODEL, DENSITY)
    linear = friction_roll_damping(MODEL, DENSITY, VISCOSITY, ROLL_PERIOD)
    print(f"eddy coefficient C_R = {eddy_coefficient(MODEL):.4f}")
    print(f"quadratic b2 = {quadratic:.4f} N m s2, linear b1 = {linear:.4f} N m s")
    omega = 2.0 * math.pi / ROLL_PERIOD
    for amplitude in (0.02, 0.1, 0.2):
        equivalent = linear + 8.0 / (3.0 * np.pi) * omega * amplitude * quadratic
        print(f"  at {amplitude:.2f} rad equivalent {equivalent:.3f} N m s")


if __name__ == "__main__":
    main()
