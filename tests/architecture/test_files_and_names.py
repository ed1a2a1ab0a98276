"""No file or function is longer than a reader holds in mind; no two classes share a name.

Fields are described where they stand.
"""

from collections import defaultdict

from source_files import FILES, SOURCE, findings

LONGEST = 600
LONGEST_FUNCTION = 80
#: Functions of more lines than a reader takes in at once, and why each stays whole; none joins without a reason.
LONG_FUNCTIONS = {
    "one compiled loop: calls would cost time and pass dozens of arrays": (
        "coupled/planar_kernel.py: march_together",
        "flexible/explicit_kernel.py: march",
        "flexible/force_kernel.py: blocks",
        "flexible/force_kernel.py: forces",
        "flexible/implicit_kernel.py: implicit_march",
        "floating/lanes_kernel.py: run_lanes",
        "mooring/segments.py: solve_segments",
        "structures/cage/rigid/load_kernel.py: loads",
        "structures/cage/rigid/march_kernel.py: march",
        "structures/units/time/kernel.py: march",
    ),
    "a third is the declaration of its options": (
        "cli/measuring_flume.py: flume",
        "cli/measuring_tide.py: tide",
        "cli/scale.py: scale",
        "flexible/ensemble.py: simulate_together",
        "flexible/simulation.py: simulate",
        "floating/statics.py: find_equilibrium",
        "interop/coefficients.py: assemble",
        "interop/wamit.py: read_wamit",
        "records/survey/tension_blocks.py: analyse_blocks",
        "structures/curtain/statics/section.py: solve_section",
    ),
    "one table of the variables that it writes": (
        "structures/breakwater/frequency/irregular.py: irregular_sea",
        "structures/breakwater/time/regular.py: regular_sea",
        "structures/curtain/analyses/statics.py: _statics",
        "structures/network/run.py: network_dataset",
    ),
    "a list of checks, each a condition with its sentence": (
        "series/snap_record.py: _check",
        "structures/curtain/case/check.py: _check_dynamic",
        "structures/units/time/analysis.py: _notices",
    ),
    "one order of steps whose results all go on to the next": (
        "flexible/refine.py: refined",
        "potential/heading.py: solve_states",
        "records/streaks/case/build.py: _build",
        "structures/curtain/run.py: _level_steps",
    ),
    "one row of the page or one figure after the other": (
        "records/streaks/report/page.py: _law_figures",
        "structures/curtain/limit_headlines.py: limit_headlines",
    ),
}


def test_no_file_is_longer_than_the_limit():
    long = [f"{path.relative_to(SOURCE)}: {lines}" for path in FILES if (lines := _lines(path)) > LONGEST]
    assert not long, "\n".join(long)


def test_no_function_is_longer_than_the_limit_without_a_reason():
    long = {
        f"{path.relative_to(SOURCE)}: {name}": lines
        for path, found in findings().items()
        for name, lines in found.functions
        if lines > LONGEST_FUNCTION
    }
    allowed = {name for names in LONG_FUNCTIONS.values() for name in names}
    new = [
        f"{name}: {lines} lines, more than {LONGEST_FUNCTION}" for name, lines in long.items() if name not in allowed
    ]
    assert not new, "\n".join(new)
    shorter = sorted(allowed - long.keys())
    assert not shorter, f"no longer too long, take off the list: {', '.join(shorter)}"


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
