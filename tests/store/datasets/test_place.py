"""The URL of a dataset, refused by the name it has on the command line."""

from __future__ import annotations

import pytest

from sim.core.errors import SpecError
from store.datasets.place import dataset_place


def test_bucket_prefix_and_server() -> None:
    place = dataset_place("s3://bucket/a/rig?endpoint=http://127.0.0.1:9000&region=eu-1")
    assert (place.bucket, place.prefix, place.endpoint, place.region) == (
        "bucket",
        "a/rig",
        "http://127.0.0.1:9000",
        "eu-1",
    )


@pytest.mark.parametrize("url", ["rig", "https://bucket/rig", "s3:///rig", "s3://key:secret@bucket/rig"])
def test_what_is_no_bucket_is_refused(url: str) -> None:
    with pytest.raises(SpecError) as caught:
        dataset_place(url)
    problem = caught.value.problems[0]
    assert problem.field == "URL" and "s3://BUCKET" in problem.allowed and "secret@" not in str(caught.value)
