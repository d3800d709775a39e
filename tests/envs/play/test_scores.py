"""High scores in the player's file."""

import json
from pathlib import Path

import pytest
from arkanoid.envs.config import Config
from arkanoid.envs.play.scores import MOST_KEPT, Scores, game_name


def test_scores_are_kept_in_their_order_and_found_again(tmp_path: Path) -> None:
    path = tmp_path / "new folder" / "scores.json"
    given = [300, 100, 200, 300, 0]
    places = [Scores(path).add("a", score, 1) for score in given]
    # An equal score comes after the older one; nothing is no score.
    assert places == [0, 1, 1, 1, None]
    assert [entry.score for entry in Scores(path).best("a")] == [300, 300, 200, 100]
    assert Scores(path).best("b") == []


def test_only_the_best_are_kept(tmp_path: Path) -> None:
    scores = Scores(tmp_path / "scores.json")
    for score in range(1, 2 * MOST_KEPT + 1):
        scores.add("a", score, 3)
    assert [entry.score for entry in scores.best("a")] == [*range(20, 10, -1)]
    assert scores.add("a", 10, 1) is None


@pytest.mark.parametrize("content", ["", "{", "[]", '{"a": 1}', '{"a": [[1, 2]]}', "[" * 100_000])
def test_a_broken_file_stays_as_it_is(tmp_path: Path, content: str) -> None:
    """What somebody else wrote there is not ours to throw away."""
    path = tmp_path / "scores.json"
    path.write_text(content)
    scores = Scores(path)
    assert scores.best("a") == []
    with pytest.raises(ValueError, match="holds no scores"):
        scores.add("a", 5, 1)
    assert path.read_text() == content


def test_games_with_other_settings_have_other_names() -> None:
    usual = Config()
    assert game_name(usual, usual, {"level": None}) == "{}"
    names = {
        game_name(config, usual, options)
        for config, options in (
            (usual, {}),
            (Config(lives=5), {}),
            (Config(speed=1.5), {}),
            (Config(enemies=False, capsules=False), {}),
            (usual, {"level": "comb"}),
            (usual, {"level": 6}),
        )
    }
    assert len(names) == 6
    assert {"lives": 5} in [json.loads(name) for name in names]
