"""Reading of records: what was written by other libraries comes back in SI, and faults name file, row and column."""

import datetime as dt

import numpy as np
import pytest

from moyai.core.errors import InputError
from moyai.records.reading.reader import aligned, blocks, read_chunks, read_record, si_symbol
from moyai.records.reading.record import instant_text
from moyai.records.reading.sources import ClockCorrection, ColumnSource, LoggerSource, TimeSource

SECONDS = TimeSource(columns=("t",), unit="s")


def logger(path, columns, time=SECONDS, **more):
    paths = path if isinstance(path, tuple) else (path,)
    return LoggerSource("logger", paths, tuple(columns), time, **more)


@pytest.fixture
def sample():
    random = np.random.default_rng(7)
    time = np.arange(500) * 0.1
    return time, random.normal(size=500), random.normal(2.0, 0.3, size=500)


@pytest.mark.parametrize("delimiter", [",", ";", "\t", "|", " "])
@pytest.mark.parametrize("decimal", [".", ","])
@pytest.mark.parametrize("encoding", ["utf-8", "cp932", "utf-16"])
def test_text_in_any_dress(tmp_path, sample, delimiter, decimal, encoding):
    if delimiter == decimal:
        pytest.skip("a delimiter that is the decimal sign cannot be read by anybody")
    time, height, force = sample
    lines = ["計測所 北防波堤", delimiter.join(["t", "波高（cm）", "張力[tf]"])]
    rows = zip(time, height * 100.0, force)
    lines += [delimiter.join(f"{value:.9f}".replace(".", decimal) for value in row) for row in rows]
    path = tmp_path / "記録.csv"
    path.write_text("\r\n".join(lines) + "\r\n", encoding=encoding)
    columns = [ColumnSource("波高", "elevation"), ColumnSource("張力", "tension")]
    record = read_record(logger(path, columns, header_row=2, decimal=decimal))
    assert record.units == ("m", "N")
    np.testing.assert_allclose(record["elevation"], height, atol=1e-10)
    np.testing.assert_allclose(record["tension"], force * 9806.65, atol=1e-4)
    np.testing.assert_allclose(record.time, time, atol=1e-9)


def test_stamps_of_japan_in_two_columns(tmp_path):
    start = dt.datetime(1999, 9, 24, 13, 0, 0)
    rows = ["日付,時刻,水位 [m]"]
    rows += [
        f"{(start + dt.timedelta(seconds=i)):%Y/%m/%d},{(start + dt.timedelta(seconds=i)):%H:%M:%S},{i}"
        for i in range(90)
    ]
    path = tmp_path / "a.csv"
    path.write_text("\n".join(rows), encoding="shift_jis")
    time = TimeSource(columns=("日付", "時刻"), form="%Y/%m/%d %H:%M:%S", utc_offset=9 * 3600.0)
    record = read_record(logger(path, [ColumnSource("水位", "level")], time))
    expected = dt.datetime(1999, 9, 24, 4, 0, 0, tzinfo=dt.UTC).timestamp()
    np.testing.assert_allclose(record.time, expected + np.arange(90), atol=1e-6)
    assert instant_text(record.time[0], True) == "1999-09-24 04:00:00.000Z"


def test_whole_second_stamps_are_spread_and_a_gap_stays(tmp_path):
    """Ten samples carry one stamp; after a gap of 30 s counting begins anew."""
    ticks = np.concatenate([np.arange(400), np.arange(700, 900)])
    start = dt.datetime(2000, 1, 31, 6, 0, 0)
    rows = ["time,x [m]"] + [f"{start + dt.timedelta(seconds=int(i) // 10):%Y-%m-%d %H:%M:%S},{i}" for i in ticks]
    path = tmp_path / "a.csv"
    path.write_text("\n".join(rows))
    time = TimeSource(columns=("time",), form="iso", rate=10.0)
    for rows_at_a_time in (37, 100_000):
        parts = list(read_chunks(logger(path, [ColumnSource("x", "x")], time), rows_at_a_time))
        instants = np.concatenate([part.time for part in parts])
        truth = start.replace(tzinfo=dt.UTC).timestamp() + ticks / 10.0
        np.testing.assert_allclose(instants, truth, atol=1e-6)


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(6))
def test_all_formats_agree(tmp_path, seed):
    """The same random numbers through text, MATLAB, NetCDF and Parquet."""
    import pyarrow as pa
    import pyarrow.parquet as pq
    import xarray as xr
    from scipy.io import savemat

    random = np.random.default_rng(seed)
    size = int(random.integers(20, 3000))
    time = np.cumsum(random.uniform(0.05, 0.2, size))
    wave = random.normal(size=size) * 10.0 ** random.integers(-3, 3)
    pull = random.normal(size=size)
    pull[random.integers(0, size, 3)] = np.nan
    columns = [ColumnSource("wave", "wave", "mm"), ColumnSource("pull", "pull", "kN")]
    table = np.column_stack([time, wave, pull])
    np.savetxt(tmp_path / "a.csv", table, delimiter=",", header="t,wave,pull", comments="", fmt="%.17g")
    savemat(tmp_path / "a.mat", {"t": time, "wave": wave[:, None], "pull": pull})
    xr.Dataset({"wave": ("time", wave), "pull": ("time", pull), "t": ("time", time)}).to_netcdf(
        tmp_path / "a.nc", engine="h5netcdf"
    )
    pq.write_table(pa.table({"t": time, "wave": wave, "pull": pull}), tmp_path / "a.parquet", row_group_size=777)
    records = [read_record(logger(tmp_path / f"a.{ending}", columns)) for ending in ("csv", "mat", "nc", "parquet")]
    for record in records:
        np.testing.assert_allclose(record.time, time, rtol=1e-14)
        np.testing.assert_allclose(record["wave"], wave * 1e-3, rtol=1e-14)
        np.testing.assert_allclose(record["pull"], pull * 1e3, rtol=1e-14)
        assert record.units == ("m", "N")
    whole = np.concatenate([part.values for part in read_chunks(logger(tmp_path / "a.parquet", columns), 113)])
    np.testing.assert_array_equal(whole, records[3].values)


def test_parquet_and_netcdf_stamps(tmp_path):
    import pyarrow as pa
    import pyarrow.parquet as pq
    import xarray as xr

    stamps = np.datetime64("2000-02-08T11:00:00", "ns") + np.arange(50) * np.timedelta64(100, "ms")
    values = np.arange(50.0)
    pq.write_table(pa.table({"time": stamps, "u [cm/s]": values}), tmp_path / "a.parquet")
    xr.Dataset({"u": ("time", values, {"units": "cm/s"})}, {"time": stamps}).to_netcdf(
        tmp_path / "a.nc", engine="h5netcdf"
    )
    for ending in ("parquet", "nc"):
        source = logger(tmp_path / f"a.{ending}", [ColumnSource("u", "u")], TimeSource(columns=("time",)))
        record = read_record(source)
        assert record.dated
        assert record.time[0] == pytest.approx(dt.datetime(2000, 2, 8, 11, tzinfo=dt.UTC).timestamp(), abs=1e-5)
        np.testing.assert_allclose(np.diff(record.time), 0.1, atol=1e-5)
        np.testing.assert_allclose(record["u"], values / 100.0)


def test_matlab_structures_matrices_and_datenum(tmp_path):
    import h5py
    from scipy.io import savemat

    days = 730387.5 + np.arange(60) / 86400.0  # 1999-09-24 12:00
    matrix = np.arange(120.0).reshape(60, 2)
    savemat(tmp_path / "a.mat", {"rec": {"t": days, "data": matrix}})
    time = TimeSource(columns=("rec.t",), unit="datenum")
    record = read_record(logger(tmp_path / "a.mat", [ColumnSource("rec.data[1]", "x", "N")], time))
    np.testing.assert_array_equal(record["x"], matrix[:, 1])
    assert instant_text(record.time[0] + 1e-4, True).startswith("1999-09-24 12:00:00.000")
    with h5py.File(tmp_path / "b.mat", "w", userblock_size=512) as file:  # version 7.3 is HDF5, axes reversed
        file["rec/t"] = days[None, :]
        file["rec/data"] = matrix.T
    with (tmp_path / "b.mat").open("r+b") as stream:
        stream.write(b"MATLAB 7.3 MAT-file".ljust(124) + b"\x00\x02IM")
    newer = read_record(logger(tmp_path / "b.mat", [ColumnSource("rec.data[1]", "x", "N")], time))
    np.testing.assert_array_equal(newer["x"], matrix[:, 1])


def test_rows_without_stamps_and_missing_signs(tmp_path):
    path = tmp_path / "buoy.raw"
    path.write_text(" 0,  -67,  -37\n 0, -9999,  -15\n 0, -134,    4\n")
    source = logger(path, [ColumnSource(2, "heave", "cm", missing=(-9999.0,))], TimeSource(rate=1.28), header_row=0)
    record = read_record(source)
    np.testing.assert_allclose(record.time, np.arange(3) / 1.28)
    np.testing.assert_allclose(record["heave"], [-0.67, np.nan, -1.34])


def test_clock_error_is_taken_off(tmp_path, sample):
    time, height, _ = sample
    np.savetxt(tmp_path / "a.csv", np.column_stack([time, height]), delimiter=",", header="t,h", comments="")
    clock = ClockCorrection(offset=2.5, drift=1e-3, reference=10.0)
    record = read_record(logger(tmp_path / "a.csv", [ColumnSource("h", "h", "m")], clock=clock))
    np.testing.assert_allclose(record.time, time + 2.5 + 1e-3 * (time - 10.0))


def test_blocks_are_cut_where_the_clock_says(tmp_path):
    random = np.random.default_rng(3)
    time = np.cumsum(random.uniform(0.01, 3.0, 400))
    np.savetxt(tmp_path / "a.csv", np.column_stack([time, time]), delimiter=",", header="t,h", comments="", fmt="%.17g")
    source = logger(tmp_path / "a.csv", [ColumnSource("h", "h", "m")])
    for rows in (7, 1000):
        cut = list(blocks(read_chunks(source, rows), origin=-5.0, length=40.0))
        assert sum(len(block.record) for block in cut) == 400
        for block in cut:
            assert block.record.time[0] >= -5.0 + 40.0 * block.index - 1e-6
            assert block.record.time[-1] < -5.0 + 40.0 * (block.index + 1)
    pairs = list(aligned([iter(cut[:3]), iter(cut[2:])]))
    assert [index for index, _ in pairs] == [block.index for block in cut]
    assert pairs[0][1][1] is None and pairs[2][1][0] is not None and pairs[2][1][1] is not None


BAD = {
    "empty": ("", "is empty"),
    "headings only": ("t,h\n", "no samples"),
    "word": ("t,h\n0,1\n0.1,abc\n", "line 3, column 'h': 'abc' is not a number"),
    "word after comments and blank lines": ("# a\nt,h\n0,1\n\n# b\n0.1,x7\n", "line 6, column 'h'"),
    "all missing": ("t,h\n0,\n1,\n2,\n", "column 'h' holds no value at all in 3 rows"),
    "backward time": ("t,h\n0,1\n2,1\n1,1\n", "line 4: the time 1 s does not come after 2 s"),
    "repeated time": ("t,h\n0,1\n0,1\n", "line 3: the time 0 s does not come after 0 s"),
    "too many cells": ("t,h\n0,1\n1,1,5\n", "line 3 has 3 cells"),
    "no time": ("t,h\n0,1\n,1\n", "line 3: there is no time"),
    "wrong column": ("t,heigth\n0,1\n", "no column 'h'"),
    "other unit": ("t,h [cm]\n0,1\n1,2\n", "states the unit [cm] and the configuration says 'm'"),
    "two of a name": ("t,h,h\n0,1,2\n1,2,3\n", "has the column 'h' 2 times"),
}


@pytest.mark.parametrize("case", BAD)
def test_faults_name_file_row_and_column(tmp_path, case):
    text, message = BAD[case]
    path = tmp_path / "bad.csv"
    path.write_text(text)
    with pytest.raises(InputError) as caught:
        read_record(logger(path, [ColumnSource("h", "h", "m")]))
    assert message in str(caught.value)
    assert "bad.csv" in str(caught.value)


def test_more_faults(tmp_path):
    path = tmp_path / "a.csv"
    path.write_text("t,h\n0,1\n1,2\n")
    with pytest.raises(InputError, match="states no unit"):
        read_record(logger(path, [ColumnSource("h", "h")]))
    with pytest.raises(InputError, match="no such file"):
        read_record(logger(tmp_path / "b.csv", [ColumnSource("h", "h", "m")]))
    with pytest.raises(InputError, match="does not fit the time format"):
        read_record(logger(path, [ColumnSource("h", "h", "m")], TimeSource(columns=("t",), form="%H:%M")))
    with pytest.raises(InputError, match="neither UTF-8 nor Shift-JIS"):
        (tmp_path / "c.csv").write_bytes(b"t,h\n0,\x85\x20\xff\x81\n")
        read_record(logger(tmp_path / "c.csv", [ColumnSource("h", "h", "m")]))
    with pytest.raises(InputError, match="is of no known format"):
        (tmp_path / "a.xyz").write_text("0")
        read_record(logger(tmp_path / "a.xyz", [ColumnSource("h", "h", "m")]))
    with pytest.raises(InputError, match="does not come after"):
        read_record(logger((path, path), [ColumnSource("h", "h", "m")], TimeSource(columns=("t",))))


def test_rows_out_of_order_can_be_left_out(tmp_path):
    path = tmp_path / "a.csv"
    path.write_text("t,h\n0,0\n1,1\n0.5,9\n2,2\n")
    record = read_record(logger(path, [ColumnSource("h", "h", "m")], TimeSource(columns=("t",), order="drop")))
    np.testing.assert_array_equal(record["h"], [0.0, 1.0, 2.0])
    assert record.notices[0].code == "time-order"


@pytest.mark.parametrize(
    ("unit", "symbol"),
    [("tf", "N"), ("kn", "m/s"), ("deg", "rad"), ("mm", "m"), ("kN/m", "N/m"), ("kPa", "Pa"), ("%", "")],
)
def test_si_symbols(unit, symbol):
    from moyai.core.units import parse_unit

    assert si_symbol(parse_unit(unit)) == symbol


def test_words_that_mean_no_value(tmp_path):
    path = tmp_path / "w.csv"
    path.write_text("t,h\n0,1\n1,欠測\n2,****\n3,-9999.0\n4,NaN\n5,2\n", encoding="utf-8")
    column = ColumnSource("h", "level", "m", missing=("欠測", "****", -9999.0, "NaN"))
    np.testing.assert_array_equal(read_record(logger(path, [column]))["level"], [1, *[np.nan] * 4, 2])
    with pytest.raises(InputError, match=r"line 3.*欠測"):
        read_record(logger(path, [ColumnSource("h", "level", "m")]))


@pytest.mark.parametrize(("decimal", "sign"), [(".", "-99.5"), (".", "-99.50"), (",", "-99,5"), (".", -99.5)])
@pytest.mark.parametrize("other", ["4", "****"])
def test_a_sign_given_as_text_is_found_among_numbers(tmp_path, decimal, sign, other):
    path = tmp_path / "n.csv"
    path.write_text(f"t;h\n0;1\n1;-99{decimal}5\n2;{other}\n")
    column = ColumnSource("h", "level", "m", missing=(sign, "****", "4"))
    source = logger(path, [column], decimal=decimal, delimiter=";")
    np.testing.assert_array_equal(read_record(source)["level"], [1, np.nan, np.nan])


@pytest.mark.parametrize("one", ["-99", -99.0, -99])
def test_one_sign_is_no_list_of_signs(one):
    with pytest.raises(InputError, match=r"missing: '-99.*' is one sign"):
        ColumnSource("h", "level", missing=one)


def test_serial_dates_of_a_spreadsheet(tmp_path):
    path = tmp_path / "e.csv"
    start = dt.datetime(1999, 9, 23, 13, 0, tzinfo=dt.UTC)
    days = (start - dt.datetime(1899, 12, 30, tzinfo=dt.UTC)) / dt.timedelta(days=1)
    path.write_text("t,h [m]\n" + "\n".join(f"{days + i / 86400.0:.9f},{i}" for i in range(40)))
    record = read_record(logger(path, [ColumnSource("h", "level")], TimeSource(columns=("t",), unit="excel")))
    assert record.dated
    np.testing.assert_allclose(record.time, start.timestamp() + np.arange(40), atol=1e-4)


@pytest.mark.parametrize(("rate", "resolution"), [(12.8, 1e-3), (30.0, 1e-2), (5.0, 86400e-6)])
def test_rounded_stamps_are_no_holes(rate, resolution):
    from moyai.records.reading.quality import find_gaps
    from moyai.records.reading.record import nominal_step
    from moyai.records.survey.blocks import _even

    exact = np.arange(6000) / rate
    stamps = np.round(exact / resolution) * resolution
    assert nominal_step(stamps) == pytest.approx(1.0 / rate, rel=1e-3)
    assert find_gaps(stamps, nominal_step(stamps), 1.5) == ((), 0)
    step, columns = _even(stamps, exact)
    assert step == pytest.approx(1.0 / rate, abs=resolution / 5999)  # both ends are rounded
    np.testing.assert_array_equal(columns[:, 0], exact)
    cut = np.delete(np.arange(6000), np.arange(3000, 3007))
    _, columns = _even(stamps[cut], exact[cut])
    assert columns.shape[0] == 6000 and np.flatnonzero(np.isnan(columns[:, 0])).tolist() == list(range(3000, 3007))


def test_short_gaps_are_filled_by_the_rule():
    """Samples lost from a sea at 2 Hz: what is put back errs by what is stated; long gaps and poor channels stay."""
    from moyai.records.reading.short_gaps import fill_short_gaps

    random = np.random.default_rng(5)
    time = np.arange(9600) * 0.5
    frequency = np.linspace(0.05, 0.5, 400)
    density = frequency**-5 * np.exp(-1.25 * (7.0 * frequency) ** -4)
    phase = 2.0 * np.pi * (frequency[:, None] * time + random.random((400, 1)))
    wave = (np.sqrt(2.0 * density)[:, None] * np.cos(phase)).sum(axis=0)[:, None] + 5.0
    holes = wave.copy()
    lost = random.choice(np.arange(13, 9580, 2), 96, replace=False)
    holes[lost] = np.nan
    filled = fill_short_gaps(holes)
    assert filled.share == pytest.approx(0.01) and np.isfinite(filled.values).all()
    np.testing.assert_array_equal(np.delete(filled.values, lost, axis=0), np.delete(wave, lost, axis=0))
    error = np.sqrt(np.mean((filled.values - wave) ** 2)) / np.std(wave)
    assert 0.0 < error <= filled.effect
    assert abs(np.std(filled.values) / np.std(wave) - 1.0) <= filled.effect < 0.02
    holes[5000:5012] = np.nan
    assert np.isnan(fill_short_gaps(holes).values[5000:5012]).all()
    assert np.isfinite(fill_short_gaps(holes).values[:4990]).all()
    holes[random.choice(9600, 500)] = np.nan
    assert fill_short_gaps(holes).share == 0.0
    # noise says nothing of its neighbours, and stays as it is
    noise = random.standard_normal((9600, 1))
    noise[lost] = np.nan
    assert fill_short_gaps(noise).share == 0.0
