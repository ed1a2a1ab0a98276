"""Case files of a network as MoorDyn decks."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from moyai.core.errors import InputError
from moyai.interop.moordyn_deck import MoorDynDeck
from moyai.interop.moordyn_network import to_deck
from moyai.interop.moordyn_records import FREQUENCY_FILE, DeckCurrent, DeckOption, DeckWaves
from moyai.interop.write_orcaflex_vessel import FloatingBox

if TYPE_CHECKING:
    from moyai.case.reader import Case
    from moyai.sea.water import Water
    from moyai.structures.network.body_plan import BodyPlan
    from moyai.structures.network.model import NetworkProblem

#: Heights at which a current is written.
CURRENT_ROWS = 101


def deck_of_case(case: Case, water_level: str | None = None) -> MoorDynDeck:
    """Return the deck of a network case without bodies at one water level (the first when left out).

    Raises
    ------
    InputError
        For a case of another structure or with bodies, or an unknown water level.
    CaseError
        All that MoorDyn cannot express, see :func:`moyai.interop.moordyn_network.to_deck`.
    """
    deck, boxes = deck_and_boxes(case, water_level)
    if boxes:
        raise InputError(
            f"the body '{boxes[0].name}' cannot be written into a deck", path="structure.bodies",
            remedy="decks with bodies are read, not written: give MoorDyn the body in a deck of your own",
        )  # fmt: skip
    return deck


def deck_and_boxes(
    case: Case, water_level: str | None = None, *, floating: bool = False
) -> tuple[MoorDynDeck, tuple[FloatingBox, ...]]:
    """Return the deck of a network case, in which points of bodies are coupled, and its bodies.

    ``floating`` is that of :func:`moyai.interop.moordyn_network.to_deck`.

    Raises
    ------
    InputError
        For a case of another structure, a body assembled of parts or turned at the start, or an unknown water level.
    CaseError
        See :func:`deck_of_case`.
    """
    from moyai.case.builder import build
    from moyai.structures.network.assembly import assemble

    if case.kind != "network":
        raise InputError(f"a case of kind '{case.kind}' has no deck", path="structure.kind", allowed="network")
    problem = build(case)
    levels = dict(problem.environment.water_levels)
    name = water_level or next(iter(levels))
    if name not in levels:
        raise InputError(f"there is no water level '{name}'", path="--water-level", allowed=", ".join(levels))
    deck = to_deck(assemble(problem, levels[name]).network, title=case.title, floating=floating)
    water = problem.environment.water_at(levels[name])
    return _with_sea(deck, problem, water), tuple(_box(plan, water) for plan in problem.bodies)


def _box(plan: BodyPlan, water: Water) -> FloatingBox:
    """Return a body as a vessel takes it; stiffness of an upright prism about its centre of gravity."""
    if plan.shape == "assembly" or any(plan.rotation):
        raise InputError(
            f"the body '{plan.name}' is no upright box or cylinder", path="structure.bodies",
            allowed="bodies of the shapes box and cylinder, without a rotation",
        )  # fmt: skip
    x, y, z = plan.size
    round_ = plan.shape == "cylinder"
    area = math.pi / 4.0 * x * y if round_ else x * y
    second = (math.pi / 64.0 * x * y**3, math.pi / 64.0 * y * x**3) if round_ else (x * y**3 / 12.0, y * x**3 / 12.0)
    draught = min(max(0.5 * z - plan.position[2], 0.0), z)
    volume, weight = area * draught, water.density * water.gravity
    arm = 0.5 * (draught - z) - plan.centre_of_gravity[2]
    surface = area if 0.0 < draught < z else 0.0
    roll, pitch = (weight * (volume * arm + (part if surface else 0.0)) for part in second)
    along, across, upwards = (water.density * volume * share for share in plan.added_mass)
    return FloatingBox(
        plan.name, plan.position, x, plan.mass, plan.inertia, plan.centre_of_gravity,
        (weight * surface, roll, pitch), (along, across, upwards), tuple(plan.points.values()),
    )  # fmt: skip


def _with_sea(deck: MoorDynDeck, problem: NetworkProblem, water: Water) -> MoorDynDeck:
    """Return the deck with the current and the waves of a case; notes say what a deck cannot hold."""
    from moyai.structures.network.runs import run_plans

    options, notes, current, waves = list(deck.options), list(deck.notes), None, None
    flowing = problem.environment.current
    if flowing is not None:
        heights = np.linspace(-water.depth, 0.0, CURRENT_ROWS)
        velocity = flowing.in_depth(water.depth).velocity(heights)
        current = DeckCurrent(tuple(map(float, heights)), tuple((float(u), float(v)) for u, v in velocity))
        options.append(DeckOption("Currents", 1.0))
        notes.append(f"the current is given in current_profile.txt at {CURRENT_ROWS} heights")
    seas = (
        [plan for plan in run_plans(problem, water) if plan.waves is not None] if problem.environment.sea_states else []
    )
    if len(seas) == 1 and seas[0].waves is not None:
        sea = seas[0].waves
        columns = (sea.omega, sea.amplitude * np.sin(sea.phase), sea.amplitude * np.cos(sea.phase), sea.heading)
        omega, real, imaginary, direction = (tuple(map(float, column)) for column in columns)
        waves = DeckWaves(omega, real, imaginary, direction)
        options.append(DeckOption("WaveKin", 7.0))
        notes.append(
            f"the waves are given in {FREQUENCY_FILE}; they do not travel on the current there and have no ramp"
        )
    elif seas:
        notes.append(f"the case has {len(seas)} seas, a deck one: none is written")
    return replace(deck, options=tuple(options), current=current, waves=waves, notes=tuple(notes))
