"""Roll beyond the waterline of linear restoring is reported with its angle."""

from __future__ import annotations

import math

import pytest

from moyai.floating.checks import roll_notices


@pytest.mark.parametrize(
    ("roll_deg", "freeboard", "draught", "said"),
    [(24.6, 0.9, 1.3, "deck edge"), (24.6, 2.0, 0.9, "bilge"), (19.0, 0.9, 1.3, ""), (24.6, 0.0, 1.3, "")],
)
def test_the_deck_edge_of_five_metres_of_beam(roll_deg: float, freeboard: float, draught: float, said: str) -> None:
    """atan(0.9 / 2.5) = 19.8 degrees; no deck, no angle."""
    found = roll_notices(math.radians(roll_deg), freeboard=freeboard, draught=draught, beam=5.0, where="LW, storm")
    assert bool(found) == bool(said)
    for notice in found:
        assert said in notice.message and "19.8 deg" in notice.message and notice.severity == "warning"
