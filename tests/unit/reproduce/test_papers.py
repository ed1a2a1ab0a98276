"""Papers: places of the equations, figures that take points, unknown names, and points laid over a figure."""

import math
from importlib import import_module
from pathlib import Path

import numpy as np
import pytest

from moyai.core.errors import InputError
from moyai.report.document import Abscissa, Panel
from moyai.reproduce import paper, papers
from moyai.reproduce.drawing import curve, figure
from moyai.reproduce.inputs import case_files, problem_of
from moyai.reproduce.points import agreements, laid_over, read_points
from moyai.reproduce.tabata.runs import ROPES
from moyai.reproduce.tabata.statements import rope_diameter


def resolve(name):
    parts = name.split(".")
    for cut in range(len(parts), 0, -1):
        try:
            found = import_module(".".join(parts[:cut]))
        except ModuleNotFoundError:
            continue
        for part in parts[cut:]:
            found = getattr(found, part)
        return found
    raise AssertionError(name)


@pytest.mark.parametrize("one", papers(), ids=lambda one: one.key)
def test_every_equation_stands_in_the_code(one):
    for equation in one.equations:
        assert equation.places
        for place in equation.places:
            assert callable(resolve(place)), place


@pytest.mark.parametrize("one", papers(), ids=lambda one: one.key)
def test_keys_are_unique_and_cases_are_there(one):
    for keys in ([row.key for row in one.statements], list(one.plotted), [row.number for row in one.equations]):
        assert len(set(keys)) == len(keys)
    assert case_files(one.key)


@pytest.mark.parametrize("one", papers(), ids=lambda one: one.key)
def test_inputs_stand_under_the_examples(one):
    folder = Path(__file__).resolve().parents[3] / "examples" / "papers" / one.key
    assert [path.name for path in sorted(folder.glob("*.yaml"))] == [path.name for path in case_files(one.key)]
    for path, own in zip(sorted(folder.glob("*.yaml")), case_files(one.key), strict=True):
        assert path.read_bytes() == own.read_bytes()


def test_unknown_paper_says_which_there_are():
    with pytest.raises(InputError, match=r"no paper 'nakamra'; allowed: nakamura, tabata, arai, sawaragi, matsubara"):
        paper("nakamra")


def points_file(tmp_path, text):
    path = tmp_path / "points.csv"
    path.write_text(text, encoding="utf-8")
    return path


@pytest.mark.parametrize(
    ("option", "text", "message"),
    [
        ("9z={}", "1,2\n", "no figure '9z' takes points; allowed: 4, 5a"),
        ("5a", "1,2\n", "'5a' has no '='"),
        ("5a={}", "x,y\n1,2\n3,much\n", "line 3: '3,much' is no pair of numbers"),
        ("5a={}", "x,y\n1\n", "line 2: '1' is no pair of numbers"),
        ("5a={}", "1,nan\n", "line 1: '1,nan' is no pair of numbers"),
        ("5a={}", "x,y\n", "holds no points"),
        ("5a={}.absent", "1,2\n", "cannot be read"),
    ],
)
def test_bad_points_are_one_line(tmp_path, option, text, message):
    with pytest.raises(InputError) as error:
        read_points(option.format(points_file(tmp_path, text)), ("4", "5a"))
    assert message in str(error.value) and "\n" not in str(error.value)


def test_bias_and_scatter_are_those_of_the_differences(tmp_path):
    x = np.linspace(0.0, 10.0, 11)
    drawn = figure("1", "line", (Abscissa("x", "x"),), Panel("y"), [curve("twice x", {"x": x}, 2.0 * x)])
    points = read_points(
        f"1={points_file(tmp_path, 'x; y' + chr(10) + '1; 1.5' + chr(10) + '2; 3' + chr(10) + '20; 0')}", ("1",)
    )
    (found,) = agreements(drawn, points)
    assert (found.count, found.bias) == (2, pytest.approx(0.75))
    assert found.scatter == pytest.approx(math.sqrt(0.125))
    assert found.relative == pytest.approx(math.sqrt((0.5**2 + 1.0) / (1.5**2 + 9.0)))
    assert laid_over(drawn, points).series[-1].style == "points"


def test_points_next_to_every_curve_are_refused(tmp_path):
    drawn = figure("1", "line", (Abscissa("x", "x"),), Panel("y"), [curve("a", {"x": np.arange(3.0)}, np.arange(3.0))])
    with pytest.raises(
        InputError, match=r"no point of points.csv lies under a curve of figure 1; allowed: x from 0 to 2"
    ):
        agreements(drawn, read_points(f"1={points_file(tmp_path, '5 1')}", ("1",)))


def test_points_over_paths_are_drawn_and_not_compared(tmp_path):
    """A loop has no value at a place; a curve next to it is compared, and refuses points that it does not reach."""
    angle = np.linspace(0.0, 6.0, 30)
    loop = curve("loop", {"x": np.cos(angle)}, np.sin(angle))
    drawn = figure("1", "paths", (Abscissa("x", "x"),), Panel("y"), [loop])
    points = read_points(f"1={points_file(tmp_path, '0.5 1')}", ("1",))
    assert agreements(drawn, points) == ()
    assert laid_over(drawn, points).series[-1].y == pytest.approx([1.0])
    with_line = figure("1", "both", (Abscissa("x", "x"),), Panel("y"), [loop, curve("a", {"x": angle}, angle)])
    (found,) = agreements(with_line, points)
    assert (found.curve, found.bias) == ("a", pytest.approx(-0.5))


def test_lift_on_the_members_by_hand():
    """Density 1000, V = KC 0.045 m 0.95 Hz, circulation 18 KC^2 cm2/s, 79 cm: 6.08e-2 KC^3 N."""
    from moyai.reproduce.arai.figures import lift

    number = np.array([0.0, 1.0, 2.0, 4.0])
    assert lift(number) == pytest.approx(1000.0 * 0.04275 * 18e-4 * 0.79 * number**3, rel=1e-3)


def test_field_curtain_of_the_case_is_that_of_the_page_and_keeps_the_product_of_the_paper():
    case = problem_of("tabata", "kansai")
    anchors, model = case.curtain.anchors, case.settings.anchor_loads
    assert anchors.stiffness == pytest.approx(ROPES["890 kN"])
    assert model.energy_factor * anchors.stiffness == pytest.approx(0.2 * 890e3)
    # it is held against strength itself, as the page holds it
    strengths = case.curtain.strengths
    for part in (strengths.upper_cable, strengths.sheet, strengths.anchor_line, strengths.anchor):
        assert part.safety_factor == 1.0


def test_printed_stiffness_of_the_field_curtain_is_no_fibre_rope():
    """The catalogue by hand: EA = 1.09e9 d2 of polyester and 4.04e10 d2 of steel wire, in N and m."""
    length = problem_of("tabata", "kansai").curtain.anchors.length
    assert rope_diameter("polyester_8_strand", length * ROPES["890 kN"]) == pytest.approx((890e3 / 1.09e9) ** 0.5)
    assert rope_diameter("wire_6x19_wire_core", length * ROPES["890 kN/m"]) == pytest.approx(
        (46.0 * 890e3 / 4.04e10) ** 0.5
    )
    assert rope_diameter("polyester_8_strand", length * ROPES["890 kN/m"]) > 0.19
