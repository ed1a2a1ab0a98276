"""The chain and rope catalogue: numbers of its sources, units, ranges, messages."""

from __future__ import annotations

import math

import pytest

from moyai.core.errors import InputError
from moyai.tables.lines import (
    available_line_types,
    check_line_properties,
    line_type,
)
from moyai.tables.reader import read_table

# breaking test loads [kN] as a maker lists them after IACS UR W22: (grade, diameter mm) -> kN
MAKER = {("R3", 34): 1065, ("R3", 50): 2230, ("R3", 66): 3762, ("R3S", 44): 1952, ("R4", 36): 1461, ("R4", 68): 4886}


@pytest.mark.parametrize(("grade", "diameter"), MAKER)
@pytest.mark.parametrize("kind", ["studless", "studlink"])
def test_breaking_loads_of_offshore_grades(kind: str, grade: str, diameter: int) -> None:
    chain = line_type(f"{kind}_chain_{grade}", diameter * 1e-3)
    assert chain.breaking_load / 1e3 == pytest.approx(MAKER[grade, diameter], abs=1.0)  # listed in whole kN, rounded up
    assert chain.confirmed


def test_common_formulas_of_chain() -> None:
    d = 0.05
    studless, stud = line_type("studless_chain_U3", d), line_type("studlink_chain_U3", d)
    assert studless.mass_per_length == pytest.approx(19.9e3 * d**2)
    assert stud.mass_per_length == pytest.approx(21.9e3 * d**2)
    assert studless.axial_stiffness == pytest.approx(0.854e11 * d**2)
    assert studless.breaking_load == pytest.approx(1.96e4 * d**2 * (44 - 80 * d) * 1e3)
    assert studless.volume_diameter == pytest.approx(1.8 * d)
    assert not studless.confirmed


@pytest.mark.parametrize("name", available_line_types())
def test_entries_are_physical(name: str) -> None:
    entry = line_type(name, 0.05)
    material = entry.mass_per_length / entry.volume_per_length
    low, high = (7000.0, 8200.0) if "chain" in name else (4500.0, 8200.0) if "wire" in name else (900.0, 1450.0)
    assert low < material < high
    strain = entry.breaking_load / entry.axial_stiffness
    assert 0.004 < strain < 1.2
    assert entry.source and entry.drag_normal > 0.0
    assert entry.diameter_range[0] < entry.diameter_range[1]


def test_submerged_weight_follows_the_water() -> None:
    chain = line_type("studless_chain_R3", 0.05)
    assert chain.submerged_weight_per_length(0.0, 9.81) == pytest.approx(chain.mass_per_length * 9.81)
    steel = chain.mass_per_length / chain.volume_per_length
    assert chain.submerged_weight_per_length(steel, 9.81) == pytest.approx(0.0, abs=1e-9)
    assert line_type("polypropylene_8_strand", 0.05).submerged_weight_per_length(1025.0, 9.81) < 0.0


def test_range_and_unconfirmed_values_are_reported() -> None:
    assert check_line_properties(line_type("studless_chain_R4", 0.08)) == ()
    codes = {notice.code for notice in check_line_properties(line_type("studless_chain_U2", 0.003))}
    assert codes == {"line-diameter-range", "line-values-unconfirmed"}


@pytest.mark.parametrize("diameter", [0.0, -1.0, math.nan, math.inf, 0.5])
def test_bad_diameters(diameter: float) -> None:
    with pytest.raises(InputError):
        line_type("studless_chain_R3", diameter)


def test_unknown_name_suggests_one() -> None:
    with pytest.raises(InputError, match="did you mean"):
        line_type("studles_chain_R3", 0.05)


def test_file_states_its_sources() -> None:
    assert len({row["name"] for row in read_table("lines.csv")}) == len(available_line_types())
