"""Small callbacks of a training: statistics, the progress bar, and stopping."""

import math
from shutil import get_terminal_size
from typing import Any

import numpy as np
from stable_baselines3.common.callbacks import BaseCallback

from ..measure.episodes import FINAL_KEYWORDS, SUMMED_KEYWORDS
from ..measure.progress import make_bar
from .checkpoint_form import STOP

# Statistics of the latest episodes that the progress bar shows, and its names for them; the last
# one only where there is room.
_SHOWN = {"r": "return", "hits": "bricks", "rounds_cleared": "rounds"}
_ROOM = 100  # columns


class GameStatistics(BaseCallback):
    """Logs the means of the game's own statistics over the latest episodes."""

    def _on_step(self) -> bool:
        return True

    def _on_rollout_end(self) -> None:
        for key in FINAL_KEYWORDS + SUMMED_KEYWORDS:
            mean = recent_mean(self.model, key)
            if mean is not None:
                self.logger.record(f"rollout/ep_{key}_mean", mean)


class ProgressBar(BaseCallback):
    """Shows decisions per second and the latest episodes' mean return, bricks and rounds."""

    def __init__(self) -> None:
        super().__init__()
        self._bar: Any = None

    def _on_training_start(self) -> None:
        # Rollouts are played to their end: the last one may exceed the budget.
        rollout = self.model.n_steps * self.training_env.num_envs  # type: ignore[attr-defined]
        total = math.ceil(self.locals["total_timesteps"] / rollout) * rollout
        done = self.model.num_timesteps
        self._bar = make_bar(max(total, done), done)

    def _on_step(self) -> bool:
        self._bar.update(self.model.num_timesteps - self._bar.n)
        return True

    def _on_rollout_end(self) -> None:
        wide = get_terminal_size().columns >= _ROOM
        means = {name: recent_mean(self.model, key) for key, name in _SHOWN.items()}
        shown = [f"{name} {mean:.2f}" for name, mean in means.items() if mean is not None]
        self._bar.set_postfix_str(", ".join(shown[: len(_SHOWN) if wide else -1]), refresh=False)

    def _on_training_end(self) -> None:
        self.close()

    def close(self) -> None:
        """End the line of the bar, also where an error ends the training."""
        if self._bar is not None:
            self._bar.close()


class StopRequest(BaseCallback):
    """Ends the training after the decision in which someone asks for it.

    Args:
        state: this callback's, empty or from a checkpoint; it is changed in place. It has the
            reason, so that a run that was killed at its end does not train on.

    Attributes:
        interrupted: whether the training is interrupted, and can be resumed.
    """

    def __init__(self, state: dict[str, Any]) -> None:
        super().__init__()
        self._state = state
        state.setdefault(STOP, "")
        self.interrupted = False

    @property
    def reason(self) -> str | None:
        """Why the run has ended; None if it has not."""
        return self._state[STOP] or None

    def request(self, reason: str) -> None:
        """Ask for the end of the run."""
        self._state[STOP] = reason

    def interrupt(self) -> None:
        """Ask for an interruption."""
        self.interrupted = True

    def _on_step(self) -> bool:
        return self.reason is None and not self.interrupted


def recent_mean(model: Any, key: str) -> float | None:
    """Return the mean of an episode statistic, or None before the first episode has ended."""
    episodes = model.ep_info_buffer
    return float(np.mean([episode[key] for episode in episodes])) if episodes else None
