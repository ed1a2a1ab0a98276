"""Sentences that the source joins of parts, each of which is translated alone, read as a whole too."""

from __future__ import annotations

import pytest

from moyai.core.errors import Fault
from moyai.language import spoken_in
from moyai.language.faults import fault_text
from moyai.language.translator import translator


@pytest.mark.parametrize(
    "text",
    [
        "storm: in the time domain the wave load is that of the oblique wave, the memory that of normal incidence: "
        "motions may be off by tens of per cent far from the normal; the frequency domain is consistent",
        "LWL: oblique waves: Haskind relation",
        "the file is not UTF-8 (it looks like Shift_JIS)",
        "short.csv, column 'heave' states no unit",
        "the first guess 3.2 m is outside of the range",
        "give a shorter step to see its effect; the method is of second order, as its memory is a convolution",
    ],
)
def test_joined_sentences_are_read_as_a_whole(text: str) -> None:
    assert translator("ja").left(text) == 0, translator("ja").text(text)


def test_the_parts_of_a_fault_are_parted_by_marks_of_the_language() -> None:
    fault = Fault("the wind speed is 900 m/s, which is impossible", allowed="at most 115 m/s", remedy="check it")
    with spoken_in("ja"):
        assert fault_text(fault) == "風速が 900 m/s で、あり得ない値である；許容：115 m/s 以下；確認する"
    with spoken_in("en"):
        assert fault_text(fault) == str(fault)


def test_a_key_with_its_value_stays_as_it_is_typed() -> None:
    """A full-width colon is none in a case file; and what may prove a limit stands behind the judgement."""
    proof = "the mean of 5 realisations keeps it: settings.time.realisations: 6 may prove it"
    said = translator("ja").text(f"factor of safety of connectors 1.98 is below 2 ({proof})")
    assert "settings.time.realisations: 6 " in said
    assert said.startswith("連結部の安全率 1.98 は 2 を下回る（")
