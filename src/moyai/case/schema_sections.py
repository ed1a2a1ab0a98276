"""Schema of section shapes: outlines in the x-z plane, x from the centre line, z above the keel."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, Literal

from pydantic import Field

from moyai.case.schema_types import Block, Length, NonNegativeLength, Number, PositiveLength

if TYPE_CHECKING:
    from moyai.potential.sections import Hull

_BEAM = "Width across the waves."
_HEIGHT = "Height from keel to deck."


class SectionPlate(Block):
    """A plate of no thickness that moves with the section."""

    points: Annotated[tuple[tuple[Length, Length], ...], Field(min_length=2, max_length=200)] = Field(
        description="Both ends and the corners between, [x, z] in the frame of the section; an end on the outline is "
        "joined to it.",
        examples=[[["-5 m", "0 m"], ["-5 m", "-1.5 m"]]],
    )
    bulges: tuple[Number, ...] | None = Field(
        default=None,
        description="tan(sweep/4) of each edge: 0 straight, 1 half circle to the right of the way. Default: straight.",
    )


class PlatedSection(Block):
    """What all shapes share: thin plates on the outline, under it or next to it."""

    plates: Annotated[tuple[SectionPlate, ...], Field(max_length=50)] = Field(
        default=(),
        description="Thin plates that move with the body: keel plates, a curtain under it. They have no buoyancy; "
        "their mass belongs to that of the body. Default: none.",
    )

    def outline(self) -> Hull:
        """Return the hull without its plates."""
        raise NotImplementedError

    def hull(self) -> Hull:
        """Return the hull with its plates.

        Raises
        ------
        InputError
            When a shape is impossible; its path ends on ``plates`` where a plate is the reason.
        """
        hull = self.outline()
        if not self.plates:
            return hull
        import numpy as np

        from moyai.core.errors import InputError
        from moyai.potential.plates import PlateLine

        lines = []
        for number, plate in enumerate(self.plates):
            try:
                bulges = None if plate.bulges is None else np.array(plate.bulges, dtype=float)
                lines.append(PlateLine(np.array(plate.points, dtype=float), bulges))
            except InputError as error:
                fault = error.fault
                raise InputError(
                    f"plate {number + 1}: {fault.message}", path="plates", allowed=fault.allowed, remedy=fault.remedy
                ) from None
        return hull.with_plates(*lines)


class RectangleSection(PlatedSection):
    """A box."""

    shape: Literal["rectangle"] = Field(description="Box.")
    beam: PositiveLength = Field(description=_BEAM)
    height: PositiveLength = Field(description=_HEIGHT)

    def outline(self) -> Hull:
        """Return the outline."""
        from moyai.potential.shapes import rectangle

        return rectangle(self.beam, self.height)


class RoundedRectangleSection(PlatedSection):
    """A box with round bilges."""

    shape: Literal["rounded_rectangle"] = Field(description="Box with quarter circles at the lower corners.")
    beam: PositiveLength = Field(description=_BEAM)
    height: PositiveLength = Field(description=_HEIGHT)
    bilge_radius: PositiveLength = Field(description="Radius of the lower corners, at most half the beam.")

    def outline(self) -> Hull:
        """Return the outline."""
        from moyai.potential.shapes import rounded_rectangle

        return rounded_rectangle(self.beam, self.height, self.bilge_radius)


class CircleSection(PlatedSection):
    """A circular cylinder."""

    shape: Literal["circle"] = Field(description="Circular cylinder.")
    radius: PositiveLength = Field(description="Radius.")

    def outline(self) -> Hull:
        """Return the outline."""
        from moyai.potential.shapes import circle

        return circle(self.radius)


class TrapezoidSection(PlatedSection):
    """A symmetric trapezoid."""

    shape: Literal["trapezoid"] = Field(description="Symmetric trapezoid.")
    bottom_beam: PositiveLength = Field(description="Width at the keel.")
    top_beam: PositiveLength = Field(description="Width at the deck.")
    height: PositiveLength = Field(description=_HEIGHT)

    def outline(self) -> Hull:
        """Return the outline."""
        from moyai.potential.shapes import trapezoid

        return trapezoid(self.bottom_beam, self.top_beam, self.height)


class PiTypeSection(PlatedSection):
    """A box with a plate hanging from each side."""

    shape: Literal["pi_type"] = Field(description="Box with a keel plate under each side.")
    beam: PositiveLength = Field(description=_BEAM)
    height: PositiveLength = Field(description="Height of the box without its plates.")
    plate_depth: PositiveLength = Field(description="Length of the plates under the box.")
    plate_thickness: PositiveLength = Field(description="Thickness of the plates, less than half the beam.")

    def outline(self) -> Hull:
        """Return the outline."""
        from moyai.potential.shapes import pi_type

        return pi_type(self.beam, self.height, self.plate_depth, self.plate_thickness)


class TwinPontoonSection(PlatedSection):
    """Two boxes side by side."""

    shape: Literal["twin_pontoon"] = Field(description="Two equal boxes with a gap between them.")
    pontoon_beam: PositiveLength = Field(description="Width of each box.")
    height: PositiveLength = Field(description="Height from keel to deck.")
    gap: PositiveLength = Field(description="Clear width between the boxes.")
    deck_thickness: NonNegativeLength = Field(
        default=0.0, description="Thickness of a deck that joins the boxes at the top, within the height. Default: 0."
    )

    def outline(self) -> Hull:
        """Return the outline."""
        from moyai.potential.shapes import twin_pontoon

        return twin_pontoon(self.pontoon_beam, self.height, self.gap, deck_thickness=self.deck_thickness)


class PolygonSection(PlatedSection):
    """Any closed outline of straight edges."""

    shape: Literal["polygon"] = Field(description="Closed outline through given points.")
    points: Annotated[tuple[tuple[Length, Length], ...], Field(min_length=3, max_length=1000)] = Field(
        description="Corners [x, z] in order around the section, either way; z above the keel (lowest corner at 0).",
        examples=[[["-5 m", "0 m"], ["5 m", "0 m"], ["4 m", "3 m"], ["-4 m", "3 m"]]],
    )

    def outline(self) -> Hull:
        """Return the outline, counter-clockwise."""
        from moyai.potential.shapes import polygon

        points = self.points
        doubled_area = sum(a[0] * b[1] - b[0] * a[1] for a, b in zip(points, (*points[1:], points[0])))
        return polygon(points if doubled_area > 0.0 else points[::-1])


Section = Annotated[
    RectangleSection
    | RoundedRectangleSection
    | CircleSection
    | TrapezoidSection
    | PiTypeSection
    | TwinPontoonSection
    | PolygonSection,
    Field(discriminator="shape"),
]
