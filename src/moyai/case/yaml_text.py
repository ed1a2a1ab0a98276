"""The text of a YAML file: its encoding, odd characters, and syntax faults in plain words."""

from __future__ import annotations

import re
from typing import Any

from moyai.core.errors import CaseError, Fault

# What YAML 1.2 does not print, and the separators that YAML 1.1 took for line ends, which would shift every line number
_ODD = re.compile("[^\t\n\r\x20-\x7e\xa0-\u2027\u202a-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]|\ufeff")

_MARKS = {b"\xef\xbb\xbf": "utf-8", b"\xff\xfe": "utf-16-le", b"\xfe\xff": "utf-16-be"}

_PLAIN: tuple[tuple[str, str, str], ...] = (
    (
        "mapping values are not allowed",
        "a ':' is where no key can begin",
        "check the ':' and the indentation of this line and the one above, or quote a value that contains ': '",
    ),
    ("could not find expected ':'", "this line has no ':' after its key", "write 'key: value'"),
    ("did not find expected ',' or ']'", "the '[' opened in line {context} is not closed", "add ',' or ']'"),
    ("did not find expected ',' or '}'", "the '{{' opened in line {context} is not closed", "add ',' or '}}'"),
    ("expected ',' or ']'", "the '[' opened in line {context} is not closed", "add ',' or ']'"),
    ("expected ',' or '}'", "the '{{' opened in line {context} is not closed", "add ',' or '}}'"),
    (
        "unexpected end of stream",
        "the quotation mark opened in line {context} is not closed",
        "close it, or remove it",
    ),
    (
        "did not find expected '-' indicator",
        "this line does not continue the list that begins in line {context}",
        "begin it with '- ' or correct its indentation",
    ),
    (
        "did not find expected key",
        "this line does not fit the block that begins in line {context}",
        "correct its indentation",
    ),
    (
        "expected <block end>",
        "this line does not fit the block that begins in line {context}",
        "correct its indentation",
    ),
    ("block sequence entries are not allowed", "a list entry '- ' may not begin here", "put it on its own line"),
    ("found undefined alias", "an alias refers to an anchor that is not defined above", ""),
    ("found duplicate anchor", "this anchor name is used twice", ""),
)


def decode(raw: bytes, file: str) -> str:
    """Return the text of a UTF-8 file (or UTF-16 with its mark), with line ends made ``\\n``.

    Raises
    ------
    CaseError
        For any other encoding, with the line of the first byte that does not fit.
    """
    if raw.startswith((b"\xff\xfe", b"\xfe\xff")):
        # What '>' writes in older Windows shells; its mark leaves no doubt
        try:
            return raw.decode("utf-16").replace("\r\n", "\n").replace("\r", "\n")
        except UnicodeDecodeError:
            raise CaseError([Fault("the file is broken UTF-16", file=file, remedy="save it again as UTF-8")]) from None
    if raw.startswith(b"\xef\xbb\xbf"):
        raw = raw[3:]
    try:
        text = raw.decode("utf-8")
    except UnicodeDecodeError as error:
        line = raw.count(b"\n", 0, error.start) + 1
        column = len(raw[raw.rfind(b"\n", 0, error.start) + 1 : error.start].decode("utf-8", "replace")) + 1
        likely = _likely_encoding(raw)
        raise CaseError(
            [
                Fault(
                    "the file is not UTF-8" + (f" (it looks like {likely})" if likely else ""),
                    file=file,
                    line=line,
                    column=column,
                    remedy="save it again as UTF-8",
                )
            ]
        ) from None
    return text.replace("\r\n", "\n").replace("\r", "\n")


def encode_like(text: str, raw: bytes) -> bytes:
    """Return a text with the mark, the encoding and the line ends of a file that :func:`decode` reads."""
    mark = next((mark for mark in _MARKS if raw.startswith(mark)), b"")
    coding = _MARKS.get(mark, "utf-8")
    ends = "\r\n" if "\r\n" in raw.decode(coding, "replace") else "\n"
    return mark + text.replace("\r\n", "\n").replace("\n", ends).encode(coding)


def _likely_encoding(raw: bytes) -> str:
    for codec, name in (("cp932", "Shift-JIS"), ("euc_jp", "EUC-JP")):
        try:
            text = raw.decode(codec)
        except UnicodeDecodeError:
            continue
        # Western accents decode as half-width katakana or rare signs; Japanese text has kana or ideographs
        if re.search("[\u3040-\u30ff\u4e00-\u9fff]", text):
            return name
    return "Windows-1252" if not re.search(rb"[\x81\x8d\x8f\x90\x9d]", raw) else ""


def refuse_odd_characters(text: str, file: str) -> None:
    """Raise a fault at the first character that a YAML file may not hold."""
    found = _ODD.search(text)
    if found is None:
        return
    line = text.count("\n", 0, found.start()) + 1
    column = found.start() - text.rfind("\n", 0, found.start())
    raise CaseError(
        [
            Fault(
                f"the character U+{ord(found[0]):04X} is not allowed in a YAML file",
                file=file,
                line=line,
                column=column,
                remedy="remove it; is this a text file?",
            )
        ]
    )


# A key of a case file at the start of a line or behind a brace or comma
_KEY = r"(?:^[\s\u3000]*(?:-[\s\u3000]+)*|[{,，、][\s\u3000]*)[A-Za-z_][A-Za-z0-9_]*"
_WIDE: tuple[tuple[re.Pattern[str], str, str], ...] = (
    (re.compile(rf"{_KEY}\s*(?P<sign>[：︰﹕])"), "a full-width colon", "write a plain ':' and a space"),
    (re.compile(r"^[ \-]*(?P<sign>\u3000)"), "a full-width space", "indent with plain spaces"),
    (re.compile(rf"{_KEY}:(?P<sign>\u3000)"), "a full-width space", "write a plain space behind ':'"),
)
_WIDE_IN_BRACES = {"，": ",", "、": ",", "：": ":", "｝": "}", "］": "]", "\u3000": " "}


def refuse_wide_signs(text: str, file: str) -> None:
    """Raise the full-width signs of Japanese input that stand where YAML needs plain ones, all at once.

    Titles, names and comments may hold them; what stands in quotes is left alone.
    """
    faults = []
    for number, line in enumerate(text.split("\n"), 1):
        if line.isascii():
            continue
        bare = _without_quotes_and_comment(line)
        places: dict[int, tuple[str, str]] = {}
        for pattern, name, remedy in _WIDE:
            for match in pattern.finditer(bare):
                places[match.start("sign")] = f"{name} '{match['sign']}'", remedy
        for opening, closing in (("{", "}"), ("[", "]")):
            start = bare.find(opening)
            end = bare.rfind(closing) if closing in bare else len(bare)
            for column in range(start, end) if start >= 0 else ():
                plain = _WIDE_IN_BRACES.get(bare[column])
                if plain is not None and re.search(r"[0-9０-９A-Za-z_\]}]\s*$", bare[start:column]):
                    what = f"a full-width sign '{bare[column]}'"
                    places.setdefault(column, (what, f"write '{plain}' in braces and brackets"))
        faults += [
            Fault(f"{what} is used where YAML needs a plain one", "", "", remedy, file, number, column + 1)
            for column, (what, remedy) in sorted(places.items())
        ]
    if faults:
        raise CaseError(faults)


def _without_quotes_and_comment(line: str) -> str:
    """Return a line with what stands in quotes blanked and its comment cut off; columns stay."""
    out, quote = [], ""
    for index, letter in enumerate(line):
        if quote:
            quote = "" if letter == quote else quote
            out.append(" ")
        elif letter in "\"'" and not (index and line[index - 1].isalnum()):
            quote = letter
            out.append(" ")
        elif letter == "#" and (index == 0 or line[index - 1] in " \t\u3000"):
            break
        else:
            out.append(letter)
    return "".join(out)


def syntax_fault(error: Any, text: str, file: str) -> Fault:
    """Return a scanner's or parser's fault in plain words.

    Parameters
    ----------
    error : yaml.MarkedYAMLError
        What PyYAML or libyaml raised.
    text, file : str
        The file, for its lines and its name.
    """
    mark = error.problem_mark or error.context_mark
    line = mark.line + 1 if mark else 1
    column = mark.column + 1 if mark else 1
    context = error.context_mark.line + 1 if error.context_mark else line
    problem = str(error.problem or error)
    lines = text.split("\n")
    written = lines[line - 1] if line <= len(lines) else ""

    def fault(message: str, remedy: str = "") -> Fault:
        return Fault(message, "", "", remedy, file, line, column)

    if "cannot start any token" in problem:
        character = written[column - 1 : column]
        if character == "\t" or "\t" in written[: len(written) - len(written.lstrip())]:
            return fault("a tab cannot indent in YAML", "indent with spaces")
        return fault(f"a value may not begin with '{character}'", "put quotes around it")
    if "tab character" in problem:
        return fault("a tab cannot indent in YAML", "indent with spaces")
    for part, message, remedy in _PLAIN:
        if part in problem:
            return fault(message.format(context=context), remedy.replace("{{", "{").replace("}}", "}"))
    return fault(f"this is not YAML: {problem}")
