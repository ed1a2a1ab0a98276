"""Processor time of the drafts of ``moyai app``, without browser: a number is changed, the report is drawn.

    python benchmarks/bench_drafts.py [--moves 5] [--only curtain]

Prints JSON lines: milliseconds of processor time until each stage of a draft is drawn, median over single moves; the
first move of each structure, which fills caches, is left out.
"""

from __future__ import annotations

import argparse
import json
import statistics
import tempfile
import time
from pathlib import Path

from bench_app import CASES, text_of

from moyai.app.draft import Drafts
from moyai.app.messages import Wish, message
from moyai.case.sliders import sliders_of
from moyai.case.yaml_reader import parse_yaml
from moyai.cli.runner import run
from moyai.core.progress import silent


def stages(drafts: Drafts, wish: Wish) -> list[tuple[float, float]]:
    """Return the processor time until each drawing [ms] and what is sent of it [kB]."""
    begin, found = time.process_time(), []
    for said in drafts.answer(wish, silent):
        size = len(message(said["message"], **{key: item for key, item in said.items() if key != "message"})) / 1e3
        if said["message"] == "not drawn" or said.get("faults"):
            raise ValueError(said["faults"])
        if said["message"] == "drawn":
            found.append((1e3 * (time.process_time() - begin), size))
    return found


def main() -> None:
    """Measure every structure."""
    options = argparse.ArgumentParser(description=__doc__)
    options.add_argument("--moves", type=int, default=5)
    options.add_argument("--only", default="")
    given = options.parse_args()
    for name, (kind, analyses, path, section) in CASES.items():
        if given.only not in name:
            continue
        text = text_of(kind, analyses, path)
        document = parse_yaml(text)
        slider = next(one for one in sliders_of(document, document.data["structure"]["kind"]) if one["path"] == path)
        with tempfile.TemporaryDirectory() as held:
            drafts, rows = Drafts(run, Path(held, "kept")), []
            for move in range(given.moves + 1):
                share = 0.4 + 0.2 * ((move * 7) % 11) / 11.0
                number = slider["low"] + (slider["high"] - slider["low"]) * share
                edits = {path: f"{number:.{slider['decimals']}f}"}
                wish = Wish(text, Path(held, "case.yaml"), Path(held), edits, shown=(section,) if section else ())
                rows.append(stages(drafts, wish))
        stages_of_moves = list(zip(*rows[1:]))
        drawn, sent = ([round(statistics.median(one[n] for one in stage)) for stage in stages_of_moves] for n in (0, 1))
        print(json.dumps({"case": name, "moves": given.moves, "drawn_ms": drawn, "sent_kB": sent}), flush=True)


if __name__ == "__main__":
    main()
