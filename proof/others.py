"""Cases of other nominal machines than the paper's, all at the target condition: does a verdict rest on its numbers?

Six a machine: two sound ones, a loose fit, a pit of an outer race, a damaged tooth, a loose seat, of middle severity.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import get_args

import numpy as np

from proof.entire import (
    baker,
    chandler,
    clear,
    dyer,
    engraver,
    entire,
    held,
    inquest,
    jury,
    mixed,
    twelfth,
    vast,
    wide,
    xenial,
    young,
    zenith,
)
from proof.kinds import kinds
from proof.nominals import NOMINALS, PAPER
from proof.plan import SEEDS, SENSOR_COUNTS, SNRS_DB, TARGET, Case, Split, hiding_of, plan, sensors_of
from proof.rotors.plan import rotors
from proof.teeth import teeth

LEVEL = 2
SPLITS: tuple[Split, ...] = get_args(Split)
TOOTH = ("broken_tooth", "root_crack")
"""The damaged tooth, in turn by machine."""


def others() -> tuple[Case, ...]:
    """All cases, machine by machine, in an order within a machine that says nothing."""
    found: list[Case] = []
    for turn, machine in enumerate(name for name in NOMINALS if name != PAPER):
        laws = (None, None, "loose_fit", "outer_pit", TOOTH[turn % len(TOOTH)], "loose_seat")
        for number in np.random.default_rng([SEEDS["others"], turn]).permutation(len(laws)):
            found.append(_case(machine, len(found), laws[int(number)]))
    return tuple(found)


def cases_of(split: Split) -> tuple[Case, ...]:
    """All cases of any split."""
    if split in {"rotors", "rotors-later"}:
        return rotors(split)
    return MADE[split]() if split in MADE else plan(split)


MADE: Mapping[str, Callable[[], tuple[Case, ...]]] = {
    "others": others, "kinds": kinds, "entire": entire, "teeth": teeth, "held": held, "wide": wide, "mixed": mixed,
    "young": young, "vast": vast, "clear": clear, "jury": jury, "inquest": inquest, "zenith": zenith,
    "xenial": xenial, "twelfth": twelfth, "baker": baker, "chandler": chandler, "dyer": dyer,
    "engraver": engraver,
}  # fmt: skip


def _case(machine: str, index: int, name: str | None) -> Case:
    seed = SEEDS["others"]
    rng = np.random.default_rng([seed, index, 0])
    effects = () if name is None else (hiding_of(name, index + index // 6, LEVEL, rng),)
    return Case(
        name=f"o{index + 1:03d}",
        index=index,
        seed=seed,
        group="single" if effects else "null",
        effects=effects,
        level=LEVEL if effects else -1,
        sensors=sensors_of(SENSOR_COUNTS[TARGET[0]], 2 * index),
        snr_db=SNRS_DB[TARGET[1]],
        speeds_hz=NOMINALS[machine].speeds_hz,
        baseline=True,
        machine=machine,
    )
