"""A misspelt option is named with what it may have been meant for."""

from __future__ import annotations

import pytest

from app.cli.main import main

HERE = ["reconcile", "--machine", "m.json"]


@pytest.mark.parametrize(
    ("typed", "told"),
    [
        ([*HERE, "--recordings", "t.json"], "--recordings is no option (did you mean --recording?)"),
        (
            [*HERE, "--recording", "t.json", "--out", "o", "--budgt=full"],
            "--budgt is no option (did you mean --budget?)",
        ),
        (["dataset", "plan", "recipe.json", "--sed", "3"], "--sed is no option (did you mean --seed?)"),
        (["presets", "--xyzzyx"], "--xyzzyx is no option"),
    ],
)
def test_it_is(typed: list[str], told: str, capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as ended:
        main(typed)
    assert ended.value.code == 2
    assert told in capsys.readouterr().err


def test_a_word_that_belongs_to_an_option_is_none(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit):
        main(HERE)
    told = capsys.readouterr().err
    assert "--recording" in told and "is no option" not in told
