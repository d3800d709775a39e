"""Images of memory: all that a game works on, laid out as it will lie in a browser."""

from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...physics.kernels.portable.wasm import FREE_FROM
from ..actions import COMMANDS
from ..config import Config
from ..draw.palette import PALETTE, palette_for
from ..game.rulebook import make_rules
from ..levels.plan import LevelPlan
from ..levels.starts import AS_THE_CONFIGURATION_SAYS, set_starts
from ..observe.planes import MAX_MARKS, GridObserver
from ..observe.vector import VectorObserver
from ..state import INFO_FIELDS, Outcome, World
from .records import CHANNELS, Game, Picture

_LINE = 64  # bytes; each array begins at a multiple


class Memory:
    """Memory of a browser, from an address on.

    Attributes:
        content: the bytes that are laid out so far, from `FREE_FROM` on.
    """

    def __init__(self) -> None:
        self.content = bytearray()

    def put(self, array: NDArray[Any]) -> int:
        """Lay out an array; return its address."""
        self.content += bytes(-len(self.content) % _LINE)
        address = FREE_FROM + len(self.content)
        self.content += array.tobytes()
        return address

    def write(self, address: int, array: NDArray[Any]) -> None:
        """Write over what lies at an address."""
        first = address - FREE_FROM
        self.content[first : first + array.nbytes] = array.tobytes()


@dataclass(frozen=True)
class Image:
    """A game that has not begun.

    Attributes:
        content: the memory from `FREE_FROM` on; what follows is zero.
        length: of all of it, in bytes.
        addresses: of the records `game`, `world`, `outcome`, `rules` and `picture`, a pattern of
            pictures; and of the observations `vector` and `grid`.
        layouts: names of parts of the observations, as slices of their first axis.
        shapes: of the observations.
    """

    content: bytes
    length: int
    addresses: dict[str, int]
    layouts: dict[str, dict[str, slice]] = field(default_factory=dict)
    shapes: dict[str, tuple[int, ...]] = field(default_factory=dict)


def lay_out(config: Config, plan: LevelPlan) -> Image:
    """Return the image of a game.

    Args:
        config: its observation does not matter: every game has a vector and a grid; the vector has
            landings if the configuration asks for them.
        plan: its levels.
    """
    return _Layout(config, plan).image()


class _Layout:
    """Lays out one game."""

    def __init__(self, config: Config, plan: LevelPlan) -> None:
        self._memory = Memory()
        self._config = config
        self._plan = plan
        self._game = np.zeros(1, Game)
        self._addresses = {"game": self._memory.put(self._game)}
        self._layouts: dict[str, dict[str, slice]] = {}
        self._shapes: dict[str, tuple[int, ...]] = {}

    def image(self) -> Image:
        """Return the image."""
        self._put_rules()
        self._put_world()
        self._put_picture()
        # What is zero comes last: it takes no room in the image.
        self._put_vector()
        self._put_grid()
        self._memory.write(self._addresses["game"], self._game)
        content = bytes(self._memory.content)
        return Image(
            content.rstrip(b"\0"), len(content), self._addresses, self._layouts, self._shapes
        )

    def _set(self, **numbers: int) -> None:
        for name, number in numbers.items():
            self._game["arrays"][name] = number

    def _put(self, name: str, array: NDArray[Any]) -> int:
        address = self._memory.put(array)
        self._set(**{name: address})
        return address

    def _put_rules(self) -> None:
        """Lay out what never changes."""
        levels = self._plan.table
        self._addresses["rules"] = self._put("rules", make_rules(self._config, self._plan))
        self._put("levels", levels)
        self._set(num_levels=len(levels), episodic_life=self._config.episodic_life)
        table = COMMANDS.get(self._config.actions)
        if table is not None:
            self._put("table", table)
            self._set(num_actions=len(table))

    def _put_world(self) -> None:
        """Lay out the state, and what a step reads and writes."""
        world = np.zeros(1, World)
        set_starts(world, np.ones(1, np.bool_), AS_THE_CONFIGURATION_SAYS)
        self._addresses["world"] = self._put("worlds", world)
        self._addresses["outcome"] = self._put("outcomes", np.zeros(1, Outcome))
        # An integer, or velocity and fire as float32.
        self._put("actions", np.zeros(1, np.int64))
        self._put("commands", np.zeros(2))
        self._put("illegal", np.zeros(1, np.int32))
        self._put("infos", np.zeros(len(INFO_FIELDS), np.int64))
        self._set(count=1)
        self._game["arrays"]["here"] = True

    def _put_vector(self) -> None:
        observer = VectorObserver(self._config, 1)
        self._observe("vector", "vectors", observer)
        self._set(vector_size=observer.observations.size, plain_length=observer.plain_length)
        self._put("vector_shown", np.zeros(3, np.int64))
        if observer.shows_landings:
            self._set(landings_start=observer.landings_start)

    def _put_grid(self) -> None:
        observer = GridObserver(self._config, 1)
        self._observe("grid", "grids", observer)
        self._set(grid_size=observer.observations.size)
        self._put("grid_shown", np.zeros(3, np.int64))
        self._put("marks", np.zeros(1 + MAX_MARKS, np.int32))

    def _observe(self, kind: str, name: str, observer: VectorObserver | GridObserver) -> None:
        self._addresses[kind] = self._put(name, observer.observations)
        self._layouts[kind] = observer.layout
        self._shapes[kind] = observer.observations.shape[1:]

    def _put_picture(self) -> None:
        """Lay out the palettes, and a picture without size."""
        picture = np.zeros(1, Picture)
        picture["worlds"] = self._addresses["world"]
        picture["rules"] = self._addresses["rules"]
        picture["num_colours"] = len(PALETTE)
        for small in (False, True):
            for channels in CHANNELS:
                palette = _palette(small, channels)
                picture["palettes"][0, int(small), channels] = self._memory.put(palette)
        self._addresses["picture"] = self._memory.put(picture)


def _palette(small: bool, channels: int) -> NDArray[np.float64]:
    """Return a palette; with four channels, the last one is the opacity of canvases."""
    if channels < 4:
        return palette_for(small, channels)
    colours = palette_for(small, 3)
    return np.hstack([colours, np.full((len(colours), 1), 255.0)])
