"""Half of a surrogate pair is refused where it stands; a pair is a character like another."""

from __future__ import annotations

import json

import pytest

from app.guards.json_text import NotStrictJson, check, writable


@pytest.mark.parametrize(
    ("document", "field", "says"),
    [
        ("\ud800", "", "holds \\ud800"),
        ({"machine": {"bodies": [{"name": "a"}, {"name": "b\udfffc"}]}}, "machine.bodies.1.name", "holds \\udfff"),
        ({"set": {"mass\udbff": 1}}, "set", "name that holds \\udbff"),
        ({"a": "\ud83d\ude00", "b": ["\ude00\ud83d"]}, "b.0", "holds \\ude00"),
        ({"first": "\ud800", "second": "\ud801"}, "first", "holds \\ud800"),
    ],
)
def test_half_a_pair_is_refused_with_its_field(document: object, field: str, says: str) -> None:
    with pytest.raises(NotStrictJson) as refused:
        check(json.dumps(document).encode(), 32)
    assert refused.value.field == field and says in str(refused.value)
    assert refused.value.given is not None and "\\ud" in refused.value.given
    (str(refused.value) + refused.value.given).encode()


def test_what_is_shown_of_a_long_text_has_the_half_in_it() -> None:
    with pytest.raises(NotStrictJson) as refused:
        check(json.dumps({"notes": "x" * 10_000 + "\ud800" + "y" * 10_000}).encode(), 32)
    assert "x\\ud800y" in (refused.value.given or "") and len(refused.value.given or "") < 100


@pytest.mark.parametrize("text", ['"\\ud83d\\ude00"', '"😀"', '"\\\\ud800"', '"\\u00e9"'])
def test_whole_characters_pass(text: str) -> None:
    check(text.encode(), 32)


def test_what_is_written_is_unicode_and_tells_what_stood_there() -> None:
    assert writable("a\ud800b😀") == "a\\ud800b😀"


def test_a_key_that_is_there_twice_is_told_in_one_pass_over_any_number_of_them() -> None:
    """A search for each name among all of them would take minutes here, on a server that has others to answer."""
    many = ",".join(f'"k{k}":{k}' for k in range(200_000))
    check(f"{{{many}}}".encode(), 8)
    with pytest.raises(NotStrictJson, match="the key 'k199999' appears twice"):
        check(f'{{{many},"k199999":0}}'.encode(), 8)
    with pytest.raises(NotStrictJson, match="the key 'b' appears twice"):
        check(b'{"a":1,"b":2,"c":{"a":1},"b":3,"a":4}', 8)
