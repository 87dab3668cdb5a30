"""Section of the page on data never fitted: its words and its table."""

from __future__ import annotations

import math

from reconcile.report.markup import Markup, tag
from reconcile.report.named import percent, readable
from reconcile.report.sections import table
from reconcile.report.words import distance, gain, known, reached, strongest_placebo
from reconcile.verdict import HeldOut

INTERVAL = "Line through a bar's end: 90 % interval."
RETUNED = "Retuned: the model's own numbers moved instead."
BLACK_BOX = "Black box: a correction with as many free numbers and no physics."
PLACEBOS = "Placebos: other effects and places in the effect's stead, the middle {strongest}of them."
BEATS = "An effect that is there should beat all."
PERFECT = (
    "Expected of a perfect model: what drift between the recordings and noise usually leave even to it; where this "
    "machine drifted less than others of its kind, more than that is reached."
)
SAYS_NOTHING = ("", "the part that was held out")
"""What was held out, said without saying it."""


METRICS = {
    "NRMSE": "the error's root mean square over the spread of what was measured: 0 % is perfect, 100 % no better than "
    "the mean",
    "log": "how far the predicted and the measured spectrum are apart in dB, root mean square",
}
"""What a measure is, by a word of its name."""


def meaning(found: HeldOut) -> str:
    """What the measure is, behind a comma; nothing of one that is not known."""
    return next((f", {words}" for word, words in METRICS.items() if word in found.metric), "")


def held_out_table(found: HeldOut | None) -> Markup:
    """Figures of the validation against the rivals."""
    if found is None:
        return Markup("")
    rows = [
        ("without it", distance(found.before, found.unit), "–"),
        ("with it", distance(found.after, found.unit), gain(found)),
    ]
    rivals = (
        ("retuned parameters only", found.retuned),
        ("black box with as many parameters", found.black_box),
        ("placebo: the middle of wrong ones", found.placebo),
    )
    rows += [(name, "", percent(share)) for name, share in rivals if known(share)]
    best = strongest_placebo(found)
    if best is not None:
        rows.append((f"strongest placebo: {readable(f'{best.term}@{best.site}')}", "", percent(best.gain)))
    expected = reached(found)
    if expected is not None:
        rows.append(("expected of a perfect model: drift and noise stay", "", percent(expected)))
    metric = found.metric.replace("_", " ")
    marked = [False, True, *[False] * (len(rows) - 2)]
    return Markup(
        tag("p", f"Measure: {metric}{meaning(found)}.") + table(("model", metric, "gain over without it"), rows, marked)
    )


def held_out_words(found: HeldOut | None) -> Markup:
    """What was held out, and how to read the bars."""
    if found is None:
        return Markup("")
    held = tag("p", f"Held out: {found.held}.") if found.held not in SAYS_NOTHING else Markup("")
    if not math.isfinite(found.gain_low):
        sure = Markup("")
    elif found.gain_low > 0.0:
        sure = tag("p", "The whole interval is above zero: the model does foretell such data better with it.")
    else:
        sure = tag("p", "The interval reaches zero: on data never fitted it is not sure that it helps.", css="note")
    return Markup(held + sure + _unbeaten(found) + _how_to_read(found))


def _how_to_read(found: HeldOut) -> Markup:
    """What the bars are, of those that are drawn."""
    strongest = "" if strongest_placebo(found) is None else "and the strongest "
    placebos = PLACEBOS.format(strongest=strongest)
    rivals = ((RETUNED, found.retuned), (BLACK_BOX, found.black_box), (placebos, found.placebo))
    shown = [words for words, share in rivals if known(share)]
    parts = [*([INTERVAL] if math.isfinite(found.gain_low) else []), *shown, *([BEATS] if shown else [])]
    parts += [PERFECT] if reached(found) is not None else []
    return tag("p", " ".join(parts), css="muted") if parts else Markup("")


def _unbeaten(found: HeldOut) -> Markup:
    """Which rivals the effect does not beat by more than its interval."""
    rivals = {"retuned parameters": found.retuned, "the black box": found.black_box}
    best = strongest_placebo(found)
    if best is not None:
        rivals[f"the strongest placebo, {readable(f'{best.term}@{best.site}')}"] = best.gain
    elif found.placebo is not None:
        rivals["the placebo"] = found.placebo
    near = {n: g for n, g in rivals.items() if g is not None and math.isfinite(g) and g >= found.gain_low}
    if not near or not math.isfinite(found.gain_low):
        return Markup("")
    named = ", ".join(f"{name} ({percent(value)})" for name, value in near.items())
    text = f"Not beaten by more than the interval: {named}. What it gains is no proof that it is this effect."
    return tag("p", text, css="note")
