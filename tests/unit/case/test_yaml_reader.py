"""YAML 1.2 scalars, places of keys, duplicate keys, syntax faults in plain words, odd files."""

import math

import pytest
import yaml
from hypothesis import given
from hypothesis import strategies as st

from moyai.case import yaml_reader
from moyai.case.yaml_reader import Place, dotted, parse_yaml, read_yaml
from moyai.core.errors import CaseError


@pytest.fixture(params=["libyaml", "pure"])
def scanner(request, monkeypatch):
    """Run with libyaml and with PyYAML's own scanner."""
    if request.param == "libyaml":
        if not yaml.__with_libyaml__:
            pytest.skip("PyYAML was built without libyaml")
        monkeypatch.setattr(yaml_reader, "_Loader", yaml.CLoader)
    else:
        monkeypatch.setattr(yaml_reader, "_Loader", yaml.Loader)
    return request.param


def faults_of(text):
    with pytest.raises(CaseError) as caught:
        parse_yaml(text, "case.yaml")
    return [str(fault) for fault in caught.value.faults]


@pytest.mark.parametrize(
    ("written", "value"),
    [
        ("5e6", 5e6),
        ("5.0E+6", 5e6),
        (".5", 0.5),
        ("5.", 5.0),
        ("-3", -3),
        ("+3", 3),
        ("010", 10),
        ("0o17", 15),
        ("0x1F", 31),
        ("1_000", "1_000"),
        ("no", "no"),
        ("on", "on"),
        ("yes", "yes"),
        ("true", True),
        ("False", False),
        ("tRue", "tRue"),
        ("null", None),
        ("~", None),
        ("", None),
        ("1:30", "1:30"),
        ("2001-01-01", "2001-01-01"),
        ("1.2.3", "1.2.3"),
        ("12 m", "12 m"),
        ("-.inf", -math.inf),
        ("'5'", "5"),
        ('"no"', "no"),
        ("!!str 5", "5"),
        ("!!float 5", 5),
        ("1" * 400, math.inf),
    ],
)
def test_scalars_follow_the_core_schema_of_yaml_1_2(scanner, written, value):
    found = parse_yaml(f"key: {written}\n").data["key"]
    assert found == value
    assert type(found) is type(value) or isinstance(value, (int, float))


def test_nan_is_read_as_nan(scanner):
    assert math.isnan(parse_yaml("a: .nan").data["a"])


def test_every_key_and_value_keeps_its_place(scanner):
    text = "\n".join(
        ["# comment", "site:", "  depth: 10 m", "  wide: {a: 1, b: [2, 30]}", "lines:", "  - x: 1", "    y: 2", ""]
    )
    document = parse_yaml(text, "f.yaml")
    assert document.data == {"site": {"depth": "10 m", "wide": {"a": 1, "b": [2, 30]}}, "lines": [{"x": 1, "y": 2}]}
    assert document.keys[("site",)] == Place(2, 1)
    assert document.keys[("site", "depth")] == Place(3, 3)
    assert document.values[("site", "depth")] == Place(3, 10)
    assert document.values[("site", "wide", "b", 1)] == Place(4, 23)
    assert document.keys[("lines", 0, "y")] == Place(7, 5)
    assert document.place(("site", "absent")) == Place(2, 1)
    assert dotted(("lines", 0, "anchor", "x")) == "lines[0].anchor.x"


def test_columns_count_characters_not_bytes(scanner):
    document = parse_yaml("title: 防波堤\n'断面': {'幅': 3}\n")
    assert document.keys[("断面", "幅")] == Place(2, 8)
    assert document.values[("断面", "幅")] == Place(2, 13)


def test_all_duplicate_keys_are_reported(scanner):
    assert faults_of("a: 1\nb:\n  c: 1\n  c: 2\na: 3\n") == [
        "case.yaml:4:3: b.c: the key 'c' is given twice; it was given in line 3: remove one",
        "case.yaml:5:1: a: the key 'a' is given twice; it was given in line 1: remove one",
    ]


def test_quoted_and_plain_forms_of_a_key_are_one_key(scanner):
    assert len(faults_of("a: 1\n'a': 2\n")) == 1


def test_anchors_aliases_and_merges(scanner):
    document = parse_yaml("base: &b {p: 1, q: 2}\nsame: *b\nmore:\n  <<: *b\n  q: 3\n")
    assert document.data["same"] == {"p": 1, "q": 2}
    assert document.data["same"] is not document.data["base"]
    assert document.data["more"] == {"p": 1, "q": 3}
    assert document.values[("same",)] == Place(2, 7)
    assert document.values[("same", "p")] == Place(1, 14)


@pytest.mark.parametrize(
    ("text", "place", "words"),
    [
        ("a:\n\tb: 1\n", "2:1", "a tab cannot indent in YAML; indent with spaces"),
        ("a: 1\n\tb: 2\n", "2:1", "a tab cannot indent in YAML"),
        ("a: b: c\n", "1:5", "a ':' is where no key can begin"),
        ("a: 1\n b: 2\n", "2:3", "a ':' is where no key can begin"),
        ("a: [1, 2\nb: 3\n", "2:2", "the '[' opened in line 1 is not closed"),
        ("a: {b: 1\nc: 2\n", "2:2", "the '{' opened in line 1 is not closed"),
        ("a: 1\nb: 'abc\n", "3:1", "the quotation mark opened in line 2 is not closed"),
        ("a: @x\n", "1:4", "a value may not begin with '@'; put quotes around it"),
        ("a: *x\n", "1:4", "'*x' refers to an anchor that is not defined above"),
        ("a: &x [*x]\n", "1:8", "'*x' is inside the block that it refers to"),
        ("a: 1\n---\nb: 2\n", "2:1", "a second document begins here"),
        ("? [a]\n: b\n", "1:3", "a key must be plain text"),
        ("a: !!python/object:os.system x\n", "1:4", "is not allowed; case files hold plain data"),
        ("a: !include other.yaml\n", "1:4", "is not allowed; case files hold plain data"),
        ("a: " + "[" * 70, "1:64", "nested more than 60 deep"),
        ("<<: 5\n", "1:5", "'<<' merges a block of keys"),
        ("ok: 1\nx: \x07\n", "2:4", "the character U+0007 is not allowed in a YAML file"),
        ("a: \ud800\n", "1:4", "U+D800"),
        ("'': 1\n", "1:1", "a key is missing before ':'"),
    ],
)
def test_syntax_faults_are_reported_in_plain_words(scanner, text, place, words):
    (fault,) = faults_of(text)
    assert fault.startswith(f"case.yaml:{place}: ")
    assert words in fault


@pytest.mark.parametrize("text", ["", "\n\n", "# nothing\n", "---\n", "null\n"])
def test_an_empty_file_points_to_the_template(scanner, text):
    assert faults_of(text) == ["case.yaml: the file is empty; 'moyai new' prints a template"]


def test_nested_aliases_cannot_fill_the_memory(scanner):
    lines = ["a0: &a0 [x, x, x, x, x, x, x, x, x, x]"]
    lines += [f"a{n}: &a{n} [" + ", ".join([f"*a{n - 1}"] * 10) + "]" for n in range(1, 12)]
    (fault,) = faults_of("\n".join(lines))
    assert "aliases expand to more than" in fault


def test_files_in_other_encodings(tmp_path):
    text = "moyai: 1\ntitle: 浮防波堤\n"
    path = tmp_path / "case.yaml"
    for encoding in ("utf-8", "utf-8-sig", "utf-16"):
        path.write_bytes(text.encode(encoding))
        assert read_yaml(path).data["title"] == "浮防波堤"
    path.write_bytes(text.encode("cp932"))
    with pytest.raises(CaseError) as caught:
        read_yaml(path)
    assert str(caught.value) == (f"{path}:2:8: the file is not UTF-8 (it looks like Shift-JIS); save it again as UTF-8")
    path.write_bytes("title: caf\xe9\n".encode("latin-1"))
    with pytest.raises(CaseError, match="Windows-1252"):
        read_yaml(path)


def test_windows_line_ends_and_byte_order_mark_keep_the_places(tmp_path):
    path = tmp_path / "case.yaml"
    path.write_bytes(b"\xef\xbb\xbfa: 1\r\nb:\r\n  c: 2\r\n")
    document = read_yaml(path)
    assert document.keys[("a",)] == Place(1, 1)
    assert document.values[("b", "c")] == Place(3, 6)


def test_folder_missing_file_and_unreadable_name(tmp_path):
    (tmp_path / "pontoon.yaml").write_text("a: 1\n")
    with pytest.raises(CaseError, match="this is a folder, not a case file"):
        read_yaml(tmp_path)
    with pytest.raises(CaseError, match=r"no such file; did you mean '.*pontoon\.yaml'"):
        read_yaml(tmp_path / "pontoom.yaml")
    with pytest.raises(CaseError, match="cannot be read"):
        read_yaml("nul\0byte.yaml")


@given(st.text(max_size=200) | st.text(alphabet="ab:-[]{}#&*!|>'\"%@`,? \n\t0189.e~<=", max_size=60))
def test_any_text_gives_data_or_a_case_error(text):
    try:
        document = parse_yaml(text, "case.yaml")
    except CaseError as error:
        assert error.faults
        assert all(str(fault) for fault in error.faults)
    else:
        assert document.data is not None


@given(st.binary(max_size=200))
def test_any_bytes_give_data_or_a_case_error(tmp_path_factory, content):
    path = tmp_path_factory.mktemp("bytes") / "case.yaml"
    path.write_bytes(content)
    try:
        read_yaml(path)
    except CaseError as error:
        assert error.faults


_PLAIN = st.one_of(
    st.integers(-(10**12), 10**12), st.floats(allow_nan=False, allow_infinity=False), st.booleans(), st.text(max_size=8)
)
_TREES = st.dictionaries(
    st.text(alphabet="abcxyz_", min_size=1, max_size=6),
    st.recursive(_PLAIN, lambda inner: st.lists(inner, max_size=3) | st.dictionaries(st.sampled_from("pqr"), inner)),
    min_size=1,
)


@pytest.mark.slow
@given(_TREES)
def test_json_is_read_as_it_was_written(tree):
    """JSON is YAML: what json writes must come back the same."""
    import json

    text = json.dumps(tree, ensure_ascii=False)
    try:
        found = parse_yaml(text).data
    except CaseError as error:
        assert "is not allowed" in str(error)
        return
    assert found == tree
