"""`arkanoid dataset ID PLAYER ...`: writes games as a Minari data set, to learn from."""

import argparse
from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING, Any

from ...envs.checks import counted
from ...envs.config import SEEN
from ..experiment.datasets import Episode, Written, check_new, write_dataset
from ..experiment.errors import SettingsError
from ..experiment.packaged import find_agent, packaged_agents
from ..experiment.seeds import Purpose, spread_seeds
from .arguments import LEVELS, PLAYED, add_trust, check_settings, whole
from .train import DEFAULT_CONFIG

if TYPE_CHECKING:
    from ...envs.batch.replays import Replay
    from ..experiment.settings import Experiment

REPLAY = ".replay"
DEFAULT_GAMES = 20
DEFAULT_DECISIONS = 2000
_LOOK = "env."

_EPILOG = """\
PLAYER is a baseline (planner, ball-follower, ...), a packaged agent (lite, full), a run or model
file, or *.replay files.

  arkanoid dataset arkanoid/planner-v0 planner --config lite --level named
  arkanoid dataset arkanoid/lite-v0 runs/lite-seed0 --env.observation rgb
  arkanoid dataset arkanoid/human-v0 monday.replay tuesday.replay
  arkanoid train lite --imitation.dataset arkanoid/planner-v0

--key value changes the game of a baseline; of models and replays only how their games are seen."""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the command's arguments."""
    parser.usage = "%(prog)s ID PLAYER... [options] [--key value ...]"
    parser.add_argument("id", metavar="ID", help="of the new data set, such as arkanoid/mine-v0")
    parser.add_argument("players", metavar="PLAYER", nargs="+", help="who plays, see below")
    parser.add_argument(
        "--config", help=f"the game that a baseline plays: as for train; default: {DEFAULT_CONFIG}"
    )
    parser.add_argument("--level", help=f"where games begin: {LEVELS}")
    parser.add_argument(
        "--games",
        type=whole(1),
        help=f"how many, on each level; default: {DEFAULT_GAMES}",
    )
    parser.add_argument(
        "--decisions",
        type=whole(1),
        help=f"after so many a game is truncated; default: {DEFAULT_DECISIONS}",
    )
    parser.add_argument(
        "--games-seed",
        type=whole(0),
        metavar="N",
        help="of the games, which no training, validation or evaluation plays; default: 0",
    )
    add_trust(parser)
    parser.epilog = _EPILOG


def run(arguments: argparse.Namespace, overrides: list[tuple[str, str]]) -> int:
    """Play, write and say what was written; return the exit status."""
    from ..experiment.settings import BASELINES

    check_new(arguments.id)
    players = arguments.players
    if all(player.endswith(REPLAY) for player in players):
        written = _write_replays(arguments, overrides)
    elif len(players) > 1:
        raise SettingsError(
            "several players: a data set is of one baseline or model, or of replays"
        )
    elif players[0] in BASELINES:
        written = _write_baseline(arguments, overrides)
    elif not find_agent(players[0]).exists():
        agents = ", ".join(packaged_agents())
        raise SettingsError(
            f"{players[0]}: neither a baseline ({', '.join(BASELINES)}) nor a packaged agent "
            f"({agents}), a file or a folder"
        )
    else:
        written = _write_model(arguments, overrides)
    print(
        f"data set {arguments.id}: {counted(written.episodes, 'game')}, "
        f"{counted(written.decisions, 'decision')}, mean return {written.mean_return:.3f}\n"
        f"files    {written.folder}"
    )
    return 0


def _write_baseline(arguments: argparse.Namespace, overrides: list[tuple[str, str]]) -> Written:
    from ..experiment.settings import load_experiment
    from ..measure.baselines import make_baseline

    (name,) = arguments.players
    check_settings(overrides, ("env_id", "env"))
    experiment = load_experiment(arguments.config or DEFAULT_CONFIG, overrides)
    # Baselines understand one observation only, whatever the data set shows.
    played = experiment.config.of_the_game()
    return _write_games(
        arguments,
        experiment,
        played,
        lambda worlds, seed: make_baseline(name, worlds, seed),
        name,
    )


def _write_model(arguments: argparse.Namespace, overrides: list[tuple[str, str]]) -> Written:
    from ..experiment.runs import ModelFile

    if arguments.config is not None:
        raise SettingsError("--config is for baselines: a model plays the game of its run")
    check_settings(overrides, PLAYED)
    model = ModelFile.find(arguments.players[0], arguments.trust)
    others = [(key, text) for key, text in overrides if not _is_look(key)]
    experiment = model.experiment(others)
    looks = [(key, text) for key, text in overrides if _is_look(key)]
    # The network need not suit what the data set shows.
    any_network = [("network.features", "auto")] if looks else []
    # Nor has every observation landings.
    other_view = any(key == "env.observation" for key, _ in looks)
    plain = [("env.landing", "false")] if other_view else []
    shown = model.run.experiment([*others, *plain, *looks, *any_network])
    from ..learn.model import load_policy

    policy = load_policy(model, experiment)
    return _write_games(
        arguments, shown, experiment.game, lambda worlds, seed: policy, model.describe()["run"]
    )


def _write_games(
    arguments: argparse.Namespace,
    experiment: "Experiment",
    played: Any,
    make_policy: Callable[[Any, int], Any],
    player: str,
) -> Written:
    """Let a policy play, and write its games as the experiment observes them."""
    import gymnasium as gym

    from ..measure.recording import record_games
    from ..measure.suites import WHOLE_GAMES, EpisodeStart, find_starts

    starts: tuple[EpisodeStart, ...] = (WHOLE_GAMES,)
    if arguments.level is not None:
        starts = find_starts(experiment, arguments.level)
    episodes = record_games(
        experiment,
        make_policy,
        played,
        experiment.game,
        spread_seeds(arguments.games_seed or 0, Purpose.DATASET, arguments.games or DEFAULT_GAMES),
        arguments.decisions or DEFAULT_DECISIONS,
        starts,
    )
    env = gym.make(experiment.env_id, **experiment.game.plain())
    return write_dataset(arguments.id, episodes, env, player, f"{player} plays Arkanoid")


def _write_replays(arguments: argparse.Namespace, overrides: list[tuple[str, str]]) -> Written:
    # The game imports Numba, which is slow.
    import gymnasium as gym

    from ...envs.batch.playback import ReplayDivergedError
    from ...envs.batch.replays import Replay
    from ..experiment.reading import parse_toml_value

    for name in ("config", "level", "games", "decisions", "games_seed"):
        if getattr(arguments, name) is not None:
            option = f"--{name.replace('_', '-')}"
            raise SettingsError(f"{option} changes nothing: replays are games that were played")
    keywords = {}
    for key, text in overrides:
        if not key.startswith(_LOOK):
            raise SettingsError(f"--{key}: replays have no settings but how their games are seen")
        keywords[key.removeprefix(_LOOK)] = parse_toml_value(text)
    try:
        replays = [Replay.load(player) for player in arguments.players]
        game = replays[0].config.of_the_game()
        for replay, path in zip(replays, arguments.players, strict=True):
            if replay.config.of_the_game() != game:
                raise SettingsError(f"{path}: another game than that of {arguments.players[0]}")
        env = gym.make("arkanoid:Arkanoid-v0", **{**game.plain(), **keywords})
        episodes = _replayed(replays, keywords)
        return write_dataset(arguments.id, episodes, env, "human", "replays of Arkanoid")
    except OSError as error:
        raise SettingsError(f"{error.filename}: {error.strerror}") from None
    except (TypeError, ValueError, ReplayDivergedError) as error:
        raise SettingsError(str(error)) from None


def _replayed(replays: "list[Replay]", keywords: dict[str, Any]) -> Iterator[Episode]:
    import numpy as np

    from ...envs.batch.transitions import replay_transitions

    for replay in replays:
        steps: list[Any] = []
        last = replay.result.decisions
        for decision, step in enumerate(replay_transitions(replay, **keywords), 1):
            steps.append(step)
            if step.terminated or step.truncated or decision == last:
                yield Episode(
                    np.stack([steps[0].observation, *(one.next_observation for one in steps)]),
                    np.stack([one.action for one in steps]),
                    np.array([one.reward for one in steps]),
                    step.terminated,
                )
                steps = []


def _is_look(key: str) -> bool:
    return key.startswith(_LOOK) and key.removeprefix(_LOOK) in SEEN
