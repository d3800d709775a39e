"""Writes `environment.md` from the code: `python docs/environment_page.py`.

Spaces are asked for, keywords and what they mean are read from `Config`, the parts of observations
from the tables of their slices, comments included. So the page cannot say what the code does not.
"""

import dataclasses
import inspect
import re
import sys
import textwrap
from collections.abc import Iterator
from pathlib import Path
from types import ModuleType
from typing import Any

import arkanoid
import gymnasium as gym
from arkanoid.envs import rules, state
from arkanoid.envs.config import Config
from arkanoid.envs.levels import starts
from arkanoid.envs.observe import planes, vector

PAGE = Path(__file__).with_name("environment.md")
OBSERVATIONS: tuple[dict[str, Any], ...] = (
    {"observation": "vector"},
    {"observation": "grid"},
    {"observation": "rgb"},
    {"observation": "rgb", "grey": True, "stack": 4},
)
ACTIONS = ("discrete6", "discrete3", "box")


def space_of(name: str, part: str, **keywords: Any) -> str:
    """Return how an environment describes a space."""
    env = gym.make(name, **keywords)
    described = str(getattr(env, part))
    env.close()
    return described


def keyword_meanings() -> dict[str, str]:
    """Return what each keyword means, as `Config` says."""
    text = inspect.getdoc(Config) or ""
    arguments = textwrap.dedent(text.partition("Args:\n")[2].partition("\n\n")[0])
    found = re.findall(r"^(\w+): (.*?)(?=^\w|\Z)", arguments, flags=re.MULTILINE | re.DOTALL)
    return {name: " ".join(meaning.split()).replace("``", "`") for name, meaning in found}


def part_meanings(module: ModuleType) -> dict[str, str]:
    """Return the comments beside the names in a module's tables of slices."""
    meanings: dict[str, str] = {}
    name = ""
    for line in inspect.getsource(module).splitlines():
        entry = re.match(r'\s+"(\w+)": [^#]+,(?:  # (.*))?$', line)
        more = re.match(r"\s+# (.*)$", line)
        if entry:
            name = entry[1]
            meanings[name] = entry[2] or ""
        elif more and name:
            meanings[name] += " " + more[1]
        else:
            name = ""
    return meanings


def outcome_meanings() -> dict[str, str]:
    """Return the comments beside the fields of `Outcome`, and of `World` where it has none."""
    meanings: dict[str, str] = {}
    for line in inspect.getsource(state).splitlines():
        entry = re.match(r'\s+\("(\w+)", np\.\w+\),(?:  # (.*))?$', line)
        if entry and entry[2]:
            meanings.setdefault(entry[1], entry[2])
    return meanings


def table(*rows: tuple[str, ...]) -> Iterator[str]:
    """Yield a table's lines; the first row is its head."""
    head, *body = rows
    yield f"| {' | '.join(head)} |"
    yield "|" + " --- |" * len(head)
    for row in body:
        yield f"| {' | '.join(cell.replace('|', chr(92) + '|') for cell in row)} |"


def default_of(field: "dataclasses.Field[Any]") -> str:
    return f"`{field.default!r}`"


def observation_table(module: ModuleType, layout: dict[str, slice]) -> Iterator[str]:
    """Yield the parts of an observation: names, slices, meanings."""
    meanings = part_meanings(module)
    rows = [("part", "slice", "what it is")]
    for name, part in layout.items():
        meaning = meanings.get(name) or OBVIOUS.get(name.rpartition("_")[2], "1 where it is")
        rows.append((f"`{name}`", f"{part.start}:{part.stop}", meaning))
    yield from table(*rows)


def layout_of(**keywords: Any) -> dict[str, slice]:
    """Return the named slices of the full game's observation."""
    env = gym.make("Arkanoid-v0", **keywords)
    layout: dict[str, slice] = env.unwrapped.layout  # type: ignore[attr-defined]
    env.close()
    return layout


def paragraphs(module: ModuleType) -> str:
    """Return a module's description without its first line, as Markdown."""
    _, _, text = (inspect.getdoc(module) or "").partition("\n\n")
    return text.replace("``", "`")


def page() -> str:
    """Return the page."""
    lines = [
        "<!-- Written by environment_page.py from the code. -->",
        "",
        "# The environments",
        "",
        *table(
            ("id", "what it is"),
            ("`Arkanoid-v0`", "the full game: power-ups, several balls, enemies, a boss"),
            ("`ArkanoidLite-v0`", "the game without capsules and enemies, three actions"),
        ),
        "",
        "```python",
        "import gymnasium as gym",
        "",
        'env = gym.make("arkanoid:Arkanoid-v0")',
        "worlds = gym.make_vec(",
        '    "arkanoid:Arkanoid-v0", num_envs=1024, vectorization_mode="vector_entry_point"',
        ")",
        "```",
        "",
        "All that follows holds for both, alone and as a vector environment.",
        "",
        "## Description",
        "",
        DESCRIPTION,
        "",
        "## Action Space",
        "",
        *table(
            ("`actions`", "space", "meaning"),
            *(
                (f"`{name!r}`", f"`{space_of('Arkanoid-v0', 'action_space', actions=name)}`", text)
                for name, text in zip(ACTIONS, ACTION_MEANINGS, strict=True)
            ),
        ),
        "",
        "## Observation Space",
        "",
        *table(
            ("keywords", "`Arkanoid-v0`", "`ArkanoidLite-v0`"),
            *(
                (
                    f"`{', '.join(f'{key}={value!r}' for key, value in keywords.items())}`",
                    f"`{space_of('Arkanoid-v0', 'observation_space', **keywords)}`",
                    f"`{space_of('ArkanoidLite-v0', 'observation_space', **keywords)}`",
                )
                for keywords in OBSERVATIONS
            ),
        ),
        "",
        "The parts have names. `env.unwrapped.layout` maps them to slices of observations' first",
        'axis, as in `observation[env.unwrapped.layout["paddle"]]`.',
        "",
        "### `vector`",
        "",
        paragraphs(vector),
        "",
        *observation_table(vector, layout_of()),
        "",
        "### `grid`",
        "",
        paragraphs(planes),
        "",
        *observation_table(planes, layout_of(observation="grid")),
        "",
        "### `rgb`",
        "",
        RGB,
        "",
        "## Rewards",
        "",
        REWARDS,
        "",
        "## Starting State",
        "",
        STARTING_STATE,
        "",
        paragraphs(starts),
        "",
        "## Episode End",
        "",
        EPISODE_END,
        "",
        "## Information",
        "",
        "`info` holds these, in a vector environment as arrays with masks:",
        "",
        *table(
            ("key", "meaning"),
            *(
                (f"`{key}`", INFO.get(key) or outcome_meanings().get(field) or COUNTED)
                for key, field in state.INFO_FIELDS.items()
            ),
        ),
        "",
        "## Arguments",
        "",
        "Keywords of `gym.make` and `gym.make_vec`, and keys of a configuration's table `[env]`:",
        "",
        *table(
            ("keyword", "default", "meaning"),
            *(
                (f"`{field.name}`", default_of(field), keyword_meanings()[field.name])
                for field in dataclasses.fields(Config)
            ),
            ("`render_mode`", "`None`", "`'rgb_array'` (no display is needed), `'human'`, or None"),
        ),
        "",
        "The vector environment takes these, too:",
        "",
        *table(("keyword", "default", "meaning"), *VECTOR_ARGUMENTS),
        "",
        "## Version History",
        "",
        "- v0: the first.",
    ]
    return "\n".join(lines) + "\n"


# By the last word of a part's name, what needs no comment in the code.
OBVIOUS = {
    "x": "place",
    "y": "place",
    "vx": "velocity",
    "vy": "velocity, on the same scale",
    "play": "1: there is one",
    "stage": "its number / 7",
}

DESCRIPTION = f"""\
A game in the manner of the arcade's of 1986, with levels and pictures of its own. The player moves
a paddle at the bottom of a field of {rules.FIELD_WIDTH:g} × {rules.FIELD_HEIGHT:g} brick widths,
and keeps a ball from falling out; the ball breaks bricks. Where it lands on the paddle decides
where it flies. Some bricks hide capsules, which give the paddle powers: to catch, to grow, to
shoot, to slow the ball down, to split it into three, to leave through a gate, to live once more.
Enemies come in through the ceiling and get in the ball's way. After twelve rounds there is a boss,
and then rounds from a generator without end, harder and harder. [Levels](levels.md) has its page.

A tick is 1/{rules.TICKS_PER_SECOND} s. Everything that touches does so at its exact time
([the engine](engine.md)): a ball may be arbitrarily fast and passes through nothing. For the same
seed and actions the game is the same bit for bit: alone or in a batch, on any number of threads."""

ACTION_MEANINGS = (
    "0 nothing, 1 left, 2 right; 3, 4, 5 the same with fire",
    "0 nothing, 1 left, 2 right; balls leave the paddle and the laser shoots by themselves",
    "velocity as a part of the paddle's speed, and fire if positive",
)

RGB = """\
Pictures, uint8, channels first: `[stack * channels, height, width]`. They are what `render` shows,
drawn by compiled kernels without a display. `size`, `grey` and `stack` say how large, whether in
brightness only, and how many of the latest pictures; at a reset the first one fills the stack."""

REWARDS = """\
- `"progress"` (default): each needed hit pays 1 / needed hits of the round; clearing it pays 1.
- `"score"`: points / 1000.
- `"sparse"`: 1 for clearing a round.

`life_penalty` is taken off for each lost life. Nothing is paid for touching the ball or for staying
alive. A decision of several ticks pays their sum."""

STARTING_STATE = f"""\
All bricks of the first round stand, and the ball lies on the paddle in the middle. It is served by
fire, or by itself after {rules.SERVE_TICKS} ticks, to a side that the seed decides.
`reset(seed=...)` determines all that follows; a reset without a seed goes on with the random
numbers as they are.
`reset(options=...)` says what is played:"""

EPISODE_END = f"""\
- *Terminated*: the last life is lost.
- *Truncated*: after `max_decisions` decisions (`info["truncation"]` is {state.DECISION_LIMIT}),
  or after {rules.IDLE_TICKS:,} ticks without damage to a brick or the boss ({state.IDLE}).
  Both clocks are part of the observation, so that what is cut is foreseeable.

A round that is cleared does not end an episode: the next one begins."""

INFO = {
    "truncation": "why the episode was cut: 0 it was not, 1 decisions, 2 nothing was damaged",
    "lives": "balls left, the present one included",
    "score": "points",
    "round": "number of the round, from 1",
    "hits": "hits of this decision on bricks, and the boss, that need them",
}

COUNTED = "how many in this decision"

VECTOR_ARGUMENTS = (
    ("`num_envs`", "`1`", "how many games"),
    (
        "`autoreset_mode`",
        "`'NextStep'`",
        "Gymnasium's `AutoresetMode` or its name: `NextStep`, `SameStep`, `Disabled`",
    ),
    (
        "`copy`",
        "`True`",
        "whether observations are copies; if not, the next step overwrites them",
    ),
    ("`threads`", "`None`", "how many step the games; None lets their number decide"),
)


def main() -> None:
    """Write the page, or to another path."""
    path = Path(sys.argv[1]) if len(sys.argv) > 1 else PAGE
    path.write_text(page(), encoding="utf-8")
    print(f"{path}: arkanoid {arkanoid.__version__}")


if __name__ == "__main__":
    main()
