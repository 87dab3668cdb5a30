"""Where things are kept, from the environment or given."""

from __future__ import annotations

import os
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from sim.core.errors import Problem, SpecError
from store.artefacts.place import ALLOWED


@dataclass(frozen=True, kw_only=True)
class StoreSettings:
    """`data_dir` holds whatever has no URL of its own."""

    data_dir: Path
    redis_url: str
    database_url: str = ""
    artefact_url: str = ""
    atlas_dir: Path | None = None

    @property
    def catalogue_url(self) -> str:
        """URL of the catalogue's database; SQLite in the data folder unless given."""
        return self.database_url or f"sqlite:///{self.data_dir / 'catalogue.sqlite'}"

    @property
    def artefact_folder(self) -> Path:
        """Folder of the artefacts, unless they go to a bucket (`store.artefacts.choose`)."""
        url = self.artefact_url
        if not url:
            return self.data_dir / "artefacts"
        if url.startswith("file://"):
            return Path(url.removeprefix("file://"))
        message = "is not a kind of artefact store this build has"
        raise SpecError(Problem(field="ARTEFACT_URL", message=message, given=url, allowed=ALLOWED))

    @property
    def atlas_folder(self) -> Path:
        """Folder of the atlases that reconciliations share; it holds nothing that could not be made again."""
        return self.atlas_dir or self.data_dir / "atlas"

    @classmethod
    def from_environment(cls, environment: Mapping[str, str] | None = None) -> StoreSettings:
        """`SIDEBAND_DATA_DIR`, `REDIS_URL`, `DATABASE_URL`, `ARTEFACT_URL`, `SIDEBAND_ATLAS`."""
        env = os.environ if environment is None else environment
        return cls(
            data_dir=Path(env.get("SIDEBAND_DATA_DIR", "data")).absolute(),
            redis_url=env.get("REDIS_URL", ""),
            database_url=env.get("DATABASE_URL", ""),
            artefact_url=env.get("ARTEFACT_URL", ""),
            atlas_dir=Path(atlas).absolute() if (atlas := env.get("SIDEBAND_ATLAS", "")) else None,
        )
