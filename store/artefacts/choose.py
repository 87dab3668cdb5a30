"""The artefact store that the settings name."""

from __future__ import annotations

from jobs.ports import ArtefactStore
from sim.core.errors import Problem, SpecError
from store.artefacts.folder import FolderStore
from store.artefacts.place import s3_place
from store.settings import StoreSettings


def open_artefacts(settings: StoreSettings) -> ArtefactStore:
    """A folder, or a bucket. The bucket is not asked yet: it may be away, and readiness tells."""
    if not settings.artefact_url.startswith("s3://"):
        return FolderStore(settings.artefact_folder)
    place = s3_place(settings.artefact_url)
    try:
        # Here and not at the top: boto3 is the optional extra `s3`.
        from store.artefacts.s3 import S3Store  # noqa: PLC0415
    except ModuleNotFoundError as error:
        message = "needs the client of object stores; install the extra `s3`"
        raise SpecError(Problem(field="ARTEFACT_URL", message=message, given=settings.artefact_url)) from error
    # Not where temporary files usually go: in a container that is memory.
    return S3Store(place, spool=settings.data_dir)
