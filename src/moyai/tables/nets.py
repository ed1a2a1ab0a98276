"""Tables of nets: ten wire nets as a paper lists them, materials of twine, growth (``data/*.csv`` hold the numbers)."""

from __future__ import annotations

import difflib
import math
from dataclasses import dataclass

from moyai.core.errors import InputError
from moyai.core.options import checks_words
from moyai.core.validity import Notice
from moyai.tables.reader import Record, read_table

_NETS, _MATERIALS, _FOULING = "matsubara_nets.csv", "net_materials.csv", "net_fouling.csv"
_INCH = 0.0254
#: Relative deviations above which a row of the ten nets does not follow the formula of the others
_SOLIDITY_TOLERANCE, _PITCH_TOLERANCE, _AREA_TOLERANCE = 0.035, 0.02, 0.10


@dataclass(frozen=True)
class NetRow:
    """One of the ten nets, as printed, with what its columns say of each other."""

    name: str
    #: Diameter of the twine [m].
    twine_diameter: float
    #: Opening of the mesh [m].
    aperture: float
    #: Of the panel's wires [m2], as printed.
    projected_area: float
    #: As printed [-].
    solidity: float
    meshes_per_inch: float
    #: Column that is printed wrongly; empty where none is.
    flag: str
    #: What that column should be, in SI; NaN where nothing is flagged.
    believed: float
    remark: str

    @property
    def solidity_doubled(self) -> float:
        """Ratio 2 d / (d + l), by which the paper lists solidities [-]."""
        return 2.0 * self.twine_diameter / (self.twine_diameter + self.aperture)

    @property
    def solidity_geometric(self) -> float:
        """Shaded share 1 - (l / (d + l))^2, crossings counted once [-]."""
        return 1.0 - (self.aperture / (self.twine_diameter + self.aperture)) ** 2

    @property
    def panel_area(self) -> float:
        """Outline area that projected area and solidity give [m2]."""
        return self.projected_area / self.solidity

    def deviations(self) -> dict[str, float]:
        """Return how far each column lies from what the others give, relative [-]."""
        return {
            "solidity": self.solidity / self.solidity_doubled - 1.0,
            "pitch": (self.twine_diameter + self.aperture) * self.meshes_per_inch / _INCH - 1.0,
            "projected_area": self.panel_area / _usual_panel_area() - 1.0,
        }

    def check(self) -> tuple[Notice, ...]:
        """Tell which columns do not follow the formula that the other rows follow."""
        limits = {"solidity": _SOLIDITY_TOLERANCE, "pitch": _PITCH_TOLERANCE, "projected_area": _AREA_TOLERANCE}
        return tuple(
            Notice(
                "net-table-misprint",
                f"net {self.name}: its {column.replace('_', ' ')} lies {100.0 * gap:+.0f} % off the other columns",
                gap,
                limits[column],
                "information",
                self.remark,
                "Matsubara, Noda and Nishihira, table 1",
            )
            for column, gap in self.deviations().items()
            if abs(gap) > limits[column]
        )


def _usual_panel_area() -> float:
    """Return the median outline area of the rows [m2]."""
    areas = sorted(row.panel_area for row in matsubara_nets())
    return 0.5 * (areas[len(areas) // 2 - 1] + areas[len(areas) // 2])


def matsubara_nets() -> tuple[NetRow, ...]:
    """Return the ten nets."""
    return tuple(_net_row(record) for record in read_table(_NETS))


def matsubara_net(name: str) -> NetRow:
    """Return one of the ten nets, A to J.

    Raises
    ------
    InputError
        For another name.
    """
    return _net_row(_named(_NETS, name, "net"))


def _net_row(record: Record) -> NetRow:
    scale = {"solidity": 0.01, "projected_area": 1e-4}.get(record["flag"], 1.0)
    return NetRow(
        name=record["name"],
        twine_diameter=float(record["diameter_mm"]) * 1e-3,
        aperture=float(record["aperture_mm"]) * 1e-3,
        projected_area=float(record["projected_area_cm2"]) * 1e-4,
        solidity=float(record["solidity_percent"]) * 1e-2,
        meshes_per_inch=float(record["meshes_per_inch"]),
        flag=record["flag"],
        believed=float(record["believed"]) * scale if record["believed"] else math.nan,
        remark=record["remark"],
    )


@checks_words
@dataclass(frozen=True)
class NetMaterial:
    """A material of twine with the range of its properties."""

    name: str
    material: str
    #: [kg/m3].
    density: float
    #: Low and high modulus, on the nominal section [Pa].
    modulus: tuple[float, float]
    #: Low and high strength, on the nominal section [Pa].
    strength: tuple[float, float]
    confirmed: bool
    source: str


def available_net_materials() -> tuple[str, ...]:
    """Return the names of the materials.

    Returns
    -------
    tuple of str
        Names that :func:`net_material` takes.

    Examples
    --------
    >>> from moyai.tables import available_net_materials
    >>> available_net_materials()[:2]
    ('nylon', 'polyester')
    """
    return tuple(record["name"] for record in read_table(_MATERIALS))


def net_material(name: str) -> NetMaterial:
    """Return a material of twine by its name.

    Parameters
    ----------
    name : str
        One of :func:`available_net_materials`.

    Returns
    -------
    NetMaterial
        Density [kg/m3], ranges of modulus and strength [Pa], source, and whether it is confirmed.

    Raises
    ------
    InputError
        For an unknown name.

    Examples
    --------
    >>> from moyai.tables import available_net_materials, net_material
    >>> material = net_material(available_net_materials()[0])
    >>> material.name, material.density                                  # [kg/m3]
    ('nylon', 1140.0)
    """
    record = _named(_MATERIALS, name, "net material")
    return NetMaterial(
        name=name,
        material=record["material"],
        density=float(record["density"]),
        modulus=(float(record["modulus_low"]), float(record["modulus_high"])),
        strength=(float(record["strength_low"]), float(record["strength_high"])),
        confirmed=record["confirmed"] == "true",
        source=record["source"],
    )


@dataclass(frozen=True)
class FoulingEntry:
    """Growth on a net as a source gives it."""

    name: str
    meaning: str
    #: Fouled over clean twine diameter [-]; NaN where the source does not give it.
    diameter_factor: float
    #: Fouled over clean drag [-]; NaN where the source does not give it.
    drag_factor: float
    #: Of the growth [kg/m3].
    density: float
    confirmed: bool
    source: str


def net_fouling(name: str) -> FoulingEntry:
    """Return an entry of growth by its name.

    Raises
    ------
    InputError
        For an unknown name.
    """
    record = _named(_FOULING, name, "growth")
    return FoulingEntry(
        name=name,
        meaning=record["meaning"],
        diameter_factor=float(record["diameter_factor"] or math.nan),
        drag_factor=float(record["drag_factor"] or math.nan),
        density=float(record["density"]),
        confirmed=record["confirmed"] == "true",
        source=record["source"],
    )


def _named(file: str, name: str, what: str) -> Record:
    names = tuple(record["name"] for record in read_table(file))
    for record in read_table(file):
        if record["name"] == name:
            return record
    near = difflib.get_close_matches(name, names, 1, 0.3)
    raise InputError(
        f"unknown {what} '{name}'",
        parameter="name",
        allowed=", ".join(names),
        remedy=f"did you mean '{near[0]}'?" if near else "",
    )
