import pytest

from learn.real.load import BEARINGS, ROOT, available, index
from learn.sim2real.figures import DEVELOPMENT_RIG
from learn.sim2real.rigs import INFERRED, RIGS, UNUSED

PAGE = (ROOT / "docs" / "sim2real.md").read_text(encoding="utf-8")


def test_the_page_names_every_set_that_is_not_used():
    assert not set(RIGS) & set(UNUSED)
    for name in UNUSED:
        assert f"`{name}`" in PAGE, name


def test_what_is_inferred_is_a_bearing_that_is_used():
    assert set(INFERRED) <= set(RIGS) & set(BEARINGS)
    assert DEVELOPMENT_RIG not in INFERRED


@pytest.mark.skipif(not available(), reason="no recordings beside the project")
def test_every_set_of_recordings_is_used_or_named_as_not():
    assert {entry["dataset"] for entry in index()} == {*RIGS, *UNUSED}
