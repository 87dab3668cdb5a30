"""Which recording a refusal is about, in the words of the person who sent it."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import replace

from signals.recording import Recording
from sim.core.errors import SpecError


def place(one: Recording, kind: str, index: int, field: str = "") -> str:
    """`t1.json: channels[0]` where the recording has a label, else `recording[0].channels[0]`.

    `kind`: `recording` or `baseline`; `index` counts from 0; `field` may be empty.
    """
    if one.label:
        return f"{one.label}: {field}" if field else one.label
    return f"{kind}[{index}].{field}" if field else f"{kind}[{index}]"


@contextmanager
def about(label: str) -> Iterator[None]:
    """A SpecError raised inside names `label` before its field, once; an empty label changes nothing."""
    try:
        yield
    except SpecError as error:
        if not label:
            raise
        raise SpecError([replace(p, field=_before(label, p.field)) for p in error.problems]) from error


def _before(label: str, field: str) -> str:
    return field if field == label or field.startswith(f"{label}: ") else f"{label}: {field}"


def sent_as(tests: Sequence[Recording], baselines: Sequence[Recording]) -> dict[str, str]:
    """What the report calls each labelled recording (`test 1`, `baseline 2`), to its label."""
    several = [
        (f"{kind} {i}", one)
        for kind, group in (("test", tests), ("baseline", baselines))
        for i, one in enumerate(group, 1)
    ]
    return {name: one.label for name, one in several if one.label}
