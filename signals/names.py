"""Names of channels under the rules of other programs."""

from __future__ import annotations

import re

MAT_NAME_CHARACTERS = 63


def matlab_name(name: str) -> str:
    """A channel's name as MATLAB allows it."""
    return re.sub(r"^(?![A-Za-z])", "c_", re.sub(r"\W", "_", name, flags=re.ASCII))[:MAT_NAME_CHARACTERS]
