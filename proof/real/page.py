"""The page of real recordings."""

from __future__ import annotations

from collections.abc import Sequence

from proof.engine_id import engine_id
from proof.real import driven, tables
from proof.real.call import Answer
from proof.real.tables import Row

HEAD = """# Real recordings

Made by `make proof-real`, engines `{kinematics}` (level `kinematics`) and `{driven}` (`driven`). It needs the
recordings, which are not part of the project; a few minutes on one core, no comparison longer than {limit:.0f} s. All
comparisons that the recordings' catalogue offers are run. The engine sees anonymised copies, the speed as the source
states it, bearing sizes and teeth. It was tuned on `hit_sm_mfs`; decision rules were changed once after the other
rigs had been seen (a depth of modulation is asked of a name, shaft lines must be among the strongest, loose mounts
are judged in the bands that changed), so those rows are not blind. The rule for speeds that nothing confirms was made
on `cwru` with labels made wrong, that for knocks without a baseline on `openei_gear`; neither changed an answer
below. That a bearing which the file lacks is listed among what strikes once a turn was left out until
`motor_acoustic` had been seen, and makes that row undecided instead of wrong. How many multiples of a shaft make a
series was chosen with `openei_gear` and `hit_sm_mfs` in view, and how far the lines of miscounted teeth must be below
others with `openei_gear`; neither names anything below.

To name a race by its lines is within reach of a plain envelope detector. What a report says beyond that is below:
place, size, the path that carried it, what it leaves unexplained, and whether it predicts data it has not seen."""
SITES = """The weight of a site says how much of the evidence points there; numbers behind channels are how firmly each
hears the lines (robust deviations over orders of no part). A size is the length along the race by the entry and exit of
the balls, else a bound below which they are not told apart; none is given where the record tells neither. Its interval
begins at nothing where all speeds are about one: what strikes second may then be a rebound. Nothing in the last column:
no shaft line and no sideband grew besides."""
PATHS = """Depth: root of the summed squares of the lines in the squared envelope over its mean, and its growth over the
baseline. The band is that in which the lines stand out most; `dB around` is where the level of a channel changed most,
lines and noise alike: the resonance that the impacts excite, or a mount. Speeds are shown where the stated one is off
by more than 0.3 %; the measured one is the catalogue's, which the engine is not told."""
GAINS = """Log-spectral distance of the envelope order spectrum in dB: baseline as it is, with the named defect, and the
rivals (the baseline retuned, as many free lines, another family of the bearing). What is left after the defect is not
explained by it. Held-out data are the later half of one record: weaker than another recording."""
DRIVEN = """Systems whose input was measured with the output, started from a linear mass on a spring: a law is named,
and the model run freely on a part or a run that it was not fitted on (normalised root mean square error). Travel: way
after a reversal until 80 % of the sliding force; the catalogue gives it for the fitted file by a measure of its own."""
RIVALS = """Rivals of the law: the linear model fitted to the held-out data themselves, a black box with as many
parameters, a placebo (a wrong law). The first third of `silverbox` is the part whose amplitude grows like an arrow
head, the usual test part; the last third is multisine. A black box fitted at a small amplitude does not hold at three
times that amplitude."""


def page(rows: Sequence[Row], systems: Sequence[tuple[driven.System, Answer]], limit_s: float) -> str:
    """All tables; `limit_s`: the longest that a comparison may take."""
    parts = [
        [HEAD.format(limit=limit_s, kinematics=engine_id("kinematics"), driven=engine_id("driven"))],
        tables.summary(rows),
        ["## Names"],
        tables.names(rows),
        ["Not right:"],
        tables.misses(rows),
        ["## Place, size, and what is left"],
        [SITES],
        tables.sites(rows),
        ["## Path"],
        [PATHS],
        tables.paths(rows),
        ["## Held-out data"],
        [GAINS],
        tables.gains(rows),
        ["## Measured input"],
        [DRIVEN],
        driven.laws(systems),
        [RIVALS],
        driven.runs(systems),
        ["Not right:"],
        driven.misses(systems) or ["- none"],
    ]
    return "\n\n".join("\n".join(part) for part in parts) + "\n"
