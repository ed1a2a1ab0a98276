"""Which letters of a text are words of a language, and which are symbols, units, names and keys."""

from __future__ import annotations

import re
from collections import Counter

_TOKEN = re.compile(r"[^\s\[\](){}（）「」、。；：,;:=<>≤≥×·・|\"“”]+")
_WORD = re.compile(r"(?<![A-Za-z])[A-Za-zÀ-ɏ]+(?:['-][A-Za-z]+)*(?![A-Za-z])")
UNITS = frozenset(
    "kN MN GN mN tf kgf kPa MPa GPa Pa deg rad mm cm km kg Hz mHz min kJ MJ Nm kW MW bar knots dB ppm px rpm".split()
)
"""Units that look like words."""
NAMES = frozenset(
    """moyai Tabata Goda Morison Froude Reynolds Keulegan Carpenter Bretschneider Mitsuyasu Pierson Moskowitz Rayleigh
    Stokes Cauchy Haskind Cummins Newman Maruo Wheeler Airy Dean Loland Løland Takagi Nakamura Sawaragi Arai Matsubara
    Weibull Gumbel Palmgren Miner Ochi Hubble Longuet-Higgins Kaimal Davenport Kirkpatrick Fenton Kristiansen Faltinsen
    Chakrabarti Sarpkaya Isaacson Borgman Ito Ursell Macagno Wiegel Salter Richardson Newmark Student Fourier Hilbert
    Chebyshev Gauss Legendre Euler Bernoulli Coulomb Archimedes Strouhal Milne Blevins Hoerner DNV ISO JIS OrcaFlex
    MoorDyn MoorPy WAMIT NEMOH Capytaine BEMIO ParaView Excel Word Typst Plotly Python YAML PyPI NumPy xarray
    JavaScript JONSWAP Ochi-Hubble Pierson-Moskowitz Bretschneider-Mitsuyasu Keulegan-Carpenter Morison's Airy's
    Palmgren-Miner Kato Yoshida Iwata Mizutani Hirayama Kaihatsu Nagasaki Ohtsuka Tanizawa Wake Oppenheim Wilson Le
    Mehaute Méhauté Zhan Klebert Lader Fredheim Berstad Huang Tang Kitamura Rudi Aarsnes Haritos He Gui NaN inf pip
    Kouwen Ontario Otsuka Ikeda Ruol ITOPF Linux Windows Darwin numpy scipy numba xarray raschii loland milne aarsnes
    balash neob fl ed omega lambda rho beta theta sigma pi PV int dx dt Legendre Magnus Weibull Intel aarch
    netCDF NetCDF github Fredriksson Chen Gudmestad DeCew Tsukrov Swift Celikkol Endresen Enerhaug Moe Sintef
    Hs Tp Tz Ts Re Fr Kc Cd Cm Ct Cr Ca Cl Sn Ur Fn St Ma Ka Uw Ux Uz Mx My Mz Fx Fy Fz GM KG KB BM GZ HWL LWL MWL CSV
    SVG PNG PDF HTML DOCX XLSX DXF VTK JSON SI EA EI sin cos tan exp log ln sqrt min max std rms Hz""".split()
)
"""Names of people, programs, formats and symbols that stay in Latin letters."""
_JAPANESE = re.compile("[\u3040-\u30ff\u4e00-\u9fff]")
_SHORT = frozenset("of in at by to on or is as it no up an if be do so us we he me my am go".split())
"""Words of two letters that are no symbols."""
_CODE = re.compile(r"[_/\\]|\w\.\w|^--?\w|^\.|\d|\w\(\)|[A-Z]{2,}|^[A-Za-z]\w?$|^[a-z]+[A-Z]|@")


def latin_words(text: str) -> list[str]:
    """Return the words of a text in Latin letters that are neither symbols nor units, names, keys or file names.

    Parameters
    ----------
    text : str
    """
    if _JAPANESE.search(text):  # a plain colon stands in code alone: `dynamic: false`
        text = re.sub(r"\b[A-Za-z_]+: [A-Za-z_]+", " ", text)
    found = []
    quoted = re.sub(r"\[eq:[^\]]*\]|'[^'\s]+'|'\w+: \w+'|`[^`]*`", " ", text)  # keys and values of files, as typed
    for token in _TOKEN.findall(quoted):
        plain = token.strip("'.!?")
        if token.isascii() and plain.lower() not in _SHORT and _CODE.search(plain):
            continue
        for word in _WORD.findall(token):
            if len(word) > 1 and word not in UNITS and word not in NAMES and not word.isupper():
                found.append(word)
    return found


def numbers(text: str) -> Counter[str]:
    """Return the numbers of a text, digit by digit as they stand there, with how often each stands there."""
    return Counter(re.findall(r"\d+(?:[.,]\d+)*", text))
