"""Every equation named in code stands in docs/theory and back; every page is listed where readers look."""

import re
from pathlib import Path

from source_files import findings

ROOT = Path(__file__).resolve().parents[2]
SOURCE, DOCS = ROOT / "src" / "moyai", ROOT / "docs"

_NAMED = re.compile(r"\[eq:([A-Za-z0-9_-]+)\]")
_LABEL = re.compile(r"^\s*:label:\s*([A-Za-z0-9_-]+)\s*$", re.MULTILINE)


def named_in_code():
    places = {}
    for path in sorted(SOURCE.rglob("*.py")):
        for label in _NAMED.findall(path.read_text(encoding="utf-8")):
            places.setdefault(label, path.relative_to(ROOT))
    return places


def labels_in_theory():
    places = {}
    repeated = []
    for path in sorted((DOCS / "theory").glob("*.md")):
        for label in _LABEL.findall(path.read_text(encoding="utf-8")):
            if label in places:
                repeated.append(label)
            places[label] = path.relative_to(ROOT)
    return places, repeated


def test_equations_of_the_code_are_in_the_theory():
    labels, _ = labels_in_theory()
    missing = {label: str(place) for label, place in named_in_code().items() if label not in labels}
    assert not missing, f"named in code, absent from docs/theory: {missing}"


def test_equations_of_the_theory_are_in_the_code():
    labels, _ = labels_in_theory()
    code = named_in_code()
    unused = {label: str(place) for label, place in labels.items() if label not in code}
    assert not unused, f"labelled in docs/theory, named nowhere in the code: {unused}"


def test_labels_are_unique_and_there_are_some():
    labels, repeated = labels_in_theory()
    assert not repeated
    assert labels


def listed(index):
    """Names in the toctrees of a page."""
    names = set()
    inside = False
    for line in index.read_text(encoding="utf-8").splitlines():
        if line.strip().startswith("```"):
            inside = "{toctree}" in line
            continue
        if inside and line.strip() and not line.strip().startswith(":"):
            names.add(line.strip())
    return names


def test_every_page_is_listed_in_its_index():
    missing = []
    for folder in ("theory", "validation", "tutorial", "adr"):
        pages = {path.stem for path in (DOCS / folder).glob("*.md")} - {"index"}
        index = DOCS / folder / "index.md"
        assert index.is_file(), f"no docs/{folder}/index.md"
        names = listed(index)
        if ":glob:" in index.read_text(encoding="utf-8") and "*" in names:
            names = (names - {"*"}) | pages
        missing += [f"docs/{folder}/{name}.md" for name in sorted(pages - names)]
        gone = names - pages
        assert not gone, f"docs/{folder}/index.md lists {sorted(gone)}, which do not exist"
    assert not missing, f"not in the index of their folder: {missing}"


def test_every_validation_page_has_a_table_of_evidence():
    """A row says what was claimed, how it is shown, and who else says so; most are made from records and tests."""
    for path in sorted((DOCS / "validation").glob("*.md")):
        if path.stem == "index":
            continue
        lines = path.read_text(encoding="utf-8").splitlines()
        rows = [line for line in lines if line.lstrip().startswith("|") or line.count(" | ") == 2]
        made = [line for line in lines if line.startswith(("```{validation} ", "```{measured-speed}"))]
        assert len(rows) >= 3 or made, f"{path.name} has no table"


def prose_of(page):
    """Lines of a page with their numbers, without code; of a row that tests hold, the claim and the source."""
    fence = ""
    for number, line in enumerate(page.read_text(encoding="utf-8").splitlines(), 1):
        mark = re.match(r"\s*(`{3,}|:{3,})", line)
        if mark:
            fence = "" if fence else line
        elif not fence or "{held-by-tests}" in fence:
            yield number, re.sub(r"`[^`]*`", "", re.sub(r" \| tests/.*", "", line) if fence else line)


def words_not_used(glossary):
    """What the glossary replaces, as an expression; words with a remark in brackets have other uses: left out."""
    rows = glossary.read_text(encoding="utf-8").split("## Words that are not used")[1].splitlines()
    words = [word.strip() for row in rows if row.startswith("| ") for word in row.split("|")[1].split(",")]
    words = [word for word in words if "(" not in word and word != "not"]
    forms = [re.sub(r"^(\w+?)(\w?)( .*)?$", r"\1\2(?:s|ed|ing|\2ed|\2ing)?\3", word) for word in words]
    # "work a survey off" is "work off" with words between
    forms = [re.sub(" off$", r"(?: [\\w-]+){0,3} off", form) for form in forms]
    return re.compile(rf"\b(?:{'|'.join(forms)})\b", re.IGNORECASE)


def test_pages_use_the_words_of_the_glossary():
    glossary = DOCS / "glossary.md"
    replaced = words_not_used(glossary)
    for text in ("two rooms", "worked off", "Works a survey off", "The bed rubbed."):
        assert replaced.search(text), text
    assert not replaced.search("a roomy housing")
    found = [
        f"{page.relative_to(ROOT)}:{number}: {match[0]}"
        for page in sorted(DOCS.rglob("*.md"))
        if page != glossary
        for number, line in prose_of(page)
        for match in replaced.finditer(line)
        if match[0].lower() != "besides"
    ]
    assert not found, "\n".join(found)


def test_texts_and_descriptions_in_the_code_use_the_words_of_the_glossary():
    """What a person reads in messages, reports and descriptions of functions, and what is new for users.

    In code ``fault`` is the name of an error in a file, as the key ``faults`` of the JSON answers; ``room`` is space.
    """
    replaced = re.compile(words_not_used(DOCS / "glossary.md").pattern + r"|\bworth\b", re.IGNORECASE)
    texts = [("CHANGELOG.md", re.sub(r"`[^`]*`", "", (ROOT / "CHANGELOG.md").read_text(encoding="utf-8")))]
    texts += [
        (f"{path.relative_to(ROOT)}:{line}", text) for path, one in findings().items() for line, text in one.texts
    ]
    found = [
        f"{place}: {text[max(match.start() - 30, 0) : match.end() + 30]}"
        for place, text in texts
        for match in replaced.finditer(text)
        if not re.match("besides|fault|room", match[0], re.IGNORECASE)
    ]
    assert not found, "\n".join(found)
