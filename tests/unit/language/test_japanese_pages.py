"""Pages in Japanese show the files and programs of the English tutorials, letter by letter."""

from __future__ import annotations

import re
import sys
from pathlib import Path

import pytest

pytest.importorskip("sphinx", reason="Sphinx is not installed")
DOCS = Path(__file__).resolve().parents[3] / "docs"
sys.path.insert(0, str(DOCS))
import japanese_lines  # noqa: E402 - stands next to the pages

JAPANESE = re.compile("[\u3040-\u30ff\u4e00-\u9fff]")
TUTORIALS = (
    "first_breakwater.md", "first_curtain.md", "flexible_cage.md", "rigid_cage.md", "submerged_member.md", "network.md",
    "records_to_model.md", "towed_nets.md", "in_python.md", "app.md", "add_a_structure.md",
)  # fmt: skip


def blocks(path: Path, *kinds: str) -> list[str]:
    """Return the blocks of a page that are of some kinds, all without one."""
    found = re.findall(r"^```([^\n]*)\n(.*?)^```$", path.read_text(encoding="utf-8"), re.DOTALL | re.MULTILINE)
    return [text for kind, text in found if not kinds or kind in kinds]


@pytest.mark.parametrize("name", TUTORIALS)
def test_case_files_are_those_of_the_english_page(name: str) -> None:
    assert blocks(DOCS / "ja" / name, "yaml") == blocks(DOCS / "tutorial" / name, "yaml")


@pytest.mark.parametrize("name", [name for name in TUTORIALS if not name.startswith("first_")])
def test_programs_and_commands_are_those_of_the_english_page(name: str) -> None:
    """So what the tests run of the English page runs of the Japanese one."""
    japanese = blocks(DOCS / "ja" / name)
    assert japanese
    assert japanese == blocks(DOCS / "tutorial" / name)


@pytest.mark.parametrize(
    "name", [path.name for path in sorted((DOCS / "tutorial").glob("*.md")) if path.stem != "index"]
)
def test_every_tutorial_stands_in_japanese_with_its_pictures(name: str) -> None:
    """Pictures of reports and photographs are in the language of the page."""
    english, japanese = ((DOCS / folder / name).read_text(encoding="utf-8") for folder in ("tutorial", "ja"))
    assert name in TUTORIALS
    asked = re.findall(r"^:(?:of|show): (\S+)$", english, re.MULTILINE)
    assert asked == re.findall(r"^:(?:of|show): (\S+)$", japanese, re.MULTILINE)
    photographs = re.findall(r"^!\[[^]]*\]\((\S+)\)$", english, re.MULTILINE)
    assert photographs == re.findall(r"^!\[[^]]*\]\((\S+)\)$", japanese, re.MULTILINE)
    assert asked or photographs
    for file in photographs:
        assert (DOCS / "tutorial" / file).is_file() and (DOCS / "ja" / file).is_file()


def test_the_page_of_the_papers_tells_the_same_numbers() -> None:
    english, japanese = ((DOCS / name).read_text(encoding="utf-8") for name in ("reproduce.md", "ja/reproduce.md"))
    assert blocks(DOCS / "ja" / "reproduce.md", "{eval-rst}") == blocks(DOCS / "reproduce.md", "{eval-rst}")
    (said,), (spoken,) = blocks(DOCS / "reproduce.md", "text"), blocks(DOCS / "ja" / "reproduce.md", "text")
    assert spoken.replace("moyai --language ja", "moyai") == said
    found = [set(re.findall(r"\d+\.\d+", text)) for text in (english, japanese)]
    assert found[0] == found[1] and len(found[0]) >= 6
    keys = [re.findall(r"^\| `(\w+)` \|", text, re.MULTILINE) for text in (english, japanese)]
    assert keys[0] == keys[1] and len(keys[0]) == 5


def test_every_page_is_japanese_and_in_the_contents() -> None:
    contents = (DOCS / "ja" / "index.md").read_text(encoding="utf-8")
    pages = [path for path in sorted((DOCS / "ja").glob("*.md")) if path.stem != "index"]
    assert {path.name for path in pages} >= set(TUTORIALS)
    for path in pages:
        assert f"\n{path.stem}\n" in contents
        assert len(JAPANESE.findall(path.read_text(encoding="utf-8"))) > 200


@pytest.mark.parametrize("name", [path.name for path in sorted((DOCS / "ja").glob("*.md"))])
def test_no_blank_stands_where_lines_of_japanese_break(name: str) -> None:
    """A browser shows the end of a line of the source as a blank."""
    text = (DOCS / "ja" / name).read_text(encoding="utf-8")
    wide = "[\u3040-\u30ff\u4e00-\u9fff、。]"
    broken = re.compile(rf"^(?![ ]*(?:[-*#|>`!(:]|\\d+\\.)).*{wide}\n[ ]*{wide}", re.MULTILINE)
    outside = re.sub(r"^```.*?^```$", "```", japanese_lines.joined(text), flags=re.DOTALL | re.MULTILINE)
    assert broken.findall(outside) == []
    assert blocks_of(japanese_lines.joined(text)) == blocks_of(text), "code stays"


def blocks_of(text: str) -> list[str]:
    """Return the blocks of code of a text."""
    return re.findall(r"^```[^\n]*\n.*?^```$", text, re.DOTALL | re.MULTILINE)


def test_lines_of_japanese_are_joined() -> None:
    text = "質量を与えない\nので、\n- 一つ\n  二つ\n- 三\n\n|表|\n|の|\n\n```\n行\n行\n```\nThe end\nof it\n`a`\nは b\n"
    assert japanese_lines.joined(text) == (
        "質量を与えないので、\n- 一つ二つ\n- 三\n\n|表|\n|の|\n\n```\n行\n行\n```\nThe end\nof it\n`a`\nは b\n"
    )
