"""Schema of the damping of floating bodies beyond wave radiation."""

from __future__ import annotations

from typing import Any, Literal

from pydantic import Field

from moyai.case.schema_types import Block, Fraction, PositiveNumber


class DampingBeyondWaves(Block):
    """Damping beyond wave radiation: computed from the section, a fraction of critical, or both.

    Structures add ``modes``, the motions that the fraction is applied to.
    """

    viscous: Literal["computed", "none"] | None = Field(
        default=None,
        description="'computed': by eddies at the edges of the section. Default: computed, unless damping of roll is "
        "given otherwise.",
    )
    viscous_factor: PositiveNumber = Field(
        default=1.0, description="What the computed viscous damping is multiplied with. Default: 1."
    )
    fraction_of_critical: Fraction | None = Field(
        default=None, description="zeta in C = 2 zeta sqrt((M + added mass)(stiffness)); needs modes."
    )
    modes: Any

    @classmethod
    def _between_keys(cls, data: dict[str, Any]) -> list[tuple[str, str, str]]:
        faults = super()._between_keys(data)
        if data.get("fraction_of_critical") is not None and data.get("modes") is None:
            remedy = "give it: Motions that it is applied to, for instance [sway, heave, roll]"
            faults.append(("", "the key 'modes' is missing", remedy))
        if data.get("modes") is not None and data.get("fraction_of_critical") is None:
            faults.append(("modes", "'modes' needs 'fraction_of_critical'", "give it, or leave 'modes' out"))
        return faults

    def computed_factor(self, *, roll_is_given: bool = False) -> float:
        """Return what the computed damping is multiplied with; 0 where it is not computed.

        A measured roll damping, or a fraction that holds for roll, holds the eddies already; a fraction of other
        motions stands for other things.
        """
        given = roll_is_given or (self.fraction_of_critical is not None and "roll" in (self.modes or ()))
        computed = not given if self.viscous is None else self.viscous == "computed"
        return self.viscous_factor if computed else 0.0


__all__ = ["DampingBeyondWaves"]
