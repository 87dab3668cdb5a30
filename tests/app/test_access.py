"""API keys: needed as soon as others can reach the server; submitters of one holder stay their own."""

from __future__ import annotations

from collections.abc import Iterator

import httpx
import pytest

from app.key_file import Key, parse_key_file
from app.keys import digest_of, main
from app.settings import Settings, parse_keys
from sim.core.errors import SpecError
from store.settings import StoreSettings
from tests.service.fakes import machine
from tests.service.parts import LiveServer, Parts

KEYS = {digest_of("key-of-ann"): "ann", digest_of("key-of-ben"): "ben"}


@pytest.fixture(scope="module")
def guarded(parts: Parts) -> Iterator[httpx.Client]:
    with LiveServer(parts.app(api_keys=KEYS)) as client:
        yield client


def bearer(name: str) -> dict[str, str]:
    return {"Authorization": f"Bearer key-of-{name}"}


def test_no_key_no_service(guarded: httpx.Client) -> None:
    for path in ("/v1/jobs", "/v1/presets", "/v1/health", "/metrics", "/openapi.json"):
        reply = guarded.get(path)
        assert reply.status_code == 401 and reply.headers["WWW-Authenticate"].startswith("Bearer")
        assert reply.headers["Content-Type"] == "application/problem+json"
    assert guarded.get("/v1/jobs", headers={"Authorization": "Bearer wrong"}).status_code == 401
    assert guarded.get("/healthz").status_code == 200 and guarded.get("/readyz").status_code == 200


def test_either_header_carries_the_key(guarded: httpx.Client) -> None:
    assert guarded.get("/v1/jobs", headers=bearer("ann")).status_code == 200
    assert guarded.get("/v1/jobs", headers={"X-API-Key": "key-of-ben"}).status_code == 200


def test_holders_withdraw_only_themselves(guarded: httpx.Client) -> None:
    body = {"machine": machine("sleep=30").model_dump(mode="json"), "seed": 900}
    for name in ("ann", "ben"):
        reply = guarded.post("/v1/simulations", json=body, headers=bearer(name))
        assert reply.json()["submitter"] == name
    path = f"/v1/jobs/{reply.json()['id']}/cancel"
    assert guarded.post(path, json={"everyone": True}, headers=bearer("ann")).json()["submitters"] == 1
    assert guarded.post(path, headers=bearer("ann")).status_code == 409
    assert guarded.post(path, headers=bearer("ben")).json()["submitters"] == 0


def test_idempotency_keys_of_two_holders_do_not_meet(guarded: httpx.Client) -> None:
    for name, seed in (("ann", 901), ("ben", 902)):
        headers = {**bearer(name), "Idempotency-Key": "same"}
        reply = guarded.post("/v1/simulations", json={"preset": "oscillator", "seed": seed}, headers=headers)
        assert reply.status_code == 202


def test_other_machines_need_keys(parts: Parts) -> None:
    with pytest.raises(SpecError, match="API keys"):
        parts.app(host="0.0.0.0")
    Settings(stores=StoreSettings(data_dir=parts.folder, redis_url=""), host="0.0.0.0", api_keys=KEYS).check()


@pytest.mark.parametrize("host", ["127.0.0.1", "::1", "localhost", "127.9.9.9"])
def test_loopback_needs_none(parts: Parts, host: str) -> None:
    Settings(stores=StoreSettings(data_dir=parts.folder, redis_url=""), host=host).check()


def test_made_key_fits_its_entry(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["carl"]) == 0
    key_line, file_line, entry_line = capsys.readouterr().out.splitlines()
    entry = entry_line.split("entry: ")[1]
    in_file = parse_key_file(f'{{"keys": [{file_line.split("entry: ")[1]}]}}'.encode())
    assert in_file == {digest_of(key_line.split(": ")[1]): Key(name="carl")}
    assert parse_keys(entry) == {digest_of(key_line.split(": ")[1]): "carl"}
    with pytest.raises(SpecError):
        parse_keys("carl:abc")


def test_made_key_with_bounds_is_for_the_file_alone(capsys: pytest.CaptureFixture[str]) -> None:
    bounds = [
        "--scopes",
        "read,submit",
        "--days",
        "90",
        "--requests-per-minute",
        "60",
        "--core-seconds-per-day",
        "3600",
    ]
    assert main(["carl", *bounds], now=1000.0) == 0
    _, line = capsys.readouterr().out.splitlines()
    (key,) = parse_key_file(f'{{"keys": [{line.split("entry: ")[1]}]}}'.encode()).values()
    assert key.scopes == {"read", "submit"} and key.not_after == 1000.0 + 90 * 86400
    assert (key.requests_per_minute, key.core_seconds_per_day) == (60, 3600.0)


@pytest.mark.parametrize("wrong", [["a b"], ["ann", "--scopes", "read,rit"], ["ann", "--requests-per-minute", "0"]])
def test_a_key_that_cannot_be_is_refused(wrong: list[str], capsys: pytest.CaptureFixture[str]) -> None:
    assert main(wrong) == 2
    told = capsys.readouterr()
    assert not told.out and "allowed" in told.err
    for days in ("0", "nan", "1e9"):
        with pytest.raises(SystemExit):
            main(["ann", "--days", days])
