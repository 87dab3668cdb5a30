from learn.orders import of_ratio
from learn.sim2real.other_bearing import OTHERS, Said, others, table_of


def test_other_bearings_are_others():
    own = of_ratio(8, 0.2)
    found = others(own)
    assert 0 < len(found) < len(OTHERS) and own not in found
    assert of_ratio(12, 0.14) in found
    assert all(abs(o.outer / own.outer - 1) > 0.03 and abs(o.inner / own.inner - 1) > 0.03 for o in found)


def test_each_row_counts_its_own():
    def one(**changes):
        return Said(**{"kind": "recording", "sound": False, "under": "another", "told": True, "healthy": False,
                       "sure": False, **changes})  # fmt: skip

    rows = table_of([one(), one(told=False, healthy=True, sure=True), one(kind="window", sound=True)]).splitlines()
    assert "| recordings, faulty | another | 2 | 1 | 1 | 1 |" in rows
    assert "| windows, sound | another | 1 | 1 | 0 | 0 |" in rows
    assert "| recordings, sound | its own | 0 | 0 | 0 | 0 |" in rows
