"""Stages 2 and 5: all candidates against the observed change, with the chance that nothing is missing."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from reconcile.judge.adequacy import Rest, explained, rest_of
from reconcile.judge.nulls import group_lengths
from reconcile.judge.space import Fitted
from reconcile.tail import tail_chance
from signals.series import FloatArray

OTHER_VIEW = 0.5
KINDS = 3
"""Views of single lines by levels alone: own lines (the teeth's; without teeth the shafts' and passing balls'), first
and second sidebands; the last is missing without teeth, where there are no views with phases behind it."""


@dataclass(frozen=True, kw_only=True)
class Screen:
    """`evidence` (effects,): drop of the squared distance against no change, over twice the overdispersion, and the
    `direct` evidence of what strikes at its own frequency.

    `p_any`: chance of such a change in a healthy machine, by the most changed group of features (one point, channel
    and kind), `strongest` in standard deviations; `p_best`: by the best candidate's evidence; `p_direct`: by impacts.
    `by` (effects,): the view (0 to 5) that speaks for each. `weights` sum to 1 over the effects.
    `misfit`: quantile of the best distance among draws of known effects; `rest`: what the best leaves of single lines,
    nothing where that view is missing. `p_lines`: chance of such a change of single lines, whatever its pattern.
    """

    names: tuple[str, ...]
    evidence: FloatArray
    direct: FloatArray
    weights: FloatArray
    by: np.ndarray
    p_any: float
    strongest: float
    p_best: float
    p_direct: float
    misfit: float
    length: float
    rest: Rest = field(default_factory=Rest)
    p_lines: float = 1.0
    lines_asked: bool = True
    """Whether single lines were asked at all: that view may be missing, or its lines not repeat."""
    p_first: float = 1.0
    """`p_best` among all machines of the kind, where the rest is of those that agree with the baseline."""
    p_turns: float = 1.0
    """Chance that the teeth's sidebands at a shaft's turns rise so together."""
    by_turns: bool = False
    """Whether nothing but that is unusual: effects count by it alone."""
    struck: tuple[frozenset[str], ...] = ()
    """Effects that strike at the lines of one part each, where impacts come at those of several."""
    silent: frozenset[str] = frozenset()
    """Effects that would strike and are not heard at all, where others are."""
    likelihoods: Mapping[str, float] = field(default_factory=dict)
    """Log likelihood over no change, feature by feature, of effects that were fitted together with the machine."""
    heard: Mapping[str, float] = field(default_factory=dict)
    """Log evidence, counted above already, against places that share their lines, by which sensor hears which band."""
    yields: Mapping[str, float] = field(default_factory=dict)
    """Log evidence, counted above already, against effects that leave lines which another, as likely, explains."""
    bursts: Mapping[str, float] = field(default_factory=dict)
    """Log evidence of bursts of teeth that is not in `evidence`, as all else that changed is another effect's."""
    unmoved: float | None = None
    """Largest evidence of a pattern before machines were fitted to what was observed; none where none were."""

    @property
    def pattern(self) -> float:
        """Largest evidence of a pattern alone that nobody has fitted a machine to."""
        return float(self.patterns.max()) if self.unmoved is None else self.unmoved

    @property
    def against(self) -> FloatArray:
        """What is `heard` against each effect's place, (effects,)."""
        return np.array([self.heard.get(name, 0.0) for name in self.names])

    @property
    def _yielded(self) -> FloatArray:
        return np.array([self.yields.get(name, 0.0) + self.bursts.get(name, 0.0) for name in self.names])

    @property
    def patterns(self) -> FloatArray:
        """Evidence of the patterns alone, (effects,): without impacts, and without what tells their place."""
        return np.asarray(self.evidence + self.against + self._yielded - self.direct)

    @property
    def located(self) -> FloatArray:
        """Evidence of impacts with what tells their place, (effects,)."""
        return np.asarray(self.direct - self.against)


@dataclass(frozen=True, kw_only=True)
class Look:
    """One view's answer: evidence over no change (effects,), of every null (n, effects), length and misfit."""

    evidence: FloatArray
    null: FloatArray
    length: float
    misfit: float


def looked(fitted: Fitted, observed: FloatArray) -> Look:
    """All effects in one view; `observed` (F,) in dB."""
    x = fitted.place(observed)
    nothing = float(np.sum(x**2))
    best, _ = fitted.paths.nearest(fitted.paths.distances(x))
    return Look(
        evidence=(nothing - best) / (2.0 * fitted.overdispersion),
        null=(fitted.null[:, None] - fitted.near) / (2.0 * fitted.overdispersion),
        length=nothing,
        misfit=quantile_of_misfit(fitted, float(best.min()), nothing),
    )


def together(told: Sequence[FloatArray]) -> FloatArray:
    """The louder view and a share of the other; of the views of single lines the louder one is heard."""
    if len(told) == 1:
        return told[0]
    families, lines = told[0], np.max(told[1:], axis=0)
    return np.asarray(np.maximum(families, lines) + OTHER_VIEW * np.minimum(families, lines))


def judge(
    views: Sequence[Fitted], observed: FloatArray, direct: Mapping[str, float] | None = None, p_direct: float = 1.0
) -> Screen:
    """`observed` (F,) in dB against all paths in one to six views, the first of families and the others of single
    lines, levels of two or three kinds first and then two of them with phases; `direct`: log evidence that needs no
    simulation.

    An effect counts by the view that speaks louder for it, and half by the other: what that one sees may be what the
    model has not, and it sees much of the same.
    """
    first = views[0]
    looks = [looked(v, observed) for v in views]
    by = np.argmax([look.evidence for look in looks], axis=0)
    shown = np.array([(direct or {}).get(name, 0.0) for name in first.paths.names])
    patterns = together([look.evidence for look in looks])
    evidence = patterns + shown
    log = evidence - evidence.max()
    resting = together([look.null for look in looks]).max(axis=1)
    own = group_lengths(first.whiten(observed)[None], first.groups)
    strongest = float(largest(own, first.resting)[0])
    best = first.paths.names[int(np.argmax(evidence))]
    return Screen(
        names=first.paths.names,
        evidence=evidence,
        direct=shown,
        by=by,
        weights=np.exp(log) / np.exp(log).sum(),
        p_any=tail_chance(largest_of_nulls(first.resting, first.pairs), strongest),
        strongest=strongest,
        p_best=tail_chance(resting, float(patterns.max())),
        p_direct=p_direct,
        misfit=looks[int(by[int(np.argmax(evidence))])].misfit,
        length=looks[0].length,
        rest=rest_in(views, observed, best, int(by[int(np.argmax(evidence))])),
        p_lines=_of_lines(views[1:], looks[1:]),
        lines_asked=any(repeats(view) for view in views[1:]),
    )


def of_best(screen: Screen, views: Sequence[Fitted], observed: FloatArray) -> Screen:
    """The screen with what its best effect leaves, where that has become another."""
    best = int(np.argmax(screen.evidence))
    speaks = int(screen.by[best])
    rest = rest_in(views, observed, screen.names[best], speaks)
    return replace(screen, rest=rest, misfit=looked(views[speaks], observed).misfit)


def rest_in(views: Sequence[Fitted], observed: FloatArray, effect: str, speaks: int) -> Rest:
    """What an effect leaves, by levels: of own lines, unless sidebands speak for it (`speaks`: number of the view)."""
    views = views[: 1 + KINDS]  # judged by levels alone
    if len(views) == 1:
        return Rest()
    lines = [rest_of(view, observed, effect) for view in views[1:]]
    pooled = explained(views[0], observed, effect)
    return replace(lines[(max(speaks, 1) - 1) % KINDS], pooled=pooled, elsewhere=max(rest.unmet for rest in lines))


def repeats(view: Fitted) -> bool:
    """Whether sound machines repeat the lines of a view."""
    return bool(getattr(view.view, "repeats", True))


def _of_lines(views: Sequence[Fitted], looks: Sequence[Look]) -> float:
    """Chance of such a change of single lines, the smallest of the views' for as many looks; of lines that sound
    machines repeat (`OneByOne.repeats`)."""
    seen = [(v, look) for v, look in zip(views, looks, strict=True) if repeats(v)]
    chances = [tail_chance(v.null, look.length) for v, look in seen]
    return min([1.0, *(len(chances) * c for c in chances)])


def largest(lengths: FloatArray, resting: FloatArray) -> FloatArray:
    """Largest standardised group length of each row."""
    spread = np.maximum(resting.std(axis=0), 1e-9)
    return np.asarray(((lengths - resting.mean(axis=0)) / spread).max(axis=1))


def largest_of_nulls(resting: FloatArray, pairs: int) -> FloatArray:
    """The same of every null (copies of so many machines), by mean and deviation of the other machines: of a few
    machines none stands out far against a deviation that it has a part in."""
    machine = np.arange(resting.shape[0]) // (resting.shape[0] // pairs)
    found = np.empty(resting.shape[0])
    for k in range(machine[-1] + 1):
        own = machine == k
        found[own] = largest(resting[own], resting[~own] if machine[-1] else resting)
    return found


def quantile_of_misfit(fitted: Fitted, found: float, length: float) -> float:
    """Quantile of `found` among left-out draws of about the same length: near 1, no known effect looks like this."""
    near = np.argsort(np.abs(np.log(fitted.size + 1e-9) - np.log(length + 1e-9)))[:60]
    own = fitted.own[near] / np.maximum(fitted.size[near], 1e-9)
    return float(np.mean(own[np.isfinite(own)] < found / max(length, 1e-9)))
