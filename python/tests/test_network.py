"""Network policies as documents, against a forward pass in NumPy."""

from __future__ import annotations

import json
import pickle
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from tltl import NetworkPolicy, Task


def document(task: Task, seed: int) -> tuple[dict[str, Any], list[Any]]:
    """A random network of 4 inputs, 8 and 5 hidden units, 3 actions and a head for each live state."""
    rng = np.random.default_rng(seed)
    live = task.num_states - (task.accepting is not None) - (task.trap is not None)
    widths = [4, 8, 5, 3 * live]
    layers = [
        (rng.normal(size=shape).astype(np.float32), rng.normal(size=shape[1]).astype(np.float32))
        for shape in zip(widths, widths[1:], strict=False)
    ]
    shape = {"inputs": 4, "hidden": [8, 5], "heads": live, "actions": 3, "entities": 0, "channels": 0}
    ends = {"accepting": task.accepting, "trap": task.trap}
    return {
        "format": "tltl-network-policy",
        "version": 1,
        "task": "walk",
        "formula": task.text,
        "actions": ["wait", "left", "right"],
        "automaton": {"states": task.num_states, "initial": task.initial, **ends},
        "training": [],
        "network": {
            "shape": shape,
            "layers": [
                {"weights": w.ravel().tolist(), "bias": bias.tolist()} for w, bias in layers
            ],
        },
    }, layers


def test_a_network_is_its_document(tmp_path: Path) -> None:
    task = Task("F a && F b ensuring !c")
    told, layers = document(task, 1)
    policy = NetworkPolicy.from_json(json.dumps(told))
    assert policy.formula == task.text and "4 inputs" in repr(policy)
    live = [q for q in range(task.num_states) if q not in (task.accepting, task.trap)]
    for x in np.random.default_rng(2).normal(size=(50, 4)).astype(np.float32):
        at = x.astype(np.float64)
        for i, (w, bias) in enumerate(layers):
            at = at @ w + bias
            at = np.maximum(at, 0) if i < 2 else at
        for head, q in enumerate(live):
            expected = at[3 * head : 3 * head + 3]
            assert np.allclose(policy.values(q, x), expected, rtol=1e-4, atol=1e-5)
            assert policy.act(q, x) == policy.values(q, x).argmax()
    policy.save(tmp_path / "network.json")
    for other in (NetworkPolicy.load(tmp_path / "network.json"), pickle.loads(pickle.dumps(policy))):
        assert other == policy
    tool = [sys.executable, "-m", "tltl", "policy", str(tmp_path / "network.json")]
    emitted = subprocess.run(tool, capture_output=True, text=True, check=True).stdout
    assert policy.emit_rust(tmp_path / "network.rs") == emitted
    assert (tmp_path / "network.rs").read_text() == emitted


def test_a_network_of_another_form_is_its_document() -> None:
    """Normalised inputs, tanh, and the automaton state among the inputs of the network."""
    task = Task("F a && F b ensuring !c")
    told, layers = document(task, 1)
    live = [q for q in range(task.num_states) if q not in (task.accepting, task.trap)]
    rng = np.random.default_rng(3)
    mean, deviation = rng.normal(size=4), rng.uniform(0.5, 2, 4)
    states = rng.normal(size=(len(live), 8)).astype(np.float32)
    w, bias = layers[-1]
    layers[-1] = w[:, :3], bias[:3]
    told["version"], network = 2, told["network"]
    network["activation"] = "tanh"
    network["scale"] = {"mean": mean.tolist(), "deviation": deviation.tolist(), "clip": 1.5}
    network["states"] = states.ravel().tolist()
    network["layers"][-1] = {"weights": w[:, :3].ravel().tolist(), "bias": bias[:3].tolist()}
    policy = NetworkPolicy.from_json(json.dumps(told))
    assert NetworkPolicy.from_json(policy.to_json()) == policy
    for x in rng.normal(size=(50, 4)).astype(np.float32):
        for head, q in enumerate(live):
            at = np.clip((x - mean) / deviation, -1.5, 1.5) @ layers[0][0] + layers[0][1]
            for w, bias in layers[1:]:
                at = np.tanh(at + (states[head] if w is layers[1][0] else 0)) @ w + bias
            assert np.allclose(policy.values(q, x), at, rtol=1e-4, atol=1e-5)
    source = policy.emit_rust()
    assert "fn tanh" in source and "static MEAN" in source and "BIAS_0: [[f32; 8]; 3]" in source
    network["states"] = network["states"][:-1]
    with pytest.raises(ValueError, match=r"`network.states` has 23 entries, not 24"):
        NetworkPolicy.from_json(json.dumps(told))


@pytest.mark.parametrize("squash", ["tanh", "clip"])
def test_an_action_may_be_numbers(squash: str) -> None:
    task = Task("F a && F b ensuring !c")
    told, _ = document(task, 1)
    low, high = np.array([-1.0, -2.0, 0.5]), np.array([1.0, 3.0, 0.5])
    told["network"]["controls"] = {"squash": squash, "low": low.tolist(), "high": high.tolist()}
    with pytest.raises(ValueError, match="`network.controls` is not a field of version 1"):
        NetworkPolicy.from_json(json.dumps(told))
    told["version"] = 2
    policy = NetworkPolicy.from_json(json.dumps(told))
    for x in np.random.default_rng(2).normal(size=(50, 4)).astype(np.float32):
        values = policy.values(0, x)
        cut = np.clip(values, low, high)
        expected = low + (np.tanh(values) + 1) / 2 * (high - low) if squash == "tanh" else cut
        assert np.allclose(policy.control(0, x), expected, atol=1e-6)
    with pytest.raises(ValueError, match="is numbers: use `control`"):
        policy.act(0, np.zeros(4, np.float32))
    told["network"]["controls"]["high"] = [1.0, -3.0, 0.5]
    with pytest.raises(ValueError, match="a `low` above its `high`"):
        NetworkPolicy.from_json(json.dumps(told))


def test_what_is_wrong_is_named() -> None:
    task = Task("F a")
    told, _ = document(task, 1)
    policy = NetworkPolicy.from_json(json.dumps(told))
    x = np.zeros(4, np.float32)
    with pytest.raises(ValueError, match="5 numbers; the network reads 4"):
        policy.act(0, np.zeros(5, np.float32))
    for q in (-1, task.accepting or 1, 99):
        with pytest.raises(IndexError, match="in which the task goes on"):
            policy.values(q, x)
    told["version"] = 9
    with pytest.raises(ValueError, match="version"):
        NetworkPolicy.from_json(json.dumps(told))
    with pytest.raises(ValueError, match="missing field `format`"):
        NetworkPolicy.from_json("{}")
