"""Finished English sentences put into Japanese: found among templates, numbers copied, unknown ones kept."""

from __future__ import annotations

import pytest

from moyai.language import said, speak, spoken_in
from moyai.language.catalogue import entries
from moyai.language.translator import Translator
from moyai.language.words import latin_words, numbers

MESSAGES = {
    "{0}. {1}": "{0}。{1}", "{0}.": "{0}。", "{0}; {1}": "{0}；{1}", "{0}: {1}": "{0}：{1}", "{0}, {1}": "{0}、{1}",
    "{0} ({1})": "{0}（{1}）", "{0} of {1}": "{1}の{0}", "largest {0}": "最大{0}", "tension": "張力",
    "largest tension": "最大張力", "anchor line": "係留索", "line {0}": "索 {0}", "storm": "暴風時",
    "{0} realisations": "{0} 実現", "limit {0}, judged at {1}": "限界値 {0}、判定値 {1}",
    "Half of the snaps have a rise time of more than {0} s": "スナップの半数は立上り時間が {0} s を超える",
}  # fmt: skip


@pytest.fixture(scope="module")
def translator() -> Translator:
    return Translator(MESSAGES)


@pytest.mark.parametrize(
    ("english", "japanese"),
    [
        ("tension", "張力"),
        ("Tension", "張力"),
        ("storm: largest tension of anchor line (5 realisations)", "暴風時：係留索の最大張力（5 実現）"),
        ("tension of line seaward", "索 seaward の張力"),
        ("Limit 3.00 kN, judged at 2.5 kN.", "限界値 3.00 kN、判定値 2.5 kN。"),
        (
            "storm: Half of the snaps have a rise time of more than 0.6 s",
            "暴風時：スナップの半数は立上り時間が 0.6 s を超える",
        ),
        ("storm; tension. Storm.", "暴風時；張力。暴風時。"),
        ("3.4 kN", "3.4 kN"),
        ("", ""),
        ("  tension\nstorm", "  張力\n暴風時"),
    ],
)
def test_sentences(translator: Translator, english: str, japanese: str) -> None:
    assert translator.text(english) == japanese
    assert numbers(english) == numbers(japanese)


def test_a_sentence_that_no_template_knows_stays_as_it_is(translator: Translator) -> None:
    unknown = "The hull of the ship that nobody has described of yet leaks in 3 places."
    assert translator.text(unknown) == unknown
    assert translator.text(f"{unknown} Tension.") == f"{unknown[:-1]}。張力。"


def test_half_a_phrase_is_not_translated(translator: Translator) -> None:
    """A preposition joins translated parts or a short name; it does not open a sentence that nobody knows."""
    unknown = "the opinion about several unheard things of tension"
    assert translator.text(unknown) == unknown


def test_words_and_symbols_are_distinguished() -> None:
    assert latin_words("K_T of 3 kN at HWL, settings.time.step, results.nc, --json, JONSWAP, moyai") == ["of", "at"]
    assert latin_words("最大張力 3.4 kN、C_M -15～+15 %") == []
    assert latin_words("'criteria' and `dynamic`") == ["and"]
    assert latin_words("[eq:potential-energy] K1 T4p6 MoorDyn") == []


def test_message_files_are_read_with_continued_lines() -> None:
    text = '# note\nmsgid ""\nmsgstr ""\n"Language: ja\\n"\n\nmsgid "a "\n"b"\nmsgstr "い"\n"ろ"\n\n'
    text += 'msgid "\\"c\\""\nmsgstr "は"\n'
    assert list(entries(text)) == [("", "Language: ja\n"), ("a b", "いろ"), ('"c"', "は")]


def test_the_language_in_force_ends_with_its_block() -> None:
    assert said("warning") == "warning"
    with spoken_in("ja"):
        assert said("warning") == "警告"
        speak("en")
        assert said("warning") == "warning"
        with spoken_in("ja"):
            assert said("warning") == "警告"
    assert said("warning") == "warning"


def test_a_word_of_counting_stands_behind_numbers_alone() -> None:
    """A sea of the name 'components' behind a body is no number of components."""
    found = Translator({"{0} components": "成分 {0} 個", "{0}, {1}": "{0}、{1}", "components": "成分波"})
    assert found.text("3 components") == "成分 3 個"
    assert found.text("two components") == "成分 two 個"
    assert found.text("column, components") == "column、成分波"


def test_a_name_known_as_a_whole_stands_in_any_place() -> None:
    """With the place and the unit behind it, or with its value; a word of a comparison is no name."""
    found = Translator({
        "share above: by the fit; all": "割合", "{0}, worst of all other axes": "{0}、最も厳しい値", "LWL": "LWL",
        "water depth": "水深", "at least": "以上", "at least {0}": "{0} 以上", "{0}, {1}": "{0}、{1}",
    })  # fmt: skip
    assert (
        found.text("share above: by the fit; all (LWL) [kN], worst of all other axes")
        == "割合（LWL）[kN]、最も厳しい値"
    )
    assert found.text("water depth 15 m") == "水深 15 m"
    assert found.text("at least 15 m") == "15 m 以上"


def test_the_part_of_a_line_is_translated_behind_the_name_that_the_user_gave() -> None:
    messages = {"the tension of '{0}' jumps": "「{0}」の張力が跳ねる", "{0} part {1}": "{0} 部分 {1}"}
    said = Translator(messages)
    assert said.text("the tension of 'part of mine part 2' jumps") == "「part of mine 部分 2」の張力が跳ねる"
    assert said.text("the tension of 'part of mine' jumps") == "「part of mine」の張力が跳ねる"
