"""Damage to files, drawn from a seed, and what a reader makes of it.

``python tests/robustness/mutation.py KIND,... SEED COUNT`` prints the failures of kinds as lines, and each kind as it
is begun and ended; it is run as a process of its own where a reader may take the interpreter down.
"""

from __future__ import annotations

import resource
import signal
import sys
import tempfile
import warnings
from collections.abc import Callable
from pathlib import Path
from random import Random

WORDS = (b"nan", b"-1", b"0", b"1e999", b"1e9", b"999999999999", b"", b"\x00", b"\xff\xfe", b"'", b'"', b"(", b"text")
SECONDS = 20
"""Time that one file may take."""


def _cut(raw: bytes, random: Random) -> bytes:
    return raw[: random.randrange(len(raw) + 1)]


def _flip(raw: bytes, random: Random) -> bytes:
    out = bytearray(raw)
    for _ in range(random.choice((1, 1, 2, 8, 40))):
        out[random.randrange(len(out))] ^= 1 << random.randrange(8)
    return bytes(out)


def _fill(raw: bytes, random: Random) -> bytes:
    first = random.randrange(len(raw))
    last = min(len(raw), first + random.choice((1, 2, 4, 8, 64, 512)))
    return raw[:first] + bytes([random.choice((0, 255, 127, 32))]) * (last - first) + raw[last:]


def _remove(raw: bytes, random: Random) -> bytes:
    first = random.randrange(len(raw))
    return raw[:first] + raw[first + random.choice((1, 4, 16, 100)) :]


def _repeat(raw: bytes, random: Random) -> bytes:
    first = random.randrange(len(raw))
    part = raw[first : first + random.choice((1, 4, 16, 100))]
    return raw[:first] + part * random.choice((2, 3, 50)) + raw[first:]


def _word(raw: bytes, random: Random) -> bytes:
    """Replace a word of a text file, or as many bytes of another."""
    first = random.randrange(len(raw))
    while first > 0 and raw[first - 1 : first] not in (b" ", b",", b"\n"):
        first -= 1
    last = first
    while last < len(raw) and raw[last : last + 1] not in (b" ", b",", b"\n"):
        last += 1
    return raw[:first] + random.choice(WORDS) + raw[last:]


def _long_line(raw: bytes, random: Random) -> bytes:
    first = random.randrange(len(raw))
    return raw[:first] + random.choice((b"1", b"x", b'"', b" ", b",")) * 140_000 + raw[first:]


DAMAGES: tuple[Callable[[bytes, Random], bytes], ...] = (_cut, _flip, _flip, _flip, _fill, _remove, _repeat, _word,
                                                         _word, _long_line)  # fmt: skip


def damaged(raw: bytes, random: Random) -> bytes:
    """Return a damaged copy of a file's content."""
    return random.choice(DAMAGES)(raw, random) if raw else b"x"


def try_damaged(kind: str, seed: int, count: int) -> list[str]:
    """Read ``count`` damaged files of a kind; return a line for every one that ends in other than an error of moyai's.

    Every mutant has a seed of its own, ``seed + n``, so that one line is enough to make it again.
    """
    from sample_files import KINDS

    from moyai.core.errors import MoyaiError

    def late(*_: object) -> None:
        raise TimeoutError(f"more than {SECONDS} s")

    failures: list[str] = []
    before = signal.signal(signal.SIGALRM, late)
    try:
        with tempfile.TemporaryDirectory() as name:
            folder = Path(name)
            sound = {path: path.read_bytes() for path in KINDS[kind].write(folder)}
            KINDS[kind].read(folder)
            for number in range(seed, seed + count):
                random = Random(number)
                victim = random.choice(list(sound))
                victim.write_bytes(damaged(sound[victim], random))
                signal.alarm(SECONDS)
                try:
                    with warnings.catch_warnings():
                        warnings.simplefilter("ignore")
                        KINDS[kind].read(folder)
                except MoyaiError as error:
                    words = str(error)
                    if "more than" in words and "TimeoutError" in words:
                        failures.append(f"{kind} seed {number}: takes too long")
                    if "\n" in words and "deck" not in kind:
                        failures.append(f"{kind} seed {number}: more than one line: {words[:200]!r}")
                except BaseException as error:
                    failures.append(f"{kind} seed {number}: {type(error).__name__}: {str(error)[:120]!r}")
                finally:
                    signal.alarm(0)
                victim.write_bytes(sound[victim])
    finally:
        signal.signal(signal.SIGALRM, before)
    return failures


if __name__ == "__main__":
    # A file that claims more than it holds is to be refused, not to fill the memory
    resource.setrlimit(resource.RLIMIT_AS, (6 << 30, 6 << 30))
    for one in sys.argv[1].split(","):
        print(f"begun: {one}", flush=True)
        print("\n".join([*try_damaged(one, int(sys.argv[2]), int(sys.argv[3])), f"ended: {one}"]), flush=True)
