"""Names of sections, columns and options in MoorDyn input files: versions 1 and 2, and what has no meaning here."""

from __future__ import annotations

#: Titles of sections, in capitals, and what they are here.
SECTIONS = {
    "LINE TYPES": "line types",
    "LINE DICTIONARY": "line types",
    "POINTS": "points",
    "POINT PROPERTIES": "points",
    "POINT LIST": "points",
    "CONNECTIONS": "points",
    "CONNECTION PROPERTIES": "points",
    "NODES": "points",
    "NODE PROPERTIES": "points",
    "LINES": "lines",
    "LINE PROPERTIES": "lines",
    "LINE LIST": "lines",
    "ROD TYPES": "rod types",
    "ROD DICTIONARY": "rod types",
    "RODS": "rods",
    "ROD LIST": "rods",
    "ROD PROPERTIES": "rods",
    "BODIES": "bodies",
    "BODY LIST": "bodies",
    "BODY PROPERTIES": "bodies",
    "OPTIONS": "options",
    "SOLVER OPTIONS": "options",
    "FAILURE": "failure",
    "FAILURES": "failure",
    "LINE FAILURE": "failure",
    "SYROPE IC": "syrope ic",
    "OUTPUTS": "outputs",
    "OUTPUT": "outputs",
}

#: Sections whose rows this reader refuses, and why.
REFUSED_SECTIONS = {
    "CONTROL": "lines of controlled length are not read",
    "EXTERNAL LOADS": "external loads are not read",
    "USER METADATA": "",
}

#: Columns by their names in lower case.
LINE_TYPE_COLUMNS = {
    "typename": "name", "linetype": "name", "name": "name",
    "diam": "diameter", "diameter": "diameter", "d": "diameter",
    "mass/m": "mass_per_length", "massden": "mass_per_length", "massdeninair": "mass_per_length",
    "ea": "stiffness",
    "ba/-zeta": "damping", "ba": "damping", "cintdamp": "damping",
    "ei": "bending_stiffness",
    "cd": "drag_normal", "cdn": "drag_normal", "cdtr": "drag_normal",
    "ca": "added_mass_normal", "can": "added_mass_normal",
    "cdax": "drag_axial", "cdt": "drag_axial",
    "caax": "added_mass_axial", "cat": "added_mass_axial",
    "tbd": "unused", "cl": "lift", "df": "lift_range", "cf": "lift_frequency",
}  # fmt: skip
POINT_COLUMNS = {
    "id": "number", "node": "number", "point": "number", "connection": "number",
    "type": "kind", "attachment": "kind",
    "x": "x", "y": "y", "z": "z",
    "mass": "mass", "m": "mass",
    "volume": "volume", "v": "volume", "vol": "volume",
    "cda": "drag_area", "ca": "added_mass_coefficient",
    "fx": "force x", "fy": "force y", "fz": "force z",
}  # fmt: skip
LINE_COLUMNS = {
    "id": "number", "line": "number",
    "linetype": "line_type",
    "attacha": "start", "nodea": "start", "nodeanch": "start", "enda": "start", "attachanch": "start",
    "attachb": "end", "nodeb": "end", "nodefair": "end", "endb": "end", "attachfair": "end",
    "unstrlen": "length", "unstretchedlength": "length",
    "numsegs": "segments", "nseg": "segments", "segments": "segments",
    "outputs": "outputs", "lineoutputs": "outputs", "flags/outputs": "outputs",
}  # fmt: skip

SYROPE_COLUMNS = {
    "line(s)": "lines", "lines": "lines", "line": "lines",
    "tmax0": "highest", "tmax": "highest", "tmean0": "mean", "tmean": "mean",
}  # fmt: skip
FAILURE_COLUMNS = {
    "failureid": "number", "id": "number",
    "point": "point", "node": "point", "attachment": "point",
    "line(s)": "lines", "lines": "lines", "line": "lines",
    "failtime": "time", "time": "time",
    "failten": "tension", "tension": "tension",
}  # fmt: skip

#: Columns in the order in which MoorDyn v2 takes them, whatever their headings say.
LINE_TYPE_ORDER = (
    "name", "diameter", "mass_per_length", "stiffness", "damping", "bending_stiffness", "drag_normal",
    "added_mass_normal", "drag_axial", "added_mass_axial",
)  # fmt: skip

#: Orders in which versions 2 and 1 take the columns of each section, whatever their headings say.
LAYOUTS: dict[str, tuple[tuple[str, ...], ...]] = {
    "line types": (
        (*LINE_TYPE_ORDER, "lift", "lift_range", "lift_frequency"),
        ("name", "diameter", "mass_per_length", "stiffness", "damping", "added_mass_normal", "added_mass_axial",
         "drag_normal", "drag_axial"),
    ),
    "points": (
        ("number", "kind", "x", "y", "z", "mass", "volume", "drag_area", "added_mass_coefficient"),
        ("number", "kind", "x", "y", "z", "mass", "volume", "force x", "force y", "force z", "drag_area",
         "added_mass_coefficient"),
    ),
    "lines": (
        ("number", "line_type", "start", "end", "length", "segments", "outputs"),
        ("number", "line_type", "length", "segments", "start", "end", "outputs"),
    ),
    "rod types": (
        ("name", "diameter", "mass_per_length", "drag_normal", "added_mass_normal", "drag_end", "added_mass_end"),
    ),
    "bodies": (
        ("number", "kind", "x", "y", "z", "roll", "pitch", "yaw", "mass", "centre", "inertia", "volume", "drag_area",
         "added_mass"),
    ),
    "failure": (("number", "point", "lines", "time", "tension"),),
    "rods": (
        ("number", "rod_type", "kind", "xa", "ya", "za", "xb", "yb", "zb", "segments", "outputs"),
    ),
}  # fmt: skip

#: Columns that hold words, or numbers parted by |.
WORDS = frozenset(
    ("name", "kind", "line_type", "rod_type", "stiffness", "damping", "outputs", "start", "end", "centre", "inertia",
     "drag_area", "added_mass", "point", "lines")
)  # fmt: skip

#: Columns that a section may go without (version 1 had no bending stiffness, OUTPUTS flags may be left out).
MAY_MISS = {
    "line types": {"unused", "bending_stiffness", "lift", "lift_range", "lift_frequency"},
    "points": {"force x", "force y", "force z"},
    "lines": {"outputs"},
    "rods": {"outputs"},
}

POINT_KINDS = {
    "fixed": "fixed", "fix": "fixed", "anchor": "fixed", "anch": "fixed",
    "vessel": "coupled", "ves": "coupled", "coupled": "coupled", "cpld": "coupled",
    "free": "free", "connect": "free", "connection": "free", "con": "free", "point": "free", "pnt": "free",
}  # fmt: skip

#: Options that a run here uses, by their names in lower case.
OPTIONS_USED = {
    "wtrdpth": "WtrDpth", "depth": "WtrDpth", "wtrdepth": "WtrDpth", "waterdepth": "WtrDpth",
    "wtrdnsty": "WtrDnsty", "rho": "WtrDnsty", "rhow": "WtrDnsty", "waterdensity": "WtrDnsty",
    "g": "g", "gravity": "g",
    "kbot": "kBot", "kb": "kBot",
    "cbot": "cBot", "cb": "cBot",
    "frictioncoefficient": "FrictionCoefficient", "mu_kt": "FrictionCoefficient",
    "mu_ka": "FrictionCoefficient",
    "seafloorfile": "SeafloorFile", "bathymetryfile": "SeafloorFile", "bathyfile": "SeafloorFile",
    "wavekin": "WaveKin",
    "dtwave": "dtWave",
    "currents": "Currents", "currentmod": "Currents",
    "waterkin": "WaterKin",
}  # fmt: skip

#: Options that steer MoorDyn's own step, start or files: kept in the deck, without meaning here.
OPTIONS_WITHOUT_MEANING = {
    "dtm": "dtM", "cfl": "cfl", "tscheme": "tScheme", "dtout": "dtOut", "writelog": "writeLog", "echo": "Echo",
    "dtic": "dtIC", "tmaxic": "TmaxIC", "cdscaleic": "CdScaleIC", "icdfac": "CdScaleIC", "threshic": "threshIC",
    "icgendynamic": "ICgenDynamic", "fileic": "fileIC", "disableoutput": "disableOutput",
    "disableouttime": "disableOutTime", "writeunits": "WriteUnits", "fricdamp": "FricDamp",
    "statdynfricscale": "StatDynFricScale", "mc": "StatDynFricScale", "cv": "FricDamp", "outswitch": "outSwitch",
    "icthresh": "threshIC", "unifycurrentgrid": "unifyCurrentGrid", "inertialf": "inertialF",
    "inertialf_rampt": "inertialF_rampT", "dtscheme": "tScheme", "tmax": "TmaxIC",
}  # fmt: skip

#: Values of WaveKin and what is read.
WAVES_READ = {
    0.0: "still water", 1.0: "waves given to the run", 2.0: "wave_frequencies.txt on even frequencies",
    3.0: "wave_elevation.txt", 7.0: "wave_frequencies.txt, wave by wave",
}  # fmt: skip

#: Values of WaveKin and Currents that are refused, in words.
WAVE_KINEMATICS = {
    4.0: "Fourier sums at the nodes, which MoorDyn has not either",
    5.0: "kinematics at the nodes, which MoorDyn has not either",
    6.0: "kinematics on a grid, which MoorDyn has not either",
}
CURRENT_KINDS = {
    3.0: "a steady current at the nodes, which MoorDyn has not either",
    4.0: "a changing current at the nodes, which MoorDyn has not either",
}
