"""`ArkanoidVectorEnv`: many games as one Gymnasium vector environment, stepped by one kernel."""

from collections.abc import Sequence
from functools import cached_property
from typing import TYPE_CHECKING, Any

import gymnasium as gym
import numpy as np
from gymnasium.vector.utils import batch_space
from numpy.typing import NDArray

from .actions import action_meanings
from .batch.batch import Autoreset, Batch
from .batch.infos import final_infos, infos_of
from .batch.snapshots import restore_snapshot, spread_snapshot, take_snapshot
from .batch.starts import set_start
from .checks import check_boolean, check_integer, check_seeds, counted
from .config import MOST_WORLDS, Config
from .hints import BATCH_KEYWORDS
from .interface import (
    SpecWithLimit,
    action_space,
    check_attribute,
    check_limit,
    check_options,
    check_render_mode,
    check_was_reset,
    frame_size,
    instance_metadata,
)
from .masks import action_masks
from .observe.parts import copy_of, parts_of
from .state import Worlds

if TYPE_CHECKING:
    from .batch.recorder import Recorder

try:
    from gymnasium.vector import AutoresetMode
except ImportError as error:
    raise ImportError(
        f"ArkanoidVectorEnv needs Gymnasium 1.1 or newer, which has autoreset modes; this is "
        f"{gym.__version__}. gym.make() and SyncVectorEnv work with it"
    ) from error

Observations = Any  # an array, or with observation="dict" a dictionary of arrays

_RENDER_MODES = ("rgb_array",)
# What `call` asks each world for. Everything else is the same for all worlds.
_OF_EACH_WORLD = ("action_masks", "render")
_MODES = {
    AutoresetMode.DISABLED: Autoreset.DISABLED,
    AutoresetMode.NEXT_STEP: Autoreset.NEXT_STEP,
    AutoresetMode.SAME_STEP: Autoreset.SAME_STEP,
}


class ArkanoidVectorEnv(gym.vector.VectorEnv[Observations, NDArray[np.int64], Any]):
    """Many games of Arkanoid, equal bit for bit to `SyncVectorEnv` of `ArkanoidEnv`.

    Args:
        num_envs: the number of worlds.
        render_mode: ``"rgb_array"`` or None.
        autoreset_mode: a Gymnasium `AutoresetMode` or its text (``"NextStep"``, ``"SameStep"``,
            ``"Disabled"``).
        copy: whether `reset` and `step` return fresh observations. With False they return views of
            the same memory each time: do not write into it, a later step writes only changes.
        threads: the largest number of threads that step the worlds; None lets the number of
            worlds decide. It changes no bit of the results.
        render_size: of the frames: their height in pixels (the width follows), or (height, width);
            None is a height of 512.
        max_episode_steps: Gymnasium passes it from a spec; at least `max_decisions`.
        **keywords: the rules and the interface, see `Config`.

    Raises:
        TypeError, ValueError: a keyword is unknown or its value is illegal.
        MemoryError: there is no room for so many worlds.
    """

    spec: Any = SpecWithLimit()

    def __init__(
        self,
        num_envs: int = 1,
        render_mode: str | None = None,
        autoreset_mode: str | AutoresetMode = AutoresetMode.NEXT_STEP,
        copy: bool = True,
        threads: int | None = None,
        render_size: int | tuple[int, int] | None = None,
        max_episode_steps: int | None = None,
        **keywords: Any,
    ) -> None:
        check_render_mode(render_mode, _RENDER_MODES)
        check_integer("num_envs", num_envs, 1, MOST_WORLDS)
        if threads is not None:
            check_integer("threads, if it is not None,", threads, 1, MOST_WORLDS)
        check_boolean("copy", copy)
        self.config = Config.from_keywords(keywords, ("num_envs", *BATCH_KEYWORDS))
        check_limit(max_episode_steps, self.config)
        self.num_envs = num_envs
        self.render_mode = render_mode
        self._frame_size = frame_size(render_size)
        self.copy = copy
        self.autoreset_mode = _read_mode(autoreset_mode)
        self.metadata = instance_metadata(self.config) | {
            "render_modes": list(_RENDER_MODES),
            "autoreset_mode": self.autoreset_mode,
        }
        self._mode = _MODES[self.autoreset_mode]
        try:
            self._batch = Batch(num_envs, self.config, self._mode, threads)
        except MemoryError as error:
            raise MemoryError(f"num_envs={num_envs} does not fit into memory") from error
        self.single_observation_space = self._batch.observer.space
        self.single_action_space = action_space(self.config)
        self.action_space = batch_space(self.single_action_space, num_envs)
        self.layout = self._batch.observer.layout
        self._everywhere = np.ones(num_envs, np.bool_)
        self._attributes: dict[str, tuple[Any, ...]] = {}

    # Made when it is asked for: of a million worlds, it takes gigabytes and many seconds.
    @cached_property
    def observation_space(self) -> Any:  # type: ignore[override]
        """The space of all worlds' observations."""
        return batch_space(self.single_observation_space, self.num_envs)

    def reset(
        self,
        *,
        seed: int | Sequence[int | None] | None = None,
        options: dict[str, Any] | None = None,
    ) -> tuple[Observations, dict[str, Any]]:
        """Begin an episode in every world, or in those of ``options["reset_mask"]`` (bool [n]).

        An int, at most 2^64 - n, seeds world ``i`` with ``seed + i``; a sequence gives each world's
        own seed; None goes on with each world's generator. The options ``"level"``, ``"seed"``,
        ``"repeat"`` and ``"difficulty"`` say how this and the following episodes of those worlds
        begin, see `arkanoid.envs.levels.starts`. They stay in force until the world gets a seed or
        other options. With `episodic_life` a world's game goes on after the loss of a life, unless
        it gets either.

        Raises:
            TypeError, ValueError: a seed or an option is illegal; the games are as they were then.
        """
        check_options(options, "reset_mask")
        seeds = check_seeds(seed, self.num_envs)
        mask = self._everywhere
        if options and "reset_mask" in options:
            mask = self._reset_mask(options["reset_mask"])
        super().reset(seed=seeds[0] if isinstance(seed, int | np.integer) else None)
        unseeded = np.flatnonzero(mask & ~self._batch.seeded).tolist()
        for index in unseeded:
            if seeds[index] is None:
                seeds[index] = int(self.np_random.integers(1 << 62))
        self._batch.reset(mask, options, seeds if seed is not None or unseeded else None)
        return self._observations(), infos_of(self._batch.outcomes, mask)

    def set_start(self, world: int, options: dict[str, Any]) -> None:
        """Set how a world's next games begin, as `reset` does, while its present one goes on."""
        check_options(options)
        set_start(self._batch, world, options)

    def step(
        self, actions: Any
    ) -> tuple[
        Observations,
        NDArray[np.float64],
        NDArray[np.bool_],
        NDArray[np.bool_],
        dict[str, Any],
    ]:
        """Play one decision in every world.

        Args:
            actions: integers [n], or velocity and fire, [n, 2].

        Raises:
            TypeError, ValueError: they are not in the action space.
            gymnasium.error.ResetNeeded: a world was never reset, or its episode is over and the
                autoreset mode is ``"Disabled"``.
        """
        batch = self._batch
        batch.command(actions)
        batch.step()
        outcomes = batch.outcomes
        infos: dict[str, Any] = {}
        terminated: NDArray[np.bool_] = outcomes["terminated"].copy()
        truncated: NDArray[np.bool_] = outcomes["truncated"].copy()
        if self._mode is Autoreset.SAME_STEP:
            infos = final_infos(batch, terminated | truncated)
        infos |= infos_of(outcomes, self._everywhere)
        return self._observations(), outcomes["reward"].copy(), terminated, truncated, infos

    def render(self) -> tuple[NDArray[np.uint8], ...] | None:
        """Return a frame of each world, uint8 [height, width, 3]; None without a render mode.

        Raises:
            gymnasium.error.ResetNeeded: a world was never reset.
        """
        if self.render_mode is None:
            return None
        check_was_reset(self._batch.worlds, "render()")
        # Imported on demand: playing without pictures needs none of the drawing kernels.
        from .draw.picture import draw_world

        batch = self._batch
        return tuple(
            draw_world(batch.worlds, batch.rules, index, *self._frame_size)
            for index in range(self.num_envs)
        )

    def action_masks(self) -> NDArray[np.bool_]:
        """Return which actions do something now, bool [n, actions], for algorithms that mask.

        Raises:
            ValueError: the actions are continuous.
            gymnasium.error.ResetNeeded: a world was never reset.
        """
        return action_masks(self.config, self._batch.worlds, self._batch.rules)

    def get_action_meanings(self) -> list[str]:
        """Return Atari's word for each action: ``"NOOP"``, ``"LEFT"``, ``"RIGHTFIRE"``, ...

        Raises:
            ValueError: the actions are continuous.
        """
        return action_meanings(self.config.actions)

    def call(self, name: str, *args: Any, **kwargs: Any) -> tuple[Any, ...]:
        """Return what a method or an attribute of each world gives, as `SyncVectorEnv.call` does.

        ``"action_masks"``, ``"render"`` and ``"snapshot"`` differ from world to world. Anything
        else is asked of the environment once, and the same for all worlds.

        Raises:
            AttributeError: there is nothing of that name.
        """
        if name in self._attributes:
            return self._attributes[name]
        if name == "snapshot":
            return tuple(self.snapshot(world) for world in range(self.num_envs))
        if name in ("observation_space", "action_space"):
            name = f"single_{name}"
        value: Any = getattr(self, name)
        if callable(value):
            value = value(*args, **kwargs)
            if name in _OF_EACH_WORLD:
                return tuple(value) if value is not None else (None,) * self.num_envs
        return (value,) * self.num_envs

    def get_attr(self, name: str) -> tuple[Any, ...]:
        """Return an attribute of each world, see `call`."""
        return self.call(name)

    def set_attr(self, name: str, values: Any) -> None:
        """Set an attribute of each world: a list or tuple with one value per world, or one for all.

        Of this environment's own attributes, ``render_mode`` and ``copy`` can be set, for all
        worlds at once. A name that it does not have is only kept for `get_attr`.

        Raises:
            AttributeError: it is another attribute of this environment.
            TypeError: ``copy`` is no boolean.
            ValueError: the number of values is wrong, they differ where all worlds share one, or
                the render mode is illegal.
        """
        if not isinstance(values, list | tuple):
            values = [values] * self.num_envs
        if len(values) != self.num_envs:
            worlds = counted(self.num_envs, "world")
            raise ValueError(f"{counted(len(values), 'value')} for {worlds}; give one for each")
        if not hasattr(self, name):
            self._attributes[name] = tuple(values)
            return
        check_attribute(name, values[0], _RENDER_MODES)
        if any(value != values[0] for value in values):
            raise ValueError(f"all worlds share {name!r}: give one value; got {values!r}")
        setattr(self, name, values[0])

    @property
    def state(self) -> Worlds:
        """The state of each game, NumPy records [n]: a read-only view that shows the present.

        Their fields are those of `arkanoid.envs.state.World`, for example
        ``env.state["paddle_x"]``, float64 [n], or ``env.state[3].lives``.
        """
        return self._batch.state

    def snapshot(self, world: int | None = None) -> bytes:
        """Return the whole state of all worlds, or of one, to go on from with `restore`.

        It includes random generators, earlier pictures that observations show, and whether a world
        waits for its reset.

        Args:
            world: its index; None: all of them.

        Raises:
            RuntimeError: a world was never reset.
            TypeError, ValueError: there is no such world.
        """
        return take_snapshot(self._batch, world)

    def restore(self, snapshot: bytes) -> tuple[Observations, dict[str, Any]]:
        """Go on from a snapshot, and return the observations and infos that were the latest then.

        It may be of this environment, or of another one of the same configuration and number of
        worlds, with any number of threads.

        Raises:
            TypeError: it is not bytes.
            ValueError: it is corrupt, of another version, configuration, number of worlds or other
                levels, of a state to which no play leads (the message names the field), or has an
                episode that is over where this environment would have begun the next; the
                environment is as it was then.
        """
        restore_snapshot(self._batch, snapshot)
        return self._observations(), infos_of(self._batch.outcomes, self._everywhere)

    def spread(
        self, snapshot: bytes, seed: int | None = None
    ) -> tuple[Observations, dict[str, Any]]:
        """Bring all worlds into the same state, for planning; return as `restore` does.

        Args:
            snapshot: of one world: a single environment's, or ``snapshot(world)``.
            seed: seeds world ``i``'s random numbers from here on with ``seed + i``. None: all
                worlds will have the same ones, so that a planner sees what chance will bring.

        Raises:
            TypeError, ValueError: as `restore`.
        """
        seeds = check_seeds(seed, self.num_envs)
        spread_snapshot(self._batch, snapshot, seeds)
        return self._observations(), infos_of(self._batch.outcomes, self._everywhere)

    def record(self, world: int = 0) -> "Recorder":
        """Begin to record the games of a world, for replays, each from its beginning.

        Raises:
            TypeError, ValueError: there is no such world.
        """
        # Imported on demand: most play is not recorded.
        from .batch.recorder import Recorder

        return Recorder(self._batch, world)

    def __repr__(self) -> str:
        from .play.shown import differences, progress

        keywords = ", ".join([f"num_envs={self.num_envs}", *differences(self.config)])
        return f"<{type(self).__name__}({keywords}): {progress(self.state)}>"

    def _repr_png_(self) -> bytes | None:
        """Return the first sixteen worlds as a PNG file, which notebooks show."""
        from .play.shown import pictures_png

        return pictures_png(self.state, self._batch.rules, self._frame_size)

    def close(self, **kwargs: Any) -> None:
        """End the threads, also those that a step after an earlier `close` has started."""
        super().close(**kwargs)
        self.close_extras()

    def close_extras(self, **kwargs: Any) -> None:
        """End the threads."""
        # Gymnasium before 1.3 also closes an environment whose `__init__` has failed.
        if hasattr(self, "_batch"):
            self._batch.close()

    def _reset_mask(self, mask: Any) -> NDArray[np.bool_]:
        if not isinstance(mask, np.ndarray) or mask.dtype != np.bool_:
            raise TypeError(f"options['reset_mask'] must be a NumPy array of bool; got {mask!r}")
        if mask.shape != (self.num_envs,) or not mask.any():
            raise ValueError(
                f"options['reset_mask'] must have shape ({self.num_envs},) and a True in it; "
                f"got {mask!r}"
            )
        # Kernels are compiled anew for an array whose numbers do not lie side by side.
        return np.ascontiguousarray(mask)

    def _observations(self) -> Observations:
        observations = self._batch.observations
        return copy_of(observations) if self.copy else parts_of(observations)


def _read_mode(mode: str | AutoresetMode) -> AutoresetMode:
    try:
        return AutoresetMode(mode)
    except ValueError:
        legal = ", ".join(repr(each.value) for each in AutoresetMode)
        raise ValueError(f"autoreset_mode must be one of {legal}; got {mode!r}") from None
