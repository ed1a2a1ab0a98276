"""Sentences that the source joins of parts, each of which is translated alone, read as a whole too."""

from __future__ import annotations

import pytest

from moyai.language.translator import translator


@pytest.mark.parametrize(
    "text",
    [
        "storm: in the time domain the wave load is that of the oblique wave, the memory that of normal incidence: "
        "motions may be off by tens of per cent far from the normal; the frequency domain is consistent",
        "LWL: oblique waves: Haskind relation",
        "the file is not UTF-8 (it looks like Shift_JIS)",
        "the first guess 3.2 m is outside of the range",
        "give a shorter step to see its effect; the method is of second order, as its memory is a convolution",
    ],
)
def test_joined_sentences_are_read_as_a_whole(text: str) -> None:
    assert translator("ja").left(text) == 0, translator("ja").text(text)
