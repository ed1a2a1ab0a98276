"""The types that schemas are made of: quantities with units, names, blocks that report every error at once."""

from __future__ import annotations

import difflib
import math
import re
from dataclasses import dataclass, fields
from typing import Annotated, Any, ClassVar, Literal, Self, TypeVar

from pydantic import (
    BaseModel,
    BeforeValidator,
    ConfigDict,
    Discriminator,
    Field,
    GetCoreSchemaHandler,
    GetJsonSchemaHandler,
    Tag,
    ValidationInfo,
    model_validator,
)
from pydantic.json_schema import JsonSchemaValue
from pydantic_core import PydanticCustomError, core_schema

from moyai.core import quantities
from moyai.core.errors import InputError
from moyai.core.quantities import QuantityKind, to_si
from moyai.tables.plausible_ranges import kind_bounds

#: Settings of an analysis, a dataclass.
Filled = TypeVar("Filled")


def refuse(message: str, *, allowed: str = "", remedy: str = "") -> PydanticCustomError:
    """Return the error that carries a fault's message, allowed range and remedy through pydantic."""
    # The template is filled by pydantic; braces of the message itself must survive it
    return PydanticCustomError("moyai", "{message}", {"message": message, "allowed": allowed, "remedy": remedy})


#: Between these a length [m] is what rounding leaves of zero, as of a place that was turned.
_ROUNDED = (1e-20, 1e-9)


@dataclass(frozen=True)
class QuantityOf:
    """Annotation of a ``float`` field that takes a number or a text with a unit."""

    #: What is expected.
    kind: QuantityKind
    #: Open lower limit, in the unit of plain numbers.
    above: float = -math.inf
    #: Closed lower limit, in the unit of plain numbers.
    least: float = -math.inf
    #: Open upper limit, in the unit of plain numbers.
    below: float = math.inf
    #: Closed upper limit, in the unit of plain numbers.
    most: float = math.inf
    #: Words that stand for a value: ``(("infinite", math.inf),)``, ``(("auto", None),)``.
    words: tuple[tuple[str, float | None], ...] = ()

    @property
    def example(self) -> str:
        """An example of the kind; empty for a plain number out of the range."""
        text = str(self.kind.example)
        try:
            value = float(text)
        except ValueError:
            return text
        inside = self.least <= value <= self.most and self.above < value < self.below
        return text if inside else ""

    @property
    def allowed(self) -> str:
        """The range in words, empty when there is none."""
        unit = f" {self.kind.unit}" if self.kind.unit else ""
        parts = []
        if math.isfinite(self.above):
            parts.append(f"greater than {self.above:g}{unit}")
        if math.isfinite(self.least):
            parts.append(f"at least {self.least:g}{unit}")
        if math.isfinite(self.below):
            parts.append(f"less than {self.below:g}{unit}")
        if math.isfinite(self.most):
            parts.append(f"at most {self.most:g}{unit}")
        text = " and ".join(parts)
        if self.words:
            words = [f"'{word}'" for word, _ in self.words]
            text = " or ".join([text, *words] if text else words)
        return text

    def parse(self, value: Any) -> float | None:
        """Return the number of a field in the unit of plain numbers, or raise what pydantic understands."""
        if isinstance(value, str) and value.strip() in dict(self.words):
            return dict(self.words)[value.strip()]
        try:
            number = to_si(value, self.kind)
        except InputError as error:
            fault = error.fault
            words = " or ".join(f"'{word}'" for word, _ in self.words)
            raise refuse(
                fault.message, allowed=fault.allowed or (f"also {words}" if words else ""), remedy=fault.remedy
            ) from None
        bounds = kind_bounds().get(self.kind.name)
        if (
            self.kind is quantities.LENGTH
            and self.above < 0.0 >= self.least
            and _ROUNDED[0] < abs(number) < _ROUNDED[1]
        ):
            number = 0.0
        if bounds is not None and number != 0.0 and not bounds[0] <= abs(number) <= bounds[1]:
            if not math.isfinite(number):
                return number
            unit = f" {self.kind.unit}" if self.kind.unit else ""
            shown = value if isinstance(value, str) else f"{value:g}{unit}"
            raise refuse(
                f"{shown} is no {self.kind.name.split(' ', 1)[1]} that a structure in water can have",
                allowed=f"{bounds[0]:g} to {bounds[1]:g}{unit} as a magnitude",
                remedy="check the number and its unit",
            )
        if not (self.above < number < self.below and self.least <= number <= self.most):
            shown = value if isinstance(value, str) else f"{value:g}{' ' + self.kind.unit if self.kind.unit else ''}"
            raise refuse(f"{shown} is out of range", allowed=self.allowed)
        return number

    def __get_pydantic_core_schema__(self, source: Any, handler: GetCoreSchemaHandler) -> core_schema.CoreSchema:
        return core_schema.no_info_plain_validator_function(
            self.parse, serialization=core_schema.plain_serializer_function_ser_schema(lambda value: value)
        )

    def __get_pydantic_json_schema__(
        self, schema: core_schema.CoreSchema, handler: GetJsonSchemaHandler
    ) -> JsonSchemaValue:
        number: dict[str, Any] = {"type": "number"}
        for name, limit in (
            ("exclusiveMinimum", self.above),
            ("minimum", self.least),
            ("exclusiveMaximum", self.below),
            ("maximum", self.most),
        ):
            if math.isfinite(limit):
                number[name] = limit
        text: dict[str, Any] = {"type": "string", "pattern": r"^\s*[+-]?(\d|\.\d)", "examples": [self.kind.example]}
        forms = [number, text]
        if self.words:
            forms.append({"enum": [word for word, _ in self.words]})
        return {"anyOf": forms, "unit": self.kind.unit, "range": self.allowed}


Length = Annotated[float, QuantityOf(quantities.LENGTH)]
PositiveLength = Annotated[float, QuantityOf(quantities.LENGTH, above=0.0)]
NonNegativeLength = Annotated[float, QuantityOf(quantities.LENGTH, least=0.0)]
Depth = Annotated[float, QuantityOf(quantities.LENGTH, above=0.0, words=(("infinite", math.inf),))]
Mass = Annotated[float, QuantityOf(quantities.MASS, above=0.0)]
AddedMass = Annotated[float, QuantityOf(quantities.MASS, least=0.0)]
Volume = Annotated[float, QuantityOf(quantities.VOLUME, least=0.0)]
Inertia = Annotated[float, QuantityOf(quantities.INERTIA, above=0.0)]
AddedInertia = Annotated[float, QuantityOf(quantities.INERTIA, least=0.0)]
Duration = Annotated[float, QuantityOf(quantities.TIME, above=0.0)]
AutoDuration = Annotated[float | None, QuantityOf(quantities.TIME, above=0.0, words=(("auto", None),))]
Heading = Annotated[float, QuantityOf(quantities.ANGLE_DEGREES, least=-360.0, most=360.0)]
SpreadAngle = Annotated[float, QuantityOf(quantities.ANGLE_DEGREES, above=0.0, most=180.0)]
AngularFrequency = Annotated[float, QuantityOf(quantities.ANGULAR_FREQUENCY, above=0.0)]
Speed = Annotated[float, QuantityOf(quantities.SPEED, least=0.0)]
SignedSpeed = Annotated[float, QuantityOf(quantities.SPEED)]
Gravity = Annotated[float, QuantityOf(quantities.ACCELERATION, above=0.0)]
Density = Annotated[float, QuantityOf(quantities.DENSITY, above=0.0)]
Force = Annotated[float, QuantityOf(quantities.FORCE)]
PositiveForce = Annotated[float, QuantityOf(quantities.FORCE, above=0.0)]
AxialStiffness = Annotated[float, QuantityOf(quantities.FORCE, above=0.0, words=(("inextensible", math.inf),))]
WeightPerLength = Annotated[float, QuantityOf(quantities.FORCE_PER_LENGTH)]
MassPerLength = Annotated[float, QuantityOf(quantities.MASS_PER_LENGTH)]
PositiveMassPerLength = Annotated[float, QuantityOf(quantities.MASS_PER_LENGTH, above=0.0)]
Stiffness = Annotated[float, QuantityOf(quantities.STIFFNESS, above=0.0)]
Damping = Annotated[float, QuantityOf(quantities.DAMPING, least=0.0)]
RollDamping = Annotated[float, QuantityOf(quantities.ROTATIONAL_DAMPING, least=0.0)]
RollQuadraticDamping = Annotated[float, QuantityOf(quantities.ROTATIONAL_QUADRATIC_DAMPING, least=0.0)]
Fraction = Annotated[float, QuantityOf(quantities.NUMBER, least=0.0)]
Number = Annotated[float, QuantityOf(quantities.NUMBER)]
PositiveNumber = Annotated[float, QuantityOf(quantities.NUMBER, above=0.0)]
NonNegativeNumber = Annotated[float, QuantityOf(quantities.NUMBER, least=0.0)]
PeakEnhancement = Annotated[float, QuantityOf(quantities.NUMBER, least=1.0, most=20.0)]

KeyGroups = tuple[tuple[str, ...], ...]
"""Groups of keys that a rule speaks of."""

_RESERVED = re.compile(r"[/\\\x00-\x1f]")


def _name(value: Any) -> Any:
    if isinstance(value, bool) or value is None:
        raise refuse("expected a name", remedy="put quotes around it")
    if isinstance(value, (int, float)):
        value = f"{value:g}" if isinstance(value, float) else str(value)
    if isinstance(value, str):
        value = value.strip()
        if not value or value in (".", "..") or _RESERVED.search(value) or len(value) > 80:
            raise refuse(f"'{value}' is not a name", allowed="1 to 80 characters without '/' and '\\'")
    return value


Name = Annotated[str, BeforeValidator(_name), Field(min_length=1, max_length=80)]
"""A label that also names a group of the results, so it holds no slash."""

LevelNames = Annotated[
    Annotated[Literal["all"], Tag("<word>")] | Annotated[tuple[Name, ...], Field(min_length=1), Tag("<list>")],
    Discriminator(lambda value: "<word>" if isinstance(value, str) else "<list>"),
]
LEVEL_NAMES = "Water levels to run: all, or a list of names."

FileName = Annotated[str, Field(min_length=1)]
"""A path, relative to the folder of the case file."""

Whole = Annotated[int, Field(strict=True, ge=1, le=1_000_000)]
Seed = Annotated[int, Field(strict=True, ge=0, le=2**63 - 1)]
Truth = Annotated[bool, Field(strict=True)]


@dataclass(frozen=True)
class OneOrMany:
    """Annotation of a tuple field that takes one entry without its list as well."""

    def __get_pydantic_core_schema__(self, source: Any, handler: GetCoreSchemaHandler) -> core_schema.CoreSchema:
        return core_schema.no_info_before_validator_function(self.to_list, handler(source))

    def __get_pydantic_json_schema__(
        self, schema: core_schema.CoreSchema, handler: GetJsonSchemaHandler
    ) -> JsonSchemaValue:
        many = handler(schema)
        return {"if": {"type": "array"}, "then": many, "else": many["items"]}

    @staticmethod
    def to_list(value: Any) -> Any:
        """Return a block as a list of one."""
        return [value] if isinstance(value, dict) else value


class Notes:
    """What validation records on its way: which schema a block was read by, and faults between its keys.

    Passed to pydantic as the validation context; blocks are known by identity, since pydantic does not tell where
    in the file a block stands.
    """

    def __init__(self) -> None:
        self.models: dict[int, type[Block]] = {}
        self.faults: list[tuple[int, str, str, str]] = []

    def fault(self, block: Any, key: str, message: str, remedy: str = "") -> None:
        """Record a fault of ``block`` at ``key`` (empty for the block itself)."""
        self.faults.append((id(block), key, message, remedy))


#: What a line with properties of its own is made of, and the words for it.
LineComponent = Literal["chain", "rope", "wire"]
COMPONENT = "What it is made of, for the factors of design codes; absent: the strictest of the code."


class Block(BaseModel):
    """A block of keys: unknown keys are faults, and the rules between keys are declared next to them."""

    model_config = ConfigDict(extra="forbid", frozen=True, populate_by_name=False)

    exactly_one: ClassVar[KeyGroups] = ()
    at_least_one: ClassVar[KeyGroups] = ()
    at_most_one: ClassVar[KeyGroups] = ()

    def changed(self, **values: Any) -> Self:
        """Return the block with other values, which are not checked.

        Parameters
        ----------
        **values : Any
            By the name of the field.
        """
        return self.model_copy(update=values)

    def fill(self, kind: type[Filled], **others: Any) -> Filled:
        """Return the settings of an analysis, from the keys of the same names and from ``others``.

        A key that is absent leaves the default of the settings.

        Parameters
        ----------
        kind : type
            Dataclass of the settings.
        **others : Any
            Further fields, which go before the keys.
        """
        names = {one.name for one in fields(kind)} & type(self).model_fields.keys() - others.keys()  # type: ignore[arg-type]
        given = {name: value for name in names if (value := getattr(self, name)) is not None}
        return kind(**given, **others)

    @classmethod
    def key_names(cls) -> tuple[str, ...]:
        """Names of the keys as they stand in a file."""
        return tuple(field.alias or name for name, field in cls.model_fields.items())

    @model_validator(mode="before")
    @classmethod
    def _note(cls, data: Any, info: ValidationInfo) -> Any:
        if not isinstance(data, dict):
            return data
        faults = list(cls._between_keys(data))
        if isinstance(info.context, Notes):
            info.context.models[id(data)] = cls
            for key, message, remedy in faults:
                info.context.fault(data, key, message, remedy)
        elif faults:
            key, message, remedy = faults[0]
            raise refuse(message, remedy=remedy)
        return data

    @classmethod
    def _between_keys(cls, data: dict[str, Any]) -> list[tuple[str, str, str]]:
        """Return faults (key, message, remedy) of the rules between keys."""
        faults = []
        given = [key for key, value in data.items() if value is not None]
        for group in (*cls.exactly_one, *cls.at_most_one):
            both = [key for key in given if key in group]
            if len(both) > 1:
                names = " and ".join(f"'{key}'" for key in group if key in both)
                faults.append((both[1], f"{names} exclude each other", f"keep one: {_either(group)}"))
        for group in (*cls.exactly_one, *cls.at_least_one):
            # A key without value is reported as such
            if not any(key in data for key in group):
                faults.append(("", f"{_either(group)} is missing", "give one of them"))
        return faults

    @classmethod
    def __get_pydantic_json_schema__(
        cls, schema: core_schema.CoreSchema, handler: GetJsonSchemaHandler
    ) -> JsonSchemaValue:
        out = handler(schema)
        target = handler.resolve_ref_schema(out)
        rules: list[dict[str, Any]] = []
        for group in cls.exactly_one:
            rules.append({"oneOf": [{"required": [key]} for key in group]})
        for group in cls.at_least_one:
            rules.append({"anyOf": [{"required": [key]} for key in group]})
        for group in cls.at_most_one:
            rules.append({"not": {"required": list(group)}})
        if rules:
            target["allOf"] = rules
        return out


def _either(group: tuple[str, ...]) -> str:
    quoted = [f"'{key}'" for key in group]
    return quoted[0] if len(quoted) == 1 else ", ".join(quoted[:-1]) + " or " + quoted[-1]


def holds_key(block: dict[str, Any], key: str) -> bool:
    """Whether a block holds ``key``, perhaps misspelt: tells which form of a block its writer meant."""
    return key in block or bool(difflib.get_close_matches(key, map(str, block), n=1, cutoff=0.75))


class Range(Block):
    """Evenly spaced values, from the lowest to the highest."""

    count: Annotated[int, Field(strict=True, ge=2, le=10_000, description="Number of values.")]

    @model_validator(mode="after")
    def _from_low_to_high(self) -> Range:
        first, last = getattr(self, "first", None), getattr(self, "last", None)
        if isinstance(first, int | float) and isinstance(last, int | float) and first > last:
            raise refuse(
                f"the range runs backwards: 'from' {first:g} is not below 'to' {last:g}",
                allowed="'from' below 'to'",
                remedy=f"write from: {last:g}, to: {first:g}",
            )
        return self

    @staticmethod
    def spread(first: float, last: float, count: int) -> tuple[float, ...]:
        """Return ``count`` values from ``first`` to ``last``, both included, exactly at the ends.

        Those between are rounded to twelve figures: 0.64 and not 0.6400000000000001 stands in tables and on axes.
        """
        step = (last - first) / (count - 1)
        return (first, *(float(f"{first + step * index:.12g}") for index in range(1, count - 1)), last)


Auto = Literal["auto"]


def once_each(values: tuple[Any, ...]) -> tuple[Any, ...]:
    """Refuse a list that names something twice."""
    for index, value in enumerate(values):
        if value in values[:index]:
            raise refuse(f"'{value}' is given twice in the list", remedy="remove one")
    return values
