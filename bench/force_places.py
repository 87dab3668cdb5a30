"""`python -m bench.force_places`: whether a free force by lines finds its place, 25 s a made gearbox on one core.

On the gearboxes of `bench.forces` acts a law or a sum of sines at one of four supports, heard by three sensors at three
speeds. Asked is where, in two ways: by what a force at one support alone explains, with the engine's likelihood of each
line, and by forces at all supports that share lines, of which few may act (group lasso), and how often each is among
the chosen in halves of the lines (stability selection: Meinshausen and Buhlmann, J. R. Stat. Soc. B 72, 2010, 417-473).
"""

from __future__ import annotations

import os

for _name in ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS"):
    os.environ[_name] = "1"  # must be set before numpy is imported

import argparse  # noqa: E402
from collections.abc import Mapping  # noqa: E402
from dataclasses import dataclass  # noqa: E402

import numpy as np  # noqa: E402

from bench.forces import Kept, gearbox, made, setting_of  # noqa: E402
from reconcile.atlas.plan import atlas_plan  # noqa: E402
from reconcile.calibrate.uncertain import uncertain_numbers  # noqa: E402
from reconcile.judge.changes import healthy_of  # noqa: E402
from reconcile.machine.added_power import Reached, machines_like, reached  # noqa: E402
from reconcile.machine.force import likely_squares  # noqa: E402
from reconcile.machine.setting import Setting  # noqa: E402
from signals.series import FloatArray  # noqa: E402
from sim.core.errors import SidebandError  # noqa: E402

AHEAD = 10.0
"""Log likelihood by which the best place leads, from which on it would be told."""
STANDS_OUT = 2.5
"""Deviations by which a line must have risen at one sensor to be asked."""
MODEL_SHARE = 0.5
"""Error of what a line gained, as a share of it."""
PENALTIES = np.geomspace(0.95, 0.3, 8)
"""Of the largest at which any place acts."""
HALVES, STEPS, MOST_PLACES = 40, 80, 2.0
"""Halves of the lines that are drawn, steps of the solver, and how many places may act on the mean at a penalty."""


@dataclass(frozen=True, kw_only=True)
class Lines:
    """Lines that rose, as the channels hear them: `gained` (L, C) and, by a force at each place in each way,
    `heard` (L, C, places), both over the error."""

    gained: FloatArray
    heard: FloatArray


def by_one(heard: Mapping[str, list[Reached]]) -> dict[str, float]:
    """Log likelihood of a free force at each support alone over none, all lines and operating points together."""
    return {site: sum(float(likely_squares(one.heard).sum()) for one in own) for site, own in heard.items()}


def lines_of(heard: Mapping[str, list[Reached]]) -> Lines:
    """Of all operating points, each line's error made one."""
    gained, by_places = [], []
    sites = list(heard)
    for at_point in zip(*heard.values(), strict=True):
        own = at_point[0].heard
        rise = own.test - own.before
        error = np.hypot(own.deviation, MODEL_SHARE * np.maximum(rise, 0.0))
        asked = (rise > STANDS_OUT * own.deviation).any(axis=0)
        each = [np.nan_to_num(one.heard.response).mean(axis=0) for one in at_point]
        response = np.stack(each, axis=-1) / error[..., None]
        gained.append((rise / error).T[asked])
        by_places.append(np.moveaxis(response, 1, 0)[asked])
    return Lines(gained=np.concatenate(gained), heard=np.concatenate(by_places).reshape(-1, rise.shape[0], len(sites)))


def chosen(lines: Lines, rows: np.ndarray) -> np.ndarray:
    """(penalties, places): whether any force acts there, by forces that are not negative (accelerated proximal
    gradient), every line and every place's response counting alike."""
    heard = lines.heard[rows]
    heard = heard / np.maximum(np.linalg.norm(heard, axis=1, keepdims=True), 1e-30)
    gained = lines.gained[rows] / np.maximum(np.linalg.norm(lines.gained[rows], axis=1, keepdims=True), 1e-30)
    square, met = np.einsum("lcp,lcq->lpq", heard, heard), np.einsum("lcp,lc->lp", heard, gained)
    step = 1.0 / max(float(np.linalg.eigvalsh(square)[:, -1].max()), 1e-30)
    largest = float(np.linalg.norm(np.maximum(met, 0.0), axis=0).max())
    found, force = [], np.zeros(met.shape)
    for penalty in PENALTIES * largest:
        ahead, pace = force.copy(), 1.0
        for _ in range(STEPS):
            moved = np.maximum(ahead - step * (np.einsum("lpq,lq->lp", square, ahead) - met), 0.0)
            size = np.linalg.norm(moved, axis=0)
            moved = moved * np.maximum(1.0 - step * penalty / np.maximum(size, 1e-30), 0.0)
            faster = 0.5 * (1.0 + np.sqrt(1.0 + 4.0 * pace**2))
            ahead, force, pace = moved + (pace - 1.0) / faster * (moved - force), moved, faster
        found.append(np.linalg.norm(force, axis=0) > 0.0)
    return np.array(found)


def stable(lines: Lines, rng: np.random.Generator) -> FloatArray:
    """(places,): share of halves of the lines in which a place is chosen, at penalties that choose few."""
    count = lines.gained.shape[0]
    if not lines.heard.any():
        return np.zeros(lines.heard.shape[2])
    halves = [rng.choice(count, max(2, count // 2), replace=False) for _ in range(HALVES)]
    share = np.mean([chosen(lines, rows) for rows in halves], axis=0)
    few = share.sum(axis=1) <= MOST_PLACES
    return np.asarray(share[few].max(axis=0) if few.any() else share[0])


def asked(setting: Setting) -> dict[str, list[Reached]]:
    """What the channels hear of a force at each support at each operating point."""
    machines, healthy = machines_like(setting), [healthy_of(bank, setting.plan) for bank in setting.banks]
    found = {}
    for bearing in setting.machine.bearings:
        own = [reached(setting, k, bearing.name, machines, healthy) for k in range(len(setting.data))]
        found[bearing.name] = [one for one in own if one is not None]
    return found


def main() -> None:
    """Make, ask, count."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--first", type=int, default=0, help="number of the first gearbox")
    parser.add_argument("--machines", type=int, default=32, help="how many are made (some do not run)")
    given = parser.parse_args()
    nominal = gearbox()
    plan, keeper = atlas_plan(nominal, uncertain_numbers(nominal), (), seed=0), Kept()
    rows = []
    for number in range(given.first, given.first + given.machines):
        try:
            one = made(number)
        except SidebandError as error:
            print(f"{number}: does not run ({str(error)[:60]})", flush=True)
            continue
        heard = asked(setting_of(one, plan, keeper))
        alone, lines = by_one(heard), lines_of(heard)
        first, second = sorted(alone, key=lambda site: -alone[site])[:2]
        share = stable(lines, np.random.default_rng(number))
        sparse = list(heard)[int(np.argmax(share))]
        lead = alone[first] - alone[second] > AHEAD
        rows.append((first == one.site, lead, lead and first == one.site, sparse == one.site))
        print(f"{number}: {one.kind} at {one.site}: alone {first} (ahead by {alone[first] - alone[second]:.0f}), "
              f"sparse {sparse} ({share.max():.2f}), {lines.gained.shape[0]} lines rose", flush=True)  # fmt: skip
    right, led, surely, sparsely = np.sum(rows, axis=0)
    print(f"{len(rows)} gearboxes; right place first by one force alone {right}, where it leads {surely} of {led}; by "
          f"the place chosen most often {sparsely}; by chance {len(rows) / 4:.0f}")  # fmt: skip


if __name__ == "__main__":
    main()
