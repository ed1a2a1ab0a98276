"""Schema of section shapes: outlines in the x-z plane, x from the centre line, z above the keel."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, Literal

from pydantic import Field

from moyai.case.schema_types import Block, Length, NonNegativeLength, PositiveLength

if TYPE_CHECKING:
    from moyai.potential.sections import Hull

_BEAM = "Width across the waves."
_HEIGHT = "Height from keel to deck."


class RectangleSection(Block):
    """A box."""

    shape: Literal["rectangle"] = Field(description="Box.")
    beam: PositiveLength = Field(description=_BEAM)
    height: PositiveLength = Field(description=_HEIGHT)

    def hull(self) -> Hull:
        """Return the outline."""
        from moyai.potential.shapes import rectangle

        return rectangle(self.beam, self.height)


class RoundedRectangleSection(Block):
    """A box with round bilges."""

    shape: Literal["rounded_rectangle"] = Field(description="Box with quarter circles at the lower corners.")
    beam: PositiveLength = Field(description=_BEAM)
    height: PositiveLength = Field(description=_HEIGHT)
    bilge_radius: PositiveLength = Field(description="Radius of the lower corners, at most half the beam.")

    def hull(self) -> Hull:
        """Return the outline."""
        from moyai.potential.shapes import rounded_rectangle

        return rounded_rectangle(self.beam, self.height, self.bilge_radius)


class CircleSection(Block):
    """A circular cylinder."""

    shape: Literal["circle"] = Field(description="Circular cylinder.")
    radius: PositiveLength = Field(description="Radius.")

    def hull(self) -> Hull:
        """Return the outline."""
        from moyai.potential.shapes import circle

        return circle(self.radius)


class TrapezoidSection(Block):
    """A symmetric trapezoid."""

    shape: Literal["trapezoid"] = Field(description="Symmetric trapezoid.")
    bottom_beam: PositiveLength = Field(description="Width at the keel.")
    top_beam: PositiveLength = Field(description="Width at the deck.")
    height: PositiveLength = Field(description=_HEIGHT)

    def hull(self) -> Hull:
        """Return the outline."""
        from moyai.potential.shapes import trapezoid

        return trapezoid(self.bottom_beam, self.top_beam, self.height)


class PiTypeSection(Block):
    """A box with a plate hanging from each side."""

    shape: Literal["pi_type"] = Field(description="Box with a keel plate under each side.")
    beam: PositiveLength = Field(description=_BEAM)
    height: PositiveLength = Field(description="Height of the box without its plates.")
    plate_depth: PositiveLength = Field(description="Length of the plates under the box.")
    plate_thickness: PositiveLength = Field(description="Thickness of the plates, less than half the beam.")

    def hull(self) -> Hull:
        """Return the outline."""
        from moyai.potential.shapes import pi_type

        return pi_type(self.beam, self.height, self.plate_depth, self.plate_thickness)


class TwinPontoonSection(Block):
    """Two boxes side by side."""

    shape: Literal["twin_pontoon"] = Field(description="Two equal boxes with a gap between them.")
    pontoon_beam: PositiveLength = Field(description="Width of each box.")
    height: PositiveLength = Field(description="Height from keel to deck.")
    gap: PositiveLength = Field(description="Clear width between the boxes.")
    deck_thickness: NonNegativeLength = Field(
        default=0.0, description="Thickness of a deck that joins the boxes at the top, within the height. Default: 0."
    )

    def hull(self) -> Hull:
        """Return the outline."""
        from moyai.potential.shapes import twin_pontoon

        return twin_pontoon(self.pontoon_beam, self.height, self.gap, deck_thickness=self.deck_thickness)


class PolygonSection(Block):
    """Any closed outline of straight edges."""

    shape: Literal["polygon"] = Field(description="Closed outline through given points.")
    points: Annotated[tuple[tuple[Length, Length], ...], Field(min_length=3, max_length=1000)] = Field(
        description="Corners [x, z] in order around the section, either way; z above the keel (lowest corner at 0).",
        examples=[[["-5 m", "0 m"], ["5 m", "0 m"], ["4 m", "3 m"], ["-4 m", "3 m"]]],
    )

    def hull(self) -> Hull:
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
