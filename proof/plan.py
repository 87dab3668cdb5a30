"""The plan: which cases there are. A stated fraction of the full crossing, the same for the same split every time.

Every second case stands at the target condition (3 sensors, 20 dB, 3 speeds, baseline); the others run through the nine
rows of an orthogonal array of sensors x noise x speeds, so each pair of levels occurs equally often. All cases of
the splits `third`, `fourth`, `quiet`, `unmet`, `next`, `beside`, `pitted` and `anew` stand at the target condition.
Laws, sites, severities and variants go round in cycles of different length.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np

from proof.effects import Law
from proof.library import CLOSED
from proof.nominals import KINDS, NOMINALS, PAPER, Nominal
from proof.rotors.machine import ROTORS
from proof.unknown import OPEN

Split = Literal[
    "dev", "sealed", "later", "third", "fourth", "quiet", "unmet", "next", "others", "rotors", "rotors-later",
    "kinds", "beside", "pitted", "anew", "entire", "teeth", "held", "wide", "mixed", "young", "vast", "clear",
    "jury", "inquest", "zenith", "xenial", "twelfth", "baker", "chandler", "dyer", "engraver",
]  # fmt: skip
Group = Literal["null", "misset", "sensor", "single", "double", "open", "no_baseline", "ambiguous"]
SEEDS = {
    "dev": 20_240_611,
    "sealed": 7_310_552_903,
    "later": 5_148_093_277,
    "third": 6_902_417_355,
    "fourth": 8_219_604_731,
    "quiet": 3_471_980_629,
    "unmet": 2_685_330_917,
    "next": 4_417_902_663,
    "others": 9_036_127_745,
    "rotors": 1_873_264_509,
    "rotors-later": 6_340_917_285,
    "kinds": 7_752_049_163,
    "beside": 3_958_271_407,
    "pitted": 9_302_716_583,
    "anew": 5_790_146_323,
    "entire": 8_064_731_295,
    "teeth": 4_836_201_759,
    "held": 2_916_480_537,
    "wide": 6_174_392_805,
    "mixed": 9_481_205_763,
    "young": 3_617_948_205,
    "vast": 5_283_740_961,
    "clear": 7_904_163_528,
    "jury": 6_583_017_249,
    "inquest": 3_120_864_795,
    "zenith": 8_706_415_239,
    "xenial": 5_247_930_816,
    "twelfth": 4_693_170_258,
    "baker": 8_310_659_427,
    "chandler": 7_600_884_850,
    "dyer": 8_112_450_613,
    "engraver": 9_274_018_356,
}
COUNTS = {
    "dev": {
        "null": 8, "misset": 3, "sensor": 5, "single": 26, "double": 6, "open": 8, "no_baseline": 3, "ambiguous": 3,
    },
    "sealed": {
        "null": 26, "misset": 8, "sensor": 16, "single": 80, "double": 22, "open": 24, "no_baseline": 14,
        "ambiguous": 12,
    },
    "later": {"null": 14, "sensor": 8, "single": 40, "double": 12, "open": 16, "ambiguous": 4},
    "third": {"null": 6, "sensor": 4, "single": 16, "double": 4, "open": 6},
    "fourth": {"null": 2, "single": 6, "double": 10},
    "quiet": {"null": 40},
    "unmet": {"null": 2, "single": 10, "double": 4, "open": 2},
    "next": {"null": 3, "single": 9, "double": 4, "open": 4},
    "beside": {"null": 2, "single": 6, "double": 10, "open": 2},
    "pitted": {"null": 1, "single": 5, "double": 9},
    "anew": {"null": 3, "single": 14, "double": 4, "open": 4},
}  # fmt: skip
"""`later` was sealed when the cases of `sealed` that share the nominal machine's atlases had been looked at, `third`
when those of `later` at the target condition had been; `fourth` when two effects were first fitted together;
`quiet`, of sound machines alone, to count false alarms at the target condition; `unmet` when the collision damping of a
fit was first searched; `next` when lines at multiples of a slow shaft and orders of no part had been; `beside` when
second effects were first found by what the fitted first one leaves; `pitted` when those beside impacts were first found
by the teeth's own lines; `anew` when recordings of other rigs had been gone through."""
TURNED = {"third": 40, "fourth": 60, "quiet": 80, "unmet": 100, "next": 124, "beside": 148, "pitted": 172, "anew": 196}
"""From which number on the cycles of laws, severities and variants go in a split that others have gone before."""
EXTRA: dict[str, tuple[tuple[Group, int], ...]] = {
    "dev": (("sensor", 5), ("sensor", 6), ("sensor", 7)), "sealed": (), "later": (), "third": (), "fourth": (),
    "quiet": (), "unmet": (), "next": (), "beside": (), "pitted": (), "anew": (),
}  # fmt: skip
"""Cases behind the shuffled ones: the faults that the first five leave out."""
SENSOR_COUNTS, SNRS_DB, SPEED_COUNTS = (3, 1, 8), (20.0, 30.0, 10.0), (3, 1, 5)
TARGET = (0, 0, 0)
ORTHOGONAL = tuple((a, b, (a + b) % 3) for a in range(3) for b in range(3))
SPEEDS_HZ = {1: (30.0,), 3: (22.5, 30.0, 39.0), 5: (18.0, 22.5, 30.0, 36.0, 39.0)}
"""Stated speeds, the same in all cases (the real ones differ): atlases of the nominal machine can be shared."""
FIRST = ("loose_fit", "outer_pit", "root_crack", "loose_seat", "inner_pit", "imbalance")
"""Laws that occur in every cycle of singles; the others take turns in two further places."""
OTHERS = tuple(name for name in CLOSED if name not in FIRST)
PAIRS = (
    ("loose_fit", "root_crack"), ("outer_pit", "loose_seat"), ("outer_pit", "root_crack"), ("inner_pit", "run_out"),
    ("loose_seat", "imbalance"), ("loose_fit", "outer_pit"), ("root_crack", "run_out"), ("inner_pit", "loose_fit"),
    ("play", "root_crack"), ("wider_clearance", "run_out"), ("outer_pit", "inner_pit"),
)  # fmt: skip
SHOWN_PAIRS = (
    ("outer_pit", "loose_seat"), ("loose_fit", "imbalance"), ("inner_pit", "loose_fit"), ("loose_seat", "imbalance"),
    ("outer_pit", "wider_clearance"), ("loose_fit", "outer_pit"), ("inner_pit", "loose_seat"),
    ("wider_clearance", "imbalance"), ("loose_fit", "loose_seat"), ("outer_pit", "imbalance"),
)  # fmt: skip
"""Of the splits of `SHOWN`: effects that mostly move the spectrum more than drift does, so that there are two to be
told. Of 25 pairs of `PAIRS` at the target condition 12 have one that does not: cracks of teeth and gears that run
out."""
PITTED_PAIRS = (
    ("outer_pit", "loose_seat"), ("inner_pit", "loose_fit"), ("outer_pit", "wider_clearance"),
    ("inner_pit", "loose_seat"), ("outer_pit", "loose_fit"), ("inner_pit", "wider_clearance"),
    ("outer_pit", "imbalance"),
)  # fmt: skip
PITTED = ("outer_pit", "inner_pit", "broken_tooth", "outer_pit", "ball_pit")
"""Pairs and single effects of the split `pitted`: all strike, and only pairs hide a second effect."""
SHOWN = ("fourth", "unmet", "next", "beside", "anew")
MACHINES: Mapping[str, Nominal] = {**NOMINALS, **KINDS, **ROTORS}
FAULTS = ("clipping", "dropouts", "mains_hum", "loose_sensor", "stuck", "swapped", "gain_change", "aliasing")


@dataclass(frozen=True, kw_only=True)
class Hiding:
    """One hidden effect: law of `CLOSED` or `OPEN`, site, severity, variant of the law."""

    law: str
    site: str
    value: float
    variant: int

    def about(self) -> Law:
        """What the law is."""
        return CLOSED[self.law] if self.law in CLOSED else OPEN[self.law]


@dataclass(frozen=True, kw_only=True)
class Lookalike:
    """A case that its sensors and speeds cannot decide: sensors (names), speeds, and the causes that look alike."""

    law: str
    sensors: tuple[str, ...]
    speeds: int
    causes: tuple[tuple[str, str], ...]


@dataclass(frozen=True, kw_only=True)
class Case:
    """One case. `sensors`: `bearing1.y` and so on; `level`: 0 (faint) to 3, -1 without effect."""

    name: str
    index: int
    seed: int
    group: Group
    effects: tuple[Hiding, ...]
    level: int
    sensors: tuple[str, ...]
    snr_db: float
    speeds_hz: tuple[float, ...]
    baseline: bool
    fault: str | None = None
    causes: tuple[tuple[str, str], ...] = ()
    machine: str = PAPER
    """Which of `MACHINES` is told."""

    @property
    def nominal(self) -> Nominal:
        """The machine as it is drawn."""
        return MACHINES[self.machine]

    @property
    def torque_nm(self) -> float:
        """Stated torque on the input shaft; laws say theirs for the paper's machine."""
        share = self.nominal.parameters["T"] / NOMINALS[PAPER].parameters["T"]
        return share * min((hiding.about().torque_nm for hiding in self.effects), default=25.0)

    def rng(self, *purpose: int) -> np.random.Generator:
        """Random numbers of this case for one purpose."""
        return np.random.default_rng([self.seed, self.index, *purpose])


LOOKALIKES = (
    Lookalike(
        law="outer_pit", sensors=("bearing3.y",), speeds=3,
        causes=(("outer_spall", "bearing1"), ("outer_spall", "bearing2")),
    ),
    Lookalike(
        law="imbalance", sensors=("bearing1.y",), speeds=1, causes=(("unbalance", "pinion"), ("bent_shaft", "pinion")),
    ),
    Lookalike(
        law="inner_pit", sensors=("bearing3.y",), speeds=3,
        causes=(("inner_spall", "bearing1"), ("inner_spall", "bearing2")),
    ),
    Lookalike(
        law="root_crack", sensors=("bearing3.y",), speeds=1,
        causes=(("tooth_crack", "pinion"), ("missing_tooth", "pinion"), ("tooth_spall", "pinion")),
    ),
)  # fmt: skip


def plan(split: Split) -> tuple[Case, ...]:
    """All cases of a split of `COUNTS` in the order of their names, which say nothing."""
    groups: list[tuple[Group, int]] = [(g, i) for g, n in COUNTS[split].items() for i in range(n)]  # type: ignore[misc]
    order = np.random.default_rng(SEEDS[split]).permutation(len(groups))
    cases = []
    for place, index in enumerate(order):
        group, number = groups[int(index)]
        cases.append(_case(split, f"{split[0]}{place + 1:03d}", int(index), group, number + TURNED.get(split, 0)))
    for group, number in EXTRA[split]:
        cases.append(_case(split, f"{split[0]}{len(cases) + 1:03d}", len(cases), group, number))
    return tuple(cases)


def _case(split: Split, name: str, index: int, group: Group, number: int) -> Case:
    seed = SEEDS[split]
    rng = np.random.default_rng([seed, index, 0])
    turn = number // 8 if group == "single" else 0  # so that each law meets both kinds of condition
    row = TARGET if split in TURNED or (number + turn) % 2 == 0 else ORTHOGONAL[(number // 2) % 9]
    sensors, snr, speeds = SENSOR_COUNTS[row[0]], SNRS_DB[row[1]], SPEED_COUNTS[row[2]]
    least = {"single": 0, "ambiguous": 2}.get(group, 1)
    level = max(least, (2, 1, 3, 0, 2, 1, 3)[number % 7])
    pairs = SHOWN_PAIRS if split in SHOWN else PITTED_PAIRS if split == "pitted" else PAIRS
    effects = _effects(group, number, level, rng, pairs, PITTED if split == "pitted" else ())
    chosen = sensors_of(sensors, number)
    causes: tuple[tuple[str, str], ...] = ()
    if group == "ambiguous":
        alike = LOOKALIKES[number % len(LOOKALIKES)]
        chosen, speeds, causes = alike.sensors, alike.speeds, alike.causes
        snr = 20.0
    return Case(
        name=name,
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
    group: Group,
    number: int,
    level: int,
    rng: np.random.Generator,
    pairs: Sequence[tuple[str, str]],
    lone: Sequence[str] = (),
) -> tuple[Hiding, ...]:
    """`lone`: laws of single effects in turn; those of all splits if not given."""
    if group in {"null", "misset", "sensor"}:
        return ()
    if group == "open":
        return (hiding_of(tuple(OPEN)[number % len(OPEN)], number, level, rng),)
    if group == "double":
        return tuple(hiding_of(law, number + i, level, rng) for i, law in enumerate(pairs[number % len(pairs)]))
    if group == "ambiguous":
        alike = LOOKALIKES[number % len(LOOKALIKES)]
        site = alike.causes[0][1]
        law = CLOSED[alike.law]
        return (Hiding(law=alike.law, site=site, value=law.levels[level], variant=number % law.variants),)
    if group == "no_baseline":
        return (hiding_of(FIRST[number % len(FIRST)], number, level, rng),)
    turn, place = divmod(number, 8)
    cycled = FIRST[place] if place < 6 else OTHERS[(2 * turn + place - 6) % len(OTHERS)]
    return (hiding_of(lone[number % len(lone)] if lone else cycled, turn + place, level, rng),)


def hiding_of(name: str, number: int, level: int, rng: np.random.Generator) -> Hiding:
    """One effect of a law: drawn site, drawn size about a level, variant by number."""
    law = CLOSED[name] if name in CLOSED else OPEN[name]
    site = law.sites[int(rng.integers(0, len(law.sites)))]
    if name == "loose_fit" and rng.random() < 0.5:
        site = "bearing1"  # the paper's
    value = law.levels[level] * float(np.exp(rng.uniform(-0.15, 0.15)))
    if law.unit == "1":
        value = min(value, law.levels[3])
    return Hiding(law=name, site=site, value=float(f"{value:.4g}"), variant=number % law.variants)


def sensors_of(count: int, number: int) -> tuple[str, ...]:
    """Names of so many sensors, one of two choices of places by number."""
    if count == 8:
        return tuple(f"bearing{j}.{axis}" for j in range(1, 5) for axis in "yx")
    if count == 1:
        return (("bearing1.y",), ("bearing3.y",))[number % 4 // 2]
    return (("bearing1.y", "bearing2.y", "bearing3.y"), ("bearing1.y", "bearing1.x", "bearing4.y"))[number % 4 // 2]
