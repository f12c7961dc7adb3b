"""Stable-Baselines3: certified, exported, emitted; `pip install 'tltl[sb3]'`."""

from __future__ import annotations

import re
import shutil
import subprocess
from pathlib import Path
from typing import Any, Literal

import gymnasium as gym
import numpy as np
import pytest

from tltl import FiniteModel, NetworkPolicy, Rewards, Task, TaskWarning, solve
from tltl.gymnasium import TaskEnv

torch = pytest.importorskip("torch")
sb3 = pytest.importorskip("stable_baselines3")
pytestmark = pytest.mark.sb3
# The networks are small: threads cost more than they bring.
torch.set_num_threads(1)


def labels(env: Any, obs: Any, info: dict[str, Any]) -> dict[str, bool]:
    return {"corner": obs == 3, "goal": obs == 15}


def cells(s: int) -> dict[str, bool]:
    return {"corner": s == 3, "goal": s == 15}


def lake(**options: Any) -> TaskEnv:
    return TaskEnv(gym.make("FrozenLake-v1", is_slippery=False), "corner T goal", labels, **options)


def cart(**options: Any) -> TaskEnv:
    return TaskEnv(gym.make("CartPole-v1"), "(x > 0.05) T (x < -0.05)", columns={"x": 0}, **options)


def pendulum(**options: Any) -> TaskEnv:
    return TaskEnv(gym.make("Pendulum-v1"), "(y > 0.5) T (y < -0.5)", columns={"y": 1}, **options)


def learned(kind: str, env: Any, policy: str = "MlpPolicy", **options: Any) -> Any:
    if kind == "ppo":
        return sb3.PPO(policy, env, n_steps=128, seed=0, **options).learn(256)
    algorithm = {"dqn": sb3.DQN, "sac": sb3.SAC, "td3": sb3.TD3}[kind]
    return algorithm(policy, env, learning_starts=100, seed=0, **options).learn(300)


def test_the_checker_of_sb3_is_content() -> None:
    from stable_baselines3.common.env_checker import check_env

    for env in (lake(), cart(), lake(observe="dict")):
        check_env(env, skip_render_check=True)


@pytest.mark.parametrize("kind", ["dqn", "ppo"])
def test_a_network_is_certified(kind: str) -> None:
    from tltl.sb3 import TaskCallback, tabulate

    env = lake()
    callback = TaskCallback()
    algorithm = learned(kind, env)
    algorithm.learn(300, callback=callback)
    assert len(callback.satisfied) == len(callback.lost) > 0
    model = FiniteModel.from_env(env.env)
    table = tabulate(algorithm, model, env)
    worth = solve(model, "corner T goal", cells).certify(table)
    assert 0.0 <= worth.satisfied <= worth.optimal_satisfied == 1.0
    # What runs is what was judged: in a world without chance an episode says so.
    (obs, info), done = env.reset(seed=0), False
    while not done:
        action, _ = algorithm.predict(obs, deterministic=True)
        assert action == table[info["tltl"]["state"], obs[:16].argmax()]
        obs, _, terminated, truncated, info = env.step(int(action))
        done = terminated or truncated
    assert info["tltl"]["satisfied"] == (worth.satisfied == 1.0)


def vectors_of(make: Any, observe: str, is_normalised: bool) -> Any:
    from stable_baselines3.common.vec_env import DummyVecEnv, VecNormalize

    vectors: Any = DummyVecEnv([lambda: make(observe=observe)])
    if is_normalised:
        keys = None if observe == "flat" else ["observation"]
        vectors = VecNormalize(vectors, norm_obs_keys=keys, clip_obs=2.0)
    return vectors


def met(env: TaskEnv, observe: str, width: int, count: int) -> tuple[Any, Any]:
    """Features of the environment and live automaton states: a fifth from episodes, the rest at random."""
    rng = np.random.default_rng(1)
    live = [q for q in range(env.task.num_states) if q != env.task.accepting]
    q, states = rng.choice(live, count), rng.normal(size=(count, width)).astype(np.float32)
    obs, info = env.reset(seed=1)
    for i in range(count // 5):
        states[i] = obs[:width] if observe == "flat" else obs["observation"]
        q[i] = info["tltl"]["state"]
        obs, _, terminated, truncated, info = env.step(env.action_space.sample())
        if terminated or truncated:
            obs, info = env.reset()
    return states, q


def predicted(algorithm: Any, env: TaskEnv, vectors: Any, states: Any, q: Any) -> Any:
    seen: Any = [env.observed(obs, int(p)) for obs, p in zip(states, q, strict=True)]
    if isinstance(seen[0], dict):
        seen = {name: np.array([one[name] for one in seen]) for name in seen[0]}
    else:
        seen = np.array(seen)
    normalized = getattr(vectors, "normalize_obs", lambda obs: obs)
    return algorithm.predict(normalized(seen), deterministic=True)[0]


def emitted(policy: NetworkPolicy, call: str, states: Any, q: Any, folder: Path) -> list[str]:
    """What the emitted function says for each of the states, compiled and run."""
    if shutil.which("rustc") is None:
        pytest.skip("there is no rustc: the emitted file was not compiled")
    policy.emit_rust(folder / "policy.rs")
    states.tofile(folder / "states")
    q.astype(np.uint8).tofile(folder / "q")
    (folder / "main.rs").write_text(
        """#[allow(dead_code)] mod policy;
        fn main() {
            let (states, q) = (std::fs::read("states").unwrap(), std::fs::read("q").unwrap());
            for (row, q) in states.chunks(4 * policy::INPUTS).zip(q) {
                let mut x = [0.0; policy::INPUTS];
                for (x, bytes) in x.iter_mut().zip(row.chunks(4)) {
                    *x = f32::from_ne_bytes(bytes.try_into().unwrap());
                }
                println!("{:?}", CALL);
            }
        }""".replace("CALL", call)
    )
    subprocess.run(["rustc", "--edition=2024", "-O", "main.rs"], cwd=folder, check=True)
    run = subprocess.run([folder / "main"], cwd=folder, capture_output=True, text=True, check=True)
    return run.stdout.splitlines()


@pytest.mark.parametrize("is_normalised", [False, True])
@pytest.mark.parametrize("observe", ["flat", "dict"])
@pytest.mark.parametrize("kind", ["dqn", "ppo", "relu"])
def test_a_network_is_exported(
    kind: str, observe: Literal["flat", "dict"], is_normalised: bool, tmp_path: Path
) -> None:
    from tltl.sb3 import export

    env, vectors = cart(observe=observe), vectors_of(cart, observe, is_normalised)
    relu = {"activation_fn": torch.nn.ReLU, "net_arch": [32, 16]}
    options: Any = {"policy_kwargs": relu} if kind == "relu" else {}
    form = "MlpPolicy" if observe == "flat" else "MultiInputPolicy"
    algorithm = learned("dqn" if kind == "dqn" else "ppo", vectors, form, **options)
    policy = export(algorithm, env.task, actions=["left", "right"])
    policy.save(tmp_path / "policy.json")
    assert NetworkPolicy.load(tmp_path / "policy.json") == policy
    states, q = met(env, observe, 4, 10_000)
    theirs, differ = predicted(algorithm, env, vectors, states, q), 0
    for row, p, action in zip(states, q.tolist(), theirs, strict=True):
        values = np.sort(policy.values(p, row))
        if policy.act(p, row) != action:
            # Only where the two best are as good as equal.
            assert values[-1] - values[-2] < 1e-4 * max(1.0, abs(values[-1]))
            differ += 1
    assert differ < 100
    own = [str(policy.act(p, row)) for p, row in zip(q.tolist(), states, strict=True)]
    assert emitted(policy, "policy::act(q.into(), &x, &[])", states, q, tmp_path) == own


@pytest.mark.parametrize("is_normalised", [False, True])
@pytest.mark.parametrize("observe", ["flat", "dict"])
@pytest.mark.parametrize("kind", ["sac", "td3", "ppo"])
def test_actions_of_numbers_are_exported(
    kind: str, observe: Literal["flat", "dict"], is_normalised: bool, tmp_path: Path
) -> None:
    from tltl.sb3 import export

    env, vectors = pendulum(observe=observe), vectors_of(pendulum, observe, is_normalised)
    form = "MlpPolicy" if observe == "flat" else "MultiInputPolicy"
    options: Any = {} if kind == "ppo" else {"policy_kwargs": {"net_arch": [32, 16]}}
    algorithm = learned(kind, vectors, form, **options)
    policy = export(algorithm, env.task, actions=["torque"], inputs=["cos", "sin", "speed"])
    assert NetworkPolicy.from_json(policy.to_json()) == policy
    states, q = met(env, observe, 3, 10_000)
    theirs = predicted(algorithm, env, vectors, states, q)
    own = np.array([policy.control(p, row) for p, row in zip(q.tolist(), states, strict=True)])
    assert own.shape == theirs.shape == (10_000, 1) and np.ptp(theirs) > 0
    # Torques are from -2 to 2.
    assert np.abs(own - theirs).max() < 1e-4
    said = emitted(policy, "policy::control(q.into(), &x, &[])[0].to_bits()", states, q, tmp_path)
    assert list(map(int, said)) == own[:, 0].view(np.uint32).tolist()
    with pytest.raises(ValueError, match="is numbers: use `control`"):
        policy.act(0, states[0])


def test_a_network_without_hidden_layers_is_exported() -> None:
    from tltl.sb3 import export

    env = cart()
    algorithm = learned("dqn", env, policy_kwargs={"net_arch": []})
    policy = export(algorithm, env.task)
    x = np.array([0.1, -0.2, 0.3, 0.4], np.float32)
    for q in (0, 1):
        with torch.no_grad():
            theirs = algorithm.q_net(torch.as_tensor(env.observed(x, q)[None])).numpy()[0]
        assert np.allclose(policy.values(q, x), theirs, rtol=1e-5, atol=1e-6)


def test_what_cannot_be_exported_is_named() -> None:
    from tltl.sb3 import export

    env = cart()
    smooth = sb3.PPO(
        "MlpPolicy", env, n_steps=64, seed=0, policy_kwargs={"activation_fn": torch.nn.ELU}
    )
    with pytest.raises(ValueError, match=r"a layer ELU.*: a document has Linear layers with ReLU or"):
        export(smooth, env.task)
    with pytest.raises(ValueError, match="among actions: use `act`"):
        export(learned("dqn", env), env.task).control(0, np.zeros(4, np.float32))
    bits = gym.make("Pendulum-v1")
    bits.action_space = gym.spaces.MultiBinary(1)
    with pytest.raises(ValueError, match=r"wanted are Discrete from 0 on, or a Box with one axis and"):
        export(sb3.PPO("MlpPolicy", bits, n_steps=64, seed=0), env.task)
    by_name = cart(observe="dict", key="mode")
    many = sb3.DQN("MultiInputPolicy", by_name, seed=0)
    with pytest.raises(ValueError, match="or a Dict in which `task_state` is"):
        export(many, by_name.task)
    assert export(many, by_name.task, key="mode").formula == by_name.task.text
    other = Task("F a && F b && F c")
    with pytest.raises(ValueError, match="flat ones with the 8 states of"):
        export(learned("dqn", env), other)


@pytest.mark.parametrize("observe", ["flat", "dict"])
def test_each_step_is_stored_for_every_live_state(observe: Literal["flat", "dict"]) -> None:
    """Against the steps of environments whose automata are put into each state by hand."""
    from tltl.sb3 import CounterfactualDictReplayBuffer, CounterfactualReplayBuffer

    rewards = Rewards("shaped", environment=0.5)
    env = lake(observe=observe, rewards=rewards)
    kind: Any = CounterfactualReplayBuffer if observe == "flat" else CounterfactualDictReplayBuffer
    form = "MlpPolicy" if observe == "flat" else "MultiInputPolicy"
    algorithm = sb3.DQN(
        form,
        env,
        learning_starts=10_000,
        seed=0,
        replay_buffer_class=kind,
        replay_buffer_kwargs={"task": env.task, "rewards": rewards},
    ).learn(300)
    buffer = algorithm.replay_buffer
    assert buffer.pos == 600
    world = gym.make("FrozenLake-v1", is_slippery=False).unwrapped
    table: Any = world.P  # type: ignore[attr-defined]
    for i in range(0, 600, 2):
        both = range(i, i + 2)
        if observe == "flat":
            obs, after = (array[both, 0] for array in (buffer.observations, buffer.next_observations))
            place = [obs[:, :16].argmax(1), after[:, :16].argmax(1)]
            q, next_q = obs[:, 16:].argmax(1), after[:, 16:].argmax(1)
        else:
            arrays = (buffer.observations, buffer.next_observations)
            place = [one["observation"][both, 0].ravel() for one in arrays]
            q, next_q = (one["task_state"][both, 0].ravel() for one in arrays)
        action = int(buffer.actions[i, 0, 0])
        [(_, to, paid, done)] = table[int(place[0][0])][action]
        assert q.tolist() == [0, 1] and set(place[1].tolist()) == {to}
        for j, state in zip(both, q.tolist(), strict=True):
            then = env.task.step(state, cells(to))
            assert next_q[j - i] == then
            expected = rewards.pay(env.task, state, then, reward=paid, terminated=done)
            assert buffer.rewards[j, 0] == pytest.approx(expected)
            assert buffer.dones[j, 0] == (done or then == env.task.accepting)
    assert buffer.timeouts.sum() == 0


def test_states_of_stored_steps_are_drawn() -> None:
    from tltl.sb3 import CounterfactualReplayBuffer

    env = TaskEnv(gym.make("FrozenLake-v1"), "F corner && F goal && F wet", lambda env, obs, info: {
        "corner": obs == 3, "goal": obs == 15, "wet": obs in {5, 7, 11, 12}})
    kwargs: Any = {"task": env.task, "rewards": env.rewards, "states": 3, "seed": 1}
    algorithm = sb3.DQN(
        "MlpPolicy", env, learning_starts=10_000, seed=0,
        replay_buffer_class=CounterfactualReplayBuffer, replay_buffer_kwargs=kwargs,
    ).learn(400)
    buffer = algorithm.replay_buffer
    assert buffer.pos == 1_200
    q = buffer.observations[:1_200, 0, 16:].argmax(1).reshape(-1, 3)
    assert set(q.ravel().tolist()) == set(range(env.task.num_states)) - {env.task.accepting}
    assert (q[:, 0] == 0).any() and len({tuple(row) for row in q.tolist()}) > 20
    with pytest.raises(ValueError, match='states is 0, not "all"'):
        CounterfactualReplayBuffer(
            10, env.observation_space, env.action_space, task=env.task, rewards=env.rewards, states=0
        )
    with pytest.raises(ValueError, match="not by how much"):
        CounterfactualReplayBuffer(
            10, env.observation_space, env.action_space, task=env.task, rewards=Rewards("robustness")
        )


def test_another_discount_factor_is_warned_of() -> None:
    from tltl.sb3 import TaskCallback

    callback = TaskCallback()
    algorithm = sb3.DQN("MlpPolicy", lake(), gamma=0.9, seed=0)
    with pytest.warns(TaskWarning, match="gamma is 0.9, and the shaped rewards are for 0.99"):
        algorithm.learn(200, callback=callback)
    assert len(callback.last_q) == len(callback.lost) > 0 and set(callback.last_q) <= {0, 1, 2}


def test_the_page_does_what_it_prints() -> None:
    page = (Path(__file__).parents[1] / "docs" / "sb3.md").read_text(encoding="utf-8")
    [code] = re.findall(r"```python\n(.*?)```", page, re.DOTALL)
    assert "50_000" in code
    learned_there: dict[str, Any] = {"env": lake()}
    exec(compile(code.replace("50_000", "400"), "sb3.md", "exec"), learned_there)
    assert learned_there["model"].replay_buffer.pos == 800


def test_no_masked_action_is_taken() -> None:
    contrib = pytest.importorskip("sb3_contrib")
    slippery = gym.make("FrozenLake-v1")
    holes = {5, 7, 11, 12}
    places: Any = lambda s: {"hole": s in holes, "goal": s == 15}  # noqa: E731
    shield = solve(FiniteModel.from_env(slippery), "!hole U goal", places).shield(epsilon=0.1)
    env = TaskEnv(slippery, "!hole U goal", lambda env, obs, info: places(int(obs)), shield=shield)
    # An action that is barred raises: none is taken while it learns, nor afterwards.
    algorithm = contrib.MaskablePPO("MlpPolicy", env, n_steps=128, seed=0).learn(1_000)
    for seed in range(20):
        (obs, _), done = env.reset(seed=seed), False
        while not done:
            action, _ = algorithm.predict(obs, action_masks=env.action_masks())
            obs, _, terminated, truncated, _ = env.step(int(action))
            done = terminated or truncated
