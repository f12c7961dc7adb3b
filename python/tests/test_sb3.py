"""Stable-Baselines3: certified, exported, emitted; `pip install 'tltl[sb3]'`."""

# pyright: reportMissingImports=false

from __future__ import annotations

import shutil
import subprocess
from pathlib import Path
from typing import Any

import gymnasium as gym
import numpy as np
import pytest

from tltl import FiniteModel, NetworkPolicy, Task, solve
from tltl.gymnasium import TaskEnv

torch = pytest.importorskip("torch")
sb3 = pytest.importorskip("stable_baselines3")
pytestmark = pytest.mark.sb3


def labels(env: Any, obs: Any, info: dict[str, Any]) -> dict[str, bool]:
    return {"corner": obs == 3, "goal": obs == 15}


def cells(s: int) -> dict[str, bool]:
    return {"corner": s == 3, "goal": s == 15}


def lake(**options: Any) -> TaskEnv:
    return TaskEnv(gym.make("FrozenLake-v1", is_slippery=False), "corner T goal", labels, **options)


def cart() -> TaskEnv:
    return TaskEnv(gym.make("CartPole-v1"), "(x > 0.05) T (x < -0.05)", columns={"x": 0})


def learned(kind: str, env: TaskEnv, **options: Any) -> Any:
    if kind == "dqn":
        return sb3.DQN("MlpPolicy", env, learning_starts=100, seed=0, **options).learn(600)
    activation: Any = {"activation_fn": torch.nn.ReLU, "net_arch": [32, 16]}
    return sb3.PPO(
        "MlpPolicy", env, n_steps=128, seed=0, policy_kwargs=activation, **options
    ).learn(256)


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


@pytest.mark.parametrize("kind", ["dqn", "ppo"])
def test_a_network_is_exported(kind: str, tmp_path: Path) -> None:
    from tltl.sb3 import export

    env = cart()
    algorithm = learned(kind, env)
    policy = export(algorithm, env.task, actions=["left", "right"])
    policy.save(tmp_path / "policy.json")
    assert NetworkPolicy.load(tmp_path / "policy.json") == policy
    rng = np.random.default_rng(1)
    live = [q for q in range(env.task.num_states) if q != env.task.accepting]
    q = rng.choice(live, 10_000)
    states = rng.normal(size=(10_000, 4)).astype(np.float32)
    seen = [env.observed(obs, int(p)) for obs, p in zip(states, q, strict=True)]
    theirs, _ = algorithm.predict(np.array(seen), deterministic=True)
    differ = 0
    for obs, p, action in zip(seen, q.tolist(), theirs, strict=True):
        values = np.sort(policy.values(p, obs))
        if policy.act(p, obs) != action:
            # Only where the two best are as good as equal.
            assert values[-1] - values[-2] < 1e-4 * max(1.0, abs(values[-1]))
            differ += 1
    assert differ < 100
    if shutil.which("rustc") is None:
        pytest.skip("there is no rustc: the emitted file was not compiled")
    policy.emit_rust(tmp_path / "policy.rs")
    some = list(zip(q[:200].tolist(), seen[:200], strict=True))
    rows = ", ".join(f"({p}, {[float(x) for x in obs]})" for p, obs in some)
    (tmp_path / "main.rs").write_text(
        "#[allow(dead_code)] mod policy;\n"
        f"fn main() {{ for (q, obs) in [{rows}] as [(usize, [f32; {len(seen[0])}]); 200] {{"
        ' println!("{}", policy::act(q, &obs, &[])); } }'
    )
    subprocess.run(["rustc", str(tmp_path / "main.rs"), "-o", str(tmp_path / "main")], check=True)
    out = subprocess.run([tmp_path / "main"], capture_output=True, text=True, check=True).stdout
    assert out.split() == [str(policy.act(p, obs)) for p, obs in some]


def test_what_cannot_be_exported_is_named() -> None:
    from tltl.sb3 import export

    env = cart()
    tanh = sb3.PPO("MlpPolicy", env, n_steps=64, seed=0)
    with pytest.raises(ValueError, match=r"a layer Tanh\(\): a document has Linear layers with ReLU"):
        export(tanh, env.task)
    by_name = TaskEnv(gym.make("CartPole-v1"), "F x > 1", columns={"x": 0}, observe="dict")
    many = sb3.DQN("MultiInputPolicy", by_name, seed=0)
    with pytest.raises(ValueError, match="wanted are flat observations"):
        export(many, by_name.task)
    other = Task("F a && F b && F c")
    with pytest.raises(ValueError, match="flat ones with the 8 states of"):
        export(learned("dqn", env), other)


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
