"""Writes `environment.md`: ``python docs/environment_page.py``.

The tables come from the tables in the sources: keywords, parts of observations, reset options and
the keys of `info`, each with its meaning. The spaces come from the environments.
"""

import dataclasses
import sys
from collections.abc import Iterable
from pathlib import Path
from typing import Any

import arkanoid
import gymnasium as gym
from arkanoid.envs import rules
from arkanoid.envs.config import ACTIONS, OBSERVATIONS, REWARD_MEANINGS, Config
from arkanoid.envs.draw.status import STATUS_PARTS
from arkanoid.envs.game.flight import LANDING_IMPACTS
from arkanoid.envs.levels.starts import START_OPTIONS
from arkanoid.envs.observe import planes, vector
from arkanoid.envs.observe.landing import LANDING_PARTS
from arkanoid.envs.observe.layout import Part, slices
from arkanoid.envs.registration import GAMES
from arkanoid.envs.state import DECISION_LIMIT, INFO_MEANINGS

PAGE = Path(__file__).with_name("environment.md")
IDS = {
    "Arkanoid-v0": "the full game: power-ups, several balls, enemies, a boss",
    "ArkanoidLite-v0": "the game without capsules and enemies, three actions",
}
VIEWS: tuple[dict[str, Any], ...] = (
    {"observation": "vector"},
    {"observation": "grid"},
    {"observation": "rgb"},
    {"observation": "rgb", "grey": True, "stack": 4},
    {"observation": "rgb", "channels": "last"},
    {"observation": "dict", "grey": True, "stack": 4},
)
# Keywords whose words a section of the page explains.
SECTIONS = {
    "observation": "[Observation Space](#observation-space)",
    "actions": "[Action Space](#action-space)",
    "reward": "[Rewards](#rewards)",
}
VECTOR_KEYWORDS = {
    "num_envs": ("1", "how many games"),
    "autoreset_mode": (
        "'NextStep'",
        "Gymnasium's `AutoresetMode` or its name: `NextStep`, `SameStep`, `Disabled`",
    ),
    "copy": (
        "True",
        "whether observations are copies; otherwise do not write into them, for the next step "
        "writes only what has changed",
    ),
    "threads": ("None", "how many threads step the games; None: as many as their number is worth"),
    "device": (
        "None",
        "`'cuda'`, `'cuda:1'`, ...: the games run [on a graphics card](gpu.md) and give tensors; "
        "None: on the processor, with NumPy arrays",
    ),
}
METHODS = {
    "action_masks()": "which actions do something in the coming decision: bool `[actions]`, or "
    "`[games, actions]`",
    "get_action_meanings()": "Atari's word for each action",
    "ale.lives()": "balls left, the present one included (single environment)",
    "ale.getScreenRGB()": "the picture, where wrappers for Atari games look for it; also "
    "`ale.getScreenGrayscale()` (single environment)",
    "call(), get_attr(), set_attr()": "as Gymnasium's own vector environments have them; of the "
    "environment's own attributes only `render_mode` and `copy` can be set (vector environment)",
    "snapshot(), restore(), clone(), spread(), record()": "see [saving](saving.md)",
}


def ids() -> dict[str, str]:
    """Return the ids with what they are: the other ones stand for keywords."""
    others = {}
    for name, keywords in GAMES.items():
        base = "ArkanoidLite-v0" if "Lite" in name else "Arkanoid-v0"
        changed = {key: value for key, value in keywords.items() if GAMES[base].get(key) != value}
        given = ", ".join(f"{key}={value!r}" for key, value in changed.items())
        others[name] = f"`{base}` with `{given}`"
    return others | IDS


def table(head: tuple[str, ...], rows: Iterable[tuple[str, ...]]) -> str:
    """Return a table in Markdown."""
    lines = [head, ("---",) * len(head), *rows]
    return "\n".join(
        f"| {' | '.join(cell.replace('|', chr(92) + '|') for cell in line)} |" for line in lines
    )


def meanings(head: str, entries: dict[str, str]) -> str:
    """Return a table of names and what they mean."""
    return table((head, "meaning"), ((f"`{name}`", text) for name, text in entries.items()))


def space(name: str, kind: str, **keywords: Any) -> str:
    """Return an environment's space, as it describes itself."""
    env = gym.make(name, **keywords)
    described = f"`{getattr(env, kind)}`"
    env.close()
    return described


def action_table() -> str:
    """Return the table of action spaces."""
    rows = (
        (f"`{name!r}`", space("Arkanoid-v0", "action_space", actions=name), meaning)
        for name, meaning in ACTIONS.items()
    )
    return table(("`actions`", "space", "meaning"), rows)


def observation_table() -> str:
    """Return the table of observation spaces."""
    rows = []
    for keywords in VIEWS:
        given = ", ".join(f"{name}={value!r}" for name, value in keywords.items())
        spaces = (space(name, "observation_space", **keywords) for name in IDS)
        rows.append((f"`{given}`", OBSERVATIONS[keywords["observation"]], *spaces))
    return table(("keywords", "meaning", *(f"`{name}`" for name in IDS)), rows)


def part_table(parts: tuple[Part, ...]) -> str:
    """Return the table of an observation's parts."""
    layout = slices(parts)
    rows = (
        (f"`{part.name}`", f"{layout[part.name].start}:{layout[part.name].stop}", part.meaning)
        for part in parts
    )
    return table(("part", "slice", "meaning"), rows)


def further_parts(parts: tuple[Part, ...]) -> str:
    """Return the parts that only some games have."""
    return "; ".join(f"`{part.name}` ({part.length}), {part.meaning}" for part in parts)


def status_table() -> str:
    """Return the table of the status in small pictures."""
    rows = (
        (
            f"`{part.name}`",
            ("upper", "lower")[part.line],
            f"{part.first}:{part.first + part.units}",
            part.meaning,
        )
        for part in STATUS_PARTS
    )
    return table(("part", "line", "units", "meaning"), rows)


def keyword_table() -> str:
    """Return the table of keywords."""
    rows = []
    for keyword in dataclasses.fields(Config):
        meaning = keyword.metadata["meaning"]
        if keyword.name in SECTIONS:
            meaning = f"{meaning}: see {SECTIONS[keyword.name]}"
        elif keyword.metadata["words"]:
            words = (f"`{word!r}`: {text}" for word, text in keyword.metadata["words"].items())
            meaning = f"{meaning}. {'; '.join(words)}"
        rows.append((f"`{keyword.name}`", f"`{keyword.default!r}`", meaning.replace("``", "`")))
    rows.append(("`render_mode`", "`None`", "`'rgb_array'` (needs no display), `'human'` or None"))
    rows.append(("`render_size`", "`None`", "of frames: height or (height, width); None is 512"))
    return table(("keyword", "default", "meaning"), rows)


def page() -> str:
    """Return the page."""
    vector_keywords = (
        (f"`{name}`", f"`{default}`", meaning)
        for name, (default, meaning) in VECTOR_KEYWORDS.items()
    )
    rewards = "\n".join(f"- `{name!r}`: {meaning}." for name, meaning in REWARD_MEANINGS.items())
    return f"""\
<!-- environment_page.py writes this page. -->

# The environments

![A game of Arkanoid-v0](pictures/game.gif)

{meanings("id", ids())}

```python
import gymnasium as gym

env = gym.make("arkanoid:Arkanoid-v0")
worlds = gym.make_vec(
    "arkanoid:Arkanoid-v0", num_envs=1024, vectorization_mode="vector_entry_point"
)
```

Most ids are for tools that take no keywords; the two with `NoFrameskip` are for scripts that wrap
the Atari games of that name.

## Description

A paddle at the bottom of a field of {rules.FIELD_WIDTH:g} × {rules.FIELD_HEIGHT:g} brick widths
keeps a ball from falling out, and the ball breaks bricks. The place on the paddle where it lands
decides its angle. Some bricks hide capsules, which give the paddle powers; enemies come through the
ceiling and get in the ball's way ([all of them](things.md)). Twelve rounds lead to a boss; after
it, generated rounds get harder without end ([levels](levels.md)). The rules follow the arcade game
of 1986; the levels and pictures are our own.

A tick is 1/{rules.TICKS_PER_SECOND} s. Collisions are [exact](engine.md): a ball of any speed
passes through nothing. The same seed and actions give the same game bit for bit, alone or in a
batch, on any number of threads.

## Action Space

{action_table()}

## Observation Space

{observation_table()}

`env.unwrapped.layout` maps the names of parts to slices of an observation's first axis, as in
`observation[env.unwrapped.layout["paddle"]]`. A velocity is 1 at the speed in parentheses. Games
without capsules and enemies have only the parts up to `bricks` (`vector`) or `ball_held` (`grid`).

### `vector`

x runs from -1 at the left wall to 1 at the right one, y from -1 at the field's lower edge to 1 at
the ceiling. Numbers of things that are not there are 0.

{part_table(vector.CORE_PARTS + vector.EXTRA_PARTS)}

With `reward="score"`, two parts follow, which say what pays: {further_parts(vector.PAY_PARTS)}.

With `landing=True`, three parts come last: {further_parts(LANDING_PARTS)}. Each ball flies as in
the game, but alone and without enemies, and breaks bricks on its way. A held ball is there already.
A landing is unknown if the ball would clear the round first, has more than {LANDING_IMPACTS}
impacts, or is already below the paddle's upper side.

### `grid`

A cell is as large as a brick, 1 by 1/2. Row 0 lies under the ceiling, the lattice of bricks is rows
2 to 19, and the paddle is in row 24. A moving thing has a weight of 1, shared among the four cells
whose middles surround it: the nearer, the more. Its velocity is shared in the same way. Where
things share a cell, their numbers are added and clipped.

{part_table(planes.CORE_PARTS + planes.EXTRA_PARTS)}

The rows of `status`, from the top: {", ".join(f"`{name}`" for name in planes.STATUS)}.

With `reward="score"`, a plane follows: {further_parts(planes.PAY_PARTS)}. The row `next_life` has
the points to the next life / {rules.EXTRA_LIFE_EVERY}; with other rewards it is 0.

### `rgb`

Pictures as `render` shows them, `[stack * channels, height, width]`, or with `channels="last"`
`[height, width, stack * channels]`. At a reset the first picture fills the stack.

Pictures with less than 8 pixels per brick width (84 × 84, say) have no score line. The field's
lowest two rows of cells, below the paddle, show the status instead. A unit is half a brick wide and
as high as a brick: at 84 × 84, 3 × 3 pixels, and the units begin at row 78 and column 9.
`arkanoid.envs.draw.status.status_layout(height, width)` returns the pixels of each part.

{status_table()}

In such pictures the ball is white, and everything else is darker than 226 of 255.

### `dict`

The pictures as `"rgb"` and the numbers as `"vector"`. `layout` has the layouts under these names.

## Rewards

{rewards}

Each lost life costs `life_penalty`. Nothing is paid for touching the ball or for staying alive.

A round is cleared when its last breakable brick is broken and the boss, if there is one, is beaten.
It is also cleared when the paddle leaves through the gate that the capsule *break* opens:
`'progress'` and `'sparse'` pay 1 for it, however many bricks still stand.

## Points

- Coloured bricks: [{rules.COLOUR_POINTS[0]} to {rules.COLOUR_POINTS[-1]}](levels.md#level-files).
- Silver: {rules.SILVER_POINTS} times the round's number, when it breaks.
- A caught capsule: {rules.CAPSULE_POINTS:,}. A destroyed enemy: {rules.ENEMY_POINTS}.
- Each hit on the boss: {rules.BOSS_POINTS:,}. The way through the gate: {rules.BREAK_POINTS:,}.

{rules.EXTRA_LIFE_FIRST:,} points and every multiple of {rules.EXTRA_LIFE_EVERY:,} bring a life.

## Starting State

All bricks of the first round stand, and the ball lies on the middle of the paddle. Fire serves it;
after {rules.SERVE_TICKS} ticks it serves itself.

`reset(seed=..., options=...)` determines everything that follows; with a seed, the game forgets the
options of earlier resets. A seed is an integer from 0 to 2^64 - 1. In a vector environment an
integer, at most 2^64 - `num_envs`, gives game `i` the seed `seed + i`; a list gives each game its
own. A reset without a seed continues the random numbers. The options are:

{meanings("option", START_OPTIONS)}

An option stays in force for later episodes until a reset changes it or has a seed; None returns to
the configuration.

A vector environment's `set_start(world, options)` says how the next games of a world begin; its
present game goes on.

## Episode End

- *Terminated*: the last life is lost.
- *Truncated*: after `max_decisions` decisions (`info["truncation"]` is {DECISION_LIMIT}).

A cleared round does not end an episode. With [`episodic_life=True`](#arguments) each lost life
does; the game is over when `info["lives"]` is 0 or the episode was truncated.

{rules.IDLE_TICKS:,} ticks without damage to a brick or the boss cost a life: all balls in play are
gone. Each serve and each damage start this clock anew. Observations show it, and that of
`max_decisions`.

After a cut, training should count the value of the last observation, as `arkanoid train` does.
Otherwise it would pay to keep the lives until `max_decisions`. If `life_penalty` exceeds what a
life earns, extra lives are a loss.

Before the first reset, a step, a frame or masks raise `gymnasium.error.ResetNeeded`. So does a step
after an episode's end, unless the vector environment resets by itself (`autoreset_mode`).

Where Gymnasium's own `TimeLimit` truncates (`gym.make(..., max_episode_steps=n)`),
`info["truncation"]` is 0; `max_decisions=n` does the same and says so. `env.spec.max_episode_steps`
is `max_decisions`.

## Information

`info` has these keys; in a vector environment they hold arrays, with masks:

{meanings("key", INFO_MEANINGS)}

## Arguments

Keywords of `gym.make` and `gym.make_vec`, and keys of the table `[env]` of an experiment:

{keyword_table()}

The vector environment also takes:

{table(("keyword", "default", "meaning"), vector_keywords)}

An environment belongs to one thread at a time: `step`, `reset`, `snapshot`, `restore` and `spread`
raise a RuntimeError while another thread is in one of them. A forked process may go on with its
copy.

## Methods

{meanings("method", METHODS)}

## Version History

- v0: the first version.
"""


def main() -> None:
    """Write the page, or write it to another path."""
    path = Path(sys.argv[1]) if len(sys.argv) > 1 else PAGE
    path.write_text(page(), encoding="utf-8")
    print(f"{path}: arkanoid {arkanoid.__version__}")


if __name__ == "__main__":
    main()
