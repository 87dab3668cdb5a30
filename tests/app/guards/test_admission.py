"""Calls with keys: which are refused, and how that is told."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from app.guards.admission import Admission
from app.guards.rate import Buckets
from app.guards.scopes import SCOPES, Scope
from app.key_file import Key


def judge(now: float = 0.0) -> Admission:
    return Admission(buckets=Buckets(most=10, clock=lambda: now), clock=lambda: now)


@pytest.mark.parametrize(
    ("key", "given", "words"),
    [
        (None, False, "send an API key"),
        (None, True, "not known"),
        (Key(name="ann", not_after=50), True, "ended at 1970"),
    ],
)
def test_unauthorized_says_why(key: Key | None, given: bool, words: str) -> None:
    told = judge(50.0).refusal(key, given=given, scopes=("read",))
    assert told is not None and told.status == 401 and words in told.detail
    assert ("invalid_token" in told.headers["WWW-Authenticate"]) == given


def test_a_key_holds_until_its_end() -> None:
    assert judge(49.9).refusal(Key(name="ann", not_after=50), given=True, scopes=("read",)) is None


SETS = st.sets(st.sampled_from(SCOPES))


@pytest.mark.slow
@given(has=SETS, wanted=SETS)
def test_let_in_for_exactly_what_the_key_is_for(has: set[Scope], wanted: set[Scope]) -> None:
    told = judge().refusal(Key(name="ann", scopes=frozenset(has)), given=True, scopes=sorted(wanted))
    assert (told is None) == (wanted <= has)
    if told is not None:
        assert told.status == 403 and told.fields[0].allowed.split() == sorted(wanted - has)
        assert f'scope="{told.fields[0].allowed}"' in told.headers["WWW-Authenticate"]


def test_two_keys_of_one_holder_share_the_calls() -> None:
    admission = judge()
    old, new = (Key(name="ann", requests_per_minute=2, not_after=end) for end in (5.0, None))
    for key in (old, new):
        assert admission.refusal(key, given=True, scopes=("read",)) is None
    told = admission.refusal(new, given=True, scopes=("read",))
    assert told is not None and (told.status, told.slug, told.headers) == (429, "rate-limit", {"Retry-After": "30"})
    assert (told.fields[0].given, told.fields[0].allowed) == (2, "<= 2")
    assert admission.refusal(Key(name="ben", requests_per_minute=2), given=True, scopes=("read",)) is None
