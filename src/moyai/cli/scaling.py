"""What ``moyai scale`` answers: the scaled figures, what a model line needs, which numbers are not kept."""

from __future__ import annotations

import math
from dataclasses import asdict, dataclass
from fractions import Fraction
from pathlib import Path
from typing import TYPE_CHECKING, Any

from moyai.core.errors import InputError
from moyai.core.quantities import DENSITY, LENGTH, SPEED, TIME, parse_quantity, to_si
from moyai.core.validity import Notice
from moyai.design.model_needs import Need, model_need
from moyai.design.model_numbers import ModelNumber, WaterMotion, check_numbers, model_numbers
from moyai.design.similarity import Scale, ScaledQuantity, scale_quantities
from moyai.tables.waters import water_of_density

if TYPE_CHECKING:
    from rich.console import Console

_KINDS = (
    ("length", "m"),
    ("time", "s"),
    ("speed", "m/s"),
    ("mass", "kg"),
    ("mass per length", "kg/m"),
    ("mass per area", "kg/m2"),
    ("force, EA", "N"),
    ("spring, force per length", "N/m"),
    ("pressure, modulus", "Pa"),
    ("moment", "N m"),
    ("moment of inertia", "kg m2"),
    ("EI", "N m2"),
    ("damping", "N s/m"),
)


@dataclass(frozen=True)
class Request:
    """The arguments of the command as they were typed; ``factor`` is the new size over that given."""

    what: tuple[str, ...]
    factor: Fraction
    gravity: Fraction
    density: str | None
    given_density: str | None
    at_hand: tuple[str, ...]
    line_length: str | None
    speed: str | None
    across: str | None
    period: str | None
    digits: int


@dataclass(frozen=True)
class Answer:
    """Everything that the command shows; ``text`` is the new case file, ``None`` for single values."""

    scale: Scale
    rows: tuple[ScaledQuantity, ...]
    needs: tuple[Need, ...]
    numbers: dict[str, tuple[ModelNumber, ...]]
    notices: tuple[Notice, ...]
    text: str | None
    waters: tuple[str, str]
    files: tuple[tuple[str, str], ...] = ()

    def record(self) -> dict[str, Any]:
        """Return the answer as plain data."""
        return {
            "scale": asdict(self.scale),
            "ratios": {unit: self.scale.ratio(unit) for _, unit in _KINDS},
            "quantities": [asdict(row) for row in self.rows],
            "needs": [asdict(need) for need in self.needs],
            "numbers": {member: [asdict(number) for number in found] for member, found in self.numbers.items()},
            "notices": [notice.as_dict() for notice in self.notices],
            "case": self.text,
        }


def answer(request: Request) -> Answer:
    """Scale what was asked for.

    Raises
    ------
    InputError
        With what cannot be read, and what is missing.
    """
    from_model = request.factor > 1
    length = float(request.factor if from_model else 1 / request.factor)
    gravity = float(request.gravity if from_model else 1 / request.gravity)
    files = [item for item in request.what if "=" not in item or Path(item).is_file()]
    if files:
        if len(request.what) > 1:
            raise InputError("a case file and further arguments", path="what", remedy="one case file, or figures alone")
        return _of_case(request, Path(files[0]), length, gravity, from_model)
    return _of_figures(request, length, gravity, from_model)


def _density_ratio(given: float, new: str | None, from_model: bool) -> float:
    if new is None:
        return 1.0
    wanted = to_si(_number_or_text(new), DENSITY, "density")
    if not wanted > 0.0:
        raise InputError(f"the density is {new}", path="density", allowed="greater than 0")
    return wanted / given if from_model else given / wanted


def _number_or_text(text: str) -> float | str:
    try:
        return float(text)
    except ValueError:
        return text


def _of_case(request: Request, path: Path, length: float, gravity: float, from_model: bool) -> Answer:
    from moyai.case.reader import load_case
    from moyai.study.scaled_case import scale_case
    from moyai.study.scaled_motion import motions_of

    if request.given_density is not None:
        raise InputError("a case file states its own water", path="given_density", remedy="leave --given-density out")
    case = load_case(path)
    ratio = _density_ratio(float(case.model.site.density), request.density, from_model)
    scale = Scale(length, ratio, gravity)
    scaled = scale_case(case, scale, from_model=from_model, digits=request.digits)
    motions = motions_of(scaled, case)
    asked = _motion(request)
    if asked is not None:
        motions = {"as asked": asked}
    prototype = scaled.case if from_model else case
    numbers, notices, waters = _judge(
        scale, motions, float(prototype.model.site.density), float(prototype.model.site.gravity)
    )
    reported = tuple(Notice("case", fault.message, remedy=fault.remedy) for fault in scaled.case.warnings)
    needs = _needs(request, scaled.rows, scale)
    return Answer(scale, scaled.rows, needs, numbers, (*notices, *reported), scaled.text, waters, scaled.files)


def _of_figures(request: Request, length: float, gravity: float, from_model: bool) -> Answer:
    if request.density is not None and request.given_density is None:
        raise InputError("the water of the figures is not known", path="given_density", remedy="add --given-density")
    given = (
        1.0
        if request.given_density is None
        else to_si(_number_or_text(request.given_density), DENSITY, "given_density")
    )
    if not given > 0.0:
        raise InputError(f"the density is {given:g}", path="given_density", allowed="greater than 0")
    scale = Scale(length, _density_ratio(given, request.density, from_model), gravity)
    figures = _figures(request.what)
    rows = scale_quantities(figures, scale, from_model=from_model)
    motion = _motion(request)
    density = given if request.given_density is not None else 1000.0
    prototype = density if not from_model else density * scale.density
    numbers, notices, waters = _judge(scale, {} if motion is None else {"as asked": motion}, prototype, 9.81)
    return Answer(scale, rows, _needs(request, rows, scale), numbers, notices, None, waters)


def _figures(items: tuple[str, ...]) -> dict[str, tuple[float, str]]:
    """Return ``NAME=VALUE`` items as name, value and unit."""
    found: dict[str, tuple[float, str]] = {}
    for item in items:
        name, sign, text = item.partition("=")
        name = name.strip()
        if not sign or not name:
            raise InputError(f"'{item}' is not NAME=VALUE", path="what", remedy='for instance "EA=890 kN"')
        if name in found:
            raise InputError(f"'{name}' is given twice", path=name)
        try:
            quantity = parse_quantity(text)
        except InputError as error:
            raise InputError(error.fault.message, path=name, remedy=error.fault.remedy) from None
        if not quantity.unit.symbol:
            raise InputError(
                f"{text.strip()} has no unit: a plain number is the same at every size",
                path=name,
                remedy=f'give the unit, for instance "{name}={text.strip()} m"',
            )
        found[name] = (float(quantity.number), quantity.unit.symbol)
    return found


def _motion(request: Request) -> WaterMotion | None:
    if request.speed is None and request.across is None:
        return None
    if request.speed is None or request.across is None:
        missing = "speed" if request.speed is None else "across"
        raise InputError(f"'--{missing}' is missing", path=missing, remedy="Reynolds and Weber need speed and size")
    return WaterMotion(
        to_si(_number_or_text(request.speed), SPEED, "speed"),
        to_si(_number_or_text(request.across), LENGTH, "across"),
        math.inf if request.period is None else to_si(_number_or_text(request.period), TIME, "period"),
        math.inf,
    )


def _judge(
    scale: Scale, motions: dict[str, WaterMotion], density: float, gravity: float
) -> tuple[dict[str, tuple[ModelNumber, ...]], tuple[Notice, ...], tuple[str, str]]:
    prototype, model = water_of_density(density), water_of_density(density / scale.density)
    numbers: dict[str, tuple[ModelNumber, ...]] = {}
    notices: list[Notice] = []
    for member, motion in motions.items():
        found = model_numbers(scale, motion, gravity=gravity, prototype=prototype, model=model)
        numbers[member] = found
        for notice in check_numbers(scale, motion, found, gravity=gravity, prototype=prototype, model=model):
            of_water = notice.code != "similarity-reynolds"
            if of_water and any(notice.code == known.code for known in notices):
                continue
            message = notice.message if of_water else f"{member}: {notice.message}"
            notices.append(
                Notice(notice.code, message, notice.value, notice.limit, notice.severity, notice.remedy, notice.source)
            )
    return numbers, tuple(notices), (prototype.water, model.water)


def _needs(request: Request, rows: tuple[ScaledQuantity, ...], scale: Scale) -> tuple[Need, ...]:
    known = {row.name: row for row in rows}
    length = None if request.line_length is None else to_si(_number_or_text(request.line_length), LENGTH, "line_length")
    needs = []
    for name, (value, unit) in _figures(request.at_hand).items():
        if name not in known:
            raise InputError(f"'{name}' is not among the figures", path="at_hand", allowed=", ".join(known)[:300])
        needs.append(model_need(known[name], value, unit, scale, line_length=length))
    return tuple(needs)


def print_answer(console: Console, answered: Answer) -> None:
    """Print tables: figures, ratios, needs, numbers kept and not kept."""
    from moyai.cli.tables import _table as make_table
    from moyai.study.scaled_text import written_in

    scale = answered.scale
    table = make_table(("quantity", "left"), ("prototype", "right"), ("model", "right"), ("prototype/model", "right"))
    for row in answered.rows:
        table.add_row(
            row.name, written_in(row.prototype, row.unit), written_in(row.model, row.unit), f"{row.ratio:.6g}"
        )
    console.print(table)
    table = make_table(("ratio of", "left"), ("unit", "left"), ("prototype/model", "right"))
    for name, unit in _KINDS:
        table.add_row(name, unit, f"{scale.ratio(unit):.6g}")
    console.print(table)
    if answered.needs:
        table = make_table(
            ("model needs", "left"), ("wanted", "right"), ("at hand", "right"), ("over", "right"), ("", "left")
        )
        for need in answered.needs:
            wanted, at_hand = written_in(need.wanted, need.unit), written_in(need.at_hand, need.unit)
            table.add_row(need.name, wanted, at_hand, f"{need.over:.4g}", need.remedy)
        console.print(table)
    for member, numbers in answered.numbers.items():
        table = make_table(
            (f"number ({member})", "left"), ("prototype", "right"), ("model", "right"), ("", "left"), ("", "left")
        )
        for number in numbers:
            kept = "kept" if number.kept else "NOT KEPT"
            table.add_row(number.name, f"{number.prototype:.4g}", f"{number.model:.4g}", kept, number.meaning)
        console.print(table)
    if answered.numbers:
        console.print(f"prototype: {answered.waters[0]}, model: {answered.waters[1]}, both at 20 degrees", markup=False)
    else:
        console.print(
            "not kept: Reynolds and Weber number, modulus of a material; --speed and --across show by how much",
            markup=False,
        )
    for notice in answered.notices:
        console.print(f"{notice.severity}: {notice.message}", markup=False, soft_wrap=True)
