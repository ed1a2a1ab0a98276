"""Nets: values of the laws by other means, the paper's statements, coefficients planted in records."""

from __future__ import annotations

import math
from functools import partial

import numpy as np

from moyai.core.validation import ValidationCase
from moyai.morison.net_fouling import foul
from moyai.morison.net_law_names import Net, net_law
from moyai.morison.net_laws.kristiansen_faltinsen import cylinder_drag
from moyai.morison.net_laws.matsubara import Matsubara
from moyai.morison.net_wake import wake_factor
from moyai.tables.nets import matsubara_net, matsubara_nets

_PAPER = "Matsubara, Noda and Nishihira, dynamic response of an offshore fish cage"
_FORMULA = "the published formula, evaluated apart from this code"
_NU = 1.14e-6


def _ahead(name: str, solidity: float, reynolds: float = 500.0) -> float:
    """Drag of a panel perpendicular to the flow; the Reynolds number is that of the law."""
    net, law = Net.from_solidity(1e-3, solidity), net_law(name)
    speed = reynolds * _NU / 1e-3
    speed *= reynolds / float(law.reynolds(speed, net, _NU))
    return float(law.coefficients(0.0, speed, net, _NU)[0])


def _screen_on_twines(solidity: float, reynolds: float) -> float:
    """Screen model on the shaded area at Re = U d / nu."""
    net = Net.from_solidity(1e-3, solidity)
    drag, _ = net_law("kristiansen_faltinsen").coefficients(0.0, reynolds * _NU / 1e-3, net, _NU)
    return float(drag) / solidity


def _patursson(name: str) -> float:
    """Panel of 2.8 mm twine, 29 mm bars, solidity 0.20, in 0.5 m/s."""
    net = Net(2.8e-3, 29e-3, solidity_measured=0.20)
    return float(net_law(name).coefficients(0.0, 0.5, net, _NU)[0])


def _planted(quiet: bool) -> float:
    """C_D from noisy waves at rest, mean of four records, or C_M from quiet waves met under way."""
    from moyai.records.nets.runs import Specimen, Tank
    from moyai.records.nets.synthesis import Rig, wave_run
    from moyai.records.nets.vibration import Vibration
    from moyai.records.nets.waves import fit_waves, wave_coefficients

    rng = np.random.default_rng(5)
    tank = Tank(1000.0, _NU, 9.81, 0.45, -0.2)
    net = Specimen("A", Net.from_aperture(1.4e-3, 11.3e-3, solidity_listed=0.22), 0.066, 0.01507)
    rig = Rig(vibration_force=0.0, white_noise=0.0, slow_noise=0.0) if quiet else Rig()
    speed = 0.35 if quiet else 0.0
    found = []
    for _ in range(1 if quiet else 4):
        # waves of 1 s on a carriage that shakes at 3 Hz: the third harmonic lies in the band
        fits = [
            fit_waves(
                wave_run(rig, tank, item, 1.4, 2.0, name="w", height=0.08, period=1.0, rng=rng, speed=speed,
                         meter=not quiet),
                tank, net.projected_area, net.volume, Vibration(3.0, 2.4, 3.8),
                confidence=0.95, phase_error=0.0, bootstrap=50, seed=1,
            )
            for item in (net, None)
        ]  # fmt: skip
        coefficients, _ = wave_coefficients(fits[0], fits[1], net, tank, 0.95, 0.0)
        found.append(coefficients.inertia if quiet else coefficients.drag)
    return float(np.mean(found))


def _third_harmonic() -> float:
    """Third over first harmonic of u|u|, the part that a low-pass between them deletes."""
    angle = 2.0 * math.pi * np.arange(4000) / 4000
    force = np.cos(angle) * np.abs(np.cos(angle))
    return float(abs(np.mean(force * np.exp(3j * angle))) / abs(np.mean(force * np.exp(1j * angle))))


CASES: tuple[ValidationCase, ...] = (
    *(
        ValidationCase(
            f"nets: C_D of Aarsnes at solidity {s:g}", _FORMULA, partial(_ahead, "aarsnes", s), value, 2.5e-4
        )
        for s, value in ((0.15, 0.1683), (0.2, 0.2600), (0.25, 0.3866), (0.3, 0.5583))
    ),
    *(
        ValidationCase(f"nets: C_D of Loland at solidity {s:g}", _FORMULA, partial(_ahead, "loland", s), value, 2.5e-4)
        for s, value in ((0.15, 0.1802), (0.2, 0.2886), (0.25, 0.4150), (0.3, 0.5558))
    ),
    *(
        ValidationCase(
            f"nets: C_D of the screen model at solidity 0.25, Re {re:g}",
            _FORMULA,
            partial(_ahead, "kristiansen_faltinsen", 0.25, re),
            value,
            2.5e-4,
        )
        for re, value in ((100.0, 0.5292), (1000.0, 0.3909), (1e4, 0.4245))
    ),
    *(
        ValidationCase(
            f"nets: screen model on the shaded area, solidity {s:g}, Re {re:g}",
            _FORMULA,
            partial(_screen_on_twines, s, re),
            value,
            6e-3,
            note="three printed digits",
        )
        for s, re, value in (
            (0.22, 100.0, 1.96),
            (0.323, 100.0, 2.43),
            (0.5, 100.0, 3.91),
            (0.22, 1000.0, 1.42),
            (0.323, 1000.0, 1.75),
            (0.5, 1000.0, 2.84),
        )
    ),
    *(
        ValidationCase(
            f"nets: panel of Patursson by {name}",
            "C_D = 0.258 that is set for the panel of 1 m2, solidity 0.20, in studies of it",
            partial(_patursson, name),
            0.258,
            tolerance,
            note="spread of the laws, not an error of the code",
        )
        for name, tolerance in (("aarsnes", 0.02), ("kristiansen_faltinsen", 0.08), ("loland", 0.13))
    ),
    ValidationCase(
        "nets: drag of a cylinder at Re 100",
        "Wieselsberger's measurements, as in textbooks",
        lambda: float(cylinder_drag(100.0)),
        1.40,
        0.06,
        note="reading of a curve",
    ),
    ValidationCase(
        "nets: drag of a cylinder at Re 1000",
        "Wieselsberger's measurements, as in textbooks",
        lambda: float(cylinder_drag(1000.0)),
        1.0,
        0.06,
        note="reading of a curve",
    ),
    ValidationCase(
        "nets: C_D of the wire nets at Re 84", _PAPER, lambda: float(Matsubara().twine_drag(84.0)), 2.0, 3e-3
    ),
    ValidationCase(
        "nets: C_D of the wire nets at Re 1000", _FORMULA, lambda: float(Matsubara().twine_drag(1000.0)), 0.82, 3e-3
    ),
    ValidationCase(
        "nets: rows of the ten nets that do not follow their columns",
        _PAPER + ", table 1; D and J",
        lambda: float(sum(bool(row.check()) for row in matsubara_nets())),
        2.0,
        0.0,
        relative=False,
    ),
    ValidationCase(
        "nets: shaded share of net J",
        "1 - (l / (d + l))^2 by hand",
        lambda: matsubara_net("J").solidity_geometric,
        0.569,
        1e-3,
    ),
    ValidationCase(
        "nets: Balash at 60 degrees over that at 0",
        "cube of the cosine",
        lambda: float(np.divide(*net_law("balash").coefficients([math.pi / 3.0, 0.0], 0.5, Net(2e-3, 2e-2), _NU)[0])),
        0.125,
        1e-12,
    ),
    ValidationCase(
        "nets: shelter by Loland at solidity 0.25",
        "1 - 0.46 x 0.4150",
        lambda: float(
            wake_factor("loland", net_law("loland"), Net.from_solidity(1e-3, 0.25), speed=1.0, viscosity=_NU)
        ),
        0.8091,
        1e-4,
    ),
    ValidationCase(
        "nets: solidity of twines grown by half",
        "2 x 0.15 - 0.15^2",
        lambda: foul(Net(2e-3, 2e-2), 1.5, 1100.0).net.solidity,
        0.2775,
        1e-12,
    ),
    ValidationCase(
        "nets: third over first harmonic of u|u|", "Fourier series of cos|cos|: 1/5", _third_harmonic, 0.2, 1e-5
    ),
    ValidationCase(
        "nets: C_D out of waves of 1 s with a carriage that shakes at 3 Hz",
        "planted, 1.4",
        partial(_planted, False),
        1.4,
        0.05,
        note="four records with noise; the third harmonic is in the stop band",
    ),
    ValidationCase(
        "nets: C_M of a net towed against waves, by a gauge on the carriage",
        "planted, 2",
        partial(_planted, True),
        2.0,
        1e-4,
        note="no noise; the period met is found from the record",
    ),
)
