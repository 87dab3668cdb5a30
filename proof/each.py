"""One measurement of each case, on several processes; what was measured is stored after every one of them."""

from __future__ import annotations

import json
from collections.abc import Callable, Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import asdict
from multiprocessing import get_context
from pathlib import Path
from typing import TypeVar

from tqdm import tqdm

from proof.plan import Case

Found = TypeVar("Found")
"""A dataclass."""


def of_each(
    todo: Sequence[Case], measured: Callable[[Case], Found], found: dict[str, Found], store: Path, jobs: int
) -> dict[str, Found]:
    """`found` by case, with the cases `todo`; `measured` is a function of a module, so that a process can load it."""
    with ProcessPoolExecutor(jobs, mp_context=get_context("spawn")) as pool:
        told = tqdm(pool.map(measured, todo), total=len(todo), desc=store.stem)
        for case, one in zip(todo, told, strict=True):
            found[case.name] = one
            text = json.dumps({name: asdict(v) for name, v in sorted(found.items())}, indent=1)  # type: ignore[call-overload]
            store.write_text(text + "\n", encoding="utf-8")
    return found
