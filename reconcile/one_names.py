"""Channels by one name in all recordings: place, axis, quantity and unit say which is which, and a name is a label.

Where recordings have the same names in another order these tell; where names differ the order does.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from reconcile.stated import Given, given
from signals.recording import Recording

Recordings = tuple[list[Recording], list[Recording]]


def by_one_name(tests: Sequence[Recording], baselines: Sequence[Recording]) -> tuple[Recordings, tuple[str, ...]]:
    """The recordings with the names of the first test's channels, and what is to be said of those that had others.

    Channels must agree by place, axis, quantity and unit (`reconcile.entry.check_channels`).
    """
    first, *others = given(tests, baselines)
    told = tuple(said for one in others if (said := _said(first, one)))
    made = [_named_as(first.recording, one.recording) for one in (first, *others)]
    return (made[: len(tests)], made[len(tests) :]), told


def _named_as(first: Recording, one: Recording) -> Recording:
    if one.names == first.names:
        return one
    if same_in_another_order(first, one):
        return one.select(channels=first.names)
    named = tuple(replace(c, name=name) for c, name in zip(one.channels, first.names, strict=True))
    return replace(one, channels=named)


def same_in_another_order(first: Recording, one: Recording) -> bool:
    """Whether both have the same channels, by their names; not where a place or unit contradicts these."""
    here, there = ({c.name: replace(c, name="") for c in r.channels} for r in (first, one))
    return here == there


def _said(first: Given, one: Given) -> str | None:
    if one.recording.names == first.recording.names:
        return None
    place, own = one.field("channels"), ", ".join(one.recording.names)
    if same_in_another_order(first.recording, one.recording):
        return f"{place} are in another order ({own}) than those of {first.field('channels')}: matched by their names"
    names = ", ".join(first.recording.names)
    return f"{place} have other names ({own}) than those of {first.field('channels')} ({names}): matched by their order"
