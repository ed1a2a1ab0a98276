"""Runs and jobs for the tests of the app: functions of a module, since processes import them by name."""

from __future__ import annotations

import re
import time
from pathlib import Path
from typing import Any

from moyai.case.schema import json_schema
from moyai.cli.runner import run
from moyai.core.progress import Progress, silent

MEMBER = """\
# a pile, quick to compute
moyai: 1
title: Quick member   # its name

site: {water_depth: 20 m, density: 1025 kg/m3, gravity: 9.81 m/s2}

waves: {name: regular, kind: regular, height: 1 m, period: 6 s, heading_deg: 0}

structure:
  kind: member
  section: {shape: circle, diameter: 100 cm}   # outer
  start: {y: -10 m, z: -5 m}
  end: {y: 10 m, z: -5 m}
  inertia: 2.0
  drag: 1.0
  kinematic_viscosity: 1.19e-6 m2/s
  circulation: {purpose: extreme}

analyses: [forces]
"""


def run_slowly(case: Any, progress: Progress = silent, *, keep: Path | None = None, problem: Any = None) -> Any:
    """Take ten seconds for a case whose title says so; it can be stopped at any time."""
    if "slow" in case.title:
        for step in range(200):
            progress("waiting", step, 200)
            time.sleep(0.05)
    return run(case, progress, keep=keep, problem=problem)


def deaf_work(pipe: Any, stop: Any, order: Any, run: Any) -> None:
    """Report progress and never look at the flag."""
    for step in range(600):
        pipe.send(("progress", "steps", step / 600.0, "1 min"))
        time.sleep(0.05)


def quick_work(pipe: Any, stop: Any, order: Any, run: Any) -> None:
    """Wait for the flag when the order is called ``wait``; else be done at once."""
    pipe.send(("progress", "steps", 0.5, "1 s"))
    if order.name == "wait":
        stop.wait(30.0)
        pipe.send(("done", "interrupted", "", ""))
    else:
        pipe.send(("done", "converged", "all identities hold", "holds"))


def words_of_files() -> set[str]:
    """Return keys, choices and defaults of case files, as they are written, and the letters of formulas."""
    found = {"from", "to", "count", "low", "middle", "high", "speed", "values", "lid", "check", "app"}
    found |= {"gamma", "zeta", "alpha", "added", "mass", "stiffness"}

    def collect(node: Any) -> None:
        for key, value in node.items() if isinstance(node, dict) else ():
            found.update(re.findall(r"[a-z]+", key) if key != "description" else ())
            texts = value if key in ("enum", "examples") else [value] if key in ("const", "default") else []
            found.update(
                word
                for text in texts
                if isinstance(text, str | bool)
                for word in re.findall(r"[a-z]+", str(text).lower())
            )
            collect(value)
        for value in node if isinstance(node, list) else ():
            collect(value)

    collect(json_schema())
    return found
