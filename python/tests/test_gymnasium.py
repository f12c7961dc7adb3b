"""`TaskEnv`: what it reads, pays and ends, against the task run on the recorded labels."""

from __future__ import annotations

import warnings
from typing import Any

import gymnasium as gym
import numpy as np
import pytest
from gymnasium import spaces
from gymnasium.utils import RecordConstructorArgs
from gymnasium.utils.env_checker import check_env
from hypothesis import given, settings
from hypothesis import strategies as st

from tltl import FiniteModel, Rewards, Task, TaskFile, TaskWarning, solve
from tltl.gymnasium import TaskEnv, has_a_way_back

MODES = ["shaped", "acceptance", "progress", "robustness", "literal"]
FORMULAS = ["a T b", "F a && F b", "!b U a", "F a && F b ensuring !c", "X a", "F (a && X a && X X a)"]


class Tape(gym.Env[Any, Any]):
    """Plays what holds, one observation after the other, and ends where it is told."""

    def __init__(self, letters: list[int], terminated_at: int = -1, truncated_at: int = -1) -> None:
        self.observation_space = spaces.Discrete(8)
        self.action_space = spaces.Discrete(2)
        self.letters, self.ends = letters, (terminated_at, truncated_at)

    def reset(self, *, seed: int | None = None, options: Any = None) -> tuple[int, dict[str, Any]]:
        super().reset(seed=seed)
        self.at = 0
        return self.letters[0], {}

    def step(self, action: int) -> tuple[int, float, bool, bool, dict[str, Any]]:
        self.at += 1
        terminated, truncated = (self.at == end for end in self.ends)
        return self.letters[self.at], -1.0, terminated, truncated, {"own": self.at}


def abc(env: Any, obs: Any, info: dict[str, Any]) -> dict[str, bool]:
    return {name: bool(int(obs) >> i & 1) for i, name in enumerate("abc")}


def wrapped(env: gym.Env[Any, Any], task: str, **options: Any) -> TaskEnv:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", TaskWarning)
        return TaskEnv(env, task, abc, **options)


@settings(max_examples=200, deadline=None)
@given(
    st.sampled_from(FORMULAS),
    st.lists(st.integers(0, 7), min_size=2, max_size=12),
    st.sampled_from(MODES),
    st.integers(-1, 12),
)
def test_an_episode_is_the_task_run_on_its_labels(
    formula: str, letters: list[int], mode: str, end: int
) -> None:
    task = Task(formula)
    rewards = Rewards(mode, gamma=0.9, environment=0.5, step_penalty=0.25, trap_penalty=2.0)
    env = wrapped(
        Tape(letters, terminated_at=end), formula, rewards=rewards, on_decided_reset="keep"
    )
    labels = np.array([[letter >> i & 1 for i in range(3)] for letter in letters], bool)
    # The propositions of the formula, among a, b and c.
    places = ["abc".index(name) for name in task.propositions]
    own = labels[:, places]
    states = task.run(np.where(own, 1.0, -1.0)).states.tolist()
    obs, info = env.reset()
    told = info["tltl"]
    assert told["state"] == states[0] and not told["progress"]
    terminated = False
    for t, q in enumerate(states[1:], 1):
        decided = states[t - 1] in (task.accepting, task.trap)
        obs, reward, terminated, truncated, info = env.step(0)
        if decided:
            assert (reward, terminated, t) == (0.0, True, 1), "only at the start"
            break
        told = info["tltl"]
        assert (told["state"], obs[8:].argmax(), info["own"]) == (q, q, t)
        assert (told["satisfied"], told["lost"]) == (q == task.accepting, q == task.trap)
        assert told["labels"].tolist() == own[t].tolist()
        assert told["distance"] == task.distances[q]
        expected = rewards.pay(
            task, states[t - 1], q, rho=told.get("rho"), reward=-1.0, terminated=t == end
        )
        assert reward == expected and not truncated
        assert terminated == (t == end or told["satisfied"] or told["lost"])
        if terminated:
            break


def test_what_the_modes_pay() -> None:
    task = Task("!b U a")
    accepted, lost = task.step(0, {"a", "b"}), task.step(0, {"b"})
    assert (accepted, lost) == (task.accepting, task.trap)
    pays = {
        mode: [Rewards(mode, gamma=0.5).pay(task, 0, q, rho=0.25) for q in (0, accepted, lost)]
        for mode in MODES
    }
    assert pays == {
        "acceptance": [0.0, 1.0, 0.0],
        "progress": [0.0, 1.0, 0.0],
        "literal": [0.0, 1.0, 1.0],
        "robustness": [0.25, 0.25, 0.25],
        "shaped": [-0.25, 0.5, -0.5],
    }
    # Nothing is left of the potential where the environment itself ends.
    assert Rewards("shaped", gamma=0.5).pay(task, 0, 0, terminated=True) == -0.5
    rng = np.random.default_rng(1)
    q, to = rng.integers(0, 3, (2, 100))
    rho, reward, ended = rng.normal(size=100), rng.normal(size=100), rng.random(100) < 0.3
    for mode in MODES:
        rewards = Rewards(mode, environment=0.5, bound=0.7, trap_penalty=1.0)
        many = rewards.pay(task, q, to, rho=rho, reward=reward, terminated=ended)
        one = [
            rewards.pay(task, int(a), int(b), rho=c, reward=d, terminated=bool(e))
            for a, b, c, d, e in zip(q, to, rho, reward, ended, strict=True)
        ]
        assert many.tolist() == one


def test_rewards_are_values_and_checked() -> None:
    import copy
    import pickle

    rewards = Rewards("progress", gamma=0.9, trap_penalty=1.0)
    for other in (pickle.loads(pickle.dumps(rewards)), copy.deepcopy(rewards)):
        assert other == rewards and hash(other) == hash(rewards)
    assert repr(rewards).startswith('Rewards("progress", gamma=0.9')
    with pytest.raises(ValueError, match="mode is `best`, not one of shaped"):
        Rewards("best")
    with pytest.raises(ValueError, match="`gamma` is 1, not in"):
        Rewards(gamma=1.0)
    with pytest.raises(ValueError, match="rho is missing"):
        Rewards("robustness").pay(Task("F a"), 0, 1)
    with pytest.raises(IndexError, match="q is 7"):
        Rewards().pay(Task("F a"), 7, 1)


def test_starts_that_are_decided() -> None:
    with pytest.raises(RuntimeError, match="decided at the start 1"):
        wrapped(Tape([1]), "F a", on_decided_reset="raise").reset()
    with pytest.raises(RuntimeError, match="100 starts were decided"):
        wrapped(Tape([1]), "F a").reset()
    kept = wrapped(Tape([1, 0]), "F a", on_decided_reset="keep")
    obs, info = kept.reset()
    assert info["tltl"]["satisfied"]
    assert kept.step(0)[1:4] == (0.0, True, False)
    going_on = wrapped(Tape([1, 0, 0]), "F a", terminate=False)
    going_on.reset()
    assert going_on.step(0)[2] is False

    class Lottery(Tape):
        """Starts anywhere."""

        def reset(self, **options: Any) -> tuple[int, dict[str, Any]]:
            super().reset(**options)
            return int(self.np_random.integers(0, 4)), {}

    env = wrapped(Lottery([0] * 9), "F a")
    starts, resampled = zip(
        *((obs[:8].argmax(), info["tltl"]["resampled"]) for obs, info in
          (env.reset(seed=seed) for seed in range(50))),
        strict=True,
    )
    assert {int(start) for start in starts} == {0, 2} and 0 < max(resampled) <= 10


def test_truncation_stays_truncation() -> None:
    env = wrapped(Tape([0, 0, 0], truncated_at=1), "F a")
    env.reset()
    assert env.step(0)[2:4] == (False, True)


def test_columns_read_the_observation() -> None:
    env = TaskEnv(
        gym.make("CartPole-v1"), "(x > 0.2) T (x < -0.2)", columns={"x": 0}, rewards="robustness"
    )
    obs, info = env.reset(seed=1)
    recorded, states, rhos = [obs[:4]], [info["tltl"]["state"]], []
    for _ in range(8):
        obs, reward, *_, info = env.step(1)
        recorded.append(obs[:4])
        states.append(info["tltl"]["state"])
        rhos.append(info["tltl"]["rho"])
        assert reward == pytest.approx(max(-1.0, min(1.0, info["tltl"]["rho"])))
    run = env.task.run(np.array(recorded), columns={"x": 0})
    assert states == run.states.tolist() and rhos == run.progress.tolist()[1:]


class Goals(gym.ObservationWrapper[Any, Any, Any], RecordConstructorArgs):
    """Observations by name."""

    def __init__(self, env: gym.Env[Any, Any]) -> None:
        RecordConstructorArgs.__init__(self)
        super().__init__(env)
        self.observation_space = spaces.Dict({"cell": env.observation_space})

    def observation(self, observation: Any) -> Any:
        return {"cell": observation}


def cells(env: Any, obs: Any, info: dict[str, Any]) -> dict[str, bool]:
    cell = obs["cell"] if isinstance(obs, dict) else obs
    return {"corner": cell == 3, "goal": cell == 15}


@pytest.mark.parametrize("observe", ["flat", "dict", "none"])
@pytest.mark.parametrize("mode", MODES)
def test_the_checker_of_gymnasium_is_content(mode: str, observe: Any) -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        lake = gym.make("FrozenLake-v1")
        options: dict[str, Any] = {"rewards": mode, "observe": observe}
        check_env(TaskEnv(lake, "corner T goal", cells, **options), skip_render_check=True)
        named = TaskEnv(Goals(gym.make("FrozenLake-v1")), "corner T goal", cells, **options)
        check_env(named, skip_render_check=True)
        pole = TaskEnv(gym.make("CartPole-v1"), "F x > 1", columns={"x": 0}, **options)
        check_env(pole, skip_render_check=True)


@pytest.mark.parametrize("observe", ["flat", "dict", "none"])
@pytest.mark.parametrize("mode", MODES)
def test_the_checker_is_content_with_minigrid(mode: str, observe: Any) -> None:
    pytest.importorskip("minigrid")
    from doorkey_study import Features
    from test_worlds import held

    base = gym.make("MiniGrid-DoorKey-5x5-v0")
    # An image is not made flat.
    base = Features(base) if observe == "flat" else base
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        env = TaskEnv(base, "key T door T goal", held, rewards=mode, observe=observe)
        check_env(env, skip_render_check=True)


def test_what_is_refused_says_what_to_do() -> None:
    class Image(Tape):
        def __init__(self) -> None:
            super().__init__([0])
            self.observation_space = spaces.Box(0, 255, (4, 4, 3), np.uint8)

    with pytest.raises(ValueError, match='use observe="dict"'):
        wrapped(Image(), "F a")
    named: Any = wrapped(Image(), "F a", observe="dict").observation_space
    assert set(named) == {"observation", "task_state"}
    with pytest.raises(ValueError, match="choose another `key`"):
        TaskEnv(Goals(gym.make("FrozenLake-v1")), "F goal", cells, observe="dict", key="cell")
    with pytest.raises(ValueError, match="give `labels` or `columns`"):
        TaskEnv(Tape([0]), "F a")
    with pytest.raises(ValueError, match="`goal` is missing; given: goall; did you mean `goall`"):
        TaskEnv(Tape([0]), "F goal", lambda env, obs, info: {"goall": True}).reset()
    timed = TaskFile.from_text("state S { a: bool }\nstep 0.1 s\ntask t = F[0,2 s] a").task()
    slow: Any = Tape([0])
    slow.dt = 0.05
    with pytest.warns(TaskWarning, match="lasts 0.05 s, and the task says 0.1 s"):
        TaskEnv(slow, timed, abc)
    with pytest.warns(TaskWarning, match="has a way back"):
        TaskEnv(Tape([0]), "F (a && X a && X X a)", abc, rewards="progress")
    assert has_a_way_back(Task("F (a && X a)")) and not has_a_way_back(Task("a T b"))


def test_vectors_of_task_envs_agree_with_one() -> None:
    def make() -> TaskEnv:
        return TaskEnv(gym.make("FrozenLake-v1"), "corner T goal", cells)

    actions = np.random.default_rng(5).integers(0, 4, size=(200, 2))
    vector = gym.vector.SyncVectorEnv([make, make])
    ones = [make(), make()]
    obs, infos = vector.reset(seed=[3, 4])
    alone = [env.reset(seed=seed)[0] for env, seed in zip(ones, (3, 4), strict=True)]
    done = [False, False]
    for row in actions:
        assert np.array_equal(obs, alone)
        obs, rewards, *_, infos = vector.step(row)
        for i, env in enumerate(ones):
            if done[i]:
                alone[i], info = env.reset()
                done[i], reward = False, 0.0
            else:
                alone[i], reward, terminated, truncated, info = env.step(int(row[i]))
                done[i] = terminated or truncated
            assert rewards[i] == reward and infos["tltl"]["state"][i] == info["tltl"]["state"]


def test_a_shield_bars_actions() -> None:
    lake = gym.make("FrozenLake-v1")
    hole = {5, 7, 11, 12}

    def places(s: int) -> dict[str, bool]:
        return {"hole": s in hole, "goal": s == 15}

    def seen(env: Any, obs: Any, info: dict[str, Any]) -> dict[str, bool]:
        return places(int(obs))

    model = FiniteModel.from_env(lake)
    shield = solve(model, "!hole U goal", places).shield(epsilon=0.1)
    env = TaskEnv(lake, "!hole U goal", seen, shield=shield, observe="none")
    with pytest.raises(RuntimeError, match="reset the environment first"):
        env.action_masks()
    rng, barred, ends = np.random.default_rng(1), 0, []
    for episode in range(200):
        obs, info = env.reset(seed=episode)
        while True:
            mask = env.action_masks()
            assert np.array_equal(mask, shield.mask(info["tltl"]["state"], int(obs)))
            if not mask.all() and episode == 0:
                with pytest.raises(ValueError, match="the shield bars action"):
                    env.step(int(np.flatnonzero(~mask)[0]))
                barred += 1
            obs, _, terminated, truncated, info = env.step(int(rng.choice(np.flatnonzero(mask))))
            if terminated or truncated:
                ends.append(info["tltl"]["lost"])
                break
    assert barred > 0
    # What is promised, and three standard errors.
    most = shield.certify(np.zeros((3, 16), int)).smallest_lost + 0.1
    assert np.mean(ends) < most + 3 * np.sqrt(most * (1 - most) / len(ends))
    with pytest.raises(ValueError, match="there is no shield"):
        TaskEnv(lake, "F goal", seen).action_masks()
    with pytest.raises(ValueError, match="is for another task than `F goal`"):
        TaskEnv(lake, "F goal", seen, shield=shield)
    with pytest.raises(ValueError, match="is for another task than `!goal U hole`"):
        TaskEnv(lake, "!goal U hole", seen, shield=shield)
    with pytest.raises(ValueError, match="give `model_state`"):
        TaskEnv(Goals(lake), "!hole U goal", seen, shield=shield)
