"""API keys from a file (`SIDEBAND_API_KEYS_FILE`): names, digests, scopes, end, limits. Never a key itself."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Annotated

from pydantic import AwareDatetime, BaseModel, ConfigDict, Field, ValidationError

from app.guards import json_text
from app.guards.scopes import SCOPES, Scope
from jobs.validation import problems_of
from sim.core.errors import Problem, SpecError

VARIABLE = "SIDEBAND_API_KEYS_FILE"
MAX_BYTES = 2**20
MAX_KEYS = 1000
_DEPTH = 8


@dataclass(frozen=True, kw_only=True)
class Key:
    """What a key lets its holder do; times in seconds since the epoch, UTC. The defaults: everything, for ever."""

    name: str
    scopes: frozenset[Scope] = frozenset(SCOPES)
    not_after: float | None = None
    requests_per_minute: int | None = None
    core_seconds_per_day: float | None = None


class KeyEntry(BaseModel):
    """A key in the file. Several of one name are keys of one holder: an old one beside its successor, until it ends."""

    model_config = ConfigDict(frozen=True, extra="forbid", allow_inf_nan=False)

    name: Annotated[str, Field(pattern=r"^[A-Za-z0-9._-]{1,64}$")]
    sha256: Annotated[str, Field(pattern=r"^[0-9a-f]{64}$")]
    scopes: Annotated[tuple[Scope, ...], Field(min_length=1, max_length=len(SCOPES))] = SCOPES
    not_after: AwareDatetime | None = None
    """With its time zone: `2027-01-31T00:00:00Z`."""
    requests_per_minute: Annotated[int | None, Field(ge=1, le=1_000_000)] = None
    core_seconds_per_day: Annotated[float | None, Field(gt=0, le=1e9)] = None

    def key(self) -> Key:
        """The entry without its digest."""
        return Key(
            name=self.name,
            scopes=frozenset(self.scopes),
            not_after=None if self.not_after is None else self.not_after.timestamp(),
            requests_per_minute=self.requests_per_minute,
            core_seconds_per_day=self.core_seconds_per_day,
        )


class KeyFile(BaseModel):
    """The whole file."""

    model_config = ConfigDict(frozen=True, extra="forbid")

    keys: Annotated[tuple[KeyEntry, ...], Field(max_length=MAX_KEYS)]


def read_keys(path: Path) -> dict[str, Key]:
    """Keys by their digest; SpecError says what is wrong with the file, field by field."""
    try:
        with path.open("rb") as stream:
            text = stream.read(MAX_BYTES + 1)
    except OSError as error:
        raise _wrong(f"cannot be read: {error.strerror}", given=str(path), allowed="a readable file") from error
    if len(text) > MAX_BYTES:
        raise _wrong("is too large", given=str(path), allowed=f"<= {MAX_BYTES} bytes")
    return parse_key_file(text)


def parse_key_file(text: bytes) -> dict[str, Key]:
    """`read_keys` of a text."""
    try:
        json_text.check(text, _DEPTH)
        found = KeyFile.model_validate_json(text, strict=True)
    except json_text.NotStrictJson as error:
        raise _wrong(str(error).replace("the body", "it"), allowed='{"keys": [...]}') from error
    except ValidationError as error:
        raise SpecError([_kept_quiet(problem) for problem in problems_of(error, VARIABLE, KeyFile)]) from error
    keys: dict[str, Key] = {}
    for i, entry in enumerate(found.keys):
        if entry.sha256 in keys:
            message = "is there twice: which entry holds for it?"
            raise SpecError(Problem(field=f"{VARIABLE}.keys.{i}.sha256", message=message, allowed="one entry a key"))
        keys[entry.sha256] = entry.key()
    return keys


def _kept_quiet(problem: Problem) -> Problem:
    """A key that was put in place of its digest must not get into a log."""
    return replace(problem, given=None) if problem.field.endswith(".sha256") else problem


def _wrong(message: str, *, allowed: str, given: str | None = None) -> SpecError:
    return SpecError(Problem(field=VARIABLE, message=message, given=given, allowed=allowed))


def keys_of(plain: Mapping[str, str], requests_per_minute: int | None = None) -> dict[str, Key]:
    """Keys of `SIDEBAND_API_KEYS` (digest to name): every scope, no end, no limit but that of calls."""
    return {digest: Key(name=name, requests_per_minute=requests_per_minute) for digest, name in plain.items()}
