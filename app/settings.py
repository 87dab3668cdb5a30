"""The server's settings, from the environment or given."""

from __future__ import annotations

import ipaddress
import os
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

from app.key_file import VARIABLE, read_keys
from jobs.limits import Limits
from sim.core.errors import Problem, SpecError
from store.environment import Numbers
from store.settings import StoreSettings
from store.worker_settings import WorkerSettings


@dataclass(frozen=True, kw_only=True)
class Settings:
    """Everything about one API process. `api_keys` maps the SHA-256 of a key to its holder's name."""

    stores: StoreSettings
    host: str = "127.0.0.1"
    port: int = 8000
    api_keys: Mapping[str, str] = field(default_factory=dict)
    api_keys_file: Path | None = None
    """Further keys, with scopes, end and limits; read again when it changes (`app.key_file`)."""
    requests_per_minute: int = 6000
    """Calls of the holder of one of `api_keys`, in each API process; 0: no limit. Keys of the file have their own."""
    allowed_hosts: tuple[str, ...] = ()
    """Names under which a server without keys may be called, besides loopback ones. With keys any name will do."""
    limits: Limits = field(default_factory=Limits)
    max_body_bytes: int = 8 * 2**20
    max_upload_bytes: int = 512 * 2**20
    """Of a recording that is sent in."""
    upload_timeout_s: float = 900.0
    max_json_depth: int = 32
    body_timeout_s: float = 30.0
    heartbeat_s: float = 15.0
    event_streams: int = 200
    recover_every_s: float = 2.0
    max_losses: int = 2
    worker_silent_s: float = 45.0
    """A worker not heard of for so long is not counted as present."""
    static_folder: Path = Path(__file__).parent / "dashboard" / "static"
    pages_folder: Path = Path(__file__).parents[1] / "docs" / "physics"
    """Pages of the physical effects, one `KEY.md` each."""

    @property
    def keys_required(self) -> bool:
        """Keys are needed as soon as others can reach the server, or when any are set; a file counts even if empty."""
        return bool(self.api_keys) or self.api_keys_file is not None or not is_loopback(self.host)

    def check(self) -> None:
        """Refuse to be reachable from other machines without keys, and a file of keys that cannot be used."""
        in_file = {} if self.api_keys_file is None else read_keys(self.api_keys_file)
        if not is_loopback(self.host) and not self.api_keys and not in_file:
            message = "can be reached from other machines, so API keys are needed (SIDEBAND_API_KEYS"
            raise SpecError(
                Problem(
                    field="host",
                    message=f"{message}, {VARIABLE})",
                    given=self.host,
                    allowed="a loopback address, or any address with at least one key",
                )
            )

    @classmethod
    def from_environment(cls, environment: Mapping[str, str] | None = None) -> Settings:
        """`SIDEBAND_HOST`, `SIDEBAND_PORT`, `SIDEBAND_API_KEYS` (`name:sha256,...`), `SIDEBAND_API_KEYS_FILE`,
        `SIDEBAND_API_KEYS_PER_MINUTE`, `SIDEBAND_ALLOWED_HOSTS`; limits: `SIDEBAND_MAX_DURATION_S`,
        `SIDEBAND_MAX_MEMORY_BYTES`, `SIDEBAND_MAX_STEPS`,
        `SIDEBAND_MAX_SECONDS`, `SIDEBAND_MAX_WAITING`, `SIDEBAND_MAX_DATASET_CORE_HOURS`, `SIDEBAND_MAX_DATASET_BYTES`,
        `SIDEBAND_MAX_DATASETS`, `SIDEBAND_MAX_UPLOAD_BYTES`. `SIDEBAND_PAGES_DIR`: the pages of the effects, where they
        lie elsewhere."""
        env = os.environ if environment is None else environment
        read, base = Numbers(env), Limits()
        limits = Limits(
            duration_s=read.number("SIDEBAND_MAX_DURATION_S", base.duration_s, unit="s"),
            steps=read.whole("SIDEBAND_MAX_STEPS", base.steps),
            memory_bytes=read.whole("SIDEBAND_MAX_MEMORY_BYTES", base.memory_bytes, unit="bytes"),
            seconds=read.number("SIDEBAND_MAX_SECONDS", base.seconds, unit="s"),
            waiting_jobs=read.whole("SIDEBAND_MAX_WAITING", base.waiting_jobs),
            dataset_core_hours=read.number("SIDEBAND_MAX_DATASET_CORE_HOURS", base.dataset_core_hours, unit="h"),
            dataset_bytes=read.whole("SIDEBAND_MAX_DATASET_BYTES", base.dataset_bytes, unit="bytes"),
            datasets=read.whole("SIDEBAND_MAX_DATASETS", base.datasets),
        )
        port = read.whole("SIDEBAND_PORT", cls.port, most=65535)
        upload = read.whole("SIDEBAND_MAX_UPLOAD_BYTES", cls.max_upload_bytes, unit="bytes")
        per_minute = read.whole("SIDEBAND_API_KEYS_PER_MINUTE", cls.requests_per_minute, most=1_000_000, unit="1/min")
        read.settle()
        return cls(
            stores=StoreSettings.from_environment(env),
            host=env.get("SIDEBAND_HOST", cls.host),
            port=port,
            api_keys=parse_keys(env.get("SIDEBAND_API_KEYS", "")),
            api_keys_file=Path(env[VARIABLE]) if env.get(VARIABLE) else None,
            requests_per_minute=per_minute,
            pages_folder=Path(env.get("SIDEBAND_PAGES_DIR") or cls.pages_folder),
            allowed_hosts=tuple(h.strip() for h in env.get("SIDEBAND_ALLOWED_HOSTS", "").split(",") if h.strip()),
            limits=limits,
            max_upload_bytes=upload,
        )


def settings_for_everything() -> Settings:
    """From the environment, with that of the workers checked: else only each worker would find it wrong, over and over.

    SpecError names every variable that cannot be used.
    """
    problems: list[Problem] = []
    for settings in (Settings, WorkerSettings):
        try:
            settings.from_environment()
        except SpecError as error:
            problems += error.problems
    if problems:
        raise SpecError(problems)
    return Settings.from_environment()


def parse_keys(text: str) -> dict[str, str]:
    """`name:sha256,name:sha256` as a mapping from digest to name."""
    keys: dict[str, str] = {}
    for entry in filter(None, (part.strip() for part in text.split(","))):
        name, _, digest = entry.rpartition(":")
        if not name or len(digest) != 64 or set(digest.lower()) - set("0123456789abcdef"):
            message = "must be `name:sha256` entries; make one with `python -m app.keys NAME`"
            raise SpecError(Problem(field="SIDEBAND_API_KEYS", message=message, allowed="name:64 hexadecimal digits"))
        keys[digest.lower()] = name
    return keys


def is_loopback(host: str) -> bool:
    """Whether only this machine can reach the address."""
    if host.lower() == "localhost":
        return True
    try:
        return ipaddress.ip_address(host.strip("[]")).is_loopback
    except ValueError:
        return False
