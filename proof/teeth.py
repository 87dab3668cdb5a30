"""Cases of faulty teeth at the target condition, when the mean turn of a gear was first divided by its own error.

Eight cracked teeth and three other faults of one, two unbalances that rattle once a turn, a loose pedestal, and two
sound machines, in an order that says nothing.
"""

from __future__ import annotations

import numpy as np

from proof.nominals import PAPER
from proof.plan import SEEDS, SENSOR_COUNTS, SNRS_DB, SPEED_COUNTS, SPEEDS_HZ, TARGET, Case, hiding_of, sensors_of

HIDDEN: tuple[tuple[str, int] | None, ...] = (
    *(("root_crack", level) for level in (1, 1, 2, 2, 2, 3, 3, 3)),
    ("flank_pit", 1),
    ("flank_pit", 3),
    ("broken_tooth", 2),
    ("imbalance", 2),
    ("imbalance", 3),
    ("loose_seat", 3),
    None,
    None,
)
"""Law and level of severity; nothing in two."""


def teeth() -> tuple[Case, ...]:
    """All cases."""
    order = np.random.default_rng([SEEDS["teeth"], 0]).permutation(len(HIDDEN))
    return tuple(_case(index, int(number)) for index, number in enumerate(order))


def _case(index: int, number: int) -> Case:
    seed = SEEDS["teeth"]
    hidden = HIDDEN[number]
    effects = () if hidden is None else (hiding_of(*_of(hidden, number), np.random.default_rng([seed, index, 0])),)
    return Case(
        name=f"g{index + 1:03d}",
        index=index,
        seed=seed,
        group="single" if effects else "null",
        effects=effects,
        level=hidden[1] if hidden is not None else -1,
        sensors=sensors_of(SENSOR_COUNTS[TARGET[0]], 2 * number),
        snr_db=SNRS_DB[TARGET[1]],
        speeds_hz=SPEEDS_HZ[SPEED_COUNTS[TARGET[2]]],
        baseline=True,
        machine=PAPER,
    )


def _of(hidden: tuple[str, int], number: int) -> tuple[str, int, int]:
    """Law, number of its variant, and level."""
    law, level = hidden
    return law, number, level
