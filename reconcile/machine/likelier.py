"""What the likelihoods of effects that were fitted together with the machine add, feature by feature, to evidence."""

from __future__ import annotations

import numpy as np

from reconcile.judge.screen import Screen
from reconcile.machine.weigh import LEAST_EVIDENCE, alike, variants

LEAST_LIKELIER, LIKELIER_SHARE = 10.0, 0.25
"""Log likelihood, and share of the first's own over no change, by which another of a set is so much less likely,
feature by feature, that it leaves the set. How near draws come is chance too: of an unbalance and a bow, which are
alike, one leads by 453 of 2297 (r021). Of sets of the proof with one effect hidden the right first one leads a torque
by 28 of 106 (t014), a stiffening support by 11 of 83 (k018), loose fits by 53 of 554 and 12 of 235 (r007, r114)."""


def likelier(screen: Screen, chosen: tuple[str, ...]) -> tuple[str, ...]:
    """Of a set what is not far less likely than its first, feature by feature, where all of it were fitted together
    with the machine and the first is the likeliest; a bow and an unbalance of one body stay together."""
    told = screen.likelihoods
    if not chosen or any(name not in told for name in chosen):
        return chosen
    first = chosen[0]
    if told[first] < max(told[name] for name in chosen):
        return chosen
    if told[first] < LEAST_LIKELIER:
        return chosen
    least = told[first] - max(LEAST_LIKELIER, LIKELIER_SHARE * told[first])
    return tuple(name for name in chosen if told[name] > least or alike(first, name))


def rivalled(screen: Screen) -> bool:
    """Whether another effect, fitted together with the machine, is as likely as the best, feature by feature: a lead by
    patterns is then no proof that what the best leaves is its size's or model's fault. A support that stiffens led a
    loose fit of 23 um by 8.4 so, left 6.6 times as much as it should, and was as likely (m009 of the proof)."""
    best, told = screen.names[int(np.argmax(screen.evidence))], screen.likelihoods
    rivals = [v for name, v in told.items() if name != best and not variants(best, name) and not alike(best, name)]
    return best in told and max(rivals, default=-np.inf) > told[best] - LEAST_EVIDENCE
