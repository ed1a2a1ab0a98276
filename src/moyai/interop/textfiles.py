"""Reading the number tables that Fortran programs write, with file and line in every complaint."""

from __future__ import annotations

import re
from collections.abc import Iterable
from pathlib import Path

from moyai.core.errors import InputError

# Fortran writes 1.0D+00, and drops the letter where the exponent has three digits: 1.0-100
_BARE_EXPONENT = re.compile(r"^([+-]?\d*\.\d+)([+-]\d{3})$")


def parse_number(token: str) -> float | None:
    """Return the value of a Fortran number, or ``None`` when the token is none."""
    text = token.strip().rstrip(",").replace("D", "E").replace("d", "e")
    try:
        return float(text)
    except ValueError:
        match = _BARE_EXPONENT.match(text)
        return float(f"{match[1]}E{match[2]}") if match else None


def leading_numbers(line: str) -> list[float]:
    """Return the numbers at the start of a line, up to the first word (a comment)."""
    numbers: list[float] = []
    for token in line.replace(",", " ").split():
        value = parse_number(token)
        if value is None:
            break
        numbers.append(value)
    return numbers


def read_lines(path: Path) -> list[str]:
    """Return the lines of a text file, whatever its line ends: UTF-8, UTF-16, or Latin-1 where it is neither.

    Raises
    ------
    InputError
        When the file is absent or empty.
    """
    if not path.is_file():
        raise InputError(f"no such file: {path}", path="coefficients")
    text = _decoded(path.read_bytes(), path.name)
    if not text.strip():
        raise InputError(f"{path.name} is empty", path="coefficients")
    return text.splitlines()


def _decoded(raw: bytes, name: str) -> str:
    for mark, encoding in ((b"\xff\xfe", "utf-16"), (b"\xfe\xff", "utf-16")):
        if raw.startswith(mark):
            return raw.decode(encoding, errors="replace")
    if b"\x00" in raw[:4096]:
        # plain text in UTF-16 without its mark has a zero in every second place
        for place, encoding in ((1, "utf-16-le"), (0, "utf-16-be")):
            if len(raw) % 2 == 0 and raw[place:200:2].count(0) > 0.9 * len(raw[place:200:2]):
                return raw.decode(encoding, errors="replace")
        raise InputError(f"{name} holds bytes of zero: it is no text file", path="file")
    try:
        return raw.decode("utf-8-sig")
    except UnicodeDecodeError:
        return raw.decode("latin-1")


def read_table(path: Path, widths: Iterable[int]) -> list[list[float]]:
    """Return the rows of a number table; one heading line that is not numbers may stand on top.

    Parameters
    ----------
    path : Path
        File.
    widths : iterable of int
        Allowed numbers in a row.

    Raises
    ------
    InputError
        A row that is not numbers or has another width, with its line number.
    """
    allowed = tuple(widths)
    rows: list[list[float]] = []
    for number, line in enumerate(read_lines(path), start=1):
        tokens = line.split()
        if not tokens:
            continue
        values = [parse_number(token) for token in tokens]
        row = [value for value in values if value is not None]
        if len(row) != len(tokens) or len(row) not in allowed:
            if number == 1:
                continue
            raise InputError(
                f"{path.name}:{number}: {len(tokens)} columns, {len(row)} of them numbers",
                path="coefficients",
                allowed=f"{' or '.join(map(str, allowed))} numbers in a row",
            )
        rows.append(row)
    if not rows:
        raise InputError(f"{path.name} holds no rows of {' or '.join(map(str, allowed))} numbers", path="coefficients")
    return rows


def find_companion(path: Path, suffix: str) -> Path | None:
    """Return the file next to ``path`` with the same stem and ``suffix``, in any case of letters."""
    wanted = (path.stem + suffix).lower()
    for candidate in sorted(path.parent.iterdir()):
        if candidate.name.lower() == wanted and candidate.is_file():
            return candidate
    return None
