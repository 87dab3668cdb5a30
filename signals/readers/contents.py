"""What a file holds, as its reader sees it before anything large is loaded."""

from __future__ import annotations

import gzip
import logging
import re
import zipfile
import zlib
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import AbstractContextManager, contextmanager
from dataclasses import dataclass, field
from pathlib import Path, PurePath

import numpy as np
from numpy.typing import NDArray

from signals.readers.limits import Bounds
from sim.core.errors import Problem, SidebandError, SpecError

AnyArray = NDArray[np.generic]
RATE = "sampling_rate_hz"
"""The one name under which a rate in a file of arrays counts as stated (`signals.encode` writes it)."""
TEXTS = frozenset({".csv", ".tsv", ".txt", ".dat", ".json"})
"""Formats whose parsers say what is wrong with a line; the words of others say nothing to the person with the file."""
_SPEAKING = (ValueError, OSError)
"""Errors whose text says something to the person with the file."""
_NOT_KNOWN = re.compile(r"not supported|unsupported|unknown wave|not registered|required filter|encrypt", re.IGNORECASE)
"""Words of parsers for files that are whole but of a kind which they do not read."""
log = logging.getLogger(__name__)


@dataclass(frozen=True, kw_only=True)
class Entry:
    """One array of a file. `load` gives it whole, 1-D or 2-D; `shape` is known before (None: not cheaply).

    `rate_hz` and `unit` are what the file itself says of it.
    """

    load: Callable[[], AnyArray]
    shape: tuple[int, ...] | None = None
    rate_hz: float | None = None
    unit: str = ""


@dataclass(frozen=True, kw_only=True)
class Contents:
    """Arrays by name, in the order of the file. `numbered`: an integer column counts the arrays (a table's columns).

    `aliases`: other names of arrays. `together`: loads several at once, where one pass over the file gives them all.
    `remarks`: what a person should know of the file.
    """

    entries: Mapping[str, Entry]
    rate_hz: float | None = None
    numbered: bool = False
    aliases: Mapping[str, str] = field(default_factory=dict)
    together: Callable[[Sequence[str]], Mapping[str, AnyArray]] | None = None
    remarks: tuple[str, ...] = ()

    def load(self, names: Sequence[str]) -> Mapping[str, AnyArray]:
        """The arrays named, each (n,) or (n, m)."""
        if self.together is not None:
            return self.together(names)
        return {name: self.entries[name].load() for name in names}


Reader = Callable[[Path, Bounds], AbstractContextManager[Contents]]
"""Opens a file; the entries can be loaded until the context ends."""


def refused(path: Path, reason: str) -> SpecError:
    """The file cannot be read, in one line."""
    return SpecError(Problem(field=path.name, message=f"cannot be read: {reason}"))


def numeric(path: Path, name: str, value: object) -> AnyArray:
    """The value as an array of real numbers; SpecError for texts, objects, complex numbers, more than two axes."""
    array = np.asarray(value)
    if array.dtype.kind not in "fiub":
        kind = "complex numbers" if array.dtype.kind == "c" else "no numbers"
        raise SpecError(Problem(field=path.name, message=f"{name}: holds {kind}", given=str(array.dtype)[:80]))
    return array


@contextmanager
def told(path: Path) -> Iterator[None]:
    """Whatever a library raises over a broken file, as a refusal in one line. Only calls of the library belong inside.

    Parsers of binary formats fail in ways they do not document; every one of them means that the file is not read.
    """
    try:
        yield
    except (SidebandError, MemoryError):
        raise
    except Exception as error:
        log.info("reading %s failed: %s: %s", path.name, type(error).__name__, error)
        raise refused(path, _reason(path, error)) from error


def _reason(path: Path, error: Exception) -> str:
    """Of binary formats what is wrong with the file, not how its parser stumbled; of texts what the parser says."""
    if isinstance(error, EOFError):
        return "it is cut short: it ends within its data"
    if isinstance(error, zipfile.BadZipFile | gzip.BadGzipFile | zlib.error):
        return "it is damaged: its packed data do not unpack"
    if PurePath(path.name.removesuffix(".gz")).suffix.lower() not in TEXTS:
        text = str(error).strip()
        if _NOT_KNOWN.search(text) or isinstance(error, NotImplementedError):
            return f"it holds what is not read here ({_line(text)})"
        return "it is damaged or cut short: its contents do not fit together"
    text = str(error).strip() if isinstance(error, _SPEAKING) else ""
    return _line(text) if text else f"it is malformed ({type(error).__name__})"


def _line(text: str) -> str:
    return text.splitlines()[0][:300] if text else "no reason is given"
