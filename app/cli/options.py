"""Options that do not exist are named, with what they may have been meant for."""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from typing import ClassVar, NoReturn

from sim.core.near import did_you_mean


class Parser(argparse.ArgumentParser):
    """As argparse, but for a misspelt option: that names only what it left unset, or suggests nothing. `typed`: the
    words of the command, which the parsers of its actions share."""

    typed: ClassVar[Sequence[str]] = ()

    def error(self, message: str) -> NoReturn:
        """The problem, with the options that are none; ends with 2."""
        known = [name for name in self._options() if name.startswith("--")]
        typed = dict.fromkeys(word.partition("=")[0] for word in self.typed if word.startswith("--") and word != "--")
        unknown = [f"{name} is no option{did_you_mean(name, known)}" for name in typed if name not in known]
        super().error("; ".join([message, *unknown]))

    def _options(self) -> list[str]:
        """Its own, and those of the action that was typed."""
        found = list(self._option_string_actions)
        for action in self._actions:
            if isinstance(action, argparse._SubParsersAction):
                typed = next((word for word in self.typed if word in action.choices), "")
                found += list(action.choices[typed]._option_string_actions) if typed else []
        return found
