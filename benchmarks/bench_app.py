"""Latency of ``moyai app``: from a moved slider to the figures drawn again, in headless Chromium.

    python benchmarks/bench_app.py [--moves 20] [--only member]

Prints JSON lines: median and 95th percentile in milliseconds over single moves until the first draft of what is on the
screen is drawn, each after the whole answer to the one before; the first one of each structure (which fills caches) is
left out. On a machine that does other things the numbers are theirs too; the processor time of the server and of the
main thread of the page over the same span (``server_ms``, ``page_ms``, where the system tells it) are not.
"""

from __future__ import annotations

import argparse
import importlib.util
import json
import math
import re
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import Any

from moyai.case.templates import template

_FREQUENCY = "statics, mooring, frequency"
CASES = {
    "member": ("member", "", "structure.section.diameter", ""),
    "rigid cage statics": ("rigid_cage", "statics", "structure.net.twine_diameter", ""),
    "cage statics": ("cage", "statics", "current.speed", ""),
    "breakwater statics": ("breakwater", "statics", "structure.length", ""),
    "breakwater frequency, gyradius": ("breakwater", _FREQUENCY, "structure.roll_gyradius", "seas"),
    "breakwater frequency, chains": ("breakwater", _FREQUENCY, "lines[0].segments[0].diameter", "seas"),
    "breakwater frequency, wave height": ("breakwater", _FREQUENCY, "waves[0].height", "seas"),
    "breakwater frequency, section": ("breakwater", _FREQUENCY, "structure.section.beam", "seas"),
    "network statics": ("network", "statics", "current.speed", ""),
    "curtain statics": ("curtain", "statics", "current.speed", ""),
    "curtain impact": ("curtain", "statics, impact", "structure.span", "impact"),
    "units frequency, gyradius": ("units", "statics, frequency", "structure.roll_gyradius", ""),
}
"""Template, analyses (its own where empty), the number that moves, the section on the screen (the top where empty)."""
IDLE = "document.querySelector('.state') && !document.querySelector('.state.working')"
WHOLE = f"{IDLE} && document.querySelector('.report').dataset.whole"
MOVE = """((path, share) => {
  const label = [...document.querySelectorAll('.slider label')].find((one) => one.title === path);
  const range = document.getElementById(label.getAttribute('for'));
  const low = Number(range.min), high = Number(range.max);
  delete document.querySelector('.report').dataset.latency;
  range.value = low + (high - low) * share;
  for (const name of ['input', 'change']) range.dispatchEvent(new Event(name, { bubbles: true }));
})"""

DRAWN_AFTER = """((move) => new Promise((drawn) => {
  const report = document.querySelector('.report');
  new MutationObserver((_, one) => { if (report.dataset.latency) { one.disconnect(); drawn(true); } })
    .observe(report, { attributes: true, attributeFilter: ['data-latency'] });
  move();
}))"""


def driver() -> Any:
    """Return the module that drives Chromium, which stands with the tests of the reports."""
    path = Path(__file__).parents[1] / "tests" / "unit" / "report" / "chromium_pipe.py"
    spec = importlib.util.spec_from_file_location("chromium_pipe", path)
    assert spec is not None and spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def until(page: Any, expression: str, seconds: float = 180.0) -> None:
    """Wait for an expression of the page to hold."""
    end = time.monotonic() + seconds
    while page.evaluate(f"Boolean({expression})") is not True:
        if time.monotonic() > end:
            raise TimeoutError(f"{expression}: {page.errors}")
        time.sleep(0.02)


def text_of(name: str, analyses: str, path: str, section: str = "") -> str:
    """Return the template of a structure with these analyses and a slider of this number."""
    text = template(name)
    if analyses:
        text = re.sub(r"^analyses:.*$", f"analyses: [{analyses}]", text, flags=re.MULTILINE)
    return f"{text.rstrip()}\napp: {{sliders: ['{path}']}}\n"


def processor_ms(process: int, threads: str = "*") -> float:
    """Return the processor time of a process [ms]; NaN where the system does not tell it."""
    stats = list(Path(f"/proc/{process}/task").glob(f"{threads}/schedstat"))
    return sum(int(one.read_text().split()[0]) for one in stats) / 1e6 if stats else math.nan


def below(process: int) -> list[int]:
    """Return the processes that a process has started, and those that they have."""
    lists = Path(f"/proc/{process}/task").glob("*/children")
    found = [int(child) for one in lists for child in one.read_text().split()]
    return [*found, *(inner for child in found for inner in below(child))]


def times_of(app: int, browser: int) -> tuple[float, float]:
    """Return the processor time of the server and of the main threads of the pages until now [ms]."""
    pages = [one for one in below(browser) if "--type=renderer" in Path(f"/proc/{one}/cmdline").read_text()]
    return sum(map(processor_ms, [app, *below(app)])), sum(processor_ms(one, str(one)) for one in pages)


def measured(page: Any, file: str, path: str, section: str, moves: int, app: int) -> list[tuple[float, float, float]]:
    """Return latency and processor times of every move [ms], the first left out."""
    page.evaluate("location.hash = '#/'")
    card = f"[...document.querySelectorAll('.card')].find((one) => one.textContent.endsWith({file!r}))"
    until(page, card)
    page.evaluate(f"{card}.click()")
    until(page, f"{IDLE} && document.querySelector('.report').dataset.sequence && document.querySelector('.slider')")
    until(page, WHOLE)
    if section:
        page.evaluate(f"document.getElementById({section!r}).scrollIntoView({{ behavior: 'instant' }})")
    found = []
    for number in range(moves + 1):
        before = times_of(app, page.process_id)
        # without asking again and again, which would be work of the page
        page.evaluate(f"{DRAWN_AFTER}(() => {MOVE}({path!r}, {0.4 + 0.2 * ((number * 7) % 11) / 11.0}))")
        after = times_of(app, page.process_id)
        latency = float(page.evaluate("document.querySelector('.report').dataset.latency"))
        found.append((latency, after[0] - before[0], after[1] - before[1]))
        until(page, WHOLE)
    return found[1:]


def main() -> None:
    """Measure every structure."""
    options = argparse.ArgumentParser(description=__doc__)
    options.add_argument("--moves", type=int, default=20)
    options.add_argument("--only", default="")
    given = options.parse_args()
    chosen = {name: case for name, case in CASES.items() if given.only in name}
    with tempfile.TemporaryDirectory() as held:
        for name, case in chosen.items():
            Path(held, f"{name.replace(' ', '_').replace(',', '')}.yaml").write_text(text_of(*case), encoding="utf-8")
        command = [sys.executable, "-m", "moyai", "app", held, "--no-browser"]
        process = subprocess.Popen(command, stdout=subprocess.PIPE, text=True)
        try:
            assert process.stdout is not None
            found = re.search(r"http://127\.0\.0\.1:\d+/\?token=\S+", process.stdout.readline())
            assert found is not None
            module = driver()
            with module.Chromium(module.find_chromium(), 1400, 900) as page:
                page.send("Page.navigate", url=found[0])
                for name, (_, _, path, section) in chosen.items():
                    file = f"{name.replace(' ', '_').replace(',', '')}.yaml"
                    rows = measured(page, file, path, section, given.moves, process.pid)
                    times, server, main = (sorted(column) for column in zip(*rows))
                    record = {"case": name, "moves": len(times), "median_ms": statistics.median(times)}
                    record["p95_ms"] = times[round(0.95 * (len(times) - 1))]
                    record |= {"server_ms": round(statistics.median(server)), "page_ms": round(statistics.median(main))}
                    record["sum_p95_ms"] = round(sorted(row[1] + row[2] for row in rows)[round(0.95 * (len(rows) - 1))])
                    print(json.dumps(record), flush=True)
        finally:
            process.terminate()
            process.wait(20)


if __name__ == "__main__":
    main()
