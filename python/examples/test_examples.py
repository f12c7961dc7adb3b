"""Each example does what it says."""

from __future__ import annotations

import os
from pathlib import Path

import pytest
from conftest import since_1_1


@pytest.mark.parametrize(
    ("name", "steps"),
    [
        ("FrozenLake", 300_000),
        ("FrozenLake 8x8", 600_000),
        ("Taxi", 600_000),
        pytest.param("CliffWalking", 300_000, marks=since_1_1),
    ],
)
def test_what_is_learned_is_certified(name: str, steps: int) -> None:
    from toy_text import certified

    worth = certified(name, steps)
    assert worth.regret_satisfied < 1e-3 and (worth.regret_steps or 0.0) < 1e-2


@pytest.mark.sb3
def test_a_network_is_certified_beside_it() -> None:
    pytest.importorskip("stable_baselines3")
    from toy_text import certified_network

    worth = certified_network(2_000)
    assert 0 <= worth.satisfied <= worth.optimal_satisfied == 1.0 and worth.optimal_steps == 8


def test_two_skills_become_one_without_a_step() -> None:
    pytest.importorskip("minigrid")
    from minigrid_rooms import Room, composed, walked

    env = Room()
    both = composed(env, 20_000)
    seen = set(env.visited)
    worth = dict(both.steps)
    assert max(step.satisfied for step in worth.values()) == 1.0
    met = walked(env, both)
    assert env.visited == seen, "no state that was not met before"
    key, door, goal = (
        next(i for i, one in enumerate(met) if one[name]) for name in ("key", "door", "goal")
    )
    assert key < door < goal == len(met) - 1


@pytest.mark.parametrize("seed", range(3))
def test_a_cart_goes_right_and_then_left(seed: int) -> None:
    from cartpole import driven

    satisfied, walk, run = driven(seed)
    assert satisfied and run.satisfied and 0 < run.robustness < 0.2
    right = next(t for t, x in enumerate(walk[:, 0]) if x > 0.3)
    assert right < len(walk) - 1 and walk[-1, 0] < -0.3


@pytest.mark.mujoco
def test_an_arm_swings() -> None:
    pytest.importorskip("mujoco")
    from reacher import swung

    verdicts = []
    for seed in range(4):
        told, run = swung(seed)
        assert told["state"] == run.states[-1] and len(run.states) == 51
        verdicts.append(run.verdict)
    assert "satisfied" in verdicts


@pytest.mark.mujoco
def test_the_kitchen_reads_what_the_script_does() -> None:
    pytest.importorskip("mujoco")
    from kitchen import scripted

    from tltl import Task

    task = Task("kettle T microwave")
    for order in (("kettle", "microwave"), ("microwave", "kettle")):
        states, met = scripted(order)
        q, expected = task.initial, []
        for row in met:
            q = task.step(q, row)
            expected.append(q)
        assert states == expected and (states[0], states[-1]) == (0, task.accepting)
        # The microwave does not count before the kettle.
        assert states.index(1) == next(t for t, row in enumerate(met) if row[0])


def test_a_study_has_its_table() -> None:
    pytest.importorskip("minigrid")
    from doorkey_study import ARMS, TASKS, interval, made, success

    assert interval([0.5] * 5) == "0.50 (0.50 to 0.50)"
    assert interval([0.0, 1.0, 0.0, 1.0, 0.5]) == "0.50 (0.00 to 1.00)"
    for row in TASKS:
        for options in ARMS.values():
            env = made(row, **options)
            assert success(lambda obs: 2, env, 1, seed=1) == 0.0


@pytest.mark.minari
def test_recorded_episodes_are_enough(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    pytest.importorskip("minari")
    monkeypatch.setenv("MINARI_DATASETS_PATH", str(tmp_path))
    from minari_data import FORMULA, labels, learned, recorded

    from tltl import Task

    task = Task(FORMULA)
    seen, every, worth = learned(recorded(600))
    assert len(every.q) == 2 * len(seen.q) and (seen.episode[-1], worth.satisfied) == (599, 1.0)
    # Along each episode the automaton reads its first state, and then every other.
    for number in range(20):
        rows = seen.episode == number
        walk = [0, *seen.next_observations[rows].argmax(1).tolist()]
        q, expected = task.initial, []
        for s in walk:
            q = task.step(q, labels(s))
            expected.append(q)
        assert [*seen.q[rows].tolist(), seen.next_q[rows][-1]] == expected


@pytest.mark.rllib
def test_two_runners_train(monkeypatch: pytest.MonkeyPatch) -> None:
    ray = pytest.importorskip("ray")
    pytest.importorskip("ray.rllib")
    monkeypatch.setenv("PYTHONPATH", str(Path(__file__).parent), prepend=os.pathsep)
    from rllib_door import trained

    ray.init(num_cpus=3, include_dashboard=False, log_to_driver=False)
    told = trained(1)
    assert told["tltl_episodes"] > 0 and 0 <= told["tltl_satisfied"] <= 1
    ray.shutdown()
