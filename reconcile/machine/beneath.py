"""A pattern beneath the burst of a tooth: where one tooth differs for sure and all else that changed is another's.

The burst is evidence of a fault of a tooth alone, and none against what moves the lines of the machine: added to a
tooth's own faint pattern it makes that lead what explains the change.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from reconcile.judge.screen import Screen, of_best
from reconcile.judge.space import Fitted
from reconcile.machine.decide import STRANGE, STRUCK
from reconcile.machine.left_lines import leaves_lines
from reconcile.machine.weigh import FAR_AHEAD, HOPELESS, LEAST_EVIDENCE, alike, variants
from signals.series import FloatArray
from sim.terms import REGISTRY


def burst_leads(screen: Screen) -> bool:
    """Whether the best effect is a fault of a tooth that is sure by its burst."""
    first = int(np.argmax(screen.evidence))
    return _strikes(screen.names[first]) == "tooth" and bool(screen.direct[first] >= STRUCK)


def asked_beneath(screen: Screen) -> str | None:
    """What strikes nowhere and has more of a pattern than the teeth, where a burst leads: it is fitted together with
    the machine as they are; else none."""
    if not burst_leads(screen):
        return None
    resting = _resting(screen)
    best = max(resting, key=lambda name: resting[name], default=None)
    if best is None or resting[best] < max(LEAST_EVIDENCE, *_others(screen, best)):
        return None
    return best


def beneath_a_tooth(screen: Screen, views: Sequence[Fitted], observed: FloatArray) -> Screen:
    """The screen, in which faults of teeth count by their patterns alone, where a burst leads and what strikes nowhere
    was fitted together with the machine, explains the change as a name must, has `HOPELESS` or more and leads the
    patterns of all others, those of the teeth among them, by `FAR_AHEAD`. The teeth stand beside it then.

    A loose fit of 44 um beside a crack of a tooth: patterns of 18 and 4.3, and 23 of the burst, with which the tooth
    led and the fit was not asked (m038 of the proof)."""
    best = asked_beneath(screen)
    if best is None or best not in screen.likelihoods:
        return screen
    if _resting(screen)[best] < max(HOPELESS, max(_others(screen, best)) + FAR_AHEAD):
        return screen
    bursts = {name: heard for name, heard in _heard(screen).items() if _strikes(name) == "tooth" and heard > 0.0}
    evidence = screen.evidence - np.array([bursts.get(name, 0.0) for name in screen.names])
    weights = np.exp(evidence - evidence.max())
    made = replace(screen, evidence=evidence, weights=weights / weights.sum(), bursts=bursts)
    made = of_best(made, views, observed)
    made = replace(made, rest=replace(made.rest, rough=False))
    return screen if leaves_lines(made.rest) or made.misfit > STRANGE else made


def set_aside(screen: Screen) -> tuple[str, ...]:
    """Faults of teeth that are sure by their burst and stand beneath another effect's pattern, the best first."""
    told = dict(zip(screen.names, map(float, screen.evidence), strict=True))
    sure = [name for name, burst in screen.bursts.items() if burst >= STRUCK]
    return tuple(sorted(sure, key=lambda name: -told[name]))


def _strikes(name: str) -> str | None:
    term = REGISTRY.get(name.split("@", maxsplit=1)[0])
    return None if term is None else term.strikes


def _heard(screen: Screen) -> dict[str, float]:
    return dict(zip(screen.names, map(float, screen.direct), strict=True))


def _resting(screen: Screen) -> dict[str, float]:
    """Evidence of what strikes nowhere."""
    told = dict(zip(screen.names, map(float, screen.evidence), strict=True))
    return {name: value for name, value in told.items() if _strikes(name) is None}


def _others(screen: Screen, best: str) -> list[float]:
    """Patterns of all that is no form of `best`, a bow for an unbalance among the forms; at least 0."""
    told = zip(screen.names, map(float, screen.patterns), strict=True)
    return [0.0, *(value for n, value in told if n != best and not variants(n, best) and not alike(n, best))]
