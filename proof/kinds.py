"""Cases of gearboxes of two further kinds, with all groups of cases, at the target condition.

Twelve a machine: two sound ones, a sensor fault, six single effects, two pairs of laws that mostly show, one effect
that no library has. Severities go round as in the other splits, the faintest left out.
"""

from __future__ import annotations

import numpy as np

from proof.nominals import KINDS
from proof.plan import SEEDS, SENSOR_COUNTS, SNRS_DB, TARGET, Case, Group, hiding_of, sensors_of

SOUND = 2
FAULTS = ("swapped", "mains_hum")
SINGLES = (
    ("loose_fit", "outer_pit", "broken_tooth", "loose_seat", "wider_clearance", "imbalance"),
    ("inner_pit", "loose_fit", "root_crack", "ball_pit", "play", "run_out"),
)
PAIRS = (
    (("inner_pit", "loose_seat"), ("loose_fit", "imbalance")),
    (("outer_pit", "wider_clearance"), ("loose_fit", "outer_pit")),
)
OPEN = ("cross_coupling", "line_torque")
"""All of these in turn by machine."""


def kinds() -> tuple[Case, ...]:
    """All cases, machine by machine, in an order within a machine that says nothing."""
    found: list[Case] = []
    for turn, machine in enumerate(KINDS):
        wanted: list[tuple[Group, tuple[str, ...]]] = [("null", ())] * SOUND
        wanted += [("sensor", (FAULTS[turn],)), *(("single", (law,)) for law in SINGLES[turn])]
        wanted += [*(("double", pair) for pair in PAIRS[turn]), ("open", (OPEN[turn],))]
        for number in np.random.default_rng([SEEDS["kinds"], turn]).permutation(len(wanted)):
            found.append(_case(machine, len(found), *wanted[int(number)], turn=int(number)))
    return tuple(found)


def _case(machine: str, index: int, group: Group, laws: tuple[str, ...], turn: int) -> Case:
    seed = SEEDS["kinds"]
    rng = np.random.default_rng([seed, index, 0])
    level = (2, 1, 3)[turn % 3]
    hidden = () if group == "sensor" else laws
    effects = tuple(hiding_of(law, index + k, level, rng) for k, law in enumerate(hidden))
    return Case(
        name=f"k{index + 1:03d}",
        index=index,
        seed=seed,
        group=group,
        effects=effects,
        level=level if effects else -1,
        sensors=sensors_of(SENSOR_COUNTS[TARGET[0]], 2 * turn),
        snr_db=SNRS_DB[TARGET[1]],
        speeds_hz=KINDS[machine].speeds_hz,
        baseline=True,
        fault=laws[0] if group == "sensor" else None,
        machine=machine,
    )
