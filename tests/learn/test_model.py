import json
import warnings

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from sklearn.neural_network import MLPClassifier

from learn.model import Model, load, parsed, save
from learn.train import HIDDEN, ITERATIONS, PENALTY, fit_head
from sim.core.errors import SpecError

CLASSES = ("a", "b", "c")


def data(n=150, seed=0):
    rng = np.random.default_rng(seed)
    kinds = rng.integers(0, 3, n)
    rows = rng.standard_normal((n, 4)) + 2.0 * np.eye(3, 4)[kinds]
    return rows, [CLASSES[k] for k in kinds], list(range(n))


def head(seed=0, networks=2):
    rows, labels, machines = data()
    return fit_head(rows, labels, machines, tuple("wxyz"), CLASSES, seed=seed, networks=networks)


@pytest.fixture(scope="module")
def model():
    return Model(heads={"known": head()}, made_by={"command": "test"})


def test_inference_is_that_of_scikit_learn():
    rows, labels, machines = data()
    one = fit_head(rows, labels, machines, tuple("wxyz"), CLASSES, seed=3, networks=1)
    z = np.clip((rows - rows.mean(0)) / rows.std(0), -6, 6)
    kinds = np.array([CLASSES.index(x) for x in labels])
    counts = np.bincount(kinds)
    fitted = MLPClassifier(
        hidden_layer_sizes=HIDDEN, activation="tanh", solver="lbfgs", alpha=PENALTY, max_iter=ITERATIONS, random_state=3
    )
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        fitted.fit(z, kinds, sample_weight=len(kinds) / (3 * counts[kinds]))
    plain = one.probabilities(rows) ** one.temperature
    np.testing.assert_allclose(plain / plain.sum(1, keepdims=True), fitted.predict_proba(z), atol=1e-9)


def test_two_classes_too():
    rows, labels, machines = data()
    two = ["a" if x == "a" else "b" for x in labels]
    found = fit_head(rows, two, machines, tuple("wxyz"), ("a", "b"), networks=1).probabilities(rows)
    np.testing.assert_allclose(found.sum(1), 1.0)
    assert np.mean(np.argmax(found, axis=1) == [int(x == "b") for x in two]) > 0.8


def test_a_saved_model_answers_the_same(model, tmp_path):
    path = tmp_path / "model.json"
    save(model, path)
    rows, _, _ = data(20, seed=9)
    again = load(path)
    np.testing.assert_allclose(
        again.heads["known"].probabilities(rows), model.heads["known"].probabilities(rows), atol=1e-5
    )
    assert again.made_by == {"command": "test"}


@pytest.mark.slow
def test_the_same_seed_gives_the_same_bytes(tmp_path):
    for name in ("one", "two"):
        save(Model(heads={"known": head(seed=4)}, made_by={}), tmp_path / name)
    assert (tmp_path / "one").read_bytes() == (tmp_path / "two").read_bytes()


def test_what_training_never_saw_does_not_run_away(model):
    p = model.heads["known"].probabilities(np.full((1, 4), 1e300))
    assert np.all(np.isfinite(p))
    np.testing.assert_allclose(p.sum(), 1.0)


def document(model, tmp_path):
    save(model, tmp_path / "m.json")
    return json.loads((tmp_path / "m.json").read_text())


@pytest.mark.parametrize(
    ("change", "field"),
    [
        (lambda d: d.update(format="other"), "model"),
        (lambda d: d.update(version=99), "model"),
        (lambda d: d.update(heads={}), "model.heads"),
        (lambda d: d["heads"]["known"].update(scale=[1, 1, 0, 1]), "model.heads.known.scale"),
        (lambda d: d["heads"]["known"].update(mean=[1, 2]), "model.heads.known.mean"),
        (lambda d: d["heads"]["known"].update(mean=["x"] * 4), "model.heads.known.mean"),
        (lambda d: d["heads"]["known"].update(temperature=0.0), "model.heads.known.scale"),
        (lambda d: d["heads"]["known"].update(networks=[]), "model.heads.known.networks"),
        (lambda d: d["heads"]["known"].update(networks=[[{}]]), "model.heads.known.networks.0.0.weights"),
        (lambda d: d["heads"]["known"].update(classes=["a", "a", "b"]), "model.heads.known.classes"),
        (lambda d: d["heads"]["known"]["networks"][0][0]["weights"][0].append(1.0), "weights"),
        (lambda d: d["heads"]["known"]["networks"][0][0]["weights"][0].__setitem__(0, 1e99), "weights"),
    ],
)
def test_a_malformed_model_is_refused(model, tmp_path, change, field):
    found = document(model, tmp_path)
    change(found)
    with pytest.raises(SpecError) as error:
        parsed(json.dumps(found), "m.json")
    assert field in str(error.value)


@pytest.mark.parametrize(
    "text", ["", "[]", "{", "null", "[" * 100_000, '{"format": "sideband-classifier", "version": 1}']
)
def test_what_is_no_model_is_refused(text):
    with pytest.raises(SpecError):
        parsed(text, "m.json")


def test_a_pickle_is_refused_unread(tmp_path):
    path = tmp_path / "m.json"
    path.write_bytes(b"\x80\x04\x95\xff\xfe")
    with pytest.raises(SpecError, match="no text"):
        load(path)


def test_a_huge_file_is_refused_unread(tmp_path):
    path = tmp_path / "m.json"
    with path.open("wb") as file:
        file.truncate(2**30)
    with pytest.raises(SpecError, match="too large"):
        load(path)


JSON = st.recursive(
    st.none() | st.booleans() | st.floats(allow_nan=False) | st.text(max_size=5),
    lambda x: st.lists(x, max_size=3) | st.dictionaries(st.text(max_size=5), x, max_size=3),
)


@pytest.mark.slow
@settings(max_examples=60, deadline=None)
@given(JSON)
def test_any_head_is_read_or_refused(raw):
    with pytest.raises(SpecError):
        parsed(json.dumps({"format": "sideband-classifier", "version": 1, "made_by": {}, "heads": {"h": raw}}), "m")
