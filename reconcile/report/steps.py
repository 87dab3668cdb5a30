"""What each step found, in a reader's words: figures with what they mean, tables as tables."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from reconcile.report.markup import Markup, figure_text, tag
from reconcile.report.named import percent
from reconcile.report.sections import section, table
from reconcile.report.strict import Plain, plain
from reconcile.report.words import distance
from reconcile.verdict import Report

MOST_KEYS, MOST_ITEMS = 24, 12
TITLES = {
    "gate": "is the measurement sound",
    "sensor gate": "is the measurement sound",
    "observe": "speeds and features",
    "speed": "how fast it turned",
    "families": "lines of the parts in the envelopes",
    "calibrate": "machine and sensors fitted to what is sound",
    "nominate": "what might explain it",
    "judge": "how well the best does",
    "revised machine": "the revised machine, simulated",
    "validate": "tested on what was not fitted",
    "adequacy": "is anything left",
    "own time": "what keeps its own time",
    "own order": "what turns at an order of no part",
    "many turns": "what acts many times a turn",
}
WORDS = {
    "findings": "",
    "speeds": "",
    "found": "",
    "features": "features compared",
    "mode": "compared with",
    "median_gain_db": "median gain of the sensors, dB",
    "machines": "machines of the kind moved until they agree",
    "misfit_allowed": "from where on they are another machine's",
    "misfit_before": "own lines off before that, mean square in units of their variance",
    "misfit_after": "after it",
    "decided": "numbers the baseline decides",
    "undecided": "numbers it leaves open",
    "by_chance": "share of its variance that one without a part in them may lose",
    "strayed": "numbers beyond their stated spread",
    "farthest": "lines of the baseline that they are farthest from",
    "off_db": "above them by, dB",
    "length": "length of the change",
    "null_median": "of sound machines (median)",
    "p": "chance that a sound machine shows as much",
    "p_any": "by the most changed group of features",
    "p_best": "by the best candidate's pattern",
    "p_direct": "by impacts",
    "p_lines": "by single lines",
    "p_first": "by the pattern before a closer look",
    "p_turns": "by sidebands that rose together",
    "candidates": "effects at their places",
    "draws": "simulated machines with an effect",
    "misfit": "share of simulated known effects that fit better",
    "overdispersion": "scatter over what noise explains",
    "lines_left": "single lines left unexplained, over what is usual",
    "lines_left_elsewhere": "most of them in any one view",
    "lines_explained": "share of the single lines' change explained",
    "families_explained": "share of the change of families of lines explained",
    "fitted_with_the_machine": "fitted together with the machine",
    "heard_less_likely": "log evidence against places by which sensor hears which band",
    "bursts_set_aside": "log evidence of bursts of teeth, which does not speak against what else changed",
    "simulated_forms": "forms simulated",
    "level_change_db": "levels changed by, dB",
    "left_of_it_db": "left of it, dB",
    "heard": "deviations by channel",
    "z": "deviations of control orders",
    "band_hz": "band, Hz",
    "growth_db": "deeper than before by, dB",
    "present": "is there",
    "risen": "has risen",
    "hz": "distance from the teeth's lines at every speed, Hz",
    "turns": "distance from the teeth's lines, turns",
    "shaft": "of shaft",
    "speed_hz": "speed, Hz",
    "low_hz": "at least, Hz",
    "high_hz": "at most, Hz",
    "confidence": "confidence that its lines were found, of 1",
    "rival_hz": "or, as its lines fit that too, Hz",
    "rise_db": "risen by, dB",
    "elsewhere_db": "most at any other distance, dB",
    "nrmse": "error over the spread",
    "null_95": "of linear systems (95 %)",
}
SHARES = ("lines_explained", "families_explained", "share_on_left_out_blocks", "share_of_the_error_still_explained")
GAINS = ("gain", "over_placebo", "retuned", "black_box", "placebo")
DISTANCES = ("before", "after")
VALUES = {
    "mode": {"A": "baselines of this machine", "B": "the drawing, without a baseline"},
    "method": {
        "stated": "as stated, no line of the spectrum confirms it",
        "harmonics": "lines of the shaft",
        "tacho": "tacho",
    },
}


def stages(report: Report) -> Markup:
    """What each step found, folded away: the figures behind the answer."""
    rows, tables = [], []
    for stage in report.stages:
        found = plain(stage)
        if not isinstance(found, dict):
            continue
        name = str(found.pop("stage", None) or found.pop("name", "")).replace("_", " ")
        title = TITLES.get(name, name)
        wide = {k: v for k, v in found.items() if _records(v)}
        gained = name == "validate" and "gain" in found
        words = _told({k: _as_above(k, v, gained) for k, v in found.items() if k not in wide})
        if words:
            rows.append((title, words))
        tables += [Markup(tag("h3", title) + _table(v) + _there_or_risen(v)) for v in wide.values()]
    if not rows and not tables:
        return Markup("")
    note = "A small chance (p) speaks for a change; deviations are robust standard deviations."
    body = (tag("p", note, css="muted"), table(("step", "what it found"), rows), *tables)
    return section("How it was found", tag("details", tag("summary", "Steps and their figures"), *body))


def _as_above(key: str, value: Plain, gained: bool) -> Plain:
    """Shares as per cent, and figures of a validation (where it `gained`) as the sections have them that tell them too:
    one figure has one rounding."""
    values = value if isinstance(value, list) else [value]
    if not values or not all(isinstance(v, float) for v in values):
        return value
    numbers = [v for v in values if isinstance(v, float)]
    if key in SHARES or (gained and key in GAINS):
        return ", ".join(percent(v) for v in numbers)
    if gained and key in DISTANCES:
        return ", ".join(distance(v, "1") for v in numbers)
    return value


def _records(value: Plain) -> list[dict[str, Plain]]:
    """Rows of a table: a list of objects, or objects by name."""
    if isinstance(value, dict) and value and all(isinstance(v, dict) for v in value.values()):
        return [{"": name, **v} for name, v in value.items() if isinstance(v, dict)]
    if isinstance(value, list) and value and all(isinstance(v, dict) and len(v) > MOST_FLAT for v in value):
        return [v for v in value if isinstance(v, dict)]
    return []


THERE_OR_RISEN = (
    "Lines are there where they stand out more than chance makes them, as lines of this part; they have risen where "
    "they are deeper than the baselines', or without a baseline than sound machines', which noise and lines of others "
    "near them can do too. What has risen and is not there names no part by itself."
)
MOST_FLAT = 3
"""Objects of no more keys are told in a line: by their first value."""


def _table(value: Plain) -> Markup:
    records = _records(value)
    keys = [k for k in dict.fromkeys(k for r in records for k in r) if any(r.get(k) not in (None, {}) for r in records)]
    rows = [[_value(k, r.get(k)) for k in keys] for r in records]
    return table([_word(k) for k in keys], rows)


def _there_or_risen(value: Plain) -> Markup:
    """Why lines that have risen may not be there, under a table that says both."""
    if any("present" in r and "risen" in r for r in _records(value)):
        return Markup(tag("p", THERE_OR_RISEN, css="muted"))
    return Markup("")


def _word(key: str) -> str:
    return WORDS.get(key, key.replace("_", " "))


def _told(found: Mapping[str, Plain]) -> str:
    parts = []
    for key, value in list(found.items())[:MOST_KEYS]:
        if value in ([], {}, "", None):
            continue
        word = _word(key)
        parts.append(f"{word}: {_value(key, value)}" if word else _value(key, value))
    return "; ".join(parts)


def _value(key: str, value: Plain) -> str:
    if isinstance(value, str) and value in VALUES.get(key, {}):
        return VALUES[key][value]
    if isinstance(value, bool):
        return "yes" if value else "no"
    if isinstance(value, list):
        return _listed(value)
    return short(value)


def _listed(values: Sequence[Plain]) -> str:
    """Objects by their first value: `support.stiffness_y (0.86)`."""
    shown = [short(next(iter(v.values()))) if isinstance(v, dict) and v else short(v) for v in values[:MOST_ITEMS]]
    return ", ".join(shown) + (f", … ({len(values)})" if len(values) > MOST_ITEMS else "")


def short(value: Plain) -> str:
    """Any value in a line."""
    if isinstance(value, float):
        return figure_text(value, digits=4)
    if isinstance(value, list):
        return _listed(value)
    if isinstance(value, dict):
        return "; ".join(f"{k.replace('_', ' ')}: {short(v)}" for k, v in list(value.items())[:MOST_KEYS])
    return "–" if value is None else str(value)
