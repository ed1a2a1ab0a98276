"""Values of a case found from observations that the model itself made, with planted values and noise."""

import dataclasses

import numpy as np
import pytest
import study_cases

from moyai.case.reader import load_case
from moyai.core.errors import CaseError, InputError
from moyai.study.fitting import fitted_text, load_fit, run_fit

TEXT = """\
moyai: 1
fit:
  title: length of the chain
  base: base.yaml
  parameters:
    lines[*].segments[0].length: {{from: 54 m, to: 57 m}}
  observations:
    file: observed.csv
    columns: {{Hs: 'waves[storm].significant_height', Tp: 'waves[storm].peak_period'}}
    units: {{Hs: m, Tp: s}}
    observed: tension
    response: SWL/tension
    group: storm
"""


def write(tmp_path, text=TEXT, noise=0.0, planted=55.6, rows=8):
    study_cases.write_base(tmp_path)
    rng = np.random.default_rng(3)
    lines = ["Hs,Tp,tension,storm"]
    for number in range(rows):
        height, period = rng.uniform(0.3, 1.2), rng.uniform(4.0, 6.0)
        tension = 1000.0 * height**2 * period / 5.0 * (55.0 / planted) ** 4 * (1.0 + noise * rng.standard_normal())
        lines.append(f"{height!r},{period!r},{tension!r},storm {number % 4}")
    (tmp_path / "observed.csv").write_text("\n".join(lines), encoding="utf-8")
    path = tmp_path / "fit.yaml"
    path.write_text(text.format(), encoding="utf-8")
    return path


def of_one_group(fit):
    """Return the fit without leaving groups out in turn, where it is not looked at."""
    return dataclasses.replace(fit, rows=tuple(dataclasses.replace(row, group="") for row in fit.rows))


@pytest.mark.slow
def test_a_planted_value_is_found_to_rounding_and_written_into_the_case(tmp_path):
    fit = load_fit(write(tmp_path))
    result, found = run_fit(fit, study_cases.linear_case)
    assert found.values[0] == pytest.approx(55.6, abs=1e-6)
    assert result.tree["fit"]["rms"].item() < 1e-5
    text = fitted_text(fit, found)
    assert text.startswith("# Fitted by moyai") and "sha256" in text and "observed.csv" in text
    (tmp_path / "found.yaml").write_text(text, encoding="utf-8")
    case = load_case(tmp_path / "found.yaml")
    assert [line.segments[0].length for line in case.model.lines] == pytest.approx([55.6, 55.6], abs=1e-6)
    base = (tmp_path / "base.yaml").read_text(encoding="utf-8")
    # Everything else stands as it was
    assert len(text.splitlines()) == len(base.splitlines()) + 2
    assert sum(a != b for a, b in zip(text.splitlines()[2:], base.splitlines())) == 2


@pytest.mark.slow
def test_noise_is_reported_by_the_interval_and_by_the_storms_left_out(tmp_path):
    fit = load_fit(write(tmp_path, noise=0.03, rows=24))
    result, found = run_fit(fit, study_cases.linear_case)
    assert abs(found.values[0] - 55.6) < 4.0 * found.errors[0] and 0.0 < found.errors[0] < 0.3
    assert [one.group for one in found.left_out] == ["storm 0", "storm 1", "storm 2", "storm 3"]
    assert result.tree["left out"]["rms_of_group"].shape == (4,)


@pytest.mark.parametrize(
    ("change", "word"),
    [
        (("lines[*]", "lines[east]"), "no entry 'east'"),
        (("to: 57 m", "to: 53 m"), "empty"),
        (("to: 57 m", "to: 57 s"), "one kind"),
        (("from: 54 m", "from: 56 m"), "outside of the range"),
        (("observed: tension", "observed: force"), "no column 'force'"),
        (("observed.csv", "none.csv"), "no such file"),
        (("base.yaml", "none.yaml"), "no such file"),
        (("group: storm", "grup: storm"), "did you mean 'group'"),
    ],
)
def test_slips_of_a_fit_file_are_reported(tmp_path, change, word):
    with pytest.raises(CaseError) as caught:
        load_fit(write(tmp_path, TEXT.replace(*change)))
    assert word in "\n".join(str(fault) for fault in caught.value.faults)


def test_a_value_that_is_no_number_is_reported_by_row(tmp_path):
    path = write(tmp_path)
    file = tmp_path / "observed.csv"
    rows = file.read_text(encoding="utf-8").splitlines()
    rows[3] = "0.5,5,many,storm 1"
    file.write_text("\n".join(rows), encoding="utf-8")
    with pytest.raises(CaseError, match="row 4, column 'tension': 'many'"):
        load_fit(path)


def test_a_value_that_could_not_be_written_is_refused_before_the_fit(tmp_path):
    """A sea that only the fit file sets has no place in the case: that was stated after the last trial."""
    only_here = (
        TEXT.replace(
            "  parameters:\n    lines[*].segments[0].length: {{from: 54 m, to: 57 m}}",
            "  set: {{waves: [{{name: w, kind: regular, height: 1 m, periods: [5], heading_deg: 0}}]}}\n"
            "  parameters:\n    waves[w].height: {{from: 0.5 m, to: 2 m}}",
        )
        .replace(
            "columns: {{Hs: 'waves[storm].significant_height', Tp: 'waves[storm].peak_period'}}",
            "columns: {{Tp: 'waves[w].periods[0]'}}",
        )
        .replace("units: {{Hs: m, Tp: s}}", "units: {{Tp: s}}")
    )
    with pytest.raises(CaseError, match="there is no entry 'w' in 'waves'"):
        load_fit(write(tmp_path, only_here))


@pytest.mark.slow
def test_the_page_of_a_fit_shows_values_correlations_and_residuals(tmp_path):
    from moyai.report.writer import compose_document, write_report
    from moyai.study.fitting import _result

    fit = load_fit(write(tmp_path, noise=0.03, rows=4))
    # what is shown comes below
    _, found = run_fit(of_one_group(fit), study_cases.linear_case)
    (item, unit) = fit.parameters[0]
    # A second value that the observations hardly tell from the first
    twin = dataclasses.replace(item, name="stiffness")
    two = dataclasses.replace(fit, parameters=((item, unit), (twin, "N/m")))
    both = dataclasses.replace(
        found,
        values=np.array([55.6123456789, 2000.0]),
        errors=np.array([0.05, 30.0]),
        covariance=np.array([[0.05**2, -0.98 * 0.05 * 30.0], [-0.98 * 0.05 * 30.0, 30.0**2]]),
        interval=np.array([[55.5, 55.7], [1940.0, 2060.0]]),
        left_out=(),
    )
    result = _result(two, both, "N")
    np.testing.assert_allclose(result.tree["fit"]["correlation"].values, [[1.0, -0.98], [-0.98, 1.0]])
    document = compose_document(result)
    assert [section.title for section in document.sections][:3] == [
        "Summary", "What cannot be distinguished", "Observed and fitted",
    ]  # fmt: skip
    text = write_report(result, tmp_path / "out")[0].read_text(encoding="utf-8")
    assert "55.612" in text and "55.6123" not in text.split("Case file as it was run")[0].split("plot-data")[0]
    assert "hardly distinguish" in text and "-0.980" in text
    assert "Response SWL/tension" in text and all(
        figure.panels[0].unit == "N" for figure in document.sections[2].blocks
    )


@pytest.mark.slow
def test_headings_with_units_are_read_in_their_units(tmp_path):
    path = write(tmp_path, text=TEXT.replace("    units: {{Hs: m, Tp: s}}\n", ""), rows=4)
    table = (tmp_path / "observed.csv").read_text(encoding="utf-8").splitlines()
    rows = [line.split(",") for line in table[1:]]
    lines = ["Hs [cm],Tp [s],tension [kN],storm"]
    lines += [f"{100 * float(h)!r},{t},{1e-3 * float(f)!r},{storm}" for h, t, f, storm in rows]
    (tmp_path / "observed.csv").write_text("\n".join(lines), encoding="utf-8")
    _, found = run_fit(of_one_group(load_fit(path)), study_cases.linear_case)
    assert found.values[0] == pytest.approx(55.6, abs=1e-6)
    doubled = "Hs [cm],Hs [m]," + lines[0].split(",", 1)[1]
    (tmp_path / "observed.csv").write_text("\n".join([doubled, *("1," + line for line in lines[1:])]), encoding="utf-8")
    with pytest.raises(CaseError, match="more than one column 'Hs'"):
        load_fit(path)


def test_the_commented_starts_of_a_fit_and_of_its_case_fit_each_other(tmp_path):
    from moyai.case.templates import template

    for kind, name in (("fit", "fit.yaml"), ("breakwater", "breakwater.yaml")):
        (tmp_path / name).write_text(template(kind), encoding="utf-8")
    (tmp_path / "observed.csv").write_text("T [s],roll [deg/m]\n4,2.8\n5,2.7\n", encoding="utf-8")
    fit = load_fit(tmp_path / "fit.yaml")
    assert [row.observed for row in fit.rows] == pytest.approx(np.radians([2.8, 2.7]))
    # of the two water levels only that of the response is run
    assert fit.base.data["site"]["water_levels"] == {"LWL": "0 m"}


def test_columns_that_do_not_move_the_response_are_refused(tmp_path):
    columns = "Hs: 'waves[storm].significant_height', Tp: 'waves[storm].peak_period'"
    text = TEXT.replace(columns, "Tp: 'waves[storm].peak_enhancement'").replace("    units: {{Hs: m, Tp: s}}\n", "")
    with pytest.raises(InputError, match="for every row, whatever the columns set"):
        run_fit(load_fit(write(tmp_path, text=text)), study_cases.linear_case)


@pytest.mark.parametrize("unit", ["kg", "m", "kn"])
def test_observations_in_units_that_the_response_cannot_have_are_refused(tmp_path, unit):
    path = write(tmp_path)
    table = (tmp_path / "observed.csv").read_text(encoding="utf-8")
    (tmp_path / "observed.csv").write_text(table.replace("tension", f"tension [{unit}]", 1), encoding="utf-8")
    with pytest.raises(
        InputError, match=rf"observed.csv, column 'tension \[{unit}\]': '{unit}' is no unit of the resp"
    ):
        run_fit(load_fit(path), study_cases.linear_case)


def test_rows_of_observations_longer_than_the_headings_are_refused(tmp_path):
    path = write(tmp_path)
    table = (tmp_path / "observed.csv").read_text(encoding="utf-8").splitlines()
    table[3] += ",7"
    (tmp_path / "observed.csv").write_text("\n".join(table), encoding="utf-8")
    with pytest.raises(CaseError, match=r"observed\.csv line 4 has 5 cells for 4 headings"):
        load_fit(path)
