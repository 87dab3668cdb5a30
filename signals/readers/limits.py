"""How much a file may hold: checked before it is read."""

from __future__ import annotations

from dataclasses import dataclass

from sim.core.errors import Problem, SpecError


@dataclass(frozen=True, kw_only=True)
class Bounds:
    """`values`: samples over all channels that are read (20 minutes of one channel at 51.2 kHz); `unpacked_bytes`: of
    a compressed file once unpacked; `memory_bytes` and `seconds`: of the process that parses what a stranger sent."""

    file_bytes: int = 2**31
    unpacked_bytes: int = 2**31
    values: int = 64_000_000
    members: int = 4096
    """Arrays, groups, columns or archive members that are looked at."""
    memory_bytes: int = 4 * 2**30
    seconds: float = 120.0

    def check_members(self, field: str, count: int, what: str) -> None:
        """SpecError when a file has too many parts."""
        self.check(field, message=f"has too many {what}", given=count, allowed=self.members, unit=what)

    def check(self, field: str, *, message: str, given: int, allowed: int, unit: str) -> None:
        """SpecError when `given` is above `allowed`."""
        if given > allowed:
            raise SpecError(Problem(field=field, message=message, given=given, allowed=f"<= {allowed}", unit=unit))
