"""The envelope of a struck part is shown for what is told of it, by the bearing that is told, and for nothing else."""

from __future__ import annotations

from types import SimpleNamespace

import pytest

from reconcile.machine import envelope
from reconcile.machine.envelope import MOST_DRAWN, Drawn, drawn, envelopes_of
from reconcile.verdict import Cause

OUTER = Drawn(kind="outer", sites=("bearing1", "bearing2"), picture={"family": "bearing1.outer", "order": 3.1})
BALL = Drawn(kind="ball", sites=("bearing3",), picture={"family": "bearing3.ball"})


def cause(term: str, site: str, named: bool = False) -> Cause:
    return Cause(term=term, site=site, score=9.0, named=named)


def test_it_is_called_by_the_bearing_that_is_told() -> None:
    (shown,) = envelopes_of((OUTER, BALL), (cause("outer_spall", "bearing2"),))
    assert shown == {"family": "bearing2.outer", "order": 3.1}
    assert OUTER.picture["family"] == "bearing1.outer", "the picture itself stays"


def test_a_named_cause_comes_before_likelier_ones() -> None:
    causes = (cause("outer_spall", "bearing1"), cause("outer_spall", "bearing2", named=True))
    assert [p["family"] for p in envelopes_of((OUTER,), causes)] == ["bearing2.outer"]


@pytest.mark.parametrize(
    "told",
    [
        (),
        (cause("outer_spall", "bearing3"),),
        (cause("inner_spall", "bearing1"),),
        (cause("unbalance", "pinion"), cause("no_such", "bearing1")),
    ],
)
def test_what_no_cause_strikes_at_is_not_shown(told: tuple[Cause, ...]) -> None:
    assert envelopes_of((OUTER, BALL), told) == []


def family(site: str, kind: str, order: float) -> SimpleNamespace:
    return SimpleNamespace(site=site, kind=kind, order=order, key=f"{site}.{kind}", slip=0.01, spacing=1.0)


def test_the_firmest_parts_are_drawn_with_all_bearings_that_have_their_lines(monkeypatch: pytest.MonkeyPatch) -> None:
    families = [family(f"bearing{k}", "outer", 3.0 if k < 3 else 2.0 + 0.1 * k) for k in range(1, 7)]
    firm = [SimpleNamespace(family=family("shaft", "turn", 1.0), strongest=0)]
    firm += [SimpleNamespace(family=f, strongest=k) for k, f in enumerate(families[1:])]
    asked: list[list[SimpleNamespace]] = []
    rested: list[list[str]] = []

    def picture(every: list[SimpleNamespace], causes: object, tests: object, before: list[str]) -> dict[str, object]:
        asked.append(every)
        rested.append(before)
        return {"envelope": {"family": every[0].family.key}}

    monkeypatch.setattr(envelope, "envelope_picture", picture)
    monkeypatch.setattr(envelope, "same", lambda a, b: a.order == b.order)
    several = ["20 Hz", "20 Hz, half the load", "30 Hz"]
    found = drawn(firm, firm, several, several, SimpleNamespace(families=families))  # type: ignore[arg-type]
    assert rested == [["20 Hz"], ["20 Hz, half the load"], ["30 Hz"]], "of the operating point where it is heard best"
    assert len(found) == MOST_DRAWN == len(asked) and all(len(every) == len(firm) for every in asked)  # type: ignore[arg-type]
    assert [one.picture["family"] for one in found] == ["bearing2.outer", "bearing3.outer", "bearing4.outer"]
    assert [one.sites for one in found] == [("bearing1", "bearing2"), ("bearing3",), ("bearing4",)]
