"""`ArkanoidEnv`: one game as a Gymnasium environment. It is a batch of one world."""

from operator import itemgetter
from typing import TYPE_CHECKING, Any

import gymnasium as gym
import numpy as np
from numpy.typing import NDArray

from .batch import COMMANDS, Batch
from .config import Config
from .interface import (
    METADATA,
    RENDER_MODES,
    action_space,
    check_options,
    check_render_mode,
    instance_metadata,
)
from .observation import observation_layout, vector_space
from .state import INFO_FIELDS, Outcome

if TYPE_CHECKING:
    from .window import Window

Observation = NDArray[np.float32]

_REWARD = Outcome.names.index("reward")  # type: ignore[union-attr]
_TERMINATED = Outcome.names.index("terminated")  # type: ignore[union-attr]
_TRUNCATED = Outcome.names.index("truncated")  # type: ignore[union-attr]
_INFO = [Outcome.names.index(field) for field in INFO_FIELDS.values()]  # type: ignore[union-attr]
_info_values = itemgetter(*_INFO)
_ALL = np.ones(1, np.bool_)


class ArkanoidEnv(gym.Env[Observation, Any]):
    """One game of Arkanoid.

    Args:
        render_mode: ``"rgb_array"`` (uint8 frames, drawn without a display), ``"human"`` (a
            window; needs the extra ``play``) or None.
        **keywords: the rules and the interface, see `Config`.

    Raises:
        TypeError, ValueError: a keyword is unknown or its value is illegal.
    """

    metadata = METADATA

    def __init__(self, render_mode: str | None = None, **keywords: Any) -> None:
        check_render_mode(render_mode, RENDER_MODES)
        self.config = Config.from_keywords(keywords)
        self.render_mode = render_mode
        self.metadata = instance_metadata(self.config)
        self.observation_space = vector_space(self.config)
        self.action_space = action_space(self.config)
        self.layout = observation_layout(self.config)
        self._batch = Batch(1, self.config)
        self._commands = COMMANDS.get(self.config.actions)
        self._seeded = False
        self._window: Window | None = None

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Observation, dict[str, Any]]:
        """Begin an episode; a seed determines all that follows, no seed goes on as it was.

        Args:
            seed: of the game's random numbers.
            options: how this and the following episodes begin: ``"level"`` (a name or path, or the
                number of a round), ``"seed"`` (of a generated level; not the game's) and
                ``"difficulty"``; see `curriculum`.
        """
        super().reset(seed=seed)
        check_options(options)
        if seed is None and not self._seeded:
            seed = int(self.np_random.integers(1 << 62))
        if seed is not None:
            self._batch.seed(0, seed)
            self._seeded = True
        self._batch.reset(_ALL, options)
        self._show()
        return self._batch.observations[0].copy(), self._info(self._batch.outcomes[0].item())

    def step(self, action: Any) -> tuple[Observation, float, bool, bool, dict[str, Any]]:
        """Play one decision."""
        batch = self._batch
        if self._commands is None:
            batch.command(np.asarray(action)[np.newaxis])
        elif 0 <= action < len(self._commands):
            batch.commands[0] = self._commands[action]
        else:
            raise ValueError(f"action {action!r} is not in {self.action_space}")
        batch.step()
        outcome = batch.outcomes[0].item()
        if self.render_mode == "human":
            self._show()
        return (
            batch.observations[0].copy(),
            outcome[_REWARD],
            outcome[_TERMINATED],
            outcome[_TRUNCATED],
            self._info(outcome),
        )

    def render(self) -> NDArray[np.uint8] | None:
        """Return a frame, uint8 [height, width, 3], in render mode ``"rgb_array"``."""
        if self.render_mode == "rgb_array":
            return self._frame()
        if self.render_mode is None:
            gym.logger.warn(
                "render() without a render mode: use gym.make(..., render_mode='rgb_array')"
            )
        return None

    def close(self) -> None:
        """Close the window, if there is one."""
        if self._window is not None:
            self._window.close()
            self._window = None

    def _info(self, outcome: tuple[Any, ...]) -> dict[str, Any]:
        return dict(zip(INFO_FIELDS, _info_values(outcome), strict=True))

    def _frame(self) -> NDArray[np.uint8]:
        # Imported on demand: playing without pictures needs none of the drawing kernels.
        from .render import draw_world

        return draw_world(self._batch.worlds, self._batch.rules, 0)

    def _show(self) -> None:
        if self.render_mode == "human":
            if self._window is None:
                from .window import Window

                self._window = Window("Arkanoid", self.metadata["render_fps"])
            self._window.show(self._frame())
