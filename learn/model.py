"""A trained classifier: standardisation, a few small networks, a temperature; a JSON file, read by NumPy alone.

Loading executes nothing: the file is plain numbers, bounded in size and checked shape by shape.
"""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from importlib.resources import files
from pathlib import Path
from typing import Any

import numpy as np

from learn.softmax import softmax
from signals.series import FloatArray
from sim.core.errors import Problem, SpecError

FORMAT = "sideband-classifier"
VERSION = 1
MAX_BYTES = 8 * 2**20
MOST_FEATURES, MOST_CLASSES, MOST_NETWORKS, MOST_LAYERS, MOST_UNITS = 256, 32, 32, 6, 512
LARGEST = 1e6
CLIP = 6.0
"""Standardised features beyond this many deviations are pulled in: what training never saw must not run away."""


@dataclass(frozen=True, kw_only=True)
class Network:
    """Layers of weights (in, out) and offsets (out,); tanh between them."""

    weights: tuple[FloatArray, ...]
    offsets: tuple[FloatArray, ...]

    def scores(self, values: FloatArray) -> FloatArray:
        """(rows, classes) before softmax."""
        for w, b in zip(self.weights[:-1], self.offsets[:-1], strict=True):
            values = np.tanh(values @ w + b)
        return np.asarray(values @ self.weights[-1] + self.offsets[-1], dtype=np.float64)


@dataclass(frozen=True, kw_only=True)
class Head:
    """One question's classifier: which features in which order, the classes, how likely each is."""

    features: tuple[str, ...]
    classes: tuple[str, ...]
    mean: FloatArray
    scale: FloatArray
    networks: tuple[Network, ...]
    temperature: float

    def probabilities(self, rows: FloatArray) -> FloatArray:
        """(rows, classes): mean of the networks' scores over the temperature, through softmax."""
        z = np.clip((np.atleast_2d(rows) - self.mean) / self.scale, -CLIP, CLIP)
        total = np.mean([n.scores(z) for n in self.networks], axis=0)
        return softmax(total / self.temperature)


@dataclass(frozen=True, kw_only=True)
class Model:
    """Heads by question (`known`, `unknown`, ...), and how it was made."""

    heads: Mapping[str, Head]
    made_by: Mapping[str, object]


def save(model: Model, path: Path) -> None:
    """Write as JSON; equal models give equal bytes."""
    document = {
        "format": FORMAT,
        "version": VERSION,
        "made_by": dict(model.made_by),
        "heads": {name: _written(head) for name, head in model.heads.items()},
    }
    path.write_text(json.dumps(document, indent=None, separators=(",", ":"), sort_keys=True) + "\n", encoding="utf-8")


def _numbers(values: FloatArray) -> list[object]:
    """Seven digits: more than the features have."""
    rounded = [float(f"{v:.7g}") for v in values.ravel()]
    found: list[object] = np.reshape(rounded, values.shape).tolist()
    return found


def _written(head: Head) -> dict[str, Any]:
    return {
        "features": list(head.features),
        "classes": list(head.classes),
        "mean": _numbers(head.mean),
        "scale": _numbers(head.scale),
        "temperature": head.temperature,
        "networks": [
            [{"weights": _numbers(w), "offsets": _numbers(b)} for w, b in zip(n.weights, n.offsets, strict=True)]
            for n in head.networks
        ],
    }


def default_model() -> Model:
    """The model that is shipped."""
    return parsed(files("learn").joinpath("default_model.json").read_text(encoding="utf-8"), "the shipped model")


def load(path: Path) -> Model:
    """Read a model; SpecError says what is wrong with a malformed one."""
    if path.stat().st_size > MAX_BYTES:
        raise _refused("model", "is too large to be a model", path.stat().st_size, f"at most {MAX_BYTES} bytes")
    try:
        text = path.read_text(encoding="utf-8")
    except UnicodeDecodeError:
        raise _refused(
            "model",
            "is no text, so no model",
            path.name,
            "a file that `learn.model.save` or `python -m learn.sim2real --model` wrote",
        ) from None
    return parsed(text, path.name)


def parsed(text: str, name: str) -> Model:
    """A model from its text."""
    try:
        document = json.loads(text)
    except (json.JSONDecodeError, RecursionError):
        raise _refused(
            "model",
            "is no JSON, so no model",
            name,
            "a file that `learn.model.save` or `python -m learn.sim2real --model` wrote",
        ) from None
    if not isinstance(document, dict) or document.get("format") != FORMAT or document.get("version") != VERSION:
        raise _refused("model", f"is no {FORMAT} of version {VERSION}", name, f"format {FORMAT}, version {VERSION}")
    heads, made = document.get("heads"), document.get("made_by")
    if not isinstance(heads, dict) or not heads or not isinstance(made, dict):
        raise _refused("model.heads", "must be an object with at least one head", type(heads).__name__, "an object")
    return Model(heads={str(k): _head(str(k), v) for k, v in heads.items()}, made_by=made)


def _head(name: str, raw: object) -> Head:
    at = f"model.heads.{name}"
    if not isinstance(raw, dict):
        raise _refused(at, "must be an object", type(raw).__name__, "an object")
    features = _words(raw.get("features"), f"{at}.features", MOST_FEATURES)
    classes = _words(raw.get("classes"), f"{at}.classes", MOST_CLASSES)
    networks = raw.get("networks")
    if not isinstance(networks, list) or not 1 <= len(networks) <= MOST_NETWORKS:
        raise _refused(f"{at}.networks", "must be a list", type(networks).__name__, f"1 to {MOST_NETWORKS} networks")
    scale = _array(raw.get("scale"), f"{at}.scale", (len(features),))
    temperature = float(_array(raw.get("temperature"), f"{at}.temperature", ()))
    if np.any(scale <= 0) or temperature <= 0:
        raise _refused(f"{at}.scale", "and temperature must be above 0", float(np.min(scale)), "above 0")
    return Head(
        features=features,
        classes=classes,
        mean=_array(raw.get("mean"), f"{at}.mean", (len(features),)),
        scale=scale,
        networks=tuple(_network(n, f"{at}.networks.{i}", len(features), len(classes)) for i, n in enumerate(networks)),
        temperature=temperature,
    )


def _network(raw: object, at: str, inputs: int, outputs: int) -> Network:
    if not isinstance(raw, list) or not 1 <= len(raw) <= MOST_LAYERS or not all(isinstance(x, dict) for x in raw):
        raise _refused(at, "must be a list of layers", type(raw).__name__, f"1 to {MOST_LAYERS} layers")
    weights, offsets, width = [], [], inputs
    for i, layer in enumerate(raw):
        offset = np.asarray(layer.get("offsets"), dtype=object)
        units = outputs if i == len(raw) - 1 else int(offset.size)
        if not 1 <= units <= MOST_UNITS:
            raise _refused(f"{at}.{i}", "has a wrong number of units", units, f"1 to {MOST_UNITS}")
        weights.append(_array(layer.get("weights"), f"{at}.{i}.weights", (width, units)))
        offsets.append(_array(layer.get("offsets"), f"{at}.{i}.offsets", (units,)))
        width = units
    return Network(weights=tuple(weights), offsets=tuple(offsets))


def _array(raw: object, at: str, shape: tuple[int, ...]) -> FloatArray:
    try:
        values = np.asarray(raw, dtype=np.float64)
    except (TypeError, ValueError):
        raise _refused(at, "must hold numbers", type(raw).__name__, f"shape {shape}") from None
    if values.shape != shape or not np.all(np.isfinite(values)) or np.any(np.abs(values) > LARGEST):
        raise _refused(at, "must be finite numbers of the right shape", f"shape {values.shape}", f"shape {shape}")
    return values


def _words(raw: object, at: str, most: int) -> tuple[str, ...]:
    if not isinstance(raw, Sequence) or isinstance(raw, str) or not 1 <= len(raw) <= most:
        raise _refused(at, "must be a list of names", type(raw).__name__, f"1 to {most} names")
    words = tuple(str(w)[:80] for w in raw)
    if len(set(words)) != len(words):
        raise _refused(at, "must differ", list(words), "different names")
    return words


def _refused(field: str, message: str, given: object, allowed: str) -> SpecError:
    return SpecError(Problem(field=field, message=message, given=given, allowed=allowed))
