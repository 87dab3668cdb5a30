"""The Compose file against the Compose Specification's schema, and against what the product promises.

No container engine runs here: images are not built and containers not started by these tests.
"""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import jsonschema
import pytest
import yaml

ROOT = Path(__file__).resolve().parents[2]
SCHEMA = ROOT / "tests" / "data" / "compose" / "compose-spec.json"


@pytest.fixture(scope="module")
def compose() -> dict[str, Any]:
    return yaml.safe_load((ROOT / "docker-compose.yml").read_text(encoding="utf-8"))


def validate(document: object) -> None:
    schema = json.loads(SCHEMA.read_text(encoding="utf-8"))
    jsonschema.validators.validator_for(schema)(schema).validate(document)


def test_file_follows_the_specification(compose: dict[str, Any]) -> None:
    validate(compose)


def test_schema_does_refuse(compose: dict[str, Any]) -> None:
    broken = json.loads(json.dumps(compose))
    broken["services"]["api"]["helthcheck"] = {}
    with pytest.raises(jsonschema.ValidationError):
        validate(broken)


def test_every_service_has_a_health_check_and_known_volumes(compose: dict[str, Any]) -> None:
    assert set(compose["services"]) == {"valkey", "api", "worker"}
    for name, service in compose["services"].items():
        assert service["healthcheck"]["test"][0] == "CMD", name
        for volume in service["volumes"]:
            assert volume.split(":")[0] in compose["volumes"]


def test_workers_can_be_scaled_and_broker_keeps_what_it_accepts(compose: dict[str, Any]) -> None:
    worker = compose["services"]["worker"]
    assert "container_name" not in worker and "ports" not in worker
    command = compose["services"]["valkey"]["command"]
    assert command[command.index("--maxmemory-policy") + 1] == "noeviction"
    assert command[command.index("--appendonly") + 1] == "yes"


def test_only_loopback_is_published_and_keys_are_demanded(compose: dict[str, Any]) -> None:
    published = [port for service in compose["services"].values() for port in service.get("ports", [])]
    assert len(published) == 1 and published[0].startswith("127.0.0.1:")
    environment = compose["services"]["api"]["environment"]
    # It must be set, if only to nothing beside a file; the API itself refuses to start without any key.
    assert environment["SIDEBAND_API_KEYS"].startswith("${SIDEBAND_API_KEYS?")
    assert environment["SIDEBAND_HOST"] == "0.0.0.0" and "SIDEBAND_API_KEYS_FILE" in environment


def test_containers_stand_by_what_the_image_is(compose: dict[str, Any]) -> None:
    image = (ROOT / "Dockerfile").read_text(encoding="utf-8")
    for name in ("api", "worker"):
        service = compose["services"][name]
        for volume in service["volumes"]:
            assert volume.split(":")[1] in image, f"{volume} is not a folder the image makes for its user"
        assert service["environment"]["SIDEBAND_DATA_DIR"] == "/data"
        assert service["read_only"] is True and service["cap_drop"] == ["ALL"]
    published = compose["services"]["api"]["ports"][0].rpartition(":")[2]
    assert f"EXPOSE {published}\n" in image


def test_several_hosts_can_be_reached_by_all_containers(compose: dict[str, Any]) -> None:
    # `inside` has no way out: a database or a bucket elsewhere needs a network that has one.
    wanted = {"DATABASE_URL", "ARTEFACT_URL", "AWS_ACCESS_KEY_ID", "AWS_SECRET_ACCESS_KEY"}
    for name in ("api", "worker"):
        service = compose["services"][name]
        assert wanted <= set(service["environment"]) and "outside" in service["networks"], name
