"""`ArkanoidEnv`: one game as a Gymnasium environment. It is a batch of one world."""

from typing import TYPE_CHECKING, Any

import gymnasium as gym
import numpy as np
from numpy.typing import NDArray

from .actions import COMMANDS, action_meanings, read_box, read_discrete
from .batch.batch import Batch
from .batch.snapshots import restore_snapshot, take_snapshot
from .checks import check_seed
from .config import Config
from .emulator import Emulator
from .interface import (
    METADATA,
    RENDER_MODES,
    SpecWithLimit,
    action_space,
    check_options,
    check_render_mode,
    check_was_reset,
    frame_size,
    instance_metadata,
)
from .masks import action_masks
from .observe.parts import copy_of
from .rules import TICKS_PER_SECOND
from .state import WorldRecord

if TYPE_CHECKING:
    from .batch.recorder import Recorder
    from .play.window import Window

Observation = Any  # an array, or with observation="dict" a dictionary of arrays

_ALL = np.ones(1, np.bool_)


class ArkanoidEnv(gym.Env[Observation, Any]):
    """One game of Arkanoid.

    Args:
        render_mode: ``"rgb_array"`` (uint8 frames, drawn without a display), ``"human"`` (a
            window; needs the extra ``play``) or None.
        render_size: of the frames: their height in pixels (the width follows), or (height, width);
            None is a height of 512.
        **keywords: the rules and the interface, see `Config`.

    Raises:
        TypeError, ValueError: a keyword is unknown or its value is illegal.
    """

    metadata = METADATA
    spec: Any = SpecWithLimit()

    def __init__(
        self,
        render_mode: str | None = None,
        render_size: int | tuple[int, int] | None = None,
        **keywords: Any,
    ) -> None:
        check_render_mode(render_mode, RENDER_MODES)
        self.config = Config.from_keywords(keywords, ("render_mode", "render_size"))
        self.render_mode = render_mode
        self._frame_size = frame_size(render_size)
        self.metadata = instance_metadata(self.config)
        self._batch = Batch(1, self.config)
        self.observation_space = self._batch.observer.space
        self.action_space = action_space(self.config)
        self.layout = self._batch.observer.layout
        table = COMMANDS.get(self.config.actions)
        # As Python's numbers: NumPy writes them into an array faster than a row of another array.
        self._commands = None if table is None else table.tolist()
        self._window: Window | None = None

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Observation, dict[str, Any]]:
        """Begin an episode.

        Seed and options determine all that follows: a reset with a seed forgets the options of
        earlier resets. Without a seed the generator goes on from where it is, and earlier options
        stay in force; with `episodic_life` the game goes on after the loss of a life, unless there
        are options.

        Args:
            seed: of the game's random numbers, from 0 to 2^64 - 1.
            options: how this and the following episodes begin: ``"level"`` (a name or path, or the
                number of a round), ``"seed"`` (of a generated level; not the game's),
                ``"repeat"`` and ``"difficulty"``; see `arkanoid.envs.levels.starts`.

        Raises:
            TypeError, ValueError: the seed or an option is illegal; the game is as it was then.
        """
        check_options(options)
        chosen = check_seed(seed)
        super().reset(seed=chosen)
        if chosen is None and not self._batch.seeded[0]:
            chosen = int(self.np_random.integers(1 << 62))
        self._batch.reset(_ALL, options, None if chosen is None else [chosen])
        self._show()
        return self._shown()

    def step(self, action: Any) -> tuple[Observation, float, bool, bool, dict[str, Any]]:
        """Play one decision.

        Args:
            action: an integer, or velocity and fire; numbers of NumPy and torch are legal, too.

        Raises:
            TypeError, ValueError: it is not in the action space. (Velocities beyond a bound count
                as the bound.)
            gymnasium.error.ResetNeeded: there was no reset yet, or the episode is over.
        """
        batch = self._batch
        table = self._commands
        command = read_box(action) if table is None else table[read_discrete(action, len(table))]
        batch.commands[0, 0], batch.commands[0, 1] = command
        batch.step()
        # As tuples, because NumPy takes longer to make one record.
        (outcome,) = batch.outcomes.tolist()
        if self.render_mode == "human":
            self._show()
        return (copy_of(batch.observer.observations[0]), *_results(outcome))

    def render(self) -> NDArray[np.uint8] | None:
        """Return a frame, uint8 [height, width, 3], in render mode ``"rgb_array"``.

        Raises:
            gymnasium.error.ResetNeeded: there is a render mode, and there was no reset yet.
        """
        if self.render_mode is not None:
            check_was_reset(self._batch.worlds, "render()")
        if self.render_mode == "rgb_array":
            # Imported on demand: playing without pictures needs none of the drawing kernels.
            from .draw.picture import draw_world

            return draw_world(self._batch.worlds, self._batch.rules, 0, *self._frame_size)
        if self.render_mode is None:
            gym.logger.warn(
                "render() without a render mode: use gym.make(..., render_mode='rgb_array')"
            )
        return None

    @property
    def state(self) -> WorldRecord:
        """The state of the game: a read-only view, which always shows the present.

        It is a NumPy record; its fields are those of `arkanoid.envs.state.World`, for example
        ``env.state.paddle_x`` or ``env.state["brick_hits"]``. ``env.state.copy()`` keeps a state.
        """
        return self._batch.state[0]

    def snapshot(self) -> bytes:
        """Return the whole state, random numbers included, to go on from with `restore`.

        What wrappers count, such as the steps of `TimeLimit`, is not in it. A deep copy of the
        wrapped environment has that, too.

        Raises:
            RuntimeError: the environment was never reset.
        """
        return take_snapshot(self._batch)

    def restore(self, snapshot: bytes) -> tuple[Observation, dict[str, Any]]:
        """Go on from a snapshot, and return the observation and the info that were the latest then.

        It may be of this environment, of another one of the same configuration, or of one world of
        a vector environment of the same configuration.

        Raises:
            TypeError: it is not bytes.
            ValueError: it is corrupt, of another version, configuration or other levels, has
                several worlds, or is of a state to which no play leads (the message names the
                field); the environment is as it was then.
        """
        restore_snapshot(self._batch, snapshot)
        self._show()
        return self._shown()

    def clone(self, seed: int | None = None) -> "ArkanoidEnv":
        """Return an independent environment in the same state, within some µs, for planning.

        The two share the spaces and what never changes; `copy.deepcopy` shares nothing. A clone has
        no window.

        Args:
            seed: of the clone's random numbers from here on. None: they will be the same as in
                this environment, so that a planner sees what chance will bring.
        """
        chosen = check_seed(seed)
        clone = object.__new__(type(self))
        clone.__dict__.update(self.__dict__)
        clone._batch = self._batch.clone()
        clone._window = None
        if clone.render_mode == "human":
            clone.render_mode = None
        if chosen is not None:
            clone._batch.seed(0, chosen)
        return clone

    def record(self) -> "Recorder":
        """Begin to record games for replays, from the next reset on or from the one just made."""
        # Imported on demand: most play is not recorded.
        from .batch.recorder import Recorder

        return Recorder(self._batch, 0)

    def action_masks(self) -> NDArray[np.bool_]:
        """Return which actions do something now, bool [actions], for algorithms that mask.

        Raises:
            ValueError: the actions are continuous.
            gymnasium.error.ResetNeeded: there was no reset yet.
        """
        batch = self._batch
        masks: NDArray[np.bool_] = action_masks(self.config, batch.worlds, batch.rules)[0]
        return masks

    def get_action_meanings(self) -> list[str]:
        """Return Atari's word for each action: ``"NOOP"``, ``"LEFT"``, ``"RIGHTFIRE"``, ...

        Raises:
            ValueError: the actions are continuous.
        """
        return action_meanings(self.config.actions)

    @property
    def ale(self) -> Emulator:
        """Lives and pictures, where wrappers for Atari games look for them."""
        return Emulator(self._batch)

    @property
    def _frameskip(self) -> int:
        # `AtariPreprocessing` looks for it.
        return self.config.frame_skip

    def get_keys_to_action(self) -> dict[tuple[int, ...], Any]:
        """Return the action of each combination of keys: ``gymnasium.utils.play.play`` asks for it.

        Arrows or A and D move, space fires. With ``actions="box"`` play() also needs
        ``noop=numpy.zeros(2, numpy.float32)``, for its own is the number 0.
        """
        from .play.controls import keys_to_action

        return keys_to_action(self.config)

    def __repr__(self) -> str:
        from .play.shown import differences, progress

        keywords = ", ".join(differences(self.config))
        return f"<ArkanoidEnv({keywords}): {progress(self._batch.worlds)}>"

    def _repr_png_(self) -> bytes | None:
        """Return the present picture as a PNG file, which notebooks show; None before a reset."""
        from .play.shown import pictures_png

        return pictures_png(self._batch.worlds, self._batch.rules, self._frame_size)

    def __getstate__(self) -> dict[str, Any]:
        # A copy opens a window of its own.
        return self.__dict__ | {"_window": None}

    def close(self) -> None:
        """Close the window, if there is one."""
        if self._window is not None:
            self._window.close()
            self._window = None

    def _shown(self) -> tuple[Observation, dict[str, Any]]:
        """Return the present observation and info."""
        (outcome,) = self._batch.outcomes.tolist()
        *_, info = _results(outcome)
        return copy_of(self._batch.observations[0]), info

    def _show(self) -> None:
        """Show the game in render mode ``"human"``; the first call opens the window."""
        if self.render_mode != "human":
            return
        # Imported on demand: playing without pictures needs none of this.
        from .draw.picture import draw_world
        from .play.show import screen_height

        if self._window is None:
            from .play.window import Window

            self._window = Window("Arkanoid", TICKS_PER_SECOND / self.config.frame_skip)
        if not self._window.closed:
            self._window.show(draw_world(self._batch.worlds, self._batch.rules, 0, screen_height()))


def _results(outcome: tuple[Any, ...]) -> tuple[float, bool, bool, dict[str, Any]]:
    """Return reward, terminated, truncated and info, from the fields of an `Outcome`.

    The info has the keys of `INFO_FIELDS`. A loop over them would take three times as long, which
    is a tenth of a step.
    """
    (
        reward,
        score,
        lives,
        round_number,
        hits,
        bricks_broken,
        lives_gained,
        capsules_caught,
        enemies_destroyed,
        lives_lost,
        rounds_cleared,
        bricks_left,
        truncation,
        terminated,
        truncated,
    ) = outcome
    info = {
        "score": score,
        "lives": lives,
        "round": round_number,
        "bricks_left": bricks_left,
        "truncation": truncation,
        "hits": hits,
        "bricks_broken": bricks_broken,
        "capsules_caught": capsules_caught,
        "enemies_destroyed": enemies_destroyed,
        "lives_lost": lives_lost,
        "lives_gained": lives_gained,
        "rounds_cleared": rounds_cleared,
    }
    return reward, terminated, truncated, info
