"""The compressed block of a page: nothing is lost, in Python and in the browser, and a browser without it says so."""

from __future__ import annotations

import base64
import gzip
import json
import re
from pathlib import Path

import numpy as np
import pytest
from chromium_pipe import Chromium, find_chromium
from small_results import pontoon

from moyai.report.encoding import page_json
from moyai.report.html import render_html, render_parts
from moyai.report.packing import CODES, pack_arrays
from moyai.report.writer import compose_document

KINDS = {"f4": "<f4", "i2": "<i2", "i1": "i1", "u1": "u1"}


def coded(values: np.ndarray, code: str, **more: int) -> dict:
    return {code: base64.b64encode(values.astype(KINDS[code]).tobytes()).decode(), **more}


def arrays_of(data: object) -> list[tuple[str, object]]:
    if isinstance(data, list):
        return [found for item in data for found in arrays_of(item)]
    if not isinstance(data, dict):
        return []
    code = next((key for key in CODES if key in data), None)
    return [(code, data[code])] if code else [found for item in data.values() for found in arrays_of(item)]


def unpacked(block: bytes, entry: list[int], code: str) -> bytes:
    start, length, columns = entry
    width = CODES[code]
    planes = np.frombuffer(block[start : start + length], np.uint8).reshape(width, -1).astype(np.uint64)
    words = sum(planes[byte] << np.uint64(8 * byte) for byte in range(width)).reshape(columns, -1)
    total = np.cumsum(words, axis=1, dtype=np.uint64) % np.uint64(256**width)
    return total.T.astype(f"<u{width}").tobytes()


def test_every_bit_comes_back() -> None:
    random = np.random.default_rng(3)
    data = {
        "figures": {"a": {"arrays": [coded(random.normal(size=731), "f4"), [1.0, None]]}},
        "scenes": {
            "nodes": coded(random.integers(-32768, 32767, 6 * 5 * 9), "i2", columns=3, count=5),
            "pose": coded(random.integers(-128, 127, 44), "i1", columns=4),
            "levels": coded(random.integers(0, 255, 30), "u1", columns=10),
            "nothing": coded(np.zeros(0), "u1", columns=1),
            "special": coded(np.array([np.nan, np.inf, -np.inf, -0.0, 0.0, 1e-45]), "f4"),
        },
        "tables": {"t": "a,b"},
    }
    found, text = pack_arrays(data)
    block = gzip.decompress(base64.b64decode(text))
    before, after = arrays_of(data), arrays_of(found)
    assert [code for code, _ in before] == [code for code, _ in after] and len(before) == 6
    for (code, kept), (_, entry) in zip(before, after, strict=True):
        assert unpacked(block, entry, code) == base64.b64decode(kept)
    assert found["tables"] == data["tables"] and found["figures"]["a"]["arrays"][1] == [1.0, None]
    assert found["scenes"]["nodes"]["columns"] == 3


def test_a_page_without_arrays_has_no_block() -> None:
    data = {"figures": {}, "scenes": {}, "tables": {"t": "a"}}
    assert pack_arrays(data) == (data, "")


@pytest.mark.slow
def test_a_long_record_weighs_half() -> None:
    document = compose_document(pontoon())
    whole, page = page_json(render_parts(document)[1]), render_html(document)
    parts = re.findall(r'id="(report-data|packed-numbers)">(.*?)</script>', page, re.DOTALL)
    assert len(parts) == 2
    assert sum(len(text) for _, text in parts) < 0.6 * len(whole)


@pytest.mark.slow
@pytest.mark.browser
@pytest.mark.skipif(find_chromium() is None, reason="Chromium is not installed (set MOYAI_CHROMIUM to its path)")
def test_the_browser_unpacks_every_bit_or_says_that_it_cannot(tmp_path: Path) -> None:
    document = compose_document(pontoon())
    page, old = tmp_path / "report.html", tmp_path / "old.html"
    text = render_html(document)
    page.write_text(text, encoding="utf-8")
    old.write_text(text.replace("<head>", "<head><script>delete window.DecompressionStream</script>"), encoding="utf-8")
    expected = arrays_of(render_parts(document)[1])
    with Chromium(str(find_chromium()), 1280, 1000) as browser:
        browser.open(page)
        found = json.loads(
            browser.evaluate("""JSON.stringify((function all(data) {
              if (!data || typeof data !== "object") return [];
              const kinds = { f4: Float32Array, i2: Int16Array, i1: Int8Array, u1: Uint8Array };
              const code = Array.isArray(data) ? undefined : Object.keys(kinds).find((key) => key in data);
              if (!code) return Object.values(data).flatMap(all);
              const bytes = new Uint8Array(MOYAI.unpack(data[code], kinds[code]).buffer);
              return [[code, btoa(Array.from(bytes, (byte) => String.fromCharCode(byte)).join(""))]];
            })(MOYAI.data))""")
        )
        assert len(found) > 100
        assert [tuple(entry) for entry in found] == expected
        browser.open(old)
        said = browser.evaluate("[...document.querySelectorAll('.plot, .player')].map((place) => place.textContent)")
        assert len(said) > 12
        assert all("report.xlsx" in words and "DecompressionStream" in words for words in said)
