"""`python -m bench.atlas_steps`: what the steps of an atlas cost and what they change, 5 minutes on one core.

Two draws of every effect on the gearbox of the paper and 16 sound machines, at 30 Hz, with several shares of the steps
that a user's simulation takes and tolerances. Printed are processor seconds and, against the first row, how far clear
lines (down to 40 dB below the strongest of the channel) and shape bands differ, dB.
"""

from __future__ import annotations

import os

for _name in ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS"):
    os.environ[_name] = "1"  # must be set before numpy is imported

import time  # noqa: E402
from dataclasses import replace  # noqa: E402

import numpy as np  # noqa: E402

import reconcile.atlas.run as atlas_run  # noqa: E402
from reconcile.atlas.bank import Bank, make_bank  # noqa: E402
from reconcile.atlas.candidates import candidates  # noqa: E402
from reconcile.atlas.plan import AtlasPlan, Draw, Point, atlas_plan, with_tooth_pairs  # noqa: E402
from reconcile.calibrate.uncertain import uncertain_numbers  # noqa: E402
from signals.series import FloatArray  # noqa: E402
from sim.presets import preset  # noqa: E402

POINT = Point(speed_hz=30.0)
CHANNELS = ("resonator1.y.acceleration", "resonator2.y.acceleration", "resonator3.y.acceleration")
WAYS = ((2.0, 1e-3), (1.0, 1e-3), (1.0, 1e-2), (2 / 3, 1e-3), (2 / 3, 1e-2), (2 / 3, 5e-2))
"""Share of the steps and tolerance of each row."""
CLEAR = 1e-4
"""Power, as a share of the strongest line's, from which on a line is compared."""
SOUND, EACH = 16, 2


def plan() -> AtlasPlan:
    """The draws that are compared."""
    machine = with_tooth_pairs(preset("paper"))
    full = atlas_plan(machine, uncertain_numbers(machine), candidates(machine), seed=0)
    effects: dict[str, list[Draw]] = {}
    for draw in full.draws:
        if draw.candidate is not None:
            effects.setdefault(draw.candidate.term, []).append(draw)
    sound = [d for d in full.draws if d.candidate is None and not d.twin][:SOUND]
    return replace(full, draws=(*sound, *(d for own in effects.values() for d in own[2 : 2 + EACH])))


def simulated(asked: AtlasPlan, share: float, rtol: float) -> tuple[float, Bank]:
    """Processor seconds and statistics with this share of the steps and this tolerance."""
    atlas_run.COARSER = share
    atlas_run.SETTINGS = replace(atlas_run.SETTINGS, rtol=rtol)
    started = time.process_time()
    bank = make_bank(asked, POINT, CHANNELS)
    return time.process_time() - started, bank


def _apart(one: FloatArray, other: FloatArray, used: np.ndarray) -> str:
    with np.errstate(divide="ignore", invalid="ignore"):
        off = np.abs(10.0 * np.log10(one / other))[used]
    middle, most, worst = np.quantile(off[np.isfinite(off)], (0.5, 0.95, 0.99))
    return f"{middle:.3f} {most:.3f} {worst:.3f}"


def main() -> None:
    """The table."""
    asked = plan()
    simulated(replace(asked, draws=asked.draws[:SOUND]), 1.0, 1e-3)  # kernels are loaded
    print(f"{len(asked.draws)} machines; dB apart: median, 95 %, 99 %")
    print("steps  tolerance  core s  ratio  lines              bands")
    first: tuple[float, Bank] | None = None
    for share, rtol in WAYS:
        seconds, bank = simulated(asked, share, rtol)
        first = first or (seconds, bank)
        clear = first[1].line > CLEAR * np.nanmax(first[1].line, axis=2, keepdims=True)
        lines, bands = _apart(bank.line, first[1].line, clear), _apart(bank.band, first[1].band, first[1].band > 0.0)
        print(f"{share:5.2f}  {rtol:9.0e}  {seconds:6.1f}  {seconds / first[0]:5.2f}  {lines}  {bands}", flush=True)


if __name__ == "__main__":
    main()
