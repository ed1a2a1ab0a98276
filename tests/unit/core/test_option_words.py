"""Every public call refuses an option word that it does not know, before anything is computed."""

from __future__ import annotations

import dataclasses
import importlib
import inspect
import pkgutil
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np
import pytest
import xarray as xr

import moyai
from moyai import flexible, floating, potential
from moyai.case import root_schema
from moyai.core.errors import InputError
from moyai.core.options import _rules, check_word, checks_words
from moyai.coupled import RigidBody, find_coupled_equilibrium, simulate_coupled
from moyai.design import LineLoad, Scale, check_line, design_code, scale_water
from moyai.flexible import BarType, NetworkBuilder
from moyai.flexible.failures import LineFailure
from moyai.flexible.flow import Flow
from moyai.floating import Hydrodynamics
from moyai.morison import Net, inertia_coefficients, panel_force, sections
from moyai.records import TimeSource
from moyai.records.nets.campaign import NetCampaign
from moyai.sea import Water, breaking_limit, current, nonlinear_wave, spectra, synthesise
from moyai.series import find_waves


def calls_with_words() -> Iterator[tuple[str, Callable[..., Any], str]]:
    """Give every public function, method and dataclass that takes an option word, with the name of the argument.

    True and false are looked for in what packages hand out: what works inside is called by the package alone.
    """
    handed_out = {id(item) for item in things_of_packages()}
    for found in pkgutil.walk_packages(moyai.__path__, "moyai."):
        if found.name.endswith("__main__"):
            continue
        module = importlib.import_module(found.name)
        for name, item in sorted(vars(module).items()):
            if name.startswith("_") or getattr(item, "__module__", "") != module.__name__:
                continue
            for label, call, noted in calls_of(name, item):
                for argument, (words, items) in sorted(_rules(inspect.get_annotations(noted), module.__name__).items()):
                    if id(item) in handed_out or {*words, *items} - {True, False, None}:
                        yield f"{found.name}.{label}({argument})", call, argument


def things_of_packages() -> Iterator[Any]:
    """Give what the packages list in ``__all__``; of a module that is handed out as a whole, what is public in it."""
    for found in pkgutil.walk_packages(moyai.__path__, "moyai."):
        package = importlib.import_module(found.name) if found.ispkg else None
        for name in getattr(package, "__all__", ()):
            thing = getattr(package, name)
            yield from vars(thing).values() if inspect.ismodule(thing) else (thing,)


def calls_of(name: str, item: Any) -> Iterator[tuple[str, Callable[..., Any], Any]]:
    """Give a function, or a dataclass with its public methods: name, call, what carries the annotations."""
    if inspect.isfunction(item):
        yield name, item, inspect.unwrap(item)
    elif inspect.isclass(item):
        if dataclasses.is_dataclass(item):
            yield name, item, item
        for key, member in sorted(vars(item).items()):
            function = getattr(member, "__func__", member)
            if inspect.isfunction(function) and not key.startswith("_"):
                yield f"{name}.{key}", getattr(item, key), inspect.unwrap(function)


CALLS = list(calls_with_words())


def test_the_walk_finds_the_calls() -> None:
    assert len(CALLS) >= 150
    packages = {name.split(".")[1] for name, _, _ in CALLS}
    assert packages >= {"core", "design", "floating", "flexible", "morison", "potential", "records", "report", "sea"}
    assert packages >= {"series", "structures", "tables"}


@pytest.mark.parametrize(("call", "argument"), [item[1:] for item in CALLS], ids=[item[0] for item in CALLS])
def test_a_word_that_does_not_exist_is_refused(call: Callable[..., Any], argument: str) -> None:
    refused = rf"{argument}: 'no such word' is (not a known word|neither true nor false); allowed: "
    with pytest.raises(InputError, match=refused):
        call(**{argument: "no such word"})


@checks_words
@dataclass(frozen=True)
class Options:
    """What an ordinary record of options looks like."""

    many: tuple[Literal["a", "b"], ...] = ("a",)
    one: Literal["up", "down"] | None = None
    number: float = 1.0
    sure: bool = False
    held: tuple[bool, bool] | None = None


def test_a_line_that_fails_is_reported_by_true_or_false_at_which_end() -> None:
    with pytest.raises(InputError, match="at_end: 'start' is neither true nor false"):
        LineFailure("line", at_end="start")  # type: ignore[arg-type]


@pytest.mark.parametrize("key", ["sure", "held"])
@pytest.mark.parametrize("value", ["no", "True", 0, 1, 0.0, np.nan, (True, "no"), [1, 0], {}])
def test_what_is_neither_true_nor_false_is_refused(key: str, value: Any) -> None:
    with pytest.raises(InputError, match=f"{key}: .* is neither true nor false; allowed: True or False"):
        Options(**{key: value})


def test_true_and_false_in_their_forms() -> None:
    yes, no = np.array([1.0, 0.0]) > 0.5
    assert Options(sure=yes).sure == Options(sure=True).sure and Options(sure=no) == Options()
    for pair in ((True, False), [True, False], np.array([True, False]), (yes, no), None):
        Options(held=pair)  # type: ignore[arg-type]
    with pytest.raises(InputError, match="sure: 'None' is neither"):
        Options(sure=None)  # type: ignore[arg-type]
    check_word(1, (0, 1), "number")
    with pytest.raises(InputError, match="'True' is not a known word"):
        check_word(True, (0, 1), "number")


def test_lists_of_words_and_absent_ones() -> None:
    assert Options(("a", "b"), "up", 2.0) == Options(many=("a", "b"), one="up", number=2.0)
    assert Options().one is None
    with pytest.raises(InputError, match="many: 'c'"):
        Options(("a", "c"))  # type: ignore[arg-type]
    with pytest.raises(InputError, match="did you mean 'down'"):
        Options(one="dwon")  # type: ignore[arg-type]
    with pytest.raises(TypeError):
        Options(nothing=1)  # type: ignore[call-arg]


def test_the_beginning_of_a_word_names_it() -> None:
    with pytest.raises(InputError, match="did you mean 'infinite'"):
        check_word("inf", ("infinite", "zero"), "frequency")


def test_words_that_stand_in_tables_and_data() -> None:
    """Words whose list is not known before the call."""
    for key, word in (("confirmed", ["nonsense"]), ("consequence", "hihg")):
        with pytest.raises(InputError, match=f"{key}: "):
            design_code("ISO 19901-7", analysis="dynamic", **{key: word})
    design_code("ISO 19901-7", analysis="dynamic", confirmed=["API RP 2SK"])  # one list may serve several codes
    with pytest.raises(InputError, match="did you mean 'cage'"):
        root_schema("cagge")
    data = xr.Dataset(coords={"omega": [1.0], "influenced_dof": ["sway"], "radiating_dof": ["sway"]})
    with pytest.raises(InputError, match="did you mean 'sway'"):
        Hydrodynamics.from_dataset(data, modes=("swya",))
    one = np.eye(2)[None]
    with pytest.raises(InputError, match=r"form: 'numbr' is not a known word; allowed: number, iso, or a pattern"):
        TimeSource(columns=("t",), form="numbr")
    with pytest.raises(InputError, match=r"vibration: 'atuo' is not a known word.*did you mean 'auto'"):
        NetCampaign("tests", None, (), (), vibration="atuo")  # type: ignore[arg-type]
    for modes in ("ab", ("sway", "sway")):
        with pytest.raises(InputError, match=r"modes: modes are .*; allowed: a tuple of names, each once"):
            Hydrodynamics(np.ones(1), one, one, np.ones((1, 1, 2), complex), np.zeros(1), modes)  # type: ignore[arg-type]


def test_what_moves_already_is_a_body_of_the_run() -> None:
    body = RigidBody("weight", 500.0, (50.0, 50.0, 50.0), position=(0.0, 0.0, -5.0), points={"eye": (0.0, 0.0, 0.0)})
    builder = NetworkBuilder(WATER)
    builder.fixed("top", (0.0, 0.0, 0.0))
    builder.driven("eye", body.points_at_start["eye"])
    rope = BarType("rope", mass_per_length=1.0, axial_stiffness=1e6, diameter=0.03)
    builder.line("line", "top", "eye", rope, length=5.0, segments=4)
    with pytest.raises(InputError, match=r"carriers: 'wieght' is not a known word.*did you mean 'weight'"):
        simulate_coupled(
            builder.build(),
            {"weight": body},
            duration=0.2,
            output_step=0.05,
            carriers={"wieght": body.carrier(WATER, Flow(), 0.0)},
        )


WATER = Water(depth=10.0, density=1025.0, gravity=9.81)
HULL = potential.shapes.rectangle(beam=4.0, height=2.0)
PLATE = potential.Plate((0.0, 0.0), (0.0, -2.0))
NET = Net(twine_diameter=0.003, mesh_pitch=0.04)
LOAD = LineLoad("line 1", maximum_tension=1e6, mean_tension=4e5, breaking_load=2e6, component="chain")
BUILDER: Any = NetworkBuilder(WATER)
DEPTH: Any = 10.0
SECTION = HULL.immersed(draught=1.0)
BODY = {"mass": 4100.0, "centre_of_gravity": (0.0, -0.2), "length": 1.0, "density": 1025.0, "gravity": 9.81}
SEA = spectra.jonswap(significant_height=2.0, peak_period=7.0, peak_enhancement=3.3)
TIME = np.arange(100.0)
MISTAKEN: dict[str, tuple[Callable[..., Any], str]] = {
    "hull for a section": (
        lambda: floating.hydrostatics(HULL, **BODY),  # type: ignore[arg-type]
        r"section: Hull is no Section; allowed: a Section; set a hull into the water",
    ),
    "section for a hull": (
        lambda: floating.find_equilibrium(SECTION, **BODY, draught_start=1.0),  # type: ignore[arg-type]
        "hull: Section is no Hull; allowed: a Hull; give the hull in its own frame",
    ),
    "section that is turned": (
        lambda: floating.righting_curve(
            SECTION,  # type: ignore[arg-type]
            TIME[:2],
            area=4.0,
            centre_of_gravity=(0.0, 0.0),
            draught_start=1.0,
        ),
        "hull: Section is no Hull",
    ),
    "hull for a solution": (
        lambda: potential.mean_drift_far_field(HULL),  # type: ignore[arg-type]
        "solution: Hull is no RadiationDiffraction; .*solve the section first",
    ),
    "hull near the body": (
        lambda: potential.mean_drift_near_field(HULL),  # type: ignore[arg-type]
        "solution: Hull is no RadiationDiffraction",
    ),
    "section for a solution": (
        lambda: potential.surface_elevation(SECTION, [1.0], 0),  # type: ignore[arg-type]
        "solution: Section is no RadiationDiffraction",
    ),
    "what makes modes": (
        lambda: potential.solve_plate_limit(
            potential.Plate((0.0, 0.0), (0.0, -2.0)),
            WATER,
            potential.rigid_modes,  # type: ignore[arg-type]
        ),
        r"modes: .*rigid_modes.* is no motion; allowed: rigid_modes\(centre\)",
    ),
    "crossing for options": (
        lambda: find_waves(TIME, np.sin(TIME), "down"),  # type: ignore[arg-type]
        "options: str is no WaveOptions",
    ),
    "word for a spreading": (
        lambda: synthesise(SEA, WATER, duration=100.0, seed=1, spreading="cos2"),  # type: ignore[arg-type]
        "spreading: str is no Spreading",
    ),
    "hull for a plate": (
        lambda: potential.solve_plate_limit(HULL, WATER),  # type: ignore[arg-type]
        r"plate: Hull is no Plate; allowed: a Plate; give Plate\(start, end\)",
    ),
    "hull for plates": (
        lambda: potential.solve_plate_waves((PLATE, HULL), WATER, [1.0]),  # type: ignore[arg-type]
        "plates: Hull is no Plate; allowed: a Plate or a PlateLine",
    ),
    "section for its contour": (
        lambda: inertia_coefficients(sections.circle(1.0)),  # type: ignore[arg-type]
        "contour: MemberSection is no Contour; .*section.contour",
    ),
    "name for a law": (
        lambda: panel_force("loland", NET, [1.0, 0.0, 0.0], TIME[:3], area=1.0, density=1e3, viscosity=1e-6),  # type: ignore[arg-type]
        r"law: str is no NetLaw; .*net_law\(name\)",
    ),
    "name for a code": (
        lambda: check_line(LOAD, "ISO 19901-7"),  # type: ignore[arg-type]
        "code: str is no DesignCode; .*design_code",
    ),
    "code before the load": (
        lambda: check_line(design_code("ISO 19901-7", analysis="dynamic"), LOAD),  # type: ignore[arg-type]
        "load: DesignCode is no LineLoad",
    ),
    "model of a body": (
        lambda: floating.simulate(HULL, None, duration=1.0),  # type: ignore[arg-type]
        "model: Hull is no CumminsModel",
    ),
    "nothing for a case": (
        lambda: moyai.run(None),  # type: ignore[arg-type]
        "case: NoneType is no Case; .*path of a case file",
    ),
    "word for a velocity": (
        lambda: Flow(velocity="east"),  # type: ignore[arg-type]
        "velocity of the flow is east; allowed: three finite numbers",
    ),
}


@pytest.mark.parametrize(("call", "message"), MISTAKEN.values(), ids=MISTAKEN)
def test_another_kind_of_object_is_refused(call: Callable[..., Any], message: str) -> None:
    with pytest.raises(InputError, match=message):
        call()


#: Calls that take a network, given its builder.
UNBUILT: tuple[Callable[[], Any], ...] = (
    lambda: flexible.solve_equilibrium(BUILDER),
    lambda: flexible.simulate(BUILDER, duration=1.0, output_step=0.1),
    lambda: flexible.simulate_together(BUILDER, [], duration=1.0, output_step=0.1),
    lambda: flexible.natural_modes(BUILDER, BUILDER),
    lambda: flexible.peak_sensitivity(BUILDER, bar=0),
    lambda: flexible.refined(BUILDER, 2),
    lambda: find_coupled_equilibrium(BUILDER, {}),
    lambda: simulate_coupled(BUILDER, {}, duration=1.0, output_step=0.1),
)


@pytest.mark.parametrize("call", UNBUILT)
def test_a_network_that_is_not_built_is_refused(call: Callable[[], Any]) -> None:
    with pytest.raises(InputError, match=r"network: NetworkBuilder is no Network; .*; call build\(\) of the builder"):
        call()


#: Calls that take the water, given its depth.
DEPTHS: tuple[Callable[[], Any], ...] = (
    lambda: NetworkBuilder(DEPTH),
    lambda: potential.solve(SECTION, DEPTH, [1.0], modes=potential.rigid_modes((0.0, 0.0))),
    lambda: potential.solve_plate_limit(PLATE, DEPTH),
    lambda: potential.solve_plate_waves(PLATE, DEPTH, [1.0]),
    lambda: potential.solve_rectangle(4.0, 1.0, DEPTH, [1.0], centre=(0.0, 0.0)),
    lambda: potential.solve_vertical_barrier(1.0, DEPTH, [1.0]),
    lambda: potential.recommend_frequencies(DEPTH, breadth=4.0, wall_height=1.0),
    lambda: potential.wall_sided_tails(DEPTH, -0.2),
    lambda: breaking_limit(6.0, DEPTH),
    lambda: nonlinear_wave("stokes", height=1.0, water=DEPTH, period=6.0),
    lambda: synthesise(SEA, DEPTH, duration=100.0, seed=1),
    lambda: spectra.tma(2.0, 8.0, 3.3, DEPTH),
    lambda: current.power_law(1.0, 0.2, 0.0, DEPTH),
    lambda: scale_water(DEPTH, Scale(length=25.0, density=1.0, gravity=1.0)),
)


@pytest.mark.parametrize("call", DEPTHS)
def test_a_number_for_the_water_is_refused(call: Callable[[], Any]) -> None:
    with pytest.raises(InputError, match=r"water: float is no Water; .*; give Water\(depth=.*\)"):
        call()
