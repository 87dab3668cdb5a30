"""docs/proof.md from the stored summaries: what was asked, what was reached with its interval, every failure."""

from __future__ import annotations

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import matplotlib as mpl

mpl.use("Agg")
import matplotlib.pyplot as plt

from proof.plan import COUNTS, FIRST, OTHERS
from proof.score.one import Score
from proof.score.table import failures
from proof.unknown import OPEN
from proof.visible import stored, told

TITLES = {
    "null": "nothing missing",
    "misset": "nothing missing, parameters mis-set",
    "sensor": "sensor fault",
    "single": "one effect",
    "double": "two effects",
    "open": "effect that no library has",
    "no_baseline": "one effect, no baseline",
    "ambiguous": "causes that look alike",
}
TARGETS = (
    ("null", "alarm", "false alarms on nulls at most 8/300"),
    ("single", "mechanism", "mechanism right at least 95 %"),
    ("single", "place", "with place at least 85 %"),
    ("single", "top_three", "among the first three at least 97 %"),
    ("open", "unknown_flagged", "unknown effects flagged at least 80 %"),
    ("single", "false_unknown", "false unknowns at most 5 %"),
    ("double", "both", "both of a pair at least 70 %"),
    ("double", "false_name", "a name beside the pair's"),
    ("single", "severity_covered", "90 % intervals cover 85-95 %"),
    ("single", "beats_black_box", "beats the black box in at least 80 %"),
    ("single", "gain_above_half", "spectral distance cut by at least 50 % where it can be"),
    ("single", "placebo_improves", "placebos (the median of each case's) improve in at most 5 %"),
    ("ambiguous", "cannot_tell", '"cannot tell" in at least 90 % of look-alikes'),
)
SECTIONS = {
    "fresh": "No version of the engine had met these before their run.",
    "crossing": "No version of the engine had met these before their run: five speeds with one, three and eight "
    "sensors at 30, 10 and 20 dB, twelve of the split's fifteen. l008 and l022 have each set a rule since.",
    "phases": "No version of the engine had met these before their run: one speed and three sensors at 30 dB, one or "
    "three speeds and eight sensors, and one pair at the target condition. l041 and l073 have each set a rule since.",
    "again": "The same 28 with the engine that compares phases and nominates by single lines too: none is met for the "
    "first time; l056, l069 and l093 have each set a rule.",
    "seen": "Of those looked at before, the ones that were run again: one that an earlier engine got right, six not.",
    "sound": "Cases in which nothing is missing, at all conditions of up to three speeds. All had been looked at; s106 "
    "has set two rules.",
    "further": "Not met before by the engine of that day; l044 and l048 are at the target condition.",
    "rerun": 'The five of "Further" with the later engine, two rules of which came from l077 and s106.',
    "alone": "These had been looked at before this run; there is no baseline, or the nominal machine is mis-set.",
    "later": "",
    "sealed": "",
    "dev": "Cases for development.",
}
"""Of the page, each from one stored summary: of a split, or of a part of one."""
METHOD = """# Proof: concealed cases

`python -m proof page` writes this page from the stored results; `python -m proof run` and `score` make those. The
cases come from a simulator that shares no code with `sim/` (an import rule checks it): classical Runge-Kutta with a
fixed step, its own tooth-pair stiffness, Hunt-Crossley contact with LuGre friction in a loose fit, trapezoid pits met
by single balls, raised-cosine tooth cracks, supports with rounded corners. Its healthy machine is checked against the
reference solutions. Every case has its own hidden parameters (within 10 %), a drift between baseline and test (0.15
of that spread), speed that wanders by 0.1 to 0.5 % and is up to 0.5 % off the stated one, cage slip up to 2 %, a
transfer path and gain for every sensor, and coloured noise.

The engine is called by its command line on an anonymised copy: nominal machine, recordings, nothing else. The labels'
salted hashes were committed (`proof/seals`) before the run. A seal shows that no label was changed; who has the seed
can make the cases again. What was not detected stays in the denominators of detection, mechanism, place, ranks, pairs
and "beats the black box"; intervals of sizes, placebos and distances are counted where there are any. An effect or a
pair is right only if nothing else is named. Intervals are Wilson's, 90 %.

**Design.** {n_dev} cases for development, {n_sealed} sealed, {n_later} sealed later. The full crossing of one effect
would be {laws} laws x 4 severities x 27 combinations of (1, 3, 8) sensors, (30, 20, 10) dB and (1, 3, 5) speeds =
{crossing} cases; {n_single} are planned: half at the target condition (3 sensors, 20 dB, 3 speeds, baseline), half
over the rows of an orthogonal array. A case that was looked at has served: it counts at its first run, with the
engine of that day, and is development from then on. First runs at the target condition (`--budget quick`, physics
1.2.0):

| sealed cases | engine | mechanism and place | nulls | open set |
|---|---|---|---|---|
| up to s040 | families of features | 0 of 11 | - | - |
| s041 to s074 | and machines that agree with the baseline | 1 of 6 | - | - |
| s078 to s146 | and impacts, single mesh lines, mean turns | 6 of 14 | 0 of 5 alarms | 0 of 5 flagged |
| s147 to s181 | and adequacy by single lines, sizes from the atlas | 3 of 8 | 0 of 4 alarms | 1 of 2 flagged |
| s182 to s202 | and machine and effect fitted together | 1 of 5 | 0 of 1 alarms | 1 of 3 flagged |
| l002 to l051 (split `later`) | and first sidebands of their own | 5 of 11 | 0 of 5 alarms | 1 of 5 flagged |
| l052 to l094 | and nulls that the metric has not seen | below | below | below |

Together with "Fresh" below, first runs at the target condition name and place 22 of 67 effects (33 %, 24 to 43), most
of them with engines that could less. Of the 14 sound machines of the split `later`, at all conditions, two alarmed at
their first run (l008, l077; 14 %, 5 to 35); each has set a rule since, so no later figure of theirs counts.

Below are cases that need no atlas but those of the nominal machine at up to three speeds (one has an atlas of its own),
all with the engine of the last row: of the split `later` those at the target condition with whose names in view nothing
of the engine was chosen, and those that had been looked at; of `sealed` those without a baseline and one whose nominal
machine is mis-set; twelve at five speeds ("Crossing"); and twelve with the engine that compares phases between sensors
([decision](decisions/reconcile-phases.md), "Phases"), which no other section has. Without a baseline further eight
healthy cases were run on their tests alone while the rule for that was made: four alarmed, and with the rule none of
these four does.

**Since the first runs**, with engine `6c6ea6d114b7` ("Fresh"), the rules have changed: the best of the effects that
the observation chose is judged as the best of all; impacts at the lines of several parts stand beside each other; a
place whose effects lead all elsewhere is no unknown physics (l093 and s154 set that); a speed is doubted by the teeth;
and, after two sound machines had alarmed with engine `ef79a64e454e` ("Further": l077; s106), impacts at a single point
must exceed what sound machines show, and lines without a pattern count from 1e-4. "Seen", "Rerun" and "Alone" are runs
with all of these; how often cases that nobody has met are right is what "Fresh", "Further", "Crossing" and "Phases"
say. Two rules are younger than all but the last of them: a name is taken back where the machine with it,
simulated, is no nearer to the recorded levels than without it (l008: 3.92 dB of 3.49; it touches no other case shown
here), and the place of an unknown force is told among supports alone, as `force` does (l022 would be right by it, no
other changes). Since "Phases" a lead alone does not carry what fits worse than nearly all known effects and explains
next to nothing (l041), teeth refine the speed where they are sure (l073; a line beside the shaft's own had led it 2.8 %
away; l041, run again, names the right race), and single lines count at one operating point from three sensors on,
where phases are compared. What single lines of the machines that agree with the baseline make plausible is simulated
too since then, in turn with what machines of the kind do: l078, named before phases and unknown physics with them, is
named again. Recordings that did not turn alike, another filter and a sensor mounted anew are told before or beside
the rules and touch no case here. "Again" and "Sound" were run with phases and this nomination, and show what it won
and lost of cases that had been looked at: l093 and l078 named, but two outer races named as inner ones (l056, l069:
beside their own lines, with none of the inner race's), unknown physics told as a set (l068), and a sound machine with
eight sensors that alarms (s106). Two rules came of these: the silence of what balls would strike counts where they
strike another part for sure (l056 and l069, run again, are named rightly, 41 before 26 and 37 before 27; l013, l028,
l052, l087 and l089 keep their answers), and a set whose best effect hardly stands out must come nearer by simulation
as a name must (s106, run again: not decidable; l068 stays a set). Older
changes of the engine (run-ups without pulses, standstills and two motions without a force are told or refused, no
size from a channel that is cut off, words of messages) act before or beside the rules: s122, l087 and l069, run again
with engine `e14fd6f7b232`, gave the same causes, scores and gains (read off once).

**Placebos** are the right effect elsewhere and other effects at the right place, of which at least six machines were
simulated: these are the likeliest rivals, and move some of the same bands. Every one is in the report with its gain.

**How much there is to see** stands behind each failure (`python -m proof visible`, made with everything hidden known,
which no engine has): by how many decibels, root mean square over the bins above the noise, the effect moves the
test's spectrum and the drift since the baseline alone moves it, and the share of bins that the effect lifts by 6 dB
over signal and noise. Where drift is the larger, only the effect's pattern can tell it; where a bin in a thousand is
new, nearly nothing is there.

**In the test command.** Six further cases, of neither split, run from the generator to the verdict in `make test`
(`tests/proof/test_small_cases.py`): nothing, four strong effects and a sensor fault at 30 Hz, three sensors, 20 dB,
with 12 effects to choose from: the easy end. Their atlas stands beside them (`tests/proof/atlas`); where physics or
atlas changed they fail and name the command that makes it again, `make proof-atlas`.
"""


def write_page(docs: Path, results: Path) -> Path:
    """Write the page and its pictures; a split without stored summary has no section."""
    laws = len(FIRST) + len(OTHERS) + len(OPEN)
    single = COUNTS["sealed"]["single"] + COUNTS["sealed"]["open"]
    counts = {f"n_{split}": sum(groups.values()) for split, groups in COUNTS.items()}
    parts = [METHOD.format(laws=laws, crossing=laws * 4 * 27, n_single=single, **counts)]
    for section in SECTIONS:
        kept = results / f"{section}.json"
        if not kept.exists():
            continue
        summary = json.loads(kept.read_text(encoding="utf-8"))
        picture = docs / "proof" / f"{section}.svg"
        picture.parent.mkdir(parents=True, exist_ok=True)
        draw(summary, picture)
        parts.append(_split(section, summary, results))
    target = docs / "proof.md"
    docs.mkdir(parents=True, exist_ok=True)
    target.write_text("\n".join(parts), encoding="utf-8")
    return target


def _split(section: str, summary: Mapping[str, Any], results: Path) -> str:
    split = summary["split"]
    scores = [Score(**(s | {"laws": tuple(s["laws"])})) for s in summary["scores"]]
    rows = ["| target (at the target condition) | reached |", "|---|---|"]
    rows += [f"| {sentence} | {_rate(summary, 'target', group, measure)} |" for group, measure, sentence in TARGETS]
    wide = ["| group | cases run | verdict right | mechanism | place |", "|---|---|---|---|---|"]
    for group, title in TITLES.items():
        row, planned = summary["groups"]["all"].get(group), COUNTS[split].get(group, 0)
        if row is not None or planned:
            cells = [_rate(summary, "all", group, m) for m in ("verdict_right", "mechanism", "place")]
            wide.append(f"| {title} | {row['alarm']['n'] if row else 0} of {planned} | {' | '.join(cells)} |")
    error, gain = summary["severity_error"], summary["gain"]
    seen = stored(results / f"visible-{split}.json")
    listed = [f"* {line}{told(seen.get(line.split()[0]))}" for line in failures(scores)] or ["* none"]
    return "\n".join(
        [
            f"\n## {section.capitalize()}: {summary['cases']} cases of split `{split}`\n",
            f"{SECTIONS[section]} Engine `{summary.get('engine', 'unknown')}` (hash of its source).\n",
            f"`make proof SPLIT={split} CASES={','.join(s.name for s in scores)}` runs them again.\n",
            *rows, "", *wide, "",
            f"Severity error (target: median at most 0.1, 90th percentile 0.3): {_quantiles(error)}.",
            f"Core-seconds (bar 120): {_quantiles(summary['core_seconds'], '.3g')}.",
            f"Held-out gain: {_quantiles(gain)}. Gain of a perfect model, since",
            f"drift between the recordings and noise stay: {_quantiles(summary['ceiling'])}.\n",
            f"![curves](proof/{section}.svg)\n", "### Every case that is wrong in something\n", *listed, "",
        ]
    )  # fmt: skip


def _rate(summary: Mapping[str, Any], part: str, group: str, measure: str) -> str:
    found = summary["groups"][part].get(group, {}).get(measure)
    if found is None:
        return "-"
    share = 100 * found["hits"] / found["n"]
    return f"{found['hits']}/{found['n']} = {share:.0f} % ({100 * found['low']:.0f} to {100 * found['high']:.0f})"


def _quantiles(found: Mapping[str, float], form: str = ".2g") -> str:
    if not found["n"]:
        return "none measured"
    return f"median {found['median']:{form}}, 90th percentile {found['p90']:{form}} (n = {found['n']})"


def draw(summary: Mapping[str, Any], path: Path) -> None:
    """Rates of single effects over severity, noise, sensors and speeds."""
    axes = {"level": "severity (0 faint, 3 strong)", "snr_db": "SNR, dB", "sensors": "sensors", "speeds": "speeds"}
    with mpl.rc_context({"svg.hashsalt": "proof", "font.size": 8}):
        figure, panels = plt.subplots(1, len(axes), figsize=(11, 2.8), sharey=True)
        for panel, (axis, label) in zip(panels, axes.items(), strict=True):
            for measure, title in (("alarm", "detected"), ("mechanism", "mechanism right"), ("place", "and place")):
                rows = sorted((float(v), r) for v, r in summary["curves"][axis][measure].items())
                if not rows:
                    continue
                share = [r["hits"] / max(1, r["n"]) for _, r in rows]
                low = [max(0.0, s - r["low"]) for s, (_, r) in zip(share, rows, strict=True)]
                high = [max(0.0, r["high"] - s) for s, (_, r) in zip(share, rows, strict=True)]
                places = list(range(len(rows)))
                panel.errorbar(places, share, yerr=[low, high], marker="o", capsize=2, label=title)
                panel.set_xticks(places, [f"{v:g}" for v, _ in rows])
            panel.set_xlabel(label)
            panel.set_ylim(0, 1.02)
        panels[0].set_ylabel("share, 90 % interval")
        if panels[0].get_legend_handles_labels()[1]:
            panels[0].legend()
        figure.tight_layout()
        figure.savefig(path, metadata={"Date": None})
        plt.close(figure)
