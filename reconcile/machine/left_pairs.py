"""A second effect beside the best one, by what that leaves (`leftover`): all of the atlas are asked.

Sums err where two effects act on each other: wider clearance lets an unbalance rattle. They only choose who is
simulated beside the first; what is simulated decides. Beside a pit of a bearing whose impacts are sure the teeth's own
lines alone are asked: impacts bring a forest of other lines, and what is left of that is the form of their law.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from reconcile.atlas.bank import Mapper
from reconcile.judge.screen import looked
from reconcile.judge.space import Fitted
from reconcile.machine.asked import LEAD, TEMPER, Asked, least_lead, promising
from reconcile.machine.assimilate import simulated_again
from reconcile.machine.decide import Decision
from reconcile.machine.interplay import drives, interplaying, rattles, shaken
from reconcile.machine.left_start import led_again, start_of
from reconcile.machine.leftover import Leftover, leftover, ranked_seconds
from reconcile.machine.library import Catalogued, joined
from reconcile.machine.pairs import Pair, Pairs, Simulated, evidence_in, inadequate, of_its_tooth, pair_of
from reconcile.machine.second import strikes
from reconcile.machine.setting import Found, Setting
from reconcile.machine.sizes import searched
from reconcile.machine.told_by import counted, heard, impacts_beside, own_lines, repeats, teeth_tell
from reconcile.machine.weigh import LEAST_EVIDENCE, alike, exclusive, variants
from signals.series import FloatArray

NEAR_SHARE, LEAST_ASKED = 0.5, 2
"""Share of the most that any adds by sums from which a second is simulated, two in any case, and of what the best adds
simulated from which one that was not is told with it. Beside a loose fit a crack of a shaft added 48 by sums and the
unbalance that was there 37; simulated 54 and 123."""
BESIDE_LOOSE = 3  # seconds simulated at most beside a loose ring, whose machines often run one by one
TWIN_SHARE = 0.85
"""Share of the gain of a bow or an unbalance from which the other one of the same body is told too, on a machine with
teeth, which tell."""


def best_left_pair(
    setting: Setting,
    found: Found,
    decision: Decision,
    atlas: Catalogued,
    members: int,
    most: int,
    mapper: Mapper,
) -> Pairs | None:
    """What stands beside the best effect, of at most so many that are simulated: nothing where none adds enough, where
    both leave what no known effects should, or where another effect alone or another first would do as well. None where
    none is looked for, as where no known effect is adequate, unless one is `shaken`: two mimic much. `atlas`: draws of
    all effects."""
    lines = _lines(setting, found, decision)
    if lines is None:
        return None
    first = decision.chosen[0]
    asked = _asked(setting, found, first, atlas, lines, members, mapper)
    seen = ranked_seconds(asked.left, setting.changes, asked.every, _possible(setting, asked.every, first))
    seen = [one for one in seen if one[1] >= promising(first, one[0])]
    near = sum(one[1] >= NEAR_SHARE * seen[0][1] for one in seen)
    most = min(most, BESIDE_LOOSE) if first.startswith("fit_clearance") else most
    made = {name: _fitted(asked, name, rows) for name, _, rows in seen[: max(LEAST_ASKED, min(near, most))]}
    sought = _searched(asked, made, seen)
    sought = sought or _rattling(asked, made) or _driven(asked, made, seen)
    fitted = _fairly(asked, {**made, **sought})
    more = _as_near(asked, fitted, [one for one in seen if one[0] not in fitted], most)
    fitted = _fairly(asked, {**made, **sought, **more}) if more else fitted
    kept = {n: p for n, p in fitted.items() if p and repeats(asked.setting, first, n, p.parts, asked.least)}
    pairs = sorted(kept.values(), key=lambda p: -_with_impacts(asked, p))
    simulated = {name: None if pair is None else pair.gain for name, pair in fitted.items()}
    tried = tuple((name, gain, simulated.get(name)) for name, gain, _ in seen)
    best = pairs[0] if pairs and _stands(asked, decision, pairs[0]) else None
    if best is not None:
        second = best.beside.names[0]
        told = {n: p for n, p in fitted.items() if p is not None and (n in kept or alike(n, second))}
        sums = {name: gain for name, gain, _ in seen if name in told or fitted.get(name) is None}
        others = _rivals(asked, best, list(told.values()), sums)
        others += [n for n in of_its_tooth(second, _tempered(tried)) if n not in others]
        drawn = None if others else _drawn(asked, atlas, best)
        best = replace(best, others=(second, *others) if others else (), drawn=drawn)
        best = best if others or drawn is not None else None
    return Pairs(first=first, tried=tried, best=best)


def _as_near(
    asked: Asked,
    made: Mapping[str, Pair | None],
    others: Sequence[tuple[str, float, tuple[int, ...]]],
    most: int,
) -> dict[str, Pair | None]:
    """What by its sum comes as near to the best of those `made`, which adds less simulated than by its own, and would
    be told with it: simulated as well, while there may be so many."""
    reached = max((pair.gain for pair in made.values() if pair is not None), default=0.0)
    if reached < asked.least:
        return {}
    near = [one for one in others if one[1] > NEAR_SHARE * reached]
    return {name: _fitted(asked, name, rows) for name, _, rows in near[: max(0, most - len(made))]}


def _tempered(tried: Sequence[tuple[str, float, float | None]]) -> tuple[tuple[str, float, float | None], ...]:
    """As log evidence."""
    return tuple((name, gain / TEMPER, None if made is None else made / TEMPER) for name, gain, made in tried)


def _lines(setting: Setting, found: Found, decision: Decision) -> Fitted | None:
    """The view of single lines in which a pair is fitted; None where none is looked for."""
    if decision.word not in ("explained", "ambiguous") and not shaken(found, decision):
        return None
    if not decision.chosen:
        return None
    first = decision.chosen[0]
    if strikes(first):
        return found.fine if teeth_tell(setting, found, first) else None
    if decision.word != "explained" and at_one_point(setting):
        return None
    return found.sides or found.fine


def _asked(
    setting: Setting, found: Found, first: str, atlas: Catalogued, view: Fitted, members: int, mapper: Mapper
) -> Asked:
    return Asked(
        setting=setting,
        found=found,
        first=first,
        every=joined(atlas, found.known),
        local=len(atlas.terms),
        left=_left(setting, found, first),
        view=view,
        members=members,
        mapper=mapper,
    )


def _searched(
    asked: Asked, made: Mapping[str, Pair | None], seen: Sequence[tuple[str, float, tuple[int, ...]]]
) -> dict[str, Pair]:
    """The second whose simulation refuses least of what its sum promises, with the sizes of both searched, where none
    of those `made` adds enough: a first that was fitted alone is too large beside it. What would strike, is heard and
    does not repeat beside a play adds too little as well: a race pitted beside a loose ring (dy040 of the proof) added
    75 and 69 at two speeds and took 70 at the third."""
    gains = {
        name: -np.inf if p is None else counted(asked.setting, asked.first, name, p.gain, p.parts, asked.least)
        for name, p in made.items()
    }
    refused = {name: rows for name, gain, rows in seen if name in made and gain >= asked.least}
    if asked.beside_impacts or not refused or max(gains.values()) >= asked.least:
        return {}
    name = max(refused, key=lambda n: gains[n])
    found = searched(asked, start_of(asked, (), ""), refused[name])
    return {} if found is None else {name: _of_both(_pair(asked, name, found))}


def _rattling(asked: Asked, made: Mapping[str, Pair | None]) -> dict[str, Pair]:
    """What a driving first makes rattle, with the sizes of both searched, where none of those `made` adds enough."""
    if any(rattles(name) and pair is not None and pair.gain >= asked.least for name, pair in made.items()):
        return {}
    alone = start_of(asked, (), "")
    beat = max((p.gain for p in made.values() if p is not None and p.gain >= asked.least), default=0.0)
    found = {name: searched(asked, alone, rows, beat) for name, rows in interplaying(asked, alone).items()}
    return {name: _of_both(_pair(asked, name, one)) for name, one in found.items() if one is not None}


def _driven(
    asked: Asked, made: Mapping[str, Pair | None], seen: Sequence[tuple[str, float, tuple[int, ...]]]
) -> dict[str, Pair]:
    """What drives a first that rattles, with the sizes of both searched, where it is the best by sums and another was
    simulated better: the first, fitted alone, rattles more than it does beside what drives it. A heavy unbalance in a
    loose foot (z068 of the proof) added 52 by sums, 35 simulated, and a cracked shaft, which was named, 64."""
    name, _, rows = seen[0] if seen else ("", 0.0, ())
    own, best = made.get(name), max((p.gain for p in made.values() if p is not None), default=0.0)
    if not (rattles(asked.first) and drives(name)) or own is None or own.gain >= best or best < asked.least:
        return {}
    found = searched(asked, start_of(asked, (), ""), rows, best)
    pair = None if found is None else _pair(asked, name, found)
    return {name: _of_both(pair)} if pair is not None and pair.gain > own.gain else {}


def _of_both(pair: Pair) -> Pair:
    """The pair, whose first's size is the one beside the second."""
    together = pair.beside.together
    if together is None:
        return pair
    return replace(pair, beside=replace(pair.beside, together=replace(together, searched=True)))


def _fairly(asked: Asked, made: Mapping[str, Pair | None]) -> dict[str, Pair | None]:
    """With what the first alone gains by being moved once more, as the pairs were, taken off; where it matters."""
    if max((p.gain for p in made.values() if p is not None), default=0.0) < asked.least:
        return dict(made)
    again = led_again(asked, start_of(asked, (), ""), "")
    if again is None or (gained := asked.left.level(again.known.library.changes) - asked.left.base) <= 0.0:
        return dict(made)
    own = _parts(asked, again)
    return {name: None if p is None else _without(p, gained, own) for name, p in made.items()}


def _without(pair: Pair, gained: float, own: Sequence[float]) -> Pair:
    return replace(pair, gain=pair.gain - gained, parts=tuple(a - b for a, b in zip(pair.parts, own, strict=True)))


def _with_impacts(asked: Asked, pair: Pair) -> float:
    """The gain by which a pair is compared with others: impacts of the second, which no other brings, count."""
    return pair.gain + TEMPER * impacts_beside(asked.setting, asked.first, pair.beside.names[0])


def _rivals(asked: Asked, best: Pair, pairs: Sequence[Pair], sums: Mapping[str, float]) -> list[str]:
    """What may stand beside the first as well as the best does: what is near it simulated; what was not simulated and
    is near it by its sum; a bow for an unbalance and the other way round, which teeth alone tell apart."""
    second, told = best.beside.names[0], {p.beside.names[0]: _with_impacts(asked, p) for p in pairs}
    most = _with_impacts(asked, best)
    teeth = bool(asked.setting.machine.gears)
    near = []
    for name, gain in sums.items():
        least = TWIN_SHARE * most if teeth else -np.inf
        reached = told.get(name, gain)
        if name == second or variants(name, second):
            continue
        if alike(name, second):
            near += [name] if reached > least else []
        elif reached > (most - least_lead(asked.first) if name in told else NEAR_SHARE * most):
            near.append(name)
    return near


def _left(setting: Setting, found: Found, name: str) -> Leftover:
    rows = list(found.known.library.groups[name])
    told = evidence_in(found.fitted, found.known.library.changes[rows], setting.changes.observed)
    left = leftover(setting, found, name, told)
    return left.by(own_lines(setting)) if strikes(name) else left


def _possible(setting: Setting, every: Catalogued, first: str) -> list[str]:
    names = [n for n in every.library.groups if n != first and not exclusive(n, first)]
    return [n for n in names if not strikes(n) or (heard(setting, n) and not strikes(first))]


def _drawn(asked: Asked, atlas: Catalogued, pair: Pair) -> FloatArray | None:
    """What both show on machines that were not led to the observation, with the sizes that were searched if they had
    to be: for held-out data. None where too few run."""
    second, together = pair.beside.names[0], pair.beside.together
    bare = replace(asked.found, known=asked.found.unled)
    free = _asked(asked.setting, bare, asked.first, atlas, asked.view, asked.members, asked.mapper)
    ((_, _, rows),) = ranked_seconds(free.left, free.setting.changes, free.every, [second])
    start = start_of(free, rows, second)
    if together is not None and together.searched:
        both = [together.terms[k % len(together.terms)] for k in range(len(start.terms))]
        start = replace(start, terms=tuple(a for a, _ in both), also=tuple(b for _, b in both))
    more = simulated_again(free.setting, start.candidate, start.offsets, start.terms, free.mapper, also=start.also)
    return None if more is None else more.library.changes


def _fitted(asked: Asked, second: str, rows: Sequence[int]) -> Pair | None:
    """Both on the machines of the first one's draws, fitted together; None where too few run."""
    made = led_again(asked, start_of(asked, rows, second), second)
    return None if made is None else _pair(asked, second, made)


def _pair(asked: Asked, second: str, made: Simulated) -> Pair:
    gain = asked.left.level(made.known.library.changes) - asked.left.base
    pair = pair_of(asked.setting, asked.found, asked.first, second, asked.view, made, gain / TEMPER)
    together = pair.beside.together
    if asked.beside_impacts and together is not None:
        pair = replace(pair, beside=replace(pair.beside, together=replace(together, own=None)))
    return replace(pair, gain=gain, parts=_parts(asked, made))


def _parts(asked: Asked, made: Simulated) -> tuple[float, ...]:
    return tuple(map(float, asked.left.by_point(made.known.library.changes, len(asked.setting.data))))


def _stands(asked: Asked, decision: Decision, best: Pair) -> bool:
    if best.gain < asked.least or (decision.word != "explained" and inadequate(best)):
        return False
    if asked.beside_impacts:
        return _leads(asked, decision)
    reached = asked.left.base + best.gain - LEAD
    if any(_alone(asked, name) > reached for name in asked.found.known.library.groups if name != asked.first):
        return False
    second = best.beside.names[0]
    firsts = [n for n in decision.chosen[1:] if n != second and not variants(n, asked.first)]
    return not any(_with_another(asked, name, second) > reached for name in firsts)


def at_one_point(setting: Setting) -> bool:
    """Where a wrong second makes up for a wrong first: a loose ring and a cracked tooth (x024 of the proof) were a
    wider clearance there and a cracked shaft, and a placebo gained as much on a later time of the record."""
    return len(setting.data) == 1


def _leads(asked: Asked, decision: Decision) -> bool:
    """Whether the first leads what else of the set it may be by impacts and families of features: single lines of the
    teeth say nothing of which part is struck."""
    fitted, screen = asked.found.fitted, asked.found.screen
    families = looked(fitted, asked.setting.changes.observed).evidence
    told = dict(zip(screen.names, families + screen.direct, strict=True))
    others = [n for n in decision.chosen[1:] if not variants(n, asked.first)]
    return all(told[asked.first] - told[n] >= LEAST_EVIDENCE for n in others)


def _alone(asked: Asked, name: str) -> float:
    """What another effect of the same machines reaches without a second, by as many draws."""
    known = asked.found.known.library
    return asked.left.level(asked.left.nearest(known.changes[list(known.groups[name])]))


def _with_another(asked: Asked, first: str, second: str) -> float:
    """What another first reaches with the second, simulated as the best was."""
    if exclusive(first, second):
        return -np.inf
    other = replace(asked, first=first)
    shown = _left(asked.setting, asked.found, first)
    ((_, _, rows),) = ranked_seconds(shown, asked.setting.changes, asked.every, [second])
    made = led_again(other, start_of(other, rows, second), second)
    return -np.inf if made is None else asked.left.level(made.known.library.changes)
