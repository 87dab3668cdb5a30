"""Cases of rotors, all at the target condition: 22 of `rotors` to develop with, 22 of `rotors-later` to count.

Each split, half on either machine: five sound ones, three sensor faults, ten single effects, two pairs, two effects
that no library has. Laws are those that need no teeth and show on a shaft without torque.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from proof.plan import SEEDS, SNRS_DB, TARGET, Case, Group, Hiding, Split, hiding_of
from proof.rotors.machine import ROTORS

SENSORS = (("bearing1.y", "bearing2.y", "bearing1.x"), ("bearing1.y", "bearing2.y", "bearing2.x"))
LAWS = (
    "outer_pit", "loose_fit", "inner_pit", "imbalance", "loose_seat", "wider_clearance", "ball_pit", "extra_mode",
    "parallel_offset", "breathing_crack", "oil_film", "inner_waves", "outer_waves",
)  # fmt: skip
OFTEN = 6
"""So many of the first occur in both halves of a split; the others take turns."""
PAIRS = (
    ("outer_pit", "imbalance"), ("loose_fit", "inner_pit"), ("inner_pit", "loose_seat"), ("imbalance", "loose_fit"),
)  # fmt: skip
OPEN = ("cross_coupling", "free_knocks", "hysteretic_mount", "magnetic_pull")
FAULTS = ("swapped", "gain_change", "loose_sensor", "clipping", "mains_hum", "dropouts")
SITES = frozenset({"bearing1", "bearing2", "pinion", "input"})
"""Of a law's: those that a rotor has."""
SHARE = {"imbalance": 0.3, "parallel_offset": 0.3}
"""Of the gearboxes' severities: weight presses less than teeth do."""
SINGLES, NULLS = 10, 5


def rotors(split: Split) -> tuple[Case, ...]:
    """All cases of `rotors` or `rotors-later`, in an order that says nothing."""
    later = split == "rotors-later"
    wanted: list[tuple[Group, tuple[str, ...]]] = [("null", ())] * NULLS
    wanted += [("sensor", (FAULTS[k + 3 * later],)) for k in range(3)]
    others = np.roll(LAWS[OFTEN:], -4 * later)[: SINGLES - OFTEN]
    wanted += [("single", (str(law),)) for law in (*LAWS[:OFTEN], *others)]
    wanted += [("double", PAIRS[k + 2 * later]) for k in range(2)]
    wanted += [("open", (OPEN[k + 2 * later],)) for k in range(2)]
    order = np.random.default_rng(SEEDS[split]).permutation(len(wanted))
    return tuple(_case(split, place, *wanted[int(n)], turn=int(n)) for place, n in enumerate(order))


def _case(split: Split, place: int, group: Group, laws: tuple[str, ...], turn: int) -> Case:
    seed = SEEDS[split]
    rng = np.random.default_rng([seed, place, 0])
    machine = tuple(ROTORS)[(turn + (split == "rotors-later")) % 2]
    level = (2, 1, 3)[turn % 3]
    hidden = () if group == "sensor" else laws
    effects = tuple(_hiding(law, turn + k, level, rng) for k, law in enumerate(hidden))
    return Case(
        name=f"r{place + 1 + 100 * (split == 'rotors-later'):03d}",
        index=place,
        seed=seed,
        group=group,
        effects=effects,
        level=level if effects else -1,
        sensors=SENSORS[turn // 2 % 2],
        snr_db=SNRS_DB[TARGET[1]],
        speeds_hz=ROTORS[machine].speeds_hz,
        baseline=True,
        fault=laws[0] if group == "sensor" else None,
        machine=machine,
    )


def _hiding(name: str, number: int, level: int, rng: np.random.Generator) -> Hiding:
    """One effect at a site that a rotor has."""
    while True:
        found = hiding_of(name, number, level, rng)
        if found.site in SITES:
            break
    return replace(found, value=float(f"{found.value * SHARE.get(name, 1.0):.4g}"))
