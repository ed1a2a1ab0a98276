"""Case texts that the tests vary."""

from pathlib import Path

from moyai.case.reader import case_of
from moyai.case.yaml_reader import parse_yaml
from moyai.core.errors import CaseError

CASE = """\
moyai: 1
title: Test pontoon
site:
  water_depth: 10 m
  water_levels: {HWL: 1.5 m, LWL: 0 m}
  density: 1025 kg/m3
  gravity: 9.81 m/s2
waves:
  - name: operation
    kind: regular
    height: 0.6 m
    periods: [4, 5, 6]
    heading_deg: 0
  - name: storm
    kind: jonswap
    significant_height: 1.0 m
    peak_period: 5 s
    peak_enhancement: 3.3
    heading_deg: 10
wind: {speed: 25 m/s, heading_deg: 0, density: 1.225 kg/m3}
current: {speed: 0.3 m/s, heading_deg: 0}
structure:
  kind: breakwater
  length: 21 m
  section: {shape: rectangle, beam: 10 m, height: 4.5 m}
  draught: 3 m
  centre_of_gravity_above_keel: 2.29 m
  roll_gyradius: 2.67 m
  damping: {fraction_of_critical: 0.15, modes: [sway, heave, roll]}
  wind_drag_coefficient: 1.2
  current_drag_coefficient: 1.5
lines:
  - name: seaward
    count: 2
    fairlead: {x: -5 m, above_keel: 0 m}
    anchor: {x: -57.5 m}
    segments:
      - {catalogue: studless_chain_R3, diameter: 68 mm, length: 54.0 m}
  - name: shoreward
    count: 2
    fairlead: {x: 5 m, above_keel: 0 m}
    anchor: {x: 57.5 m}
    segments:
      - {catalogue: studless_chain_R3, diameter: 68 mm, length: 54.0 m}
analyses: [statics, mooring, frequency, time]
"""


def changed(*changes: tuple[str, str], text: str = CASE) -> str:
    """Return the case with the first occurrence of each text replaced."""
    for old, new in changes:
        assert old in text, old
        text = text.replace(old, new, 1)
    return text


def read(text: str, folder: Path = Path(".")):
    """Return the case of a text."""
    return case_of(parse_yaml(text, "case.yaml"), folder / "case.yaml")


def faults(text: str, folder: Path = Path(".")) -> list[str]:
    """Return the faults of a text, empty when it is sound."""
    try:
        read(text, folder)
    except CaseError as error:
        return [str(fault) for fault in error.faults]
    return []


def place(text: str, needle: str) -> str:
    """Return ``line:column`` of the first occurrence of ``needle``."""
    start = text.index(needle)
    line = text.count("\n", 0, start) + 1
    return f"{line}:{start - text.rfind(chr(10), 0, start)}"
