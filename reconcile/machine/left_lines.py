"""Whether what an effect leaves of single lines is too much for a name, and enough for none of the known ones."""

from __future__ import annotations

from reconcile.judge.adequacy import Rest

UNMET, UNMET_ROUGH = 0.8, 1.5
"""What the best effect leaves of single lines, over what is usual, from which it is not what changed; the second where
machine and effect were not fitted together. Right effects of five development cases leave nothing unusual or 1.1 to
1.3 (a rigid bore 5), effects that no library has 1.1 to 5; before, right ones reach 1.2 and unknown ones 1.7 to 2.7."""
LEAST_LEFT_UNKNOWN = 2.0
"""The same from which it is told that no known effect changed them, where machine and effect were fitted together. Of
concealed cases three with effects that no library has left 2.5 to 3.8, and five without any 1.1 to 1.9: two sound
machines (e127, h034), two loose pedestals (h062, h107) and a loose fit (e141)."""
LEAST_LEFT_ELSEWHERE = 3.0
"""The same of lines of a view to which the effect was not fitted, where it leaves no more than usual (`UNMET`) of those
to which it was: a parallel offset of the output (x032) left 2.2 of them."""
MOST_KEPT, MOST_KEPT_ROUGH = 1.15, 0.62
"""Share of the single lines' change above which an effect is named all the same, with the remark that a part is left:
the largest changes are the least alike. Where machine and effect were fitted together it is the sum with the share of
the families' change: right effects of development cases keep 1.15 to 1.6, effects that no library has 0.8 to 1.05."""
AMPLE = 12.0
"""Log evidence of the best effect from which the little it leaves is a remark: a loose ring and a loose foot of 23.7
and 23.0 that left 1.3 and 1.2 times too much were right (tw052, tw010); unknown effects had 8.3 at most (i042)."""


def leaves_lines(rest: Rest) -> bool:
    """Whether an effect is not what changed the single lines; one that was fitted to the lines of one view must not
    leave those of the other, to which it was not fitted, either."""
    if rest.rough:
        return rest.unmet > UNMET_ROUGH and rest.kept < MOST_KEPT_ROUGH
    left = rest.unmet > UNMET or rest.elsewhere > UNMET_ROUGH
    return left and rest.kept + rest.pooled < MOST_KEPT


def leaves_little(rest: Rest) -> bool:
    """Whether an effect leaves more of the single lines than a right one does, and less than unknown ones did."""
    least = LEAST_LEFT_UNKNOWN if rest.unmet > UNMET else LEAST_LEFT_ELSEWHERE
    return leaves_lines(rest) and not rest.rough and max(rest.unmet, rest.elsewhere) < least


def leaves_a_remark(best: float, rest: Rest) -> bool:
    """Whether the little that an effect of so much log evidence leaves is told beside it, and denies it nothing."""
    return best >= AMPLE and leaves_little(rest)
