"""The client against a real server, broker and worker."""

from __future__ import annotations

import json
from collections.abc import Iterator
from pathlib import Path

import httpx
import numpy as np
import pytest

import sideband_client
from app.keys import digest_of
from sideband_client import Client, Job, Progress, errors
from sideband_client.transport import Timing, Transport
from tests.service.fakes import machine
from tests.service.parts import LiveServer, Parts

pytestmark = pytest.mark.slow  # everything here waits for a worker that simulates or reads


def spec(notes: str) -> dict:
    return machine(notes).model_dump(mode="json")


@pytest.fixture(scope="module")
def done(url: str) -> Iterator[Job]:
    with sideband_client.connect(url) as client:
        yield client.simulate("oscillator", duration_s=0.5, seed=21).wait()


def test_progress_runs_from_waiting_to_done(client: Client) -> None:
    seen: list[Progress] = []
    job = client.simulate(spec("sleep=0.5"), duration_s=0.1, seed=1)
    assert job.wait(progress=seen.append, timeout_s=60) is job
    fractions = [told.fraction for told in seen]
    assert fractions == sorted(fractions) and seen[-1].fraction == 1.0 and seen[-1].status == "successful"
    assert "running" in {told.status for told in seen}


def test_signals_are_arrays_in_the_order_asked_for(done: Job) -> None:
    result = done.result()
    whole = result.signals()
    assert [c.name for c in whole.channels] == ["mass.y.displacement", "mass.y.acceleration"]
    assert whole.values.shape == (2, 15000) and whole.sampling_rate_hz == 30000.0
    assert np.max(np.abs(whole["mass.y.displacement"] - np.sin(2 * np.pi * 40 * whole.t_s))) < 0.01
    part = result.signals(["mass.y.acceleration", "mass.y.displacement"], start_s=0.1, end_s=0.2)
    assert part.values.shape == (2, 3000) and part.start_s == pytest.approx(0.1)
    assert np.array_equal(part.values, whole.values[::-1, 3000:6000])
    assert [c.unit for c in part.channels] == ["m/s^2", "m"]
    with pytest.raises(KeyError, match="there are: mass"):
        whole["nothing"]


def test_summary_spectrum_and_peaks(done: Job) -> None:
    result = done.result()
    assert result.summary["samples"] == 15000
    spectrum = result.spectrum("mass.y.displacement")
    assert spectrum.axis[np.argmax(spectrum.values)] == 40.0 and spectrum.axis_unit == "Hz"
    assert result.peaks()["peaks"][0]["label"] == "1*f_r1"
    with pytest.raises(errors.NotFound) as caught:
        result.spectrum("mass.y.displacement", "order")
    assert "amplitude of mass.y.displacement" in str(caught.value)
    with pytest.raises(LookupError, match=r"mass\.y\.displacement"):
        result.signals(["nothing"])


def test_saved_files_hold_the_result(done: Job, tmp_path: Path) -> None:
    folder = done.result().save(tmp_path / "out")
    assert sorted(p.name for p in folder.iterdir()) == ["peaks.json", "signals.npz", "summary.json"]
    with np.load(folder / "signals.npz") as archive:
        assert np.array_equal(archive["mass.y.displacement"], done.result().signals()["mass.y.displacement"])
    assert json.loads((folder / "summary.json").read_text())["job"] == done.id


def test_nothing_is_overwritten_unless_told_to(done: Job, tmp_path: Path) -> None:
    result = done.result()
    (tmp_path / "summary.json").write_text("mine")
    with pytest.raises(FileExistsError, match=r"summary\.json.*overwrite=True") as caught:
        result.save(tmp_path)
    assert isinstance(caught.value, errors.AlreadyThere)
    assert [p.name for p in tmp_path.iterdir()] == ["summary.json"], "nothing is written beside it either"
    result.save(tmp_path, overwrite=True)
    assert json.loads((tmp_path / "summary.json").read_text())["job"] == done.id
    with pytest.raises(errors.AlreadyThere):
        result.download("signals.f64", tmp_path / "signals.npz")
    result.download("signals.f64", tmp_path / "signals.npz", overwrite=True)


def test_stored_file_is_checked_on_the_way(done: Job, tmp_path: Path) -> None:
    result = done.result()
    raw = np.fromfile(result.download("signals.f64", tmp_path / "raw"), dtype="<f8").reshape(2, -1)
    assert np.array_equal(raw, result.signals().values)
    with pytest.raises(errors.NotFound, match=r"signals\.f64"):
        result.download("nothing", tmp_path / "x")


def test_damaged_bytes_are_noticed_and_leave_no_file(done: Job, tmp_path: Path) -> None:
    result = done.result()
    summary = json.loads(json.dumps(result.summary))
    summary["files"]["signals.f64"]["sha256"] = "0" * 64
    result.__dict__["summary"] = summary
    with pytest.raises(errors.BadReply, match="damaged"):
        result.download("signals.f64", tmp_path / "raw")
    assert list(tmp_path.iterdir()) == []


def test_invalid_request_names_the_fields(client: Client) -> None:
    with pytest.raises(ValueError) as caught:
        client.simulate("oscillator", duration_s=-1.0)
    assert isinstance(caught.value, errors.InvalidRequest)
    assert caught.value.fields[0].field == "duration_s" and caught.value.fields[0].given == -1.0
    assert "duration_s" in str(caught.value)
    with pytest.raises(errors.InvalidRequest, match="allowed: oscillator, slow"):
        client.simulate("no-such-preset")
    with pytest.raises(errors.NotFound, match="oscillator"):
        client.preset("no-such-preset")


def test_failed_job_says_why(client: Client) -> None:
    with pytest.raises(errors.JobFailed) as caught:
        client.simulate(spec("diverge"), seed=3).wait()
    assert (caught.value.code, caught.value.detail["dof"]) == ("diverged", "mass.y")
    assert "smaller step" in caught.value.advice


def test_a_result_that_will_never_be_is_told_at_once(client: Client) -> None:
    failed = client.simulate(spec("diverge"), seed=31)
    with pytest.raises(errors.JobFailed):
        failed.wait()
    for job in (failed, client.job(failed.id)):
        with pytest.raises(errors.JobFailed, match="diverged"):
            job.result()
    waiting = client.simulate(spec("sleep=30"), seed=32)
    with pytest.raises(errors.NotReady, match="wait"):
        waiting.result()
    waiting.cancel()
    with pytest.raises(errors.JobDismissed):
        waiting.wait(timeout_s=30)
    with pytest.raises(errors.JobDismissed, match="cancelled"):
        waiting.result()


def test_cancel_withdraws_this_submission_only(client: Client) -> None:
    first = client.simulate(spec("sleep=30"), seed=4)
    second = client.simulate(spec("sleep=30"), seed=4)
    assert first.id == second.id
    assert first.cancel().document["submitters"] == 1
    with pytest.raises(errors.WaitedTooLong):
        second.wait(timeout_s=0.3)
    with pytest.raises(errors.NotReady) as caught:
        _ = second.result().summary
    assert caught.value.retry_after_s
    assert second.cancel().document["submitters"] == 0
    with pytest.raises(errors.JobDismissed):
        second.wait(timeout_s=30)
    with pytest.raises(errors.Conflict):
        second.cancel()


def test_deleted_job_is_gone(client: Client) -> None:
    job = client.simulate("oscillator", duration_s=0.1, seed=5).wait()
    job.delete()
    with pytest.raises(errors.Gone):
        _ = job.result().summary
    with pytest.raises(errors.Gone):
        client.job(job.id)
    with pytest.raises(errors.NotFound):
        client.job("0" * 32)
    with pytest.raises(ValueError, match="not a name"):
        client.job("../presets")


def test_list_goes_over_pages(client: Client, monkeypatch: pytest.MonkeyPatch) -> None:
    for seed in range(5):
        client.simulate("oscillator", duration_s=0.1, seed=100 + seed).wait()
    monkeypatch.setattr("sideband_client.asking.PAGE", 2)
    listed = [state.id for state in client.jobs(status=["successful"], preset="oscillator")]
    assert len(listed) == len(set(listed)) >= 5
    oldest = [state.created_at for state in client.jobs(sort="created_at")]
    assert oldest == sorted(oldest)


def test_what_there_is_to_choose_from(client: Client) -> None:
    assert {"oscillator", "slow"} <= {entry["name"] for entry in client.presets()}
    assert client.check(client.preset("oscillator"))["valid"] is True
    assert client.terms()[0]["key"] == "fit_clearance"
    assert client.bearings()[0]["designation"] == "6203"
    assert client.health()["broker"]["status"] == "ok"


def test_key_opens_the_guarded_server(parts: Parts) -> None:
    with LiveServer(parts.app(api_keys={digest_of("key-of-ann"): "ann"})) as http:
        url = str(http.base_url)
        with sideband_client.connect(url) as nobody, pytest.raises(errors.NotAllowed):
            nobody.presets()
        with sideband_client.connect(url, api_key="key-of-ann") as ann:
            job = ann.simulate(spec("sleep=30"), seed=6)
            job.cancel()
            with pytest.raises(errors.JobDismissed):
                job.wait(timeout_s=30)


class _LosesReplies(httpx.HTTPTransport):
    """The request arrives and is carried out, the reply of the first POST is lost."""

    lost = 0

    def handle_request(self, request: httpx.Request) -> httpx.Response:
        reply = super().handle_request(request)
        if request.method == "POST" and not self.lost:
            self.lost += 1
            reply.close()
            raise httpx.ReadTimeout("lost")
        return reply


def test_lost_reply_makes_no_second_job_and_no_second_submitter(url: str, client: Client) -> None:
    wire = _LosesReplies()
    with Client(Transport(httpx.Client(transport=wire, base_url=url), Timing(), sleep=lambda _: None)) as unlucky:
        job = unlucky.simulate(spec("sleep=30"), seed=7)
        assert wire.lost == 1
        assert job.state.document["submitters"] == 1
        job.cancel()
        with pytest.raises(errors.JobDismissed):
            client.job(job.id).wait(timeout_s=30)


def test_reused_key_is_told(client: Client) -> None:
    client.simulate("oscillator", duration_s=0.1, seed=8, idempotency_key="mine")
    with pytest.raises(errors.KeyReused):
        client.simulate("oscillator", duration_s=0.1, seed=9, idempotency_key="mine")
