"""`python -m proof.made`: the engine on made rigs of which it gets a drawing and recordings; the page of its answers.

Case N of a kind is made of the seed N alone; what is hidden goes round in turn. Every answer is counted, none is left
out.
"""

from __future__ import annotations

import argparse
import json
import subprocess
import sys
import tempfile
from collections import Counter
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from tqdm import tqdm

from proof.engine_id import engine_id
from proof.made.rigs import KINDS, FloatArray, Rig, rig
from proof.made.signals import Hidden, heard, hidden
from proof.run import Engine
from proof.score.one import QUIET

TEETH = ("missing_tooth", "tooth_crack", "tooth_spall")
PITS = {"outer": ("outer_spall",), "inner": ("inner_spall",), "ball": ("ball_spall",), "tooth": TEETH}
ANSWERS = ("right", "among others", "elsewhere", "quiet", "an alarm", "failed")
FIRST, COUNT = 1000, 60


def main(argv: Sequence[str] | None = None) -> int:
    """Run the cases, print the table, and write the page if asked."""
    parser = argparse.ArgumentParser(prog="proof.made", description=__doc__)
    parser.add_argument("--first", type=int, default=FIRST, help="seed of the first case of each kind")
    parser.add_argument("--count", type=int, default=COUNT, help="cases of each kind")
    parser.add_argument("--alone", action="store_true", help="without baselines")
    parser.add_argument("--docs", type=Path, help="also write the table to this page")
    given = parser.parse_args(argv)
    seeds = range(given.first, given.first + given.count)
    engine, rows, wrong = Engine(), Counter[tuple[str, str, str]](), []
    for kind, seed in tqdm([(kind, seed) for kind in KINDS for seed in seeds], desc="made", disable=None):
        what, report, refused = answered(engine, kind, seed, with_baseline=not given.alone)
        found = worth(what, report)
        rows[kind, what.word, found] += 1
        if found in ANSWERS[2:] and not (found == "quiet" and what.word in ("nothing", "load")):
            said = refused if report is None else report["sentence"]
            wrong.append(f"* {kind} {seed}, {what.word} {what.site} ({what.strength:.2g}), {found}: {said}")
    text = page(rows, wrong, given.first, given.count, alone=given.alone)
    sys.stdout.write(text)
    if given.docs is not None:
        given.docs.write_text(text, encoding="utf-8")
    return 0


def made(kind: str, seed: int) -> tuple[Rig, Hidden, FloatArray, FloatArray]:
    """Rig, what is hidden, baseline and test (sensors, samples)."""
    rng = np.random.default_rng((KINDS.index(kind), seed))
    built = rig(kind, rng)
    what = hidden(built, seed, rng)
    return built, what, heard(built, Hidden(word="nothing"), rng), heard(built, what, rng)


def answered(
    engine: Engine, kind: str, seed: int, *, with_baseline: bool
) -> tuple[Hidden, Mapping[str, Any] | None, str]:
    """What is hidden in a case, the report on it, None where there is none, and then why."""
    built, what, baseline, test = made(kind, seed)
    with tempfile.TemporaryDirectory(prefix="made-") as temporary:
        folder = Path(temporary)
        (folder / "machine.json").write_text(json.dumps(built.drawing()), encoding="utf-8")
        _write(folder, "test_1", built, test, "unknown")
        if with_baseline:
            _write(folder, "baseline_1", built, baseline, "baseline")
        command = engine.call(folder / "machine.json", folder, folder / "out")
        try:
            done = subprocess.run(command, capture_output=True, text=True, timeout=engine.timeout_s, check=False)
        except subprocess.TimeoutExpired:
            return what, None, f"no answer within {engine.timeout_s:.0f} s"
        stored = folder / "out" / "report.json"
        if stored.exists():
            return what, json.loads(stored.read_text(encoding="utf-8")), ""
        return what, None, (done.stderr.strip().splitlines() or ["no report"])[-1]


def _write(folder: Path, stem: str, built: Rig, samples: FloatArray, condition: str) -> None:
    np.savez(folder / f"{stem}.npz", data=samples.astype(np.float32))
    near = [built.bearings[k % len(built.bearings)].name for k in range(built.sensors)]
    channels = [
        {
            "name": f"a{k}",
            "column": f"data[{k},:]",
            "quantity": "acceleration",
            "unit": "m/s^2",
            "location": site,
            "axis": "y",
        }
        for k, site in enumerate(near)
    ]
    document = {
        "sampling_rate_hz": built.rate_hz,
        "channels": channels,
        "operating": {"shaft": built.shafts[0], "speed_hz": built.speed_hz},
        "condition": condition,
        "data": f"{stem}.npz",
    }
    (folder / f"{stem}.json").write_text(json.dumps(document), encoding="utf-8")


def worth(what: Hidden, report: Mapping[str, Any] | None) -> str:
    """One of `ANSWERS`: right is the one part alone, named or the only site of a set of its kind."""
    if report is None:
        return "failed"
    if report["verdict"] in QUIET:
        return "quiet"
    if what.word not in PITS:
        return "an alarm"
    kinds = {(c["term"], c["site"]) for c in report["causes"]}
    wanted = {(term, what.site) for term in PITS[what.word]}
    parts = {site for term, site in kinds if term in (*TEETH, "outer_spall", "inner_spall", "ball_spall")}
    if not kinds & wanted:
        return "elsewhere"
    alone = parts == {what.site} and (what.word == "tooth" or kinds <= wanted)
    return "right" if alone else "among others"


def page(rows: Mapping[tuple[str, str, str], int], wrong: Sequence[str], first: int, count: int, *, alone: bool) -> str:
    """The answers by what was hidden, and every case that is wrong."""
    command = f"python -m proof.made --first {first} --count {count}" + (" --alone" if alone else "")
    lines = [
        "# Made rigs of which a drawing is known",
        "",
        f"Made by `{command}`, engine `{engine_id('kinematics')}`.",
        "Motors and gearboxes with other shafts, teeth, bearings, sensors, paths and speeds each (`proof/made`),",
        "labels up to 1 % off, speeds that wander by 0.03 to 0.3 %, balls that slip; strengths from hardly to be seen",
        "to gross, all counted. The generator shares no code with the product. Right is the one part alone: a defect",
        "with its place, or a set of tooth faults of one gear, which this level cannot tell apart.",
        "",
        f"| rig | hidden | cases | {' | '.join(ANSWERS)} |",
        "|---|---|---|" + "---|" * len(ANSWERS),
    ]
    for kind, word in sorted({(kind, word) for kind, word, _ in rows}):
        counted = [rows.get((kind, word, answer), 0) for answer in ANSWERS]
        lines.append(f"| {kind} | {word} | {sum(counted)} | {' | '.join(str(n or '') for n in counted)} |")
    lines += ["", "Not right, and not one of several:", "", *(wrong or ["none"])]
    return "\n".join(lines) + "\n"


if __name__ == "__main__":
    sys.exit(main())
