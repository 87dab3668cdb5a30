"""Splits of all groups that one version of the engine runs: none of their cases was met by it or an earlier one.

Three of four cases stand at the target condition, the fourth goes through the rows of an orthogonal array. Pairs are
those of all earlier splits in turn. A third of the pits have edges that stand up, which no split before them had.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from proof.effects import LIPPED
from proof.library import CLOSED
from proof.plan import (
    FAULTS,
    FIRST,
    LOOKALIKES,
    ORTHOGONAL,
    OTHERS,
    PAIRS,
    PITTED_PAIRS,
    SEEDS,
    SENSOR_COUNTS,
    SHOWN_PAIRS,
    SNRS_DB,
    SPEED_COUNTS,
    SPEEDS_HZ,
    TARGET,
    Case,
    Group,
    Hiding,
    Split,
    hiding_of,
    sensors_of,
)
from proof.unknown import OPEN

Row = tuple[int, int, int]


@dataclass(frozen=True, kw_only=True)
class Design:
    """One such split: `turned` is from which number on the cycles of laws, severities and variants go, as other splits
    have gone before, `begun` from which on those of rarer laws, pairs and unknown effects; `rows` are the conditions of
    every fourth case."""

    split: Split
    groups: Mapping[Group, int]
    turned: int
    rows: tuple[Row, ...]
    begun: int = 0
    initials: str = ""
    """How its cases' names begin, if not as the split's: no two plans share a name."""


ENTIRE = Design(
    split="entire",
    groups={
        "null": 30, "misset": 3, "sensor": 14, "single": 76, "double": 26, "open": 26, "no_baseline": 9, "ambiguous": 8,
    },
    turned=220,
    rows=ORTHOGONAL,
)  # fmt: skip
HELD = Design(
    split="held",
    groups={"null": 24, "sensor": 8, "single": 48, "double": 13, "open": 13, "no_baseline": 8, "ambiguous": 6},
    turned=311,
    rows=tuple(row for row in ORTHOGONAL if row != TARGET and SPEED_COUNTS[row[2]] != 5),
)
"""Of a size that two cores run in an afternoon: without five speeds and mis-set machine files, whose atlases are made
for one or two cases each."""
WIDE = Design(
    split="wide",
    groups={"null": 14, "sensor": 4, "single": 32, "double": 8, "open": 8, "no_baseline": 3, "ambiguous": 3},
    turned=439,
    rows=HELD.rows,
)
"""The same in little, for the engine that came of the misses of the others."""
MIXED = Design(split="mixed", groups=WIDE.groups, turned=557, rows=HELD.rows, begun=8)
"""As wide, of laws, pairs and unknown effects that it leaves out."""
YOUNG = Design(split="young", groups=WIDE.groups, turned=673, rows=HELD.rows, begun=16)
"""As mixed, of those that both leave out, then from the first on."""
VAST = Design(split="vast", groups=WIDE.groups, turned=787, rows=HELD.rows, begun=24)
"""As young, of the rarer laws and most of the pairs that it leaves out."""
CLEAR = Design(split="clear", groups=WIDE.groups, turned=907, rows=HELD.rows, begun=32)
"""As vast, of the rarer laws and most of the pairs that it leaves out."""
JURY = Design(split="jury", groups=WIDE.groups, turned=1013, rows=HELD.rows, begun=40)
"""As clear, of the rarer laws and most of the pairs that it leaves out."""
INQUEST = Design(split="inquest", groups=WIDE.groups, turned=1117, rows=HELD.rows, begun=48)
"""As jury, of the rarer laws and most of the pairs that it leaves out."""
ZENITH = Design(split="zenith", groups=WIDE.groups, turned=1213, rows=HELD.rows, begun=56)
"""As inquest, of the rarer laws and most of the pairs that it leaves out."""
XENIAL = Design(split="xenial", groups=WIDE.groups, turned=1319, rows=HELD.rows, begun=64)
"""As zenith, of the rarer laws and most of the pairs that it leaves out."""
TWELFTH = Design(split="twelfth", groups=WIDE.groups, turned=1423, rows=HELD.rows, begun=72, initials="tw")
"""As xenial, of the rarer laws and most of the pairs that it leaves out."""
BAKER = Design(split="baker", groups=WIDE.groups, turned=1531, rows=HELD.rows, begun=80, initials="bk")
"""As twelfth, of the rarer laws and most of the pairs that it leaves out."""
CHANDLER = Design(split="chandler", groups=WIDE.groups, turned=1637, rows=HELD.rows, begun=88, initials="ch")
"""As baker, of the rarer laws and most of the pairs that it leaves out."""
DYER = Design(split="dyer", groups=WIDE.groups, turned=1741, rows=HELD.rows, begun=96, initials="dy")
"""As chandler, of the rarer laws and most of the pairs that it leaves out."""
ENGRAVER = Design(split="engraver", groups=WIDE.groups, turned=1847, rows=HELD.rows, begun=104, initials="eg")
"""As dyer, of the rarer laws and most of the pairs that it leaves out."""
ALL_PAIRS = tuple(dict.fromkeys((*SHOWN_PAIRS, *PAIRS, *PITTED_PAIRS)))
STRUCK = ("outer_pit", "inner_pit", "ball_pit")
FORMS = 3
"""Of a pit: two trapezoids, and one with a lip."""
LEVELS = (2, 1, 3, 0, 2, 1, 3)


def entire() -> tuple[Case, ...]:
    """All cases of the first."""
    return cases_of_design(ENTIRE)


def held() -> tuple[Case, ...]:
    """All cases of the second."""
    return cases_of_design(HELD)


def wide() -> tuple[Case, ...]:
    """All cases of the third."""
    return cases_of_design(WIDE)


def mixed() -> tuple[Case, ...]:
    """All cases of the fourth."""
    return cases_of_design(MIXED)


def young() -> tuple[Case, ...]:
    """All cases of the fifth."""
    return cases_of_design(YOUNG)


def vast() -> tuple[Case, ...]:
    """All cases of the sixth."""
    return cases_of_design(VAST)


def clear() -> tuple[Case, ...]:
    """All cases of the seventh."""
    return cases_of_design(CLEAR)


def jury() -> tuple[Case, ...]:
    """All cases of the eighth."""
    return cases_of_design(JURY)


def inquest() -> tuple[Case, ...]:
    """All cases of the ninth."""
    return cases_of_design(INQUEST)


def zenith() -> tuple[Case, ...]:
    """All cases of the tenth."""
    return cases_of_design(ZENITH)


def xenial() -> tuple[Case, ...]:
    """All cases of the eleventh."""
    return cases_of_design(XENIAL)


def twelfth() -> tuple[Case, ...]:
    """All cases of the twelfth."""
    return cases_of_design(TWELFTH)


def baker() -> tuple[Case, ...]:
    """All cases of the thirteenth."""
    return cases_of_design(BAKER)


def chandler() -> tuple[Case, ...]:
    """All cases of the fourteenth."""
    return cases_of_design(CHANDLER)


def dyer() -> tuple[Case, ...]:
    """All cases of the fifteenth."""
    return cases_of_design(DYER)


def engraver() -> tuple[Case, ...]:
    """All cases of the sixteenth."""
    return cases_of_design(ENGRAVER)


def cases_of_design(design: Design) -> tuple[Case, ...]:
    """All cases in the order of their names, which say nothing: any first so many are a sample of the split."""
    every = [(group, i) for group, count in design.groups.items() for i in range(count)]
    order = np.random.default_rng(SEEDS[design.split]).permutation(len(every))
    return tuple(_case(design, place, int(index), *every[int(index)]) for place, index in enumerate(order))


def _case(design: Design, place: int, index: int, group: Group, number: int) -> Case:
    seed = SEEDS[design.split]
    rng = np.random.default_rng([seed, index, 0])
    row = design.rows[(number // 4) % len(design.rows)] if number % 4 == 3 else TARGET
    sensors, snr, speeds = SENSOR_COUNTS[row[0]], SNRS_DB[row[1]], SPEED_COUNTS[row[2]]
    turned = number + design.turned
    level = max({"single": 0, "ambiguous": 2}.get(group, 1), LEVELS[turned % len(LEVELS)])
    chosen = sensors_of(sensors, turned)
    causes: tuple[tuple[str, str], ...] = ()
    if group == "ambiguous":
        alike = LOOKALIKES[number % len(LOOKALIKES)]
        chosen, speeds, causes, snr = alike.sensors, alike.speeds, alike.causes, 20.0
    effects = _effects(group, number, turned, level, rng, design.begun)
    return Case(
        name=f"{design.initials or design.split[0]}{place + 1:03d}",
        index=index,
        seed=seed,
        group=group,
        effects=effects,
        level=level if effects else -1,
        sensors=chosen,
        snr_db=snr,
        speeds_hz=SPEEDS_HZ[speeds],
        baseline=group != "no_baseline",
        fault=FAULTS[number % len(FAULTS)] if group == "sensor" else None,
        causes=causes,
    )


def _effects(
    group: Group, number: int, turned: int, level: int, rng: np.random.Generator, begun: int
) -> tuple[Hiding, ...]:
    if group in {"null", "misset", "sensor"}:
        return ()
    if group == "open":
        return (hiding_of(tuple(OPEN)[(number + begun) % len(OPEN)], turned, level, rng),)
    if group == "double":
        pair = ALL_PAIRS[(number + begun) % len(ALL_PAIRS)]
        return tuple(_formed(hiding_of(law, turned + i, level, rng), turned + i) for i, law in enumerate(pair))
    if group == "ambiguous":
        alike = LOOKALIKES[number % len(LOOKALIKES)]
        law = CLOSED[alike.law]
        return (Hiding(law=alike.law, site=alike.causes[0][1], value=law.levels[level], variant=number % law.variants),)
    if group == "no_baseline":
        return (_formed(hiding_of(FIRST[(number + begun) % len(FIRST)], turned, level, rng), turned),)
    turn, place = divmod(number, 8)
    law_name = FIRST[place] if place < len(FIRST) else OTHERS[(2 * turn + begun + place - len(FIRST)) % len(OTHERS)]
    return (_formed(hiding_of(law_name, turned + turn, level, rng), turn + place),)


def _formed(hiding: Hiding, number: int) -> Hiding:
    """The same; of pits every third has a lip."""
    if hiding.law not in STRUCK or number % FORMS != LIPPED:
        return hiding
    return Hiding(law=hiding.law, site=hiding.site, value=hiding.value, variant=LIPPED)
