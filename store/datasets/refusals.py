"""What stands in the way of an upload, by what was typed: the folder (DIR) or the place (URL)."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager

from botocore.exceptions import (
    BotoCoreError,
    ClientError,
    HTTPClientError,
    NoCredentialsError,
    PartialCredentialsError,
)
from botocore.exceptions import ConnectionError as NotConnected

from sim.core.errors import Problem, SpecError
from store.datasets.place import ALLOWED

ELSEWHERE = "a prefix that holds nothing else"
KEYS = "AWS_ACCESS_KEY_ID and AWS_SECRET_ACCESS_KEY of one who may list, read, put and abort uploads there"
_KEYS = ("AccessDenied", "403", "InvalidAccessKeyId", "SignatureDoesNotMatch", "ExpiredToken", "InvalidToken")
_REGION = ("PermanentRedirect", "301", "AuthorizationHeaderMalformed", "IllegalLocationConstraintException")


def in_place(url: str, message: str, allowed: str) -> SpecError:
    """Something is wrong with the place, or with what is there."""
    return SpecError(Problem(field="URL", message=message, given=url, allowed=allowed))


def in_folder(folder: object, found: Sequence[object]) -> SpecError:
    """The folder is not what its manifest says."""
    told = "; ".join(map(str, found[:3])) + " ..." * (len(found) > 3)
    allowed = "a dataset that `sideband dataset verify` finds nothing wrong with"
    return SpecError(Problem(field="DIR", message=f"is damaged: {told}", given=str(folder), allowed=allowed))


def code_of(error: ClientError) -> str:
    """The store's word for what happened."""
    return str(error.response.get("Error", {}).get("Code", "unknown"))


@contextmanager
def refusals(url: str) -> Iterator[None]:
    """Errors of the store as SpecError of the URL; its own text is not repeated."""
    try:
        yield
    except ClientError as error:
        raise _refused(url, code_of(error)) from error
    except (NoCredentialsError, PartialCredentialsError) as error:
        raise in_place(url, "needs keys of access", KEYS) from error
    except (NotConnected, HTTPClientError) as error:
        message = f"cannot be reached, or broke off ({type(error).__name__})"
        raise in_place(url, message, "an endpoint that answers; run it again to go on") from error
    except BotoCoreError as error:
        raise in_place(url, f"does not answer as it should ({type(error).__name__})", ALLOWED) from error


def _refused(url: str, code: str) -> SpecError:
    if code in ("NoSuchBucket", "404"):
        return in_place(url, "names a bucket that is not there", "a bucket that exists")
    if code in _KEYS:
        return in_place(url, f"is refused to these keys of access ({code})", KEYS)
    if code in _REGION:
        return in_place(url, f"is in another region ({code})", "the bucket's own: `?region=NAME` or AWS_REGION")
    return in_place(url, f"is refused by the store ({code})", "run it again to go on")
