from learn.sim2real.severities import severity_pairs, severity_table


def told(made, name, label, size, index, *, said=None, stated_hz=20.0):
    return made.with_severity(made.case(name, label, size=size, stated_hz=stated_hz), said or label, index)


def test_only_pairs_of_one_race_and_speed_are_compared(made):
    found = severity_pairs(
        [
            told(made, "a", "outer", 2.0, -0.8),
            told(made, "b", "outer", 8.0, 0.1),
            told(made, "c", "inner", 8.0, -1.0),
            told(made, "d", "outer", 5.0, 0.5, stated_hz=10.0),
        ]
    )
    assert found == {"pairs": 1, "right": 1, "pairs_across_speeds": 2, "right_across_speeds": 1}


def test_a_pair_with_a_wrong_class_stays_a_pair_and_is_not_right(made):
    rows = [
        told(made, "a", "outer", 2.0, -0.8),
        told(made, "b", "outer", 8.0, 0.1, said="inner"),
        told(made, "c", "outer", 5.0, None, said="healthy"),
    ]
    found = severity_pairs(rows)
    assert (found["pairs"], found["right"]) == (3, 0)
    assert "0 of 3 pairs of one race and speed" in severity_table(rows)


def test_the_wrong_order_is_not_right(made):
    rows = [told(made, "a", "inner", 2.0, 0.3), told(made, "b", "inner", 8.0, 0.1)]
    assert severity_pairs(rows)["right"] == 0
