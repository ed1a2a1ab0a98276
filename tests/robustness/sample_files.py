"""One small sound file of every kind that is read, and the reader that a command uses for it.

The files are written here, from random numbers with a fixed seed; nothing is stored.
"""

from __future__ import annotations

import importlib.util
import sys
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

UNIT = Path(__file__).parents[1] / "unit"


def _module(path: Path) -> Any:
    """Return a test module that has writers of files."""
    name = f"writers_of_{path.stem}"
    if name not in sys.modules:
        spec = importlib.util.spec_from_file_location(name, path)
        assert spec is not None and spec.loader is not None
        sys.modules[name] = importlib.util.module_from_spec(spec)
        spec.loader.exec_module(sys.modules[name])
    return sys.modules[name]


@dataclass(frozen=True)
class Kind:
    """A kind of file: ``write(folder)`` returns the files that are damaged, ``read(folder)`` reads them."""

    write: Callable[[Path], list[Path]]
    read: Callable[[Path], Any]


def _columns() -> dict[str, np.ndarray]:
    rng = np.random.default_rng(1)
    return {"t": np.arange(400) * 0.1, "level": rng.normal(size=400), "force": rng.normal(size=400) * 1e3}


def _logger(name: str, **options: Any) -> Callable[[Path], Any]:
    def read(folder: Path) -> Any:
        from moyai.records.reading.reader import read_record
        from moyai.records.reading.sources import ColumnSource, LoggerSource, TimeSource

        columns = (ColumnSource("level", "level", "m"), ColumnSource("force", "force", "N"))
        time = TimeSource(("t",), order="drop")
        return read_record(LoggerSource("logger", (folder / name,), columns, time, **options))

    return read


def _mat5(compressed: bool) -> Callable[[Path], list[Path]]:
    def write(folder: Path) -> list[Path]:
        from scipy.io import savemat

        savemat(folder / "a.mat", _columns(), do_compression=compressed)
        return [folder / "a.mat"]

    return write


def _mat73(folder: Path) -> list[Path]:
    import h5py

    file = folder / "a.mat"
    with h5py.File(file, "w", userblock_size=512) as stored:
        for name, values in _columns().items():
            stored.create_dataset(name, data=values[None, :], compression="gzip", fletcher32=True)
    raw = bytearray(file.read_bytes())
    raw[:128] = b"MATLAB 7.3 MAT-file".ljust(124) + b"\x00\x02IM"
    file.write_bytes(bytes(raw))
    return [file]


def _netcdf(engine: str, form: str | None = None) -> Callable[[Path], list[Path]]:
    def write(folder: Path) -> list[Path]:
        import xarray as xr

        columns = _columns()
        data = xr.Dataset({name: ("t", columns[name]) for name in ("level", "force")}, coords={"t": columns["t"]})
        encoding = {"level": {"zlib": True, "fletcher32": True}} if engine == "h5netcdf" else None
        data.to_netcdf(folder / "a.nc", engine=engine, format=form, encoding=encoding)
        return [folder / "a.nc"]

    return write


def _parquet(folder: Path) -> list[Path]:
    import pyarrow as pa
    import pyarrow.parquet as parquet

    parquet.write_table(pa.table(_columns()), folder / "a.parquet")
    return [folder / "a.parquet"]


def _csv(folder: Path) -> list[Path]:
    columns = _columns()
    rows = [",".join(f"{value:.4f}" for value in row) for row in zip(*columns.values())]
    (folder / "a.csv").write_text("t,level,force\n" + "\n".join(rows) + "\n")
    return [folder / "a.csv"]


def _flume(folder: Path) -> list[Path]:
    columns = _columns()
    rows = [",".join(f"{value:.4f}" for value in row) for row in zip(*columns.values())]
    (folder / "a.csv").write_text("Time [s],level [m],force [N]\n" + "\n".join(rows) + "\n")
    return [folder / "a.csv"]


def _read_flume(folder: Path) -> Any:
    from moyai.records.survey.flume import read_flume_record

    return read_flume_record(folder / "a.csv")


def _text(name: str, text: str) -> Callable[[Path], list[Path]]:
    def write(folder: Path) -> list[Path]:
        (folder / name).write_text(text)
        return [folder / name]

    return write


def _read_archive(name: str) -> Callable[[Path], Any]:
    def read(folder: Path) -> Any:
        from moyai.sea.spectrum_archives import read_archive

        return read_archive(folder / name)

    return read


def _swan() -> str:
    lines = [
        "SWAN   1",
        "$ written by hand",
        "TIME",
        "  1",
        "LOCATIONS",
        "  2",
        "  0.0 0.0",
        "  100.0 0.0",
        "AFREQ",
        "  4",
    ]
    lines += ["  0.1", "  0.15", "  0.2", "  0.3", "NDIR", "  3", "  0.0", "  120.0", "  240.0", "QUANT", "  1"]
    lines += ["VaDens", "m2/Hz/degr", "-99.0", "20200101.120000"]
    for _ in range(2):
        lines += ["FACTOR", "  0.01"] + [f"  {n} {2 * n} {n + 1}" for n in range(1, 5)]
    return "\n".join(lines) + "\n"


def _ww3_text() -> str:
    lines = ["'WAVEWATCH III SPECTRA' 3 4 1 'grid'", " 0.1 0.2 0.3", " 0.0 1.5708 3.14159 4.71239"]
    for hour in (0, 3):
        lines += [f"20200101 {hour:02d}0000", "'point' 34.0 135.0 20.0 0.0 0.0 0.0 0.0"]
        lines += [" " + " ".join(f"{0.1 * (n + row + 1):.3f}" for n in range(4)) for row in range(3)]
    return "\n".join(lines) + "\n"


def _ndbc() -> str:
    head = "#YY  MM DD hh mm   .0200  .0325  .0375  .0500"
    rows = [f"2020 01 01 {hour:02d} 00   0.00   {hour + 1}.20   2.50   1.00" for hour in range(4)]
    return "\n".join([head, *rows]) + "\n"


def _ndbc_recent() -> str:
    head = "#YY  MM DD hh mm Sep_Freq  < spec_1 (freq_1) spec_2 (freq_2) spec_3 (freq_3) ... >"
    rows = [f"2020 01 01 {hour:02d} 00 0.153 0.00 (0.033) {hour}.50 (0.038) 1.20 (0.043) " for hour in range(4)]
    return "\n".join([head, *rows]) + "\n"


def _ww3_netcdf(folder: Path) -> list[Path]:
    import xarray as xr

    rng = np.random.default_rng(2)
    data = xr.Dataset(
        {"efth": (("time", "station", "frequency", "direction"), rng.uniform(0.1, 1.0, (2, 1, 5, 8)))},
        coords={
            "time": np.array(["2020-01-01", "2020-01-02"], dtype="datetime64[ns]"),
            "frequency": np.linspace(0.05, 0.3, 5),
            "direction": np.arange(8) * 45.0,
        },
    )
    data.to_netcdf(folder / "a.nc", engine="h5netcdf")
    return [folder / "a.nc"]


def _wavespectra_netcdf(folder: Path) -> list[Path]:
    import xarray as xr

    _ww3_netcdf(folder)
    with xr.open_dataset(folder / "a.nc", engine="h5netcdf") as data:
        own = data.load().rename(station="site", frequency="freq", direction="dir")
    own.to_netcdf(folder / "a.nc", engine="h5netcdf")
    return [folder / "a.nc"]


def _spectrum(folder: Path) -> Any:
    from moyai.sea.spectra import from_file

    return from_file(folder / "a.csv")


def _other_program(program: str) -> Callable[[Path], list[Path]]:
    def write(folder: Path) -> list[Path]:
        writers = _module(UNIT / "interop" / "test_other_programs_files.py")
        body = writers.random_body(5)
        if program == "nemoh":
            writers.write_nemoh(folder, body, depth=10.0, tec=True)
        elif program == "capytaine":
            writers.capytaine_file(folder / "a.nc", body, engine="h5netcdf")
        elif program == "capytaine3":
            writers.capytaine_file(folder / "a.nc", body, engine="scipy")
        elif program == "aqwa":
            writers.write_aqwa(folder / "a.ah1", body)
        elif program == "bemio":
            writers.write_bemio(folder / "a.h5", body)
        else:
            writer = _module(UNIT / "interop" / "test_wamit_files.py").Body(3)
            writer.write(folder, 2.0 * np.pi / writer.omega)
        return sorted(path for path in folder.rglob("*") if path.is_file())

    return write


def _read_program(program: str, name: str, **options: Any) -> Callable[[Path], Any]:
    def read(folder: Path) -> Any:
        from moyai.interop.read import read_coefficients

        return read_coefficients(program, folder / name, options)

    return read


def _result(folder: Path) -> list[Path]:
    import xarray as xr

    from moyai.core.results import Result
    from moyai.core.validity import IdentityCheck, Notice

    tree = xr.DataTree.from_dict(
        {
            "/": xr.Dataset(),
            "/motion": xr.Dataset({"sway": ("time", np.arange(300.0), {"units": "m", "long_name": "sway"})}),
        }
    )
    result = Result(
        tree, checks=(IdentityCheck("energy", 0.1, 0.2, "words"),), notices=(Notice("a", "words", 1.0, 2.0),)
    )
    return [result.write(folder / "results.nc")]


def _read_result(folder: Path) -> Any:
    from moyai.core.results import read_result

    return read_result(folder / "results.nc")


def _measured(folder: Path) -> Any:
    from moyai.case.measured import read_pairs, read_points

    read_points(folder / "a.csv", {}, "measured")
    return read_pairs(folder / "a.csv", "measured")


def _scatter(folder: Path) -> Any:
    from moyai.study.scatter import read_scatter

    return read_scatter(folder / "a.csv", counts=True)


def _rows(folder: Path) -> Any:
    from moyai.study.rows_of_files import read_rows

    return read_rows(folder / "a.csv")


def _deck(folder: Path) -> Any:
    from moyai.interop.moordyn_reader import read_deck

    return read_deck(folder / "a.dat")


def _deck_with_files(folder: Path) -> list[Path]:
    """Write a deck of the Fortran version with its file of water, a record of waves, depths and a worn rope."""
    files = {
        "a.dat": DECK.replace("ˆ", "^").replace("384.243E6  -0.8 ", "SYROPE:law.dat|1.5e8|23 5e10|1e5 ").replace(
            "100     WtrDpth depth", '"depths.txt" WtrDpth depth\n"water.dat" WaterKin'
        ),
        "water.dat": "water\n--- WAVES ---\n1 WaveKinMod\n\"eta.txt\" WaveKinFile\n0.5 dtWave\n30 WaveDir\n"
        "--- CURRENT ---\n1 CurrentMod\nz-depth x y\n(m) (m/s) (m/s)\n0 0.9 0\n20 0.5 0\n---\n",
        "eta.txt": "".join(f"{0.5 * n:.1f} {0.1 * (n % 7):.2f}\n" for n in range(40)),
        "depths.txt": "depths\nnGridX 2\nnGridY 2\n -500 500\n-500 100 100\n500 100 100\n",
        "law.dat": "owc.dat OWC\nQUADRATIC WCType\n0.25 k1\n1.0 k2\n",
        "owc.dat": "Strain Tension\n(-) (N)\n0 0\n0.01 4e5\n0.03 1.2e6\n0.06 3e6\n",
    }  # fmt: skip
    for name, text in files.items():
        (folder / name).write_text(text, encoding="utf-8")
    return [folder / name for name in files]


def _case_of_deck(folder: Path) -> Any:
    from moyai.interop.moordyn_case import case_text

    return case_text(_deck(folder), duration=1.0, folder=folder)


def _output(folder: Path) -> Any:
    from moyai.interop.moordyn_output import read_output

    return read_output(folder / "a.out")


DECK = """--- header
a line
---------------------- LINE TYPES ----------------------
TypeName   Diam    Mass/m     EA         BA/-zeta    EI     Cd   Ca   CdAx CaAx
(name)     (m)     (kg/m)     (N)        (N-s/-)     (N-m2) (-)  (-)  (-)  (-)
main       0.09    77.7066    384.243E6  -0.8        0      1.6  1.0  0.1  0.0
---------------------- POINTS ----------------------
ID  Type   X  Y  Z  Mass Volume CdA Ca
(#) (name) (m) (m) (m) (kg) (mˆ3) (m^2) (-)
1   Fixed  400  0  -100  0 0 0 0
2   Coupled  5  0  -10  0 0 0 0
---------------------- LINES ----------------------
ID  LineType AttachA AttachB UnstrLen NumSegs Outputs
(#) (name)   (#) (#) (m) (-) (-)
1   main     1   2   420   20   p
---------------------- OPTIONS ----------------------
0.001   dtM   time step
9.81    g     gravity
1025    rhoW  density
100     WtrDpth depth
---------------------- OUTPUTS ----------------------
FairTen1
END
------------------------- need this line ------------------
"""
OUTPUT = "Time FairTen1\n(s) (N)\n" + "".join(f"{0.1 * n:.2f} {1000 + n}\n" for n in range(40))
POINTS = "# measured\nperiod [s], sway [m]\n" + "".join(f"{n}.5, {0.1 * n:.3f}\n" for n in range(1, 20))
SPECTRUM = "frequency,density\n" + "".join(f"{0.05 * n:.2f},{0.3 * n:.3f}\n" for n in range(1, 20))
SCATTER = "height,5,6,7\n1,10,20,5\n2,3,8,9\n3,0,1,2\n"

KINDS: dict[str, Kind] = {
    "matlab_5": Kind(_mat5(False), _logger("a.mat")),
    "matlab_5_compressed": Kind(_mat5(True), _logger("a.mat")),
    "matlab_7_3": Kind(_mat73, _logger("a.mat")),
    "netcdf_3": Kind(_netcdf("scipy"), _logger("a.nc")),
    "netcdf_4": Kind(_netcdf("h5netcdf"), _logger("a.nc")),
    "parquet": Kind(_parquet, _logger("a.parquet")),
    "csv": Kind(_csv, _logger("a.csv")),
    "flume": Kind(_flume, _read_flume),
    "swan": Kind(_text("a.spec", _swan()), _read_archive("a.spec")),
    "ww3_text": Kind(_text("a.spec", _ww3_text()), _read_archive("a.spec")),
    "ww3_netcdf": Kind(_ww3_netcdf, _read_archive("a.nc")),
    "wavespectra_netcdf": Kind(_wavespectra_netcdf, _read_archive("a.nc")),
    "ndbc": Kind(_text("a.txt", _ndbc()), _read_archive("a.txt")),
    "ndbc_recent": Kind(_text("a.data_spec", _ndbc_recent()), _read_archive("a.data_spec")),
    "spectrum": Kind(_text("a.csv", SPECTRUM), _spectrum),
    "measured_points": Kind(_text("a.csv", POINTS), _measured),
    "scatter": Kind(_text("a.csv", SCATTER), _scatter),
    "study_rows": Kind(_text("a.csv", SPECTRUM), _rows),
    "nemoh": Kind(_other_program("nemoh"), _read_program("nemoh", ".")),
    "capytaine": Kind(_other_program("capytaine"), _read_program("capytaine", "a.nc", reference_point=(0, 0, 0))),
    "capytaine_3": Kind(_other_program("capytaine3"), _read_program("capytaine", "a.nc", reference_point=(0, 0, 0))),
    "aqwa": Kind(_other_program("aqwa"), _read_program("aqwa", "a.ah1")),
    "bemio": Kind(_other_program("bemio"), _read_program("bemio", "a.h5", reference_point=(0.0, 0.0, 0.0))),
    "wamit": Kind(
        _other_program("wamit"),
        _read_program(
            "wamit", "body.1", density=1000.0, gravity=9.81, length_scale=1.0, water_depth=17.0,
            reference_point=(0.0, 0.0, 0.0),
        ),
    ),
    "deck": Kind(_text("a.dat", DECK.replace("ˆ", "^")), _deck),
    "deck_with_files": Kind(_deck_with_files, _case_of_deck),
    "deck_output": Kind(_text("a.out", OUTPUT), _output),
    "result": Kind(_result, _read_result),
}  # fmt: skip
