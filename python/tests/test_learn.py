"""Learned policies, shields and compositions, against value iteration in NumPy and one another."""

from __future__ import annotations

import _thread
import copy
import json
import pickle
import shutil
import signal
import subprocess
import sys
import threading
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

import gymnasium as gym
import numpy as np
import pytest
from gymnasium import spaces
from test_solve import cells
from toy_text import newest

from tltl import (
    FiniteModel,
    Learner,
    Policy,
    Rewards,
    Schedule,
    Settings,
    Solution,
    compose,
    solve,
)
from tltl._spaces import numbered

LAKE = ["SFFF", "FHFH", "FFFH", "HFFG"]


def holes(s: int) -> dict[str, bool]:
    return {"hole": LAKE[s // 4][s % 4] == "H", "corner": s == 3, "goal": s == 15}


def frozen_lake(**options: Any) -> FiniteModel:
    return FiniteModel.from_env(gym.make("FrozenLake-v1", **options))


@pytest.fixture(scope="module")
def lake() -> FiniteModel:
    return frozen_lake()


def test_the_same_seed_learns_the_same_in_slices(lake: FiniteModel, tmp_path: Path) -> None:
    at_once = Learner(lake, "corner T goal", cells, seed=3).train(20_000)
    sliced = Learner(lake, "corner T goal", cells, seed=3).train(5_000)
    sliced.save(tmp_path / "half.json")
    for total in (5_001, 12_345, 20_000):
        assert sliced.train(total) is sliced and sliced.steps >= total
    resumed = Learner(lake, "corner T goal", cells, seed=9).load(tmp_path / "half.json")
    assert resumed.steps < 6_000 and resumed.seed == 3
    for other in (sliced, resumed.train(20_000)):
        assert np.array_equal(other.Q, at_once.Q)
        assert (other.steps, other.episodes) == (at_once.steps, at_once.episodes)
        assert other.policy() == at_once.policy()
    other = Learner(lake, "corner T goal", cells, seed=4).train(20_000)
    assert not np.array_equal(other.Q, at_once.Q)
    with pytest.raises(ValueError, match="does not fit `goal T corner`"):
        Learner(lake, "goal T corner", cells).load(tmp_path / "half.json")
    with pytest.raises(ValueError, match="expected ident"):
        (tmp_path / "none.json").write_text("nothing")
        at_once.load(tmp_path / "none.json")
    with pytest.raises(FileNotFoundError):
        at_once.load(tmp_path / "missing.json")


def test_what_was_seen_is_what_the_policy_is_best_in(lake: FiniteModel) -> None:
    learner = Learner(lake, "corner T goal", cells, seed=1).train(30_000)
    seen = learner.experience
    assert (seen.num_states, seen.num_actions, seen.horizon) == (16, 4, 100)
    best = solve(seen, "corner T goal", cells)
    worth = best.certify(learner.policy())
    # The learner gives away at most 0.6 % of P for fewer steps.
    assert worth.satisfied >= 0.994 * worth.optimal_satisfied
    assert worth.satisfied_within is not None
    forgetful = Learner(lake, "corner T goal", cells, settings=Settings(remember=False))
    with pytest.raises(ValueError, match="settings.remember is False"):
        _ = forgetful.train(100).experience


def test_settings_are_checked_by_name(lake: FiniteModel) -> None:
    settings = Settings(
        rewards=Rewards("progress", gamma=0.9),
        epsilon=Schedule.linear(1.0, 0.1, 1000),
        alpha=0.5,
        exploration="random",
        horizon=50,
        counterfactual=False,
        initial=1.0,
    )
    learner = Learner(lake, "F goal", cells, settings=settings)
    assert learner.settings == settings and settings.rewards.gamma == 0.9
    assert (settings.alpha.at(7), settings.epsilon.at(500)) == (0.5, 0.55)
    assert (settings.exploration, settings.horizon, settings.initial) == ("random", 50, 1.0)
    assert settings.remember and not settings.counterfactual
    assert Settings().exploration == "coverage" and not Settings.paper().remember
    assert Settings.paper().exploration == "random" and Settings.paper().alpha.at(0) == 0.1
    for wrong, message in (
        ({"alpha": 0.0}, "`alpha` is 0, not in"),
        ({"epsilon": 1.5}, "`epsilon` is 1.5, not in"),
        ({"horizon": 0}, "`horizon` is 0, not at least 1"),
        ({"exploration": "greedy"}, "not `random` or `coverage`"),
    ):
        options: dict[str, Any] = wrong
        with pytest.raises(ValueError, match=message):
            Settings(**options)
    robust = Settings(rewards=Rewards("robustness"))
    assert Learner(lake, "F goal", cells, settings=robust).train(100).steps >= 100
    decided = FiniteModel.from_arrays([0, 1], [0], [1.0], actions=1)
    with pytest.raises(ValueError, match="decided at every start"):
        Learner(decided, "F a", [[1.0]]).train(1)


def test_an_interrupt_loses_nothing(lake: FiniteModel) -> None:
    # A shell that starts the tests in the background ignores interrupts for them.
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    learner = Learner(lake, "corner T goal", cells, seed=1)
    timer = threading.Timer(0.3, _thread.interrupt_main)
    timer.start()
    with pytest.raises(KeyboardInterrupt):
        learner.train(10**12)
    signal.signal(signal.SIGINT, before)
    done = learner.steps
    assert 0 < done < 10**12
    again = Learner(lake, "corner T goal", cells, seed=1).train(done)
    assert np.array_equal(learner.Q, again.Q) and learner.steps == again.steps


def test_threads_learn_side_by_side(lake: FiniteModel) -> None:
    def learned(seed: int) -> Any:
        return Learner(lake, "corner T goal", cells, seed=seed).train(50_000).Q

    with ThreadPoolExecutor(4) as pool:
        for seed, q in zip(range(4), pool.map(learned, range(4)), strict=True):
            assert np.array_equal(q, learned(seed))


def test_a_policy_is_a_document(lake: FiniteModel, tmp_path: Path) -> None:
    best = solve(lake, "corner T goal", cells)
    policy = best.certified(best.policy)
    assert policy.certificate is not None and policy.certificate.satisfied > 0.82
    assert policy.certificate.kind == "exact" and policy.certificate.within == 100
    policy.save(tmp_path / "policy.json")
    loaded = Policy.load(tmp_path / "policy.json")
    copies = [loaded, pickle.loads(pickle.dumps(policy)), copy.deepcopy(policy)]
    for other in copies:
        assert other == policy and hash(other) == hash(policy)
        assert np.array_equal(other.table, policy.table)
        assert str(other.certificate) == str(policy.certificate)
    assert np.array_equal(np.asarray(policy), policy.table)
    assert np.asarray(policy, dtype=np.int8).dtype == np.int8
    assert policy.formula == "corner T goal" and policy.training == ()
    document = json.loads((tmp_path / "policy.json").read_text())
    document["action"][5] = 4
    with pytest.raises(ValueError, match="`action`, entry 5: 4 is not less than 4"):
        Policy.from_json(json.dumps(document))
    learner = Learner(lake, "corner T goal", cells, seed=7).train(1_000)
    told = learner.policy().training
    assert told == (
        {"task": "corner T goal", "steps": learner.steps, "episodes": learner.episodes, "seed": 7},
    )
    policy.check(lake, "corner T goal", cells)
    with pytest.raises(ValueError, match="a policy"):
        policy.check(lake, "goal T corner", cells)
    with pytest.raises(ValueError, match="a policy"):
        solve(lake, "F goal", cells).certify(policy)
    for q, s in ((9, 0), (-1, 0), (0, 16), (0, -1), (1 << 40, 0)):
        with pytest.raises(IndexError, match="states"):
            policy(q, s)


def test_a_policy_runs_as_the_environment_runs(lake: FiniteModel) -> None:
    """Episodes of the environment agree with the certificate, within five standard errors."""
    env: Any = gym.make("FrozenLake-v1")
    best = solve(lake, "corner T goal", cells)
    policy, episodes, satisfied = best.policy, 2_000, 0
    obs, _ = env.reset(seed=5)
    for _ in range(episodes):
        q, done = policy.reset(int(obs)), False
        while not done:
            obs, _, terminated, truncated, _ = env.step(policy(q, int(obs)))
            q = policy.next(q, int(obs))
            done = terminated or truncated or policy.is_over(q)
        satisfied += q == 2
        obs, _ = env.reset()
    exact = best.certify(policy).satisfied_within
    assert exact is not None
    error = np.sqrt(exact * (1 - exact) / episodes)
    assert abs(satisfied / episodes - exact) < 5 * error


@pytest.mark.skipif(shutil.which("rustc") is None, reason="there is no rustc")
def test_a_policy_becomes_rust(lake: FiniteModel, tmp_path: Path) -> None:
    best = solve(lake, "corner T goal", cells)
    policy = best.certified(best.policy)
    source = policy.emit_rust(tmp_path / "policy.rs")
    assert (tmp_path / "policy.rs").read_text() == source
    policy.save(tmp_path / "policy.json")
    tool = [sys.executable, "-m", "tltl", "policy", str(tmp_path / "policy.json")]
    assert subprocess.run(tool, capture_output=True, text=True, check=True).stdout == source
    main = tmp_path / "main.rs"
    main.write_text(
        "#[allow(dead_code)] mod policy;\n"
        "fn main() { for q in 0..policy::AUTOMATON_STATES { for s in 0..policy::STATES {"
        ' println!("{} {} {}", policy::act(q, s), policy::next(q, s), policy::reset(s)); } } }'
    )
    subprocess.run(["rustc", str(main), "-o", str(tmp_path / "main")], check=True)
    out = subprocess.run([tmp_path / "main"], capture_output=True, text=True, check=True).stdout
    expected = [
        f"{policy(q, s)} {policy.next(q, s)} {policy.reset(s)}" for q in range(3) for s in range(16)
    ]
    assert out.split("\n")[:-1] == expected


def lost(P: Any, masks: Any, worst: bool) -> Any:
    """P(lost) of `!hole U goal` where it is live, the largest or smallest over what is allowed."""
    to_hole, go_on = np.zeros((16, 4)), np.zeros((16, 4, 16))
    for s, a in np.ndindex(16, 4):
        for p, to, _, done in P[s][a]:
            if holes(to)["hole"]:
                to_hole[s, a] += p
            elif to != 15 and not done:
                go_on[s, a, to] += p
    value = np.zeros(16)
    for _ in range(5_000):
        arrival = to_hole + go_on @ value
        value = np.where(masks, arrival, -1).max(1) if worst else np.where(masks, arrival, 2).min(1)
    return value


@pytest.mark.parametrize("epsilon", [0.0, 0.05, 0.3])
def test_a_shield_keeps_its_promise(lake: FiniteModel, epsilon: float) -> None:
    world: Any = gym.make("FrozenLake-v1").unwrapped
    best = solve(lake, "!hole U goal", holes)
    shield = best.shield(epsilon=epsilon)
    q = best.policy.reset(0)
    masks = shield.masks
    assert masks.shape == (3, 16, 4) and masks.any(-1).all()
    assert np.array_equal(shield.mask(q, 6), masks[q, 6])
    inside = [s for s in range(16) if not holes(s)["hole"] and s != 15]
    smallest = lost(world.P, np.ones((16, 4), bool), worst=False)
    largest = lost(world.P, masks[q], worst=True)
    assert (largest[inside] <= smallest[inside] + epsilon + 1e-9).all()
    assert epsilon < 0.3 or (largest[inside] > smallest[inside] + 0.01).any(), "it is used"
    worth = shield.certify(np.zeros((3, 16), int))
    assert worth.smallest_lost == pytest.approx(smallest[0], abs=1e-9)
    assert worth.lost_allowed == pytest.approx(largest[0], abs=1e-9)
    assert worth.lost_after <= worth.smallest_lost + epsilon + 1e-9
    assert worth.before.satisfied == best.certify(np.zeros((3, 16), int)).satisfied
    assert worth.fraction_allowed == pytest.approx(masks[q].mean())
    shielded = shield.policy(np.zeros((3, 16), int))
    assert all(masks[q, s, shielded(q, s)] for s in range(16))
    assert shielded.certificate is not None
    assert shielded.certificate.satisfied == worth.after.satisfied
    around = best.shield(epsilon=epsilon, around="best")
    assert all(around.masks[q, s, best.policy(q, s)] for s in range(16))
    for wrong in (-0.1, 1.5, float("nan")):
        with pytest.raises(ValueError, match="`epsilon` is"):
            best.shield(epsilon=wrong)
    with pytest.raises(ValueError, match="not `safest` or `best`"):
        nowhere: Any = "nowhere"
        best.shield(around=nowhere)


@pytest.mark.parametrize("around", ["safest", "best"])
def test_models_solutions_and_shields_pickle(lake: FiniteModel, around: Any) -> None:
    model = pickle.loads(pickle.dumps(lake))
    assert model.horizon == lake.horizon and np.array_equal(model.origin, lake.origin)
    rewards = Rewards("shaped", gamma=0.9)
    best = solve(model, "!hole U goal", holes, rewards=rewards)
    again = pickle.loads(pickle.dumps(best))
    for name in ("satisfied", "steps", "Q"):
        own, theirs = (getattr(one, name) for one in (best, again))
        assert np.array_equal(own, theirs, equal_nan=True)
    shield = best.shield(epsilon=0.05, around=around)
    for other in (pickle.loads(pickle.dumps(shield)), copy.deepcopy(shield)):
        assert other.task == shield.task and other.epsilon == shield.epsilon
        assert np.array_equal(other.masks, shield.masks)
    policy = np.zeros((3, 16), int)
    other = pickle.loads(pickle.dumps(shield))
    assert other.certify(policy).lost_after == shield.certify(policy).lost_after


def test_a_model_with_events_and_endings_pickles() -> None:
    events: Any = lambda s, a, to, reward: "cliff" if reward <= -100 else None  # noqa: E731
    model = FiniteModel.from_env(gym.make(newest("CliffWalking")), events=events)
    again = pickle.loads(pickle.dumps(model))
    assert (again.event, again.num_states) == (model.event, model.num_states)
    labels: Any = lambda s, event: {"goal": s == 47, "cliff": event == "cliff"}  # noqa: E731
    own, theirs = (solve(one, "!cliff U goal", labels) for one in (model, again))
    assert np.array_equal(own.satisfied, theirs.satisfied)
    # What was seen is kept as frequencies.
    seen = FiniteModel.from_experience(
        [0, 0, 0], [0, 0, 0], [1, 1, 0], num_states=2, num_actions=1, terminated=[1, 1, 0]
    )
    again = pickle.loads(pickle.dumps(seen))
    own, theirs = (solve(one, "F b", lambda s: {"b": s == 1}) for one in (seen, again))
    assert np.array_equal(own.satisfied, theirs.satisfied) and own.satisfied[0, 0] == 1.0


def test_mistakes_are_worse_actions(lake: FiniteModel) -> None:
    best = solve(lake, "corner T goal", cells)
    assert best.mistakes(best.Q.argmax(-1)) == ()
    table = best.policy.table.copy()
    worst = best.Q[0, 14].argmin()
    table[0, 14] = worst
    found = [wrong for wrong in best.mistakes(table) if (wrong.q, wrong.state) == (0, 14)]
    assert len(found) == 1 and found[0].action == worst
    assert found[0].loss == pytest.approx(best.Q[0, 14].max() - best.Q[0, 14].min())


def largest(solution: Solution) -> float:
    return solution.certify(solution.policy).optimal_satisfied


@pytest.mark.parametrize(
    ("operator", "one", "other", "formula"),
    [
        ("and", "F corner", "F goal", "F corner && F goal"),
        ("then", "F corner", "F goal", "corner T goal"),
        ("or", "!hole U corner", "!hole U goal", "(!hole U corner) || (!hole U goal)"),
    ],
)
def test_skills_compose_to_the_task(
    lake: FiniteModel, operator: Any, one: str, other: str, formula: str
) -> None:
    skills = [solve(lake, task, holes) for task in (one, other)]
    composed = compose(operator, skills)
    names = [name for name, _ in composed.steps]
    assert names == ["combined (step 2)", "compensated (steps 3-5)", "refined (step 6)"]
    exact = solve(lake, formula, holes)
    worth = composed.solve(lake).certify(composed.policy)
    assert worth.satisfied == pytest.approx(largest(exact), abs=1e-8)
    assert worth.optimal_satisfied == pytest.approx(largest(exact), abs=1e-8)
    assert "<- best" in str(composed) and "<pre>" in composed._repr_html_()
    # From what two learners saw, without a step.
    learners = [Learner(lake, task, holes, seed=1).train(60_000) for task in (one, other)]
    learned = compose(operator, learners)
    worth = composed.solve(lake).certify(learned.policy)
    assert worth.regret_satisfied < 0.02
    settings = Settings(rewards=Rewards("progress"))
    with pytest.raises(ValueError, match="different rewards"):
        compose(operator, [learners[0], Learner(lake, other, holes, settings=settings)])
    with pytest.raises(ValueError, match="none are given"):
        compose(operator, [])


class Grid(gym.Env[Any, Any]):
    """3 × 4 cells as observations of any kind; the far corner ends the episode and pays."""

    MOVES = np.array([[-1, 0], [1, 0], [0, -1], [0, 1]])

    def __init__(self, kind: str, fails_after: int = -1) -> None:
        self.kind, self.left = kind, fails_after
        self.seeds: list[int | None] = []
        self.observation_space = {
            "digits": spaces.MultiDiscrete([3, 4], start=[1, 5]),
            "bits": spaces.MultiBinary((2, 2)),
            "tuple": spaces.Tuple([spaces.Discrete(3), spaces.Discrete(4, start=-2)]),
        }[kind]
        self.action_space = spaces.Tuple([spaces.MultiBinary(1), spaces.Discrete(2)])

    def seen(self) -> Any:
        x, y = map(int, self.cell)
        if self.kind == "digits":
            return np.array([x + 1, y + 5])
        if self.kind == "bits":
            return np.array([[x // 2, x % 2], [y // 2, y % 2]], np.int8)
        return (x, y - 2)

    def reset(self, *, seed: int | None = None, options: Any = None) -> tuple[Any, dict[str, Any]]:
        super().reset(seed=seed)
        self.seeds.append(seed)
        self.cell = np.zeros(2, int)
        return self.seen(), {}

    def step(self, action: Any) -> tuple[Any, float, bool, bool, dict[str, Any]]:
        assert self.action_space.contains(action)
        if self.left == 0:
            raise RuntimeError("the wire is cut")
        self.left -= 1
        (axis,), up = action
        self.cell = np.clip(self.cell + self.MOVES[2 * axis + up], 0, [2, 3])
        end = tuple(self.cell) == (2, 3)
        return self.seen(), float(end), end, False, {}


LABELS: dict[str, Any] = {
    "digits": lambda obs: {"right": obs[1] == 8, "up": obs[0] == 3 and obs[1] == 5},
    "bits": lambda obs: {"right": obs[1].all(), "up": obs[0, 0] and not obs[1].any()},
    "tuple": lambda obs: {"right": obs[1] == 1, "up": obs == (2, -2)},
}


@pytest.mark.parametrize("kind", LABELS)
def test_environments_are_learned_in(kind: str) -> None:
    env = Grid(kind)
    learner = Learner(env, "up T right", LABELS[kind], seed=5).train(3_000)
    assert env.seeds[0] == 5 and set(env.seeds[1:]) == {None} and learner.world is env
    policy = learner.policy()
    count, number, _ = numbered(env.observation_space)
    _, _, action = numbered(env.action_space)
    assert policy.table.shape == (3, count)
    (obs, _), steps = env.reset(), 0
    q, over = policy.reset(number(obs)), False
    while not over:
        obs, _, over, _, _ = env.step(action(policy(q, number(obs))))
        q, steps = policy.next(q, number(obs)), steps + 1
    assert (q, steps) == (2, 5), "the corner above, and then to the right"
    # An exception stops training, and what was learned is kept.
    broken = Learner(Grid(kind, fails_after=100), "up T right", LABELS[kind], seed=5)
    with pytest.raises(RuntimeError, match="the wire is cut"):
        broken.train(3_000)
    assert broken.steps == 100
    seen = Learner(env, "up T right", LABELS[kind], seed=5).train(80)
    assert seen.steps < 300 and seen.experience.num_states == count


def test_a_lake_as_an_environment_is_the_lake(lake: FiniteModel) -> None:
    env = gym.make("FrozenLake-v1")
    learner = Learner(env, "corner T goal", cells, seed=1).train(60_000)
    worth = learner.certify(solve(lake, "corner T goal", cells))
    assert worth.regret_satisfied < 0.02
    with pytest.raises(ValueError, match="cannot be numbered: a table needs Discrete"):
        Learner(gym.make("CartPole-v1"), "F x", cells)


@pytest.mark.parametrize(
    "space",
    [
        spaces.Discrete(5, start=-2),
        spaces.MultiDiscrete(np.array([[2, 3], [4, 1]]), start=np.array([[0, 1], [-1, 7]])),
        spaces.MultiBinary(3),
        spaces.Tuple([spaces.Discrete(2), spaces.MultiBinary(2), spaces.Discrete(3, start=1)]),
    ],
)
def test_elements_are_numbered_one_to_one(space: Any) -> None:
    count, number, element = numbered(space)
    elements = [element(i) for i in range(count)]
    assert [number(x) for x in elements] == list(range(count))
    assert all(space.contains(x) for x in elements)
    assert len({str(x) for x in elements}) == count


def test_stored_steps_are_a_world(lake: FiniteModel) -> None:
    """Skills and their composition from steps that somebody else took."""
    env: Any = gym.make("FrozenLake-v1")
    rng = np.random.default_rng(3)
    steps: list[tuple[int, int, int, bool]] = []
    starts: list[int] = []
    env.reset(seed=3)
    while len(steps) < 40_000:
        obs, done = int(env.reset()[0]), False
        starts.append(obs)
        while not done:
            action = int(rng.integers(4))
            to, _, terminated, truncated, _ = env.step(action)
            steps.append((obs, action, int(to), terminated))
            obs, done = int(to), terminated or truncated
    columns = [np.array(column) for column in zip(*steps, strict=True)]
    s, a, to, ended = columns
    seen = FiniteModel.from_experience(
        s, a, to, terminated=ended, starts=starts, num_states=16, num_actions=4
    )
    # P(goal in one step) is a frequency; three steps are then a sum of products.
    once = solve(seen, "F goal", cells).certify(np.ones((2, 16), int), within=1)
    assert once.satisfied_within == 0.0
    from_14 = FiniteModel.from_experience(
        s, a, to, terminated=ended, starts=[14], num_states=16, num_actions=4
    )
    once = solve(from_14, "F goal", cells).certify(np.ones((2, 16), int), within=1)
    at = (s == 14) & (a == 1)
    assert once.satisfied_within == pytest.approx(np.mean(to[at] == 15), abs=1e-12)
    skills = [solve(seen, task, cells) for task in ("F corner", "F goal")]
    both = compose("then", skills)
    worth = both.solve(lake).certify(both.policy)
    assert worth.regret_satisfied < 0.02
    shuffled = rng.permutation(len(s))
    again = FiniteModel.from_experience(
        s[shuffled], a[shuffled], to[shuffled], terminated=ended[shuffled], starts=starts,
        num_states=16, num_actions=4,
    )
    assert np.allclose(solve(again, "F goal", cells).satisfied, skills[1].satisfied, atol=1e-9)
    for wrong, message in (
        ({"num_states": 9}, r"states\[\d+\] is \d+, and the largest is 8"),
        ({"num_actions": 3}, r"actions\[\d+\] is 3, and the largest is 2"),
        ({"num_actions": 0}, "a world needs some"),
        ({"terminated": [True]}, "terminated: 1 entries"),
    ):
        options: dict[str, Any] = {"num_states": 16, "num_actions": 4} | wrong
        with pytest.raises(ValueError, match=message):
            FiniteModel.from_experience(s, a, to, **options)
