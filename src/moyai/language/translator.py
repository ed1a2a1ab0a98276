"""Finished English sentences put into another language: found among the templates of a catalogue, numbers untouched.

The source writes its sentences with the numbers in them. A finished text is held against the templates: those whose
fixed parts it has, in their order, are tried, what stands between the parts is translated in turn, and the reading
that leaves the fewest English words is taken. So nothing in the source has to be marked, and a number can only be
copied.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache

from moyai.language.catalogue import catalogue, literals
from moyai.language.words import latin_words

_LETTERS = re.compile(r"[A-Za-z]+")
_JAPANESE = "[\u3040-\u30ff\u3400-\u9fff]"
_SCRIPTS = re.compile(f"{_JAPANESE}[A-Za-z0-9]|[A-Za-z0-9%°]{_JAPANESE}")
_PARTICLE = re.compile("(?<=[\u3040-\u309f]) (?=\\{)|(?<=\\}) (?=[\u3040-\u309f])")
_QUALIFIED = re.compile(r"(.*\S) \(([^()]+)\)( \[[^][]*\])?")  # a name, where it is taken, its unit
_COUNTED = re.compile(r"(\S.*[A-Za-z)]) (-?\d[\d.]*(?: \S+)?)")  # a name and its value
_PART = re.compile(r"(.*\S) part (\d+)")
_FORCE = re.compile(r"(?<=\} )[kM]?N(?![A-Za-z])")  # behind a place for its number
_COUNTER = re.compile(r"\{(\d)\} ?(?:個|本|件|回|枚|基|台|行|列)(?![所分数目])")
_DIGIT = re.compile(r"\d")
_NUMERALS = frozenset(
    [
        "a",
        "an",
        "one",
        "two",
        "three",
        "four",
        "five",
        "six",
        "seven",
        "eight",
        "nine",
        "ten",
        "no",
        "some",
        "several",
        "many",
        "few",
        "all",
    ]
)
_LONGEST = 12_000  # a text that is longer is no sentence
_NAMELESS = frozenset(("a", "an", "the", "not", "each", "every", "all", "about", "up", "to"))
_GLUED = 160  # characters of a phrase that is taken apart at its prepositions
_SENTENCE = 14  # fixed characters from which a template reads before separators do
_READINGS = 24  # ways that a template fits a text
_ENDS, _GLUE_ENDS = (". ", "; ", ": "), (". ", "; ", ": ", ", ")
_NAME, _PHRASE_NAME = 3, 2  # words that may stay English between translated ones: a name that the user gave


@dataclass(frozen=True)
class _Template:
    source: tuple[str, ...]
    order: tuple[int, ...]
    target: tuple[str, ...]
    target_order: tuple[int, ...]
    words: frozenset[str]
    #: Places between quotation marks: keys and names, which are copied.
    quoted: frozenset[int]
    #: Places for a number, behind which a word of counting stands in the target.
    counted: frozenset[int]

    @property
    def weight(self) -> int:
        """Letters that are fixed: the more, the surer is the reading."""
        return sum(map(len, self.source))

    @property
    def is_separator(self) -> bool:
        """Whether it holds no words: a full stop, a colon, brackets between clauses that stand alone."""
        return not self.words

    @property
    def is_glue(self) -> bool:
        """Whether it holds but one or two words and no colon (of, at rest, largest): it joins phrases."""
        return 0 < len(self.words) <= 2 and not any(":" in part for part in self.source)

    @property
    def most_left(self) -> float:
        """Words that may stay English in its places: a name that the user gave; none behind an article."""
        if self.is_separator:
            return math.inf
        return 0 if self.words <= _NAMELESS else _PHRASE_NAME if self.is_glue else _NAME

    @property
    def rank(self) -> tuple[int, int]:
        """Place in the order of trial: sentences, separators, short sentences, prepositions, adjectives; longest first.

        A short one (is not, in all) would read across a colon what a longer one says of the part behind it.
        """
        if self.is_glue:
            adjective = len(self.order) == 1 and self.source[0] and len(self.words) == 1
            return (4 if adjective else 3, -self.weight)
        if self.is_separator:
            return (1, -self.weight)
        return (0 if self.weight >= _SENTENCE else 2, -self.weight)

    def holds(self, number: int, value: str) -> bool:
        """Whether a part of a text may stand in a place: no end of a sentence or half a bracket in a phrase."""
        if value.count("(") != value.count(")") or value != value.strip():
            return False
        if number in self.quoted:
            return "'" not in value
        if number in self.counted and not (_DIGIT.search(value) or value.split(" ")[0] in _NUMERALS):
            return False
        if self.is_separator:
            return True
        if self.source[0].count(" ") > 1 and self.source[0] in value:
            return False  # several words begin again: a list of such phrases, not one within the other
        first = (
            not self.source[0] and number == self.order[0]
        )  # what stands before a colon is the place of the sentence
        if value.endswith((";", ":")):
            return False
        return not any(mark in value for mark in (_GLUE_ENDS if self.is_glue else _ENDS[: 3 if first else 2]))

    def filled(self, values: dict[int, str]) -> str:
        """Return the target with its places filled; a blank parts the letters of both scripts."""
        found = self.target[0]
        for number, part in zip(self.target_order, self.target[1:], strict=True):
            for piece in (values[number], part):
                joint = found[-1:] + piece[:1]
                found += f" {piece}" if _SCRIPTS.fullmatch(joint) else piece
        return found


class Translator:
    """Puts texts into one language.

    Parameters
    ----------
    messages : dict of str to str
        Templates in English and in the language, with the same places ``{0}``.
    """

    def __init__(self, messages: dict[str, str]) -> None:
        messages = dict(_without_stop(source, target) for source, target in messages.items())
        messages = {**_in_tonnes(messages), **messages}
        self._whole = {source: target for source, target in messages.items() if "{0}" not in source}
        self._by_word: dict[str, list[_Template]] = {}
        self._templates = frozenset(source for source in messages if "{0}" in source)
        templates = [_template(source, target) for source, target in messages.items() if "{0}" in source]
        count: dict[str, int] = {}
        for template in templates:
            for word in template.words:
                count[word] = count.get(word, 0) + 1
        for template in templates:
            rarest = min(template.words, key=lambda word: (count[word], word), default="")
            self._by_word.setdefault(rarest, []).append(template)
        self._stop = messages.get("{0}.", "{0}.").removeprefix("{0}")
        self._known: dict[str, tuple[str, int]] = {}

    def text(self, text: str) -> str:
        """Return a text in the language; what is not known stays English."""
        if len(text) > _LONGEST:
            return text
        lines = text.split("\n")
        return "\n".join(self._line(line) for line in lines) if len(lines) > 1 else self._line(text)

    def left(self, text: str) -> int:
        """Return how many English words of a text no message knows."""
        return sum(self._best(line.strip())[1] for line in text.split("\n"))

    def _line(self, text: str) -> str:
        inner = text.strip()
        if not inner:
            return text
        start = text.index(inner)
        return text[:start] + self._best(inner)[0] + text[start + len(inner) :]

    def _best(self, text: str) -> tuple[str, int]:
        """Return the best reading of a text and how many English words it leaves."""
        if text in self._known:
            return self._known[text]
        if (exact := self._exact(text) or self._name_in_place(text)) is not None:
            found = exact, 0
        elif (known := self._name_with_value(text)) is not None:
            found = known, 0
        elif left := len(latin_words(text)):
            found = self._sentence(text, left) if text.endswith(".") else self._read(text, left)
        else:
            found = text, 0
        self._known[text] = found
        return found

    def _name_in_place(self, text: str) -> str | None:
        """Return a name that is known as a whole, with the known words in brackets behind it."""
        if (match := _QUALIFIED.fullmatch(text)) and (name := self._exact(match[1])):
            where, left = self._best(match[2])
            unit = (match[3] or "").strip()
            return f"{name}（{where}）{unit}" if left == 0 else None
        return None

    def _name_with_value(self, text: str, *, several: bool = True) -> str | None:
        """Return a name (of several words) that is known as a whole with its number: significant height 0.5 m."""
        match = _COUNTED.fullmatch(text)
        if match is None or latin_words(match[2]) or (several and " " not in match[1]):
            return None
        if f"{match[1]} {{0}}" in self._templates:
            return None  # at least 2 is no name
        name = self._exact(match[1])
        return f"{name} {match[2]}" if name else None

    def _is_name(self, value: str) -> bool:
        """Whether a text is a name that is known as a whole, whatever marks stand in it."""
        return value == value.strip() and (self._exact(value) or self._name_in_place(value)) is not None

    def _sentence(self, text: str, left: int) -> tuple[str, int]:
        """Return the best reading of a text that ends with a full stop."""
        read, cost = self._best(text[:-1])
        return (f"{read}{self._stop}", cost) if cost < left else (text, left)

    def _part(self, value: str, alone: bool) -> tuple[str, int]:
        """Return the best reading of what stands in a place; a part that stands alone may be a name with its value."""
        found = self._best(value)
        known = self._name_with_value(value, several=False) if found[1] and alone else None
        return found if known is None else (known, 0)

    def _quoted(self, name: str) -> str:
        """Return a name as it is, what the product puts behind it translated: 'mooring part 2'."""
        match = _PART.fullmatch(name)
        form = next((one for one in self._by_word.get("part", ()) if one.source == ("", " part ", "")), None)
        return name if match is None or form is None else form.filled({0: match[1], 1: match[2]})

    def _exact(self, text: str) -> str | None:
        for form in (text, text[:1].lower() + text[1:], text[:1].upper() + text[1:]):
            if form in self._whole:
                return self._whole[form]
        if text.startswith("the ") and " " in text[4:]:  # a name of several words with its article
            return self._exact(text[4:])
        return None

    def _read(self, text: str, left: int) -> tuple[str, int]:
        best = text, left
        words = {word.lower() for word in _LETTERS.findall(text)}
        found = [t for word in (*words, "") for t in self._by_word.get(word, ()) if t.words <= words]
        for template in sorted(found, key=lambda item: item.rank):
            if template.is_glue and len(text) > _GLUED:
                continue
            for values in template_readings(template.source, template.order, text):
                if not all(template.holds(*item) or self._is_name(item[1]) for item in values.items()):
                    continue
                read = {
                    number: (self._quoted(value), 0)
                    if number in template.quoted
                    else self._part(value, template.is_separator)
                    for number, value in values.items()
                }
                rest = sum(cost for _, cost in read.values())
                if rest >= best[1] or rest > template.most_left:
                    continue
                best = template.filled({number: said for number, (said, _) in read.items()}), rest
                if rest == 0:
                    return best
        return best


def template_readings(parts: tuple[str, ...], order: tuple[int, ...], text: str) -> Iterator[dict[int, str]]:
    """Give every way in which the fixed parts stand in a text, with what stands in the places between them.

    Parameters
    ----------
    parts, order : tuple
        Of a template, as :func:`~moyai.language.catalogue.literals` gives them.
    text : str
        The first letter of the template may be a capital in it or not.
    """
    first, last = parts[0], parts[-1]
    if (
        first
        and text[: len(first)] != first
        and text[:1].lower() + text[1 : len(first)] != first[:1].lower() + first[1:]
    ):
        return
    if last and not text.endswith(last):
        return
    stop = len(text) - len(last)
    count = 0

    def fill(number: int, start: int) -> Iterator[list[str]]:
        if number == len(order) - 1:
            if stop > start:
                yield [text[start:stop]]
            return
        part = parts[number + 1]
        at = text.find(part, start + 1, stop)
        while at >= 0:
            for rest in fill(number + 1, at + len(part)):
                yield [text[start:at], *rest]
            at = text.find(part, at + 1, stop)

    for values in fill(0, len(first)):
        read = dict(zip(order, values, strict=True))
        if all(read[number] == value for number, value in zip(order, values, strict=True)):
            yield read
            count += 1
            if count >= _READINGS:
                return


def _without_stop(source: str, target: str) -> tuple[str, str]:
    """Return a sentence without its full stop, which is a separator of its own."""
    if len(source) > 4 and source.endswith(".") and not source.endswith("..") and target.endswith("。"):
        return source[:-1], target[:-1]
    return source, target


def _in_tonnes(messages: dict[str, str]) -> dict[str, str]:
    """Return the messages that hold a unit of force with tf and kgf in its place, as a page shows it that asks so."""
    found: dict[str, str] = {}
    for source, target in messages.items():
        if _FORCE.search(source):
            for unit in ("tf", "kgf"):
                found[_FORCE.sub(unit, source)] = _FORCE.sub(unit, target)
    return found


def _template(source: str, target: str) -> _Template:
    parts, order = literals(source)
    # a blank next to a particle comes back where what is filled in is Latin
    said, said_order = literals(_PARTICLE.sub("", target))
    words = frozenset(word.lower() for part in parts for word in _LETTERS.findall(part))
    quoted = (n for n, a, b in zip(order, parts, parts[1:], strict=False) if a.endswith("'") and b.startswith("'"))
    counted = frozenset(int(number) for number in _COUNTER.findall(target))
    return _Template(parts, order, said, said_order, words, frozenset(quoted), counted)


@cache
def translator(language: str) -> Translator:
    """Return the translator of a language.

    Parameters
    ----------
    language : str
        One of :data:`~moyai.language.catalogue.LANGUAGES`.
    """
    return Translator(catalogue(language))
