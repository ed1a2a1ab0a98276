"""Realisations of an irregular sea on a rigid cage: independent of their company, their mean on the first page."""

import re
from dataclasses import replace

import numpy as np
import pytest

import moyai
from moyai.case.templates import template
from moyai.core.errors import CaseError
from moyai.core.results import Result
from moyai.sea.irregular import realisation_seed
from moyai.series.intervals import reach_of_mean
from moyai.structures.cage.bands import FEW_WAVES, NO_LAWS
from moyai.structures.cage.report.rigid_page import compose
from moyai.structures.cage.rigid import laws
from moyai.structures.cage.rigid import run as rigid_run
from moyai.structures.cage.rigid.realisations import RigidCageRealisation
from moyai.structures.cage.rigid.runs import run_wave

SEA = (
    "  - {name: sea, kind: jonswap, significant_height: HEIGHT, peak_period: 1.2 s, peak_enhancement: 3.3, "
    "heading_deg: 0, duration: DURATION, seed: SEED}\n\n"
)


def result_of(
    count: int, seed: int = 3, duration: str = "60 s", equations: str = "sound", height: str = "2 cm"
) -> Result:
    """Return the template in an irregular sea, by so many realisations."""
    text = template("rigid_cage")
    first, last = text.index("\nwaves:") + 1, text.index("# current:")
    sea = "waves:\n" + SEA.replace("DURATION", duration).replace("SEED", str(seed)).replace("HEIGHT", height)
    text = text[:first] + sea + text[last:]
    text = re.sub(r"\nanalyses: .*", "\nanalyses: [statics, time]", text)
    text = text.replace("  model: rigid ", f"  model: rigid\n  equations: {equations} ")
    text += f"\nsettings: {{rigid: {{realisations: {count}}}}}\n"
    return moyai.run(moyai.load_case(text))


@pytest.fixture(scope="module")
def three() -> Result:
    return result_of(3)


def sea_of(result: Result):
    return result.tree["SWL/waves/sea"].dataset


def test_a_realisation_is_the_run_of_its_seed_whatever_its_company(three: Result) -> None:
    sea = sea_of(three)
    assert sea["seed_of_realisation"].values.tolist() == [realisation_seed(3, number) for number in range(3)]
    second = sea_of(result_of(1, int(sea["seed_of_realisation"][1])))
    assert "seed_of_realisation" not in second
    alone = second["line_tension_maximum"].values[0]
    assert np.array_equal(sea["line_tension_maximum_of_realisation"].values[1], alone)
    assert np.array_equal(sea["line_tension_maximum_of_realisation"].values[0], sea["line_tension_maximum"].values[0])


def test_the_first_page_has_their_mean_and_judges_its_uncertain_end(three: Result) -> None:
    each = sea_of(three)["line_tension_maximum_of_realisation"].values[:, 1, 0]
    (tension,) = (item for item in three.headlines if item.name == "line_tension" and item.where.startswith("shore"))
    assert tension.value == pytest.approx(each.mean(), rel=1e-12)
    band = tension.band
    assert band.realisations == 3 and band.more == "settings.rigid.realisations" and not band.decides
    assert band.low <= each.min() and band.high >= each.max() and band.judged[1] >= each.mean() + reach_of_mean(each)
    assert "sea, seed 3 and 2 more" in tension.where and "mean of the largest of 3 realisations" in tension.detail
    offsets = sea_of(three)["largest_offset_of_realisation"].values
    (offset,) = (item for item in three.headlines if item.name == "offset")
    assert offset.value == pytest.approx(offsets.mean(), rel=1e-12)
    (table,) = (one for one in _tables(compose(three)) if one.title == "Highest tension in 3 realisations: sea")
    assert table.columns[1].values[1] == pytest.approx(each.mean())


def _tables(page):
    return [block for section in page.sections for block in _flat(section.blocks) if hasattr(block, "columns")]


def _flat(blocks):
    for block in blocks:
        yield block
        yield from _flat(getattr(block, "blocks", ()))


def test_realisations_of_few_waves_prove_no_limit() -> None:
    short = result_of(2, duration="20 s")
    (tension,) = (item for item in short.headlines if item.name == "line_tension")
    assert tension.bound == "at least" and FEW_WAVES in tension.band.of


def test_the_printed_equations_have_one() -> None:
    assert "seed_of_realisation" not in sea_of(result_of(3, duration="20 s", equations="literal"))


def test_realisations_that_leave_all_bounds_are_a_failure(monkeypatch: pytest.MonkeyPatch) -> None:
    """Whichever seed it is: the mean of the others proves no limit."""
    monkeypatch.setattr(rigid_run, "further_realisations", lambda *_: iter([RigidCageRealisation(7, None, 0.02)]))
    result = result_of(2, duration="20 s")
    assert result.status == "not_converged" and "1 of 2 realisations left all bounds" in result.message


def test_a_law_whose_run_fails_is_no_result(monkeypatch: pytest.MonkeyPatch) -> None:
    def failing(problem, lines, begin, water, wave, **given):
        found = run_wave(problem, lines, begin, water, wave, **given)
        return replace(found, march=replace(found.march, status="not_converged"))

    monkeypatch.setattr(laws, "run_wave", failing)
    result = result_of(2, duration="60 s", height="3 cm")
    of_laws = result.tree["SWL/laws"].dataset
    assert of_laws.attrs["missing"] >= 1 and of_laws.sizes["law"] == 1
    (tension,) = (item for item in result.headlines if item.name == "line_tension")
    assert NO_LAWS in tension.band.of and tension.bound == "at least"


def test_the_realised_height_is_that_of_the_number(three: Result) -> None:
    (height,) = (item for item in three.headlines if item.name == "realised_height")
    series = three.tree["SWL/time/sea/sea"].dataset
    assert height.value == pytest.approx(sea_of(three).attrs["realised_height"]) != series.attrs["realised_height"]
    assert "seed 3 and 2 more" in height.detail


@pytest.mark.parametrize("wrong", [0, 101, 2.5])
def test_a_wrong_number_is_refused(wrong: float) -> None:
    with pytest.raises(CaseError, match=r"settings\.rigid\.realisations"):
        result_of(wrong)
