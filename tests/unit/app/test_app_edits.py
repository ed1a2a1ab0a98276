"""Sliders change the digits of one number and nothing else; paths stay in the chosen folder."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from moyai.app.folder import Folder, refuse_foreign_files
from moyai.app.stages import stages_of
from moyai.case.reader import case_of
from moyai.case.sliders import slider, sliders_of
from moyai.case.templates import template
from moyai.case.text_numbers import number_at, with_number
from moyai.case.yaml_reader import parse_yaml
from moyai.core.errors import CaseError, InputError

TEMPLATES = ("breakwater", "curtain", "cage", "rigid_cage", "network", "member", "units")


def kind_of(name: str) -> str:
    return "cage" if name == "rigid_cage" else name


@pytest.mark.parametrize("name", TEMPLATES)
def test_every_slider_changes_only_the_digits_of_its_number(name: str) -> None:
    document = parse_yaml(template(name))
    found = sliders_of(document, kind_of(name))
    assert 8 <= len(found) <= 12
    for one in found:
        written = number_at(document, one["path"])
        assert written is not None
        changed = with_number(document, one["path"], "7.25")
        assert changed.text == document.text[: written.start] + "7.25" + document.text[written.end :]
        assert with_number(changed, one["path"], document.text[written.start : written.end]).text == document.text
        assert one["low"] < one["high"] and one["low"] <= one["value"] <= one["high"]


@pytest.mark.parametrize(
    ("text", "changed"),
    [
        ("a: 3 m", "a: 4.5 m"),
        ("a: 3   # metres", "a: 4.5   # metres"),
        ("a: '3 m'  # quoted", "a: '4.5 m'  # quoted"),
        ('a: "3 kN/m"', 'a: "4.5 kN/m"'),
        ("a:   3e0 N m s2\nb: 1", "a:   4.5 N m s2\nb: 1"),
        ("b: {a: 3 m, c: 1}", None),
        ("a: 3\r\nb: 2\r\n", "a: 4.5\r\nb: 2\r\n"),
        ("# first\na: 3m\r\nb: 2\r\n", "# first\na: 4.5m\r\nb: 2\r\n"),
    ],
)
def test_numbers_are_found_as_they_are_written(text: str, changed: str | None) -> None:
    path = "b.a" if changed is None else "a"
    expected = "b: {a: 4.5 m, c: 1}" if changed is None else changed
    assert with_number(parse_yaml(text), path, "4.5").text == expected


@pytest.mark.parametrize("text", ["a: word", "a: [1, 2]", "a: {b: 1}", "b: 1", "a: 2026-01-01", "a: 0x10", "a: 1:30"])
def test_what_is_no_number_has_no_slider(text: str) -> None:
    assert number_at(parse_yaml(text), "a") is None
    with pytest.raises(InputError):
        with_number(parse_yaml(text), "a", "1")


def test_a_number_that_others_share_is_not_changed() -> None:
    shared = parse_yaml("first: &block {a: 3 m}\na: 1\nsecond: {<<: *block, b: 1}\n")
    with pytest.raises(InputError, match="share"):
        with_number(shared, "second.a", "4")
    with pytest.raises(InputError, match="share"):
        with_number(shared, "first.a", "4")


@pytest.mark.parametrize("number", ["", "1 m", "1\nb: 2", ".inf", ".nan", "true", "1e999", "*x", "{a: 1}"])
def test_only_numbers_are_put_into_the_text(number: str) -> None:
    with pytest.raises(InputError):
        with_number(parse_yaml("a: 3 m"), "a", number)


def test_the_range_follows_from_the_value() -> None:
    assert (slider("x", "X", "m", -107.8).low, slider("x", "X", "m", -107.8).high) == (-162.0, -54.0)
    assert slider("x", "X", "m", 0.0).low == 0.0
    assert (slider("heading_deg", "H", "", 10.0).low, slider("heading_deg", "H", "", 10.0).high) == (-35.0, 55.0)


def test_seas_that_a_draft_leaves_out_have_no_sliders() -> None:
    document = parse_yaml(template("member"))
    stage = stages_of(document, "member")[-1]
    assert [sea["kind"] for sea in stage.data["waves"]] == ["regular"]
    found = sliders_of(document, "member", stage.data)
    assert found
    assert not any("significant" in one["path"] for one in found)


def test_a_case_names_its_own_sliders() -> None:
    text = template("breakwater") + "app: {sliders: ['lines[0].segments[0].length', structure.draught]}\n"
    found = sliders_of(parse_yaml(text), "breakwater")
    assert [one["path"] for one in found] == ["lines[0].segments[0].length", "structure.draught"]
    assert [one["label"] for one in found] == ["Line length, first line", "Draught"]
    own = parse_yaml(text.replace("structure.draught", "site.gravity"))
    assert sliders_of(own, "breakwater")[1]["label"] == "Gravity of site"


@pytest.mark.parametrize("name", TEMPLATES)
def test_every_structure_may_name_its_sliders(name: str) -> None:
    path = sliders_of(parse_yaml(template(name)), kind_of(name))[0]["path"]
    document = parse_yaml(f"{template(name)}\napp: {{sliders: ['{path}']}}\n")
    assert [one["path"] for one in sliders_of(document, case_of(document, Path("case.yaml")).kind)] == [path]


def test_drafts_take_the_cheap_analyses_of_the_case() -> None:
    def analyses(text: str, kind: str) -> list[list[str]]:
        return [stage.data["analyses"] for stage in stages_of(parse_yaml(text), kind)]

    assert analyses("analyses: [statics, frequency, time]", "breakwater") == [["statics"], ["statics", "frequency"]]
    assert analyses("analyses: [statics, time]", "breakwater") == [["statics"]]
    assert analyses("analyses: time", "cage") == [["statics"]]
    assert analyses("a: 1", "curtain") == [["statics"], ["impact"], ["statics", "impact"]]


@pytest.mark.parametrize(
    "name", ["../secret.yaml", "/etc/passwd", "a/../../x.yaml", "link.yaml", "linked/x.yaml", "x\0.yaml"]
)
def test_no_path_leads_out_of_the_folder(tmp_path: Path, name: str) -> None:
    outside, root = tmp_path / "outside", tmp_path / "root"
    outside.mkdir()
    root.mkdir()
    (outside / "x.yaml").write_text("structure:\n  kind: member\n")
    (root / "link.yaml").symlink_to(outside / "x.yaml")
    (root / "linked").symlink_to(outside)
    folder = Folder(root.resolve(), root.resolve() / "out")
    with pytest.raises(InputError):
        folder.inside(name)
    assert folder.case_files() == []


def test_cases_read_no_files_from_outside(tmp_path: Path) -> None:
    root = tmp_path / "root"
    (root / "data").mkdir(parents=True)
    (root / "data" / "link.csv").symlink_to("/etc/passwd")
    refuse_foreign_files(root, root, parse_yaml("measured: {file: data/points.csv}"))
    for name in ("../points.csv", "/etc/passwd", "data/link.csv", "data"):
        with pytest.raises(CaseError, match="outside") as refused:
            refuse_foreign_files(
                root, root, parse_yaml(f"a: {{file: ok.csv}}\nmeasured:\n  - 1\n  - {{file: {name}}}\n")
            )
        (fault,) = refused.value.faults
        assert (fault.path, fault.line) == ("measured[1].file", 4)
    shared = "x: &x {file: /etc/passwd}\ny: {<<: *x}\n"
    with pytest.raises(CaseError, match="outside"):
        refuse_foreign_files(root, root, parse_yaml(shared))


def test_the_folder_lists_its_cases(tmp_path: Path) -> None:
    (tmp_path / "sub").mkdir()
    (tmp_path / "sub" / "pile.yaml").write_text(template("member"))
    (tmp_path / "notes.yaml").write_text("a: 1\n")
    found = Folder(tmp_path, tmp_path / "out").case_files()
    assert found == [{"file": "sub/pile.yaml", "kind": "member", "title": "Submerged member"}]


def test_assets_use_no_foreign_address() -> None:
    import moyai.app

    folder = Path(moyai.app.__file__).parent / "assets"
    for file in folder.iterdir():
        text = file.read_text(encoding="utf-8")
        found = re.findall(r"""(?:https?:)?//[a-z0-9-]+\.[a-z.]+""", text.replace("http://www.w3.org/2000/svg", ""))
        assert not found, (file.name, found)
        assert not re.search(r"\beval\(|new Function", text)
