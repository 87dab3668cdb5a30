"""Copies of JSON documents share nothing that can be changed."""

from signals.copied import copied


def test_a_copy_is_equal_and_shares_no_object_or_list():
    document = {"a": [{"b": 1, "c": [1.5, None]}, "x", [True]], "d": {}}
    found = copied(document)
    assert found == document
    found["a"][0]["c"].append(2)
    found["a"][2][0] = False
    found["d"]["e"] = 1
    assert document == {"a": [{"b": 1, "c": [1.5, None]}, "x", [True]], "d": {}}
    assert copied(3) == 3
