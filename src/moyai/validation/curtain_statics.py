"""Validation of curtains at rest, of anchor loads in waves and of similarity: published values and identities."""

from __future__ import annotations

import math

import numpy as np

from moyai.core.validation import ValidationCase
from moyai.design.similarity import Scale, scale_water
from moyai.sea.current import power_law, uniform
from moyai.sea.water import Water
from moyai.structures.curtain.scaling import scale_curtain
from moyai.structures.curtain.seas.anchor_energy import EnergyModel, calibrate, product_needed
from moyai.structures.curtain.seas.squared_velocity import effective_height, mean_squared_velocity, squared_velocity
from moyai.structures.curtain.statics.closed_forms import (
    arc_tension_ratio,
    cable_shape_number,
    cable_tension_ratio,
    solve_cable,
    solve_skirt_arc,
)
from moyai.structures.curtain.statics.drag import constant_drag
from moyai.structures.curtain.statics.hanging import FloatLine, HangingCurtain, solve_statics
from moyai.structures.curtain.statics.load_laws import plan_laws, section_laws
from moyai.structures.curtain.statics.plan import cosine_squared_load, solve_plan
from moyai.structures.curtain.statics.planning import itopf_load, us_navy_load
from moyai.structures.curtain.statics.section import Skirt, solve_section

_PAPER = "Sawaragi, Aoki and Liu (1991), equations (2) to (6), computed independently"
_PRACTICE = "closed forms of curtain practice, computed independently"
_FIELD = "Tabata et al., equations (1) to (5), computed independently"
_SITE = Water(20.0, 1025.0, 9.81)
_DIGITS = "six printed decimals"


def _cable_residual() -> float:
    """Return the largest relative miss of equation (4) at 20 000 random ratios."""
    rng = np.random.default_rng(7)
    ratio, stiffness = 10.0 ** rng.uniform(-2, 1, 20_000), 10.0 ** rng.uniform(-3, 12, 20_000)
    b = cable_shape_number(ratio, stiffness)
    return float(np.max(np.abs(np.sinh(b) - b / ratio - 0.5 / stiffness) / (np.sinh(b) + b / ratio + 0.5 / stiffness)))


def _section_against_catenary() -> float:
    """Return the largest relative miss of depth and flare over load ratios from 0.1 to 10."""
    drag, water = constant_drag(1.5, (1.0, 1.0), "validation"), Water(math.inf, 1000.0, 9.81)
    worst = 0.0
    for ratio in 10.0 ** np.linspace(-1, 1, 9):
        speed = math.sqrt(ratio * 100.0 / 5.0 / 750.0)
        found = solve_section(Skirt(5.0, 0.0, 100.0, 4e3), uniform(speed, 0.0), 0.0, water, drag)
        law = section_laws(5.0, 100.0, 20.0 * ratio, 4e3)[3]
        worst = max(worst, abs(found.effective_depth / law.effective_depth - 1.0), abs(found.flare / law.flare - 1.0))
    return worst


def _held_against_arc() -> float:
    """Return the largest relative miss of edge loads and tension of a skirt between two cables."""
    drag, water = constant_drag(1.5, (1.0, 1.0), "validation"), Water(math.inf, 1000.0, 9.81)
    worst = 0.0
    for speed in (0.1, 0.2, 0.3):
        found = solve_section(
            Skirt(5.0, 0.0, 100.0, 5e3), uniform(speed, 0.0), 0.0, water, drag, law="uniform_normal", toe="held"
        )
        arc = solve_skirt_arc(found.effective_depth, 5.0, 750.0 * speed**2, 5e3)
        pairs = ((found.toe_hold, arc.edge_load), (found.top_load, arc.edge_load), (found.sheet_tension, arc.tension))
        worst = max(worst, *(abs(got / float(want) - 1.0) for got, want in pairs))
    return worst


def _plan_against_cable() -> float:
    """Return the largest relative miss of tension and sag of the general plan shape, pretension included."""
    rng = np.random.default_rng(9)
    worst = 0.0
    for _ in range(30):
        span, load = rng.uniform(1, 200), 10.0 ** rng.uniform(0, 3)
        length = span * rng.uniform(0.98, 2.0)
        stiffness = load * length * 10.0 ** rng.uniform(1, 6)
        plan = solve_plan(span, length, stiffness, cosine_squared_load(load, 0.0))
        cable = solve_cable(span, length, load, stiffness)
        worst = max(worst, abs(plan.tension / float(cable.tension) - 1.0), abs(plan.sag / float(cable.sag) - 1.0))
    return worst


def _oblique() -> float:
    """Return the horizontal load on both supports of an oblique cable over the pressure on its projection."""
    flow = 0.7
    plan = solve_plan(50.0, 57.0, math.inf, cosine_squared_load(120.0, flow), intervals=400)
    # force on an element is 120 cos^2 n ds; its part along the flow is 120 cos^2 dY, dY across the flow
    turn = plan.angle + flow
    across = np.diff(plan.y) * math.cos(flow) - np.diff(plan.x) * math.sin(flow)
    middle = 0.5 * (np.cos(turn[1:]) ** 2 + np.cos(turn[:-1]) ** 2)
    along_flow = 120.0 * float(middle @ across)
    down, inward = plan.downstream_end_forces, plan.inward_end_forces
    # the first support is pulled along the span, the second against it
    found = (down[0] + down[1]) * math.cos(flow) + (inward[0] - inward[1]) * math.sin(flow)
    return found / along_flow


def _planted() -> float:
    """Return M found from tensions with 15 % scatter, planted 0.2."""
    rng = np.random.default_rng(20)
    model = EnergyModel(0.2, 518.0, 890e3, 2.0, 0.6, 1.0)
    heights, periods = rng.uniform(0.5, 5.0, 2000), rng.uniform(5.0, 8.0, 2000)
    speed = model.float_speed(heights, periods, 0.1, _SITE)
    observed = model.fluctuating_tension(speed, 0.0) * (1.0 + 0.15 * rng.standard_normal(2000))
    return calibrate(observed, speed, 0.0, line_factor=0.6).energy_factor(518.0, 890e3)


def _worked_tension() -> float:
    """Return Tu [kN] of the worked example, T = 7 s, 60 degrees."""
    model = EnergyModel(0.2, 518.0, 890e3, 2.0, 1.0, 1.0)
    height = effective_height(3.06, math.radians(60.0), "paper", 1.8)
    return float(model.fluctuating_tension(model.float_speed(height, 7.0, 0.2, _SITE), 0.0)) / 1e3


def _scaled() -> float:
    """Return the largest relative miss of a model curtain at 1:25 in fresh water, converted back."""
    sea = Water(12.0, 1025.0, 9.81)
    scale = Scale(25.0, 1.025, 1.0)
    flume = scale_water(sea, scale)
    curtain = HangingCurtain(
        20.0,
        23.0,
        Skirt(6.0, 5.0, 200.0, 1e5),
        FloatLine(980.0, 100.0, 100.0),
        3e6,
        2e6,
        "free",
        0.3,
        constant_drag(1.4, (1.0, 1.0), "validation"),
        "normal_velocity",
    )
    large = solve_statics(curtain, power_law(0.3, 1 / 7, 0.2, sea), 0.2, 0.0, sea, passing_fraction=1.0)
    current = power_law(scale.to_model(0.3, "m/s"), 1 / 7, 0.2, flume)
    small = solve_statics(scale_curtain(curtain, scale), current, 0.2, 0.0, flume, passing_fraction=1.0)
    pairs = (("anchor_horizontal_tension", "N"), ("upper_tension", "N"), ("float_reserve", "N/m"), ("toe_gap", "m"))
    ratios = [scale.to_prototype(getattr(small, name), unit) / getattr(large, name) for name, unit in pairs]
    return float(max(abs(ratio - 1.0) for ratio in ratios))


CASES: tuple[ValidationCase, ...] = (
    ValidationCase("curtain statics: inextensible cable, tau at R = 0.8", _PAPER,
                   lambda: float(cable_tension_ratio(0.8)), 0.338202, 2e-6, note=_DIGITS),
    ValidationCase("curtain statics: sag over span at R = 0.9", _PAPER,
                   lambda: float(solve_cable(0.9, 1.0, 1.0).sag) / 0.9, 0.211899, 3e-6, note=_DIGITS),
    ValidationCase("curtain statics: cable with stretch, tau at R = 1, R_E = 100", _PAPER,
                   lambda: float(cable_tension_ratio(1.0, 100.0)), 1.611732, 1e-6, note=_DIGITS),
    ValidationCase("curtain statics: arc of the skirt, tau at R = 0.9, R_E = 10", _PAPER,
                   lambda: float(arc_tension_ratio(0.9, 10.0)), 0.549097, 1e-6, note=_DIGITS),
    ValidationCase("curtain statics: equation (4) at random", "identity", _cable_residual, 0.0, 2e-15,
                   relative=False, note="rounding"),
    ValidationCase("curtain statics: circular law in plan, tau at R = 0.95", _PRACTICE,
                   lambda: plan_laws(0.95, 1.0, 1.0, 1e12)[1].tension, 0.90594, 6e-6, note="five printed decimals"),
    ValidationCase("curtain statics: depth of the catenary law at qL/W = 2", _PRACTICE,
                   lambda: section_laws(1.0, 1.0, 2.0)[0].effective_depth, 0.72182, 7e-6,
                   note="five printed decimals"),
    ValidationCase("curtain statics: depth of the circular law at qL/W = 2", _PRACTICE,
                   lambda: section_laws(1.0, 1.0, 2.0)[1].effective_depth, 0.45465, 1e-5,
                   note="five printed decimals"),
    ValidationCase("curtain statics: depth of the rigid law at qL/W = 4", _PRACTICE,
                   lambda: section_laws(1.0, 1.0, 4.0)[2].effective_depth, 0.62481, 8e-6,
                   note="five printed decimals"),
    ValidationCase("curtain statics: general section against the catenary", "closed form", _section_against_catenary,
                   0.0, 1e-9, relative=False, note="fourth-order integration"),
    ValidationCase("curtain statics: held toe against equation (2)", "closed form", _held_against_arc, 0.0, 1e-9,
                   relative=False, note="fourth-order integration"),
    ValidationCase("curtain statics: general plan against equation (4)", "closed form", _plan_against_cable, 0.0, 1e-9,
                   relative=False, note="root finding"),
    ValidationCase("curtain statics: oblique plan in equilibrium", "identity", _oblique, 1.0, 1e-5,
                   note="trapezoidal sum over 400 pieces"),
    ValidationCase("curtain statics: US Navy formula as drag coefficient", "US Navy, F = 26 A V^2: C_D = 1.88",
                   lambda: us_navy_load(1.0, 1.0, 1025.0).drag_coefficient, 1.88, 3e-3, note="three printed digits"),
    ValidationCase("curtain statics: ITOPF formula as drag coefficient", "ITOPF, F = 100 A V^2: C_D = 7.2",
                   lambda: itopf_load(1.0, 1.0, 1025.0).drag_coefficient, 7.2, 7e-3, note="two printed digits"),
    ValidationCase("curtain anchors: squared velocity [m2/s2]", _FIELD,
                   lambda: float(squared_velocity(5.508, 7.0, 0.2, 5.0, _SITE)), 5.6471736, 1e-8, note="printed"),
    ValidationCase("curtain anchors: mean in time [m2/s2]", _FIELD,
                   lambda: float(mean_squared_velocity(5.508, 7.0, 0.2, 5.0, _SITE)), 2.4109, 2e-5, note="printed"),
    ValidationCase("curtain anchors: worked tension [kN]", _FIELD, _worked_tension, 14.5, 4e-3,
                   note="three printed digits"),
    ValidationCase("curtain anchors: product with pretension over product without", _FIELD,
                   lambda: float(product_needed(14.7e3, 2.0, 13.7e3) / product_needed(14.7e3, 2.0, 0.0)), 2.864, 2e-4,
                   note="four printed digits"),
    ValidationCase("curtain anchors: planted M = 0.2 found again", "planted tensions with 15 % scatter", _planted, 0.2,
                   0.02, note="2 % asked of 2000 observations"),
    ValidationCase("similarity: curtain at 1:25 in fresh water, back in the sea", "exact", _scaled, 0.0, 1e-9,
                   relative=False, note="rounding through two root searches"),
)  # fmt: skip
