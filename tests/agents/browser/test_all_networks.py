"""Agents of other kinds than the packaged ones: what the page shows of them."""

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from arkanoid.agents.browser.agents import BrowserAgent, browser_agent
from arkanoid.agents.browser.page import make_page
from arkanoid.agents.experiment.runs import ModelFile, RunFolder
from arkanoid.agents.learn.training import train
from helpers.browser import DESKTOP, visit, wait_until
from helpers.runs import small

KINDS = {
    "lattice": {"network.features": "lattice", "env.actions": "box"},
    "planes": {"env.observation": "grid", "env.landing": "false"},
    "pictures": {
        "env.observation": "rgb",
        "env.landing": "false",
        "env.size": "48",
        "env.stack": "2",
        "network.features": "planes",
    },
}
# Which parts of the panel say what an agent of the kind sees.
SEEN = {"lattice": ["seen", "planes"], "planes": ["planes"], "pictures": ["pictures"]}


def trained(name: str, folder: Path) -> BrowserAgent:
    settings = {"name": name, "training.timesteps": "512", **KINDS[name]}
    experiment = small(folder, **settings)
    run = RunFolder.create(experiment)
    train(experiment, run, shows_progress=False)
    model = ModelFile.find(str(run.path), False)
    return browser_agent(model, model.experiment([]))


@pytest.fixture(scope="module")
def shown(browser: Any, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Any]:
    """A page with an agent of each kind."""
    folder = tmp_path_factory.mktemp("kinds")
    file = folder / "kinds.html"
    agents = [trained(name, folder) for name in KINDS]
    file.write_text(make_page(agents, opens="watch"), encoding="utf-8")
    with visit(browser, file.as_uri(), **DESKTOP) as page:
        yield page


@pytest.mark.parametrize("name", KINDS)
def test_an_agent_plays_and_says_what_it_sees(shown: Any, name: str) -> None:
    shown.get_by_label(name, exact=True).check()
    wait_until(shown, f"game?.name === '{name} at play' && world.decisions > 20")
    visible = "[...document.querySelectorAll('#panel-watch details')].filter((one) => !one.hidden)"
    assert shown.evaluate(f"{visible}.map(({{ id }}) => id)") == SEEN[name]
    box = shown.locator(f"#{SEEN[name][0]}")
    if box.get_attribute("open") is None:
        box.locator("summary").click()
    wait_until(shown, f"document.querySelector('#{SEEN[name][0]} > div').children.length")
    assert float(shown.locator("#value").text_content()) != 0.0


def test_an_agent_that_commands_velocities(shown: Any) -> None:
    """What it does is shown by direction, and moves the paddle so fast."""
    shown.get_by_label("lattice", exact=True).check()
    wait_until(shown, "game?.name === 'lattice at play' && world.decisions > 8")
    words = shown.locator("#chances > div").all_text_contents()
    assert [word.rstrip("0123456789 %") for word in words] == ["left", "right", "fire"]
    action, moved = shown.evaluate("""() => {
      const { part } = arkanoid;
      const { world } = part.game;
      const [x, most] = [world.paddle_x, part._rules.paddle_speed];
      part.game.step([part._agent.judge().action[0] / 100, 0]);
      return [part._agent.judge().action, (world.paddle_x - x) / most];
    }""")
    assert len(action) == 2
    assert abs(moved) <= 0.01


def test_pictures_are_those_of_the_game(shown: Any) -> None:
    """The newest one is what the page's kernels draw, in each pixel."""
    shown.get_by_label("pictures", exact=True).check()
    wait_until(shown, "game?.name === 'pictures at play' && world.decisions > 8")
    assert shown.evaluate("""() => {
      const { game, _agent: agent } = arkanoid.part;
      agent.judge();
      const drawn = game.draw(48, 48, 3).slice();
      const { pictures } = agent;
      return drawn.every((value, place) => pictures[drawn.length + place] === value);
    }""")


def test_pictures_are_shown_as_they_are_seen(shown: Any) -> None:
    shown.get_by_label("pictures", exact=True).check()
    wait_until(shown, "game?.name === 'pictures at play' && world.decisions > 8")
    assert shown.evaluate("""() => {
      const { part } = arkanoid;
      document.getElementById("pictures").open = true;
      part._see(true);
      const { pictures } = part._agent;
      const canvases = [...document.querySelectorAll("#pictures canvas")];
      const drawn = canvases.flatMap((canvas) => {
        const { data } = canvas.getContext("2d").getImageData(0, 0, 48, 48);
        return [...data].filter((_, place) => place % 4 < 3);
      });
      return drawn.length === pictures.length
        && drawn.every((value, place) => value === pictures[place]);
    }""")
