"""Updates of Stable-Baselines3's TD3 and SAC for each second of the processor; see `updates/main.rs`."""

import sys
import time

try:
    import gymnasium
    import numpy as np
    import torch
    from stable_baselines3 import SAC, TD3
except ImportError as error:
    sys.exit(f"skipped: {error}")


class Room(gymnasium.Env):
    """Like the room of `src/point.rs`, without pillar; an episode ends at a, or after 200 steps."""

    observation_space = gymnasium.spaces.Box(-1, 1, (5,), np.float32)
    action_space = gymnasium.spaces.Box(-1, 1, (2,), np.float32)

    def reset(self, *, seed=None, options=None):
        super().reset(seed=seed)
        self.steps, self.place, self.speed = 0, self.np_random.uniform(-1, 1, 2), np.zeros(2)
        return self.seen(), {}

    def seen(self):
        return np.array([*self.place, *self.speed / 0.8, np.hypot(*self.place) - 0.3], np.float32)

    def step(self, action):
        self.speed = np.clip(self.speed + action * 0.1, -0.8, 0.8)
        self.place = np.clip(self.place + self.speed * 0.1, -1, 1)
        self.steps += 1
        done = bool(np.hypot(self.place[0] + 0.6, self.place[1] - 0.6) < 0.25)
        return self.seen(), float(done), done, self.steps >= 200, {}


torch.set_num_threads(1)
for units, batch in ((64, 128), (256, 256)):
    for method in (TD3, SAC):
        sizes = {"policy_kwargs": {"net_arch": [units, units]}, "batch_size": batch}
        model = method("MlpPolicy", Room(), learning_starts=500, train_freq=1, seed=1, **sizes)
        model.learn(600)
        begin = time.process_time()
        model.learn(1_000, reset_num_timesteps=False)
        rate = 1_000 / (time.process_time() - begin)
        name = method.__name__
        print(f"{name}, [{units}, {units}] units, batches of {batch}: {rate:.0f} updates a second")
