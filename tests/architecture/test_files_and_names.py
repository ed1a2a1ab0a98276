"""No file is longer than a reader holds in mind; no two classes share a name; fields are described where they stand."""

from collections import defaultdict

from source_files import FILES, SOURCE, findings

LONGEST = 600


def test_no_file_is_longer_than_the_limit():
    long = [f"{path.relative_to(SOURCE)}: {lines}" for path in FILES if (lines := _lines(path)) > LONGEST]
    assert not long, "\n".join(long)


def test_half_of_the_files_are_short():
    lengths = sorted(map(_lines, FILES))
    assert lengths[len(lengths) // 2] < 200


def test_every_class_has_a_name_of_its_own():
    places = defaultdict(list)
    for path, found in findings().items():
        for name in found.classes:
            places[name].append(str(path.relative_to(SOURCE)))
    shared = [f"{name}: {', '.join(files)}" for name, files in sorted(places.items()) if len(files) > 1]
    assert not shared, "\n".join(shared)


def test_fields_are_described_where_they_stand():
    """A list of fields in the description of a class says a second time what stands, or should stand, at the fields."""
    lists = [
        f"{path.relative_to(SOURCE)}: {name}" for path, found in findings().items() for name in found.lists_of_fields
    ]
    assert not lists, "\n".join(lists)


def _lines(path):
    return path.read_text(encoding="utf-8").count("\n")
