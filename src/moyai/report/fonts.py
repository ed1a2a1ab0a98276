"""Fonts with Japanese letters for figures, PDF and pages: those of the machine, else that of ``moyai[ja]``.

The extra installs IPAex Gothic (IPA Font License 1.0) as the data of the package ``matplotlib-fontja``; nothing of the
package itself is imported.
"""

from __future__ import annotations

import base64
import io
from functools import cache
from importlib.util import find_spec
from pathlib import Path
from typing import Any

from moyai.core.errors import InputError

JAPANESE = (
    "Noto Sans CJK JP",
    "Noto Sans JP",
    "Yu Gothic",
    "Hiragino Sans",
    "Meiryo",
    "IPAexGothic",
    "IPAGothic",
    "Takao Gothic",
    "TakaoGothic",
    "VL Gothic",
    "MS Gothic",
)
"""Families with Japanese letters that machines bring, the best first."""
_PACKAGE, _FILE = "matplotlib_fontja", Path("fonts", "ipaexg.ttf")


@cache
def packaged_font() -> Path | None:
    """Return the file of IPAex Gothic where the extra ``moyai[ja]`` is installed."""
    found = find_spec(_PACKAGE)
    for folder in (found.submodule_search_locations or ()) if found is not None else ():
        if (Path(folder) / _FILE).is_file():
            return Path(folder) / _FILE
    return None


def font_folders() -> list[str]:
    """Return the folders of fonts that typst searches besides the machine's."""
    file = packaged_font()
    return [] if file is None else [str(file.parent)]


@cache
def matplotlib_families() -> tuple[str, ...]:
    """Return a Latin face and whichever Japanese face there is, so that no title turns into boxes."""
    from matplotlib import font_manager

    present = {font.name for font in font_manager.fontManager.ttflist}
    file = packaged_font()
    if file is not None and not present.intersection(JAPANESE):
        font_manager.fontManager.addfont(file)
        present.add(font_manager.get_font(str(file)).family_name)
    return ("DejaVu Sans", *(name for name in JAPANESE if name in present))


def require_japanese(families: Any, path: str = "--language") -> None:
    """Refuse to write Japanese without a font that has its letters.

    Parameters
    ----------
    families : iterable of str
        Those that are there.
    path : str
        What asked for it.

    Raises
    ------
    InputError
        When none of :data:`JAPANESE` is among them.
    """
    if not set(families).intersection(JAPANESE):
        raise InputError(
            "no font with Japanese letters was found, and a PDF or a figure would show empty boxes",
            path=path,
            remedy='pip install "moyai[ja]" brings one (IPAex Gothic); the page report.html needs none',
        )


def embedded_style(text: str) -> str:
    """Return a rule of CSS with the letters of a text in IPAex Gothic, for browsers without a Japanese font.

    Parameters
    ----------
    text : str
        All that the page may show.

    Returns
    -------
    str
        Empty where the extra ``moyai[ja]`` is not installed: the page then takes what the reader's machine has.
    """
    file = packaged_font()
    if file is None:
        return ""
    from fontTools import subset
    from fontTools.ttLib import TTFont

    options = subset.Options(layout_features=[], hinting=False, notdef_outline=True)
    options.flavor = "woff"
    with TTFont(file, recalcTimestamp=False) as font:
        cut = subset.Subsetter(options)
        cut.populate(text="".join(sorted(letter for letter in set(text) if ord(letter) > 127)))
        cut.subset(font)
        font.flavor = "woff"
        stream = io.BytesIO()
        font.save(stream)
    data = base64.b64encode(stream.getvalue()).decode("ascii")
    return f'@font-face{{font-family:"moyai-ja";src:url(data:font/woff;base64,{data}) format("woff")}}\n'
