"""Training in slices: the same policy, metrics in files, an end by certificate."""

from __future__ import annotations

import json
from pathlib import Path

import gymnasium as gym
import pytest

from tltl import FiniteModel, Learner, solve
from tltl.watch import train

TASK = "corner T goal"


def labels(s: int) -> dict[str, bool]:
    return {"corner": s == 3, "goal": s == 15}


@pytest.fixture(scope="module")
def model() -> FiniteModel:
    return FiniteModel.from_env(gym.make("FrozenLake-v1", is_slippery=True))


def test_slices_change_nothing(model: FiniteModel) -> None:
    whole, sliced = (Learner(model, TASK, labels, seed=3) for _ in range(2))
    whole.train(50_000)
    metrics = train(sliced, 50_000, every=7_000)
    assert (sliced.Q == whole.Q).all() and sliced.steps == whole.steps
    assert [line["learner_steps"] for line in metrics] == sorted(line["learner_steps"] for line in metrics)
    assert metrics[-1]["learner_steps"] == whole.steps
    assert train(sliced, 50_000) == [], "that many have been taken already"


def test_it_ends_by_certificate(model: FiniteModel, tmp_path: Path) -> None:
    solution = solve(model, TASK, labels)
    learner = Learner(model, TASK, labels, seed=3)
    metrics = train(learner, 5_000_000, every=20_000, solution=solution, within=0.02, log=tmp_path)
    assert learner.steps < 1_000_000
    last = metrics[-1]
    assert last["regret_satisfied"] <= 0.02 and last["regret_steps"] <= 0.02
    assert all(line["regret_satisfied"] > 0.02 or line["regret_steps"] > 0.02 for line in metrics[:-1])
    assert last["satisfied"] == learner.certify(solution).satisfied
    written = (tmp_path / "metrics.jsonl").read_text(encoding="utf-8").splitlines()
    assert [json.loads(line) for line in written] == metrics


def test_a_task_that_nobody_can_satisfy(model: FiniteModel) -> None:
    never = {"corner": False, "goal": False}
    solution = solve(model, TASK, lambda s: never)
    learner = Learner(model, TASK, lambda s: never, seed=1)
    metrics = train(learner, 10_000, every=1_000, solution=solution, within=0.0)
    assert metrics[-1]["satisfied"] == 0.0 and "steps_of_policy" not in metrics[-1]


def test_progress_is_told_on_the_standard_error(
    model: FiniteModel, capsys: pytest.CaptureFixture[str]
) -> None:
    train(Learner(model, TASK, labels, seed=1), 2_000, every=1_000, progress=True)
    told = capsys.readouterr()
    assert told.out == "" and "of 2,000 steps" in told.err and told.err.endswith("\n")
    train(Learner(model, TASK, labels, seed=1), 2_000, every=1_000)
    assert capsys.readouterr().err == "", "not a terminal"


def test_event_files(model: FiniteModel, tmp_path: Path) -> None:
    pytest.importorskip("tensorboardX")
    train(Learner(model, TASK, labels, seed=1), 2_000, every=1_000, log=tmp_path)
    events = list(tmp_path.glob("events.out.tfevents.*"))
    assert events and events[0].stat().st_size > 100


def test_what_is_asked_wrongly(model: FiniteModel) -> None:
    learner = Learner(model, TASK, labels)
    with pytest.raises(ValueError, match="needs `solution`"):
        train(learner, 1_000, within=0.1)
    with pytest.raises(ValueError, match="`every` is 0"):
        train(learner, 1_000, every=0)
    with pytest.raises(TypeError, match="`learner` is a NoneType, not a tltl.Learner"):
        train(None, 1_000)  # type: ignore[arg-type]
