"""Make synthetic streak pictures of a section in waves with a known circulation, and the file that measures them.

    python make_pictures.py pictures            three runs of a circle, one picture of all pulses each, four times
    python make_pictures.py pictures --section square --timing frames
    moyai measure streaks pictures/streaks.yaml -o out

Everything is fixed by the seed; the circulation that was planted is in pictures/truth.txt.
"""

import argparse
from pathlib import Path

import imageio.v3 as imageio
import numpy as np
from synthetic_pictures import Optics, synthesise

from moyai.records.streaks.camera_calibration import RayCamera, Refraction
from moyai.records.streaks.flow import OrbitalFlow, circle_map, rectangle_map
from moyai.records.streaks.timing import regular_pulses

BREADTH = 0.045
PERIOD = 1.0 / 0.95
INTERVAL = PERIOD / 9.6
PULSES = 12
POWERS = (1.0, 0.65, 0.4)
REFRACTION = Refraction(0.8, 0.012, 1.52, 0.4, 1.333)
SHAPE = (1200, 1600)
CENTRE = np.array([799.5, 599.5])
CAMERA = RayCamera(np.array([0.002, -0.003]), np.array([0.012, -0.018, 0.006]), 7600.0, CENTRE, REFRACTION)
SECTIONS = {
    "circle": (circle_map(BREADTH), "{kind: circle, diameter: 45 mm}"),
    "square": (rectangle_map(BREADTH, BREADTH), "{kind: rectangle, breadth: 45 mm, height: 45 mm}"),
    "rectangle": (rectangle_map(BREADTH, 0.024), "{kind: rectangle, breadth: 45 mm, height: 24 mm}"),
}
# Twice the wave number of waves of 0.95 Hz in deep water
DECAY = 2.0 * (2.0 * np.pi / PERIOD) ** 2 / 9.81
SETTLING = 0.4e-3


def flow_of(section, keulegan_carpenter, circulation):
    """Return the waves of one KC with their mass transport, and beads that sink a little."""
    speed = keulegan_carpenter * BREADTH / PERIOD
    transport = 0.5 * DECAY * speed**2 * PERIOD / (2.0 * np.pi)
    return OrbitalFlow(section, PERIOD, speed, speed, circulation, transport, DECAY, SETTLING)


def write_pictures(folder, name, flow, frames, density, seed):
    """Write the pictures of one recording."""
    train = regular_pulses(INTERVAL, 0.45 * INTERVAL, 1.0 if frames else POWERS, PULSES)
    optics = Optics(density=density)
    exposure = synthesise(flow, CAMERA, SHAPE, train, optics=optics, seed=seed, frames=frames, phase=0.7 * seed)
    for number, picture in enumerate(exposure.pictures):
        imageio.imwrite(folder / (f"{name}_{number:02d}.png" if frames else f"{name}.png"), picture)


def write_targets(folder, seed):
    """Write a grid of targets as they are found in a picture, with 0.1 pixels of error."""
    x, z = np.meshgrid(np.arange(-0.12, 0.091, 0.03), np.arange(-0.06, 0.091, 0.03))
    world = np.column_stack([x.ravel(), z.ravel()])
    pixels = CAMERA.to_pixels(world) + np.random.default_rng(seed).normal(0.0, 0.1, world.shape)
    rows = [f"{c:.3f}, {r:.3f}, {1e3 * a:.3f}, {1e3 * b:.3f}" for (c, r), (a, b) in zip(pixels, world)]
    (folder / "targets.csv").write_text("column, row, x [mm], z [mm]\n" + "\n".join(rows) + "\n", encoding="utf-8")


def case_text(section, timing, numbers, frames):
    """Return the file that ``moyai measure streaks`` reads."""
    pattern = "" if frames else f"  power: [{', '.join(f'{power:g}' for power in POWERS)}]\n  count: {PULSES}\n"
    ends = "_*" if frames else ""
    recordings = "".join(
        f"""\
  - name: KC {kc:g}
    period: {PERIOD:.6f} s
    keulegan_carpenter: {kc:g}
    recordings:
"""
        + "".join(f"      - pictures: [kc{kc:g}_{take}{ends}.png]\n" for take in takes)
        + "    no_model:\n"
        + f"      - pictures: [calm{kc:g}{ends}.png]\n"
        for kc, takes in numbers
    )
    return f"""\
moyai: 1
measure: streaks
title: Synthetic pictures of a {section} in waves
section: {SECTIONS[section][1]}
centre: {{x: 0 mm, z: 0 mm}}
calibration:
  targets: targets.csv
timing:
  kind: {timing}
  interval: {1e3 * INTERVAL:.5f} ms
  on_time: {450.0 * INTERVAL:.5f} ms
{pattern}\
circulation:
  size_ratios: [1.25, 1.5, 1.75, 2, 2.25, 2.5]
runs:
{recordings}"""


def main():
    """Make everything."""
    options = argparse.ArgumentParser(description=__doc__)
    options.add_argument("folder", type=Path)
    options.add_argument("--section", choices=tuple(SECTIONS), default="circle")
    options.add_argument("--timing", choices=("exposure", "frames"), default="exposure")
    options.add_argument("--kc", type=float, nargs="+", default=[1.0, 1.5, 2.0])
    options.add_argument("--circulation", type=float, default=18.0, help="cm2/s at KC = 1; grows like KC^2")
    options.add_argument("--takes", type=int, default=0, help="recordings of each run")
    options.add_argument("--seed", type=int, default=1)
    chosen = options.parse_args()
    frames = chosen.timing == "frames"
    takes = chosen.takes or (1 if frames else 4)
    density = 6000.0 if frames else 2200.0
    section = SECTIONS[chosen.section][0]
    chosen.folder.mkdir(parents=True, exist_ok=True)
    truth = ["KC, circulation [cm2/s]"]
    for kc in chosen.kc:
        planted = 1e-4 * chosen.circulation * kc**2
        truth.append(f"{kc:g}, {1e4 * planted:g}")
        for take in range(takes):
            seed = 1000 * chosen.seed + round(100 * kc) + take
            write_pictures(chosen.folder, f"kc{kc:g}_{take}", flow_of(section, kc, planted), frames, density, seed)
        # Mass transport grows with the wave: each has its own run without model
        calm = flow_of(None, kc, 0.0)
        write_pictures(chosen.folder, f"calm{kc:g}", calm, frames, density, 1000 * chosen.seed + round(100 * kc) + 50)
    write_targets(chosen.folder, chosen.seed)
    text = case_text(chosen.section, chosen.timing, [(kc, range(takes)) for kc in chosen.kc], frames)
    (chosen.folder / "streaks.yaml").write_text(text, encoding="utf-8")
    (chosen.folder / "truth.txt").write_text("\n".join(truth) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
