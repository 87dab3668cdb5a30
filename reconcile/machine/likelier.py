"""What the likelihoods of effects that were fitted together with the machine add, feature by feature, to evidence."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from reconcile.judge.screen import Screen, of_best, rest_in
from reconcile.judge.space import Fitted
from reconcile.machine.left_lines import leaves_lines
from reconcile.machine.weigh import LEAST_EVIDENCE, alike, variants
from signals.series import FloatArray

LEAST_LIKELIER, LIKELIER_SHARE = 10.0, 0.25
"""Log likelihood, and share of the first's own over no change, by which another of a set is so much less likely,
feature by feature, that it leaves the set. How near draws come is chance too: of an unbalance and a bow, which are
alike, one leads by 453 of 2297 (r021). Of sets of the proof with one effect hidden the right first one leads a torque
by 28 of 106 (t014), a stiffening support by 11 of 83 (k018), loose fits by 53 of 554 and 12 of 235 (r007, r114)."""
BEHIND, MOST_LEAD, MORE_KEPT = 4.0, 12.0, 0.3
"""Log evidence by which what yields stands behind the other, just out of the set; the most by which it may have led;
and by how much more the other must keep of the change of single lines and of families together."""


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


def rivals(screen: Screen) -> tuple[str, ...]:
    """Effects that, fitted together with the machine, are as likely as the best, feature by feature, and no forms of
    it, those with most evidence first; none where the best is hardly likelier than no change. A lead by patterns is
    then no proof that what the best leaves is its size's or model's fault: a support that stiffens led a loose fit of
    23 um by 8.4, left 6.6 times as much as it should, and was as likely (m009)."""
    best, told = screen.names[int(np.argmax(screen.evidence))], screen.likelihoods
    if told.get(best, 0.0) < LEAST_LIKELIER:
        return ()
    near = [n for n, value in told.items() if not _form_of(best, n) and value > told[best] - LEAST_EVIDENCE]
    return tuple(sorted(near, key=lambda name: -screen.evidence[screen.names.index(name)]))


def yielding(screen: Screen, views: Sequence[Fitted], observed: FloatArray) -> Screen:
    """The screen, in which the best comes behind another that is as likely, where the best leaves lines that it should
    not and the other does not, and explains more. The draws of what rattles lie far apart, so that none is as near as
    those of a smooth law may be: the loose fit of m009 kept 0.76 of the single lines' change and 0.77 of the families',
    the stiffening support 0.39 and 0.68."""
    rest = screen.rest
    if not leaves_lines(rest):
        return screen
    found = {name: screen.names.index(name) for name in rivals(screen)}
    rests = {n: replace(rest_in(views, observed, n, int(screen.by[k])), rough=False) for n, k in found.items()}
    least = rest.kept + rest.pooled + MORE_KEPT
    adequate = [n for n, one in rests.items() if not leaves_lines(one) and one.kept + one.pooled >= least]
    best = int(np.argmax(screen.evidence))
    reached = max((float(screen.evidence[found[name]]) for name in adequate), default=-np.inf)
    own = np.array([_form_of(screen.names[best], name) for name in screen.names])
    if screen.evidence[best] - reached > MOST_LEAD or np.any(screen.evidence[~own] > reached):
        return screen  # what comes between has not been looked at so closely
    evidence = np.where(own, np.minimum(screen.evidence, reached - BEHIND), screen.evidence)
    lost = screen.evidence - evidence
    against = {name: float(lost[k]) for k, name in enumerate(screen.names) if lost[k] > 0.0}
    log = evidence - evidence.max()
    weights = np.exp(log) / np.exp(log).sum()
    again = of_best(replace(screen, evidence=evidence, weights=weights, yields=against), views, observed)
    return replace(again, rest=replace(again.rest, rough=False))


def _form_of(first: str, second: str) -> bool:
    return first == second or variants(first, second) or alike(first, second)
