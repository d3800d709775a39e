"""env-breakoutatari2600-turbo-native: Atari's Breakout in Rust, without an emulator."""

import itertools

import env_breakoutatari2600_turbo_native
import gymnasium as gym

from . import Many

NAME = env_breakoutatari2600_turbo_native.GYMNASIUM_ENV_ID


class Turbo(Many):
    """Begins new episodes, which this vector environment leaves to the caller."""

    def play(self, decisions: int) -> None:
        step, reset = self.env.step, self.env.reset
        for actions in itertools.islice(self.actions, decisions):
            _, _, terminated, truncated, _ = step(actions)
            over = terminated | truncated
            if over.any():
                reset(options={"reset_mask": over})


def many(worlds: int, stack: int) -> Turbo:
    """Return grey pictures of 84 × 84, frame skip 4, in one thread; nothing is copied."""
    return Turbo(
        gym.make_vec(
            NAME,
            worlds,
            "vector_entry_point",
            game="Breakout-Atari2600-v0",
            num_threads=1,
            frame_stack=stack,
            obs_copy="unsafe_view",
        )
    )
