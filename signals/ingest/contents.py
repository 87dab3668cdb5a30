"""What a file holds, as its reader sees it before anything large is loaded."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import AbstractContextManager, contextmanager
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from signals.ingest.limits import Bounds
from sim.core.errors import Problem, SidebandError, SpecError

AnyArray = NDArray[np.generic]


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

    `together`: loads several at once, where one pass over the file gives them all.
    """

    entries: Mapping[str, Entry]
    rate_hz: float | None = None
    numbered: bool = False
    together: Callable[[Sequence[str]], Mapping[str, AnyArray]] | None = None

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
def told(path: Path, *errors: type[BaseException]) -> Iterator[None]:
    """What a library says about a broken file, as a refusal in one line."""
    try:
        yield
    except SidebandError:
        raise
    except errors as error:
        text = str(error).strip()
        raise refused(path, f"{text.splitlines()[0][:300]}" if text else type(error).__name__) from error
