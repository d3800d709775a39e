"""Generated levels: as asked for, all different, and always clearable."""

import hashlib
from typing import Any

import numpy as np
import pytest
from arkanoid.envs.levels import Level, generate_level
from arkanoid.envs.levels.generator import (
    FIRST_TEST_SEED,
    MAX_SEED,
    SYMMETRIES,
    TRAIN_SEEDS,
    Recipe,
    lay_level,
    lay_recipe,
    make_recipe,
)
from arkanoid.envs.levels.motifs import MOTIF_COUNT, MOTIFS
from arkanoid.envs.levels.noise import noise, noise_key
from arkanoid.envs.rules import GOLD, SILVER
from helpers.processes import COMPILED, INTERPRETED, run_program
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray
from scipy import ndimage

PROPERTY = settings(deadline=None, max_examples=200)
DIFFICULTIES = (0.0, 0.25, 0.5, 0.75, 1.0)
# The most cells that hold copies of one brick.
COPIES = {"none": 1, "mirror": 2, "turn": 2, "both": 4}

SEEDS = st.integers(0, MAX_SEED)
PARTS = st.fixed_dictionaries(
    {
        "motif": st.sampled_from(sorted(MOTIFS)),
        "rows": st.integers(4, 12),
        "density": st.floats(0.35, 0.9),
        "symmetry": st.sampled_from(sorted(SYMMETRIES)),
        "silver": st.floats(0.0, 0.3),
        "gold": st.floats(0.0, 0.15),
    }
)


def levels_of(seeds: range, difficulty: float) -> NDArray[np.uint8]:
    """The levels of seeds, uint8 [n, 18, 11]."""
    levels = np.zeros((len(seeds), 198), np.uint8)
    for level, seed in zip(levels, seeds, strict=True):
        lay_level(level, seed, difficulty)
    return levels.reshape(-1, 18, 11)


def recipes_of(seeds: range, difficulty: float) -> dict[str, NDArray[Any]]:
    """The recipes of seeds, one array [n] for each part."""
    recipes = [make_recipe(seed, difficulty) for seed in seeds]
    return {
        name: np.array([recipe[i] for recipe in recipes]) for i, name in enumerate(Recipe._fields)
    }


def cropped(level: Level) -> NDArray[np.uint8]:
    """The rows from the first to the last that hold bricks."""
    used = np.flatnonzero(level.kinds.any(axis=1))
    return level.kinds[used[0] : used[-1] + 1]


@pytest.mark.parametrize("difficulty", DIFFICULTIES)
@pytest.mark.parametrize("first", [TRAIN_SEEDS.start, FIRST_TEST_SEED], ids=["train", "test"])
def test_every_level_can_be_cleared(first: int, difficulty: float) -> None:
    """All training seeds, and as many test seeds, by SciPy's labelling of connected regions.

    The space above and below the bricks is open. A ball comes from below, and not round corners.
    """
    levels = levels_of(range(first, first + 10_000), difficulty)
    free = np.pad(levels != GOLD, ((0, 0), (1, 1), (0, 0)), constant_values=True)
    side_by_side = np.zeros((3, 3, 3), np.bool_)
    side_by_side[1] = ndimage.generate_binary_structure(2, 1)
    labels, _ = ndimage.label(free, side_by_side)
    reached = (labels == labels[:, -1:, :1])[:, 1:-1]
    breakable = (levels > 0) & (levels != GOLD)
    assert (breakable.sum(axis=(1, 2)) >= 10).all()
    assert not (breakable & ~reached).any()
    assert levels.max() <= GOLD


@pytest.mark.parametrize("difficulty", DIFFICULTIES)
def test_parts_stay_within_their_ranges(difficulty: float) -> None:
    recipes = recipes_of(TRAIN_SEEDS, difficulty)
    assert recipes["rows"].min() >= 4
    assert recipes["rows"].max() <= 12
    assert recipes["density"].min() >= 0.35
    assert recipes["density"].max() <= 0.9
    assert recipes["silver"].min() >= 0.0
    assert recipes["silver"].max() <= 0.3
    assert recipes["gold"].min() >= 0.0
    assert recipes["gold"].max() <= 0.15
    for part, count in (("motif", MOTIF_COUNT), ("symmetry", len(SYMMETRIES))):
        assert set(recipes[part]) == set(range(count))
    # All motifs are equally frequent: with 10 000 draws one sigma is 40.
    assert np.abs(np.bincount(recipes["motif"]) - 2000).max() < 200


def test_difficulty_sweeps_all_parts_together() -> None:
    """From a few rows without metal to a wall with much metal; from order to disorder."""
    means = []
    for difficulty in DIFFICULTIES:
        levels = levels_of(range(2000), difficulty)
        recipes = recipes_of(range(2000), difficulty)
        bricks = (levels > 0).sum()
        means.append(
            [
                recipes["rows"].mean(),
                bricks / 2000,
                (levels == SILVER).sum() / bricks,
                (levels == GOLD).sum() / bricks,
                (recipes["symmetry"] == 0).mean(),
            ]
        )
    assert (np.diff(means, axis=0) >= 0.0).all()
    assert (np.diff(means, axis=0)[1:] > 0.0).all()
    rows, _, silver, gold, _ = np.transpose(means)
    assert rows[0] < 5.0
    assert rows[-1] > 11.0
    assert silver[0] < 0.005
    assert silver[-1] > 0.25
    assert gold[0] == 0.0
    assert gold[-1] > 0.1


def test_difficulty_is_clipped_to_its_range() -> None:
    assert (levels_of(range(50), -3.0) == levels_of(range(50), 0.0)).all()
    assert (levels_of(range(50), 7.0) == levels_of(range(50), 1.0)).all()


def test_levels_differ() -> None:
    """Easy levels have a few rows of one or two colours: there some pairs must be equal."""
    for difficulty, least in ((0.0, 0.98), (0.25, 0.999), (0.5, 1.0), (1.0, 1.0)):
        levels = levels_of(TRAIN_SEEDS, difficulty).reshape(-1, 198)
        assert len(np.unique(levels, axis=0)) >= least * len(levels)


@pytest.mark.parametrize("difficulty", [0.5, 0.75, 1.0])
def test_no_test_level_is_among_the_training_levels(difficulty: float) -> None:
    train = levels_of(TRAIN_SEEDS, difficulty).reshape(-1, 198)
    test = levels_of(range(FIRST_TEST_SEED, FIRST_TEST_SEED + 10_000), difficulty).reshape(-1, 198)
    assert len(np.unique(np.concatenate([train, test]), axis=0)) == 20_000
    assert TRAIN_SEEDS.stop <= FIRST_TEST_SEED


@PROPERTY
@given(SEEDS, PARTS)
def test_levels_are_as_asked_for(seed: int, parts: dict[str, Any]) -> None:
    level = generate_level(seed, **parts)
    copies = COPIES[parts["symmetry"]]
    bricks = int((level.kinds > 0).sum())
    # A brick comes with its copies: the number of bricks is the nearest possible one.
    assert abs(bricks - int(parts["density"] * parts["rows"] * 11 + 0.5)) <= copies // 2
    silver = int(parts["silver"] * bricks)
    assert 0 <= silver - (level.kinds == SILVER).sum() < copies
    assert (level.kinds == GOLD).sum() <= parts["gold"] * bricks
    assert len(cropped(level)) <= parts["rows"]
    assert not level.kinds[0].any()
    assert not level.kinds[16:].any()


@PROPERTY
@given(SEEDS, PARTS)
def test_levels_have_the_symmetry_asked_for(seed: int, parts: dict[str, Any]) -> None:
    """This includes metal, and the gaps that were opened in it."""
    bricks = cropped(generate_level(seed, **parts))
    if parts["symmetry"] in ("mirror", "both"):
        assert (bricks == bricks[:, ::-1]).all()
    if parts["symmetry"] in ("turn", "both"):
        assert (bricks == bricks[::-1, ::-1]).all()


def test_without_symmetry_there_is_none() -> None:
    levels = [generate_level(seed, symmetry="none") for seed in range(300)]
    symmetric = [(level.kinds == level.kinds[:, ::-1]).all() for level in levels]
    assert np.mean(symmetric) < 0.03


@PROPERTY
@given(SEEDS, PARTS, st.floats(0.0, 1.0))
def test_fixing_one_part_changes_no_other(
    seed: int, parts: dict[str, Any], difficulty: float
) -> None:
    own = make_recipe(seed, difficulty)
    names = {"motif": list(MOTIFS), "symmetry": list(SYMMETRIES)}
    named = {
        part: names[part][value] if part in names else value
        for part, value in own._asdict().items()
    }
    level = generate_level(seed, difficulty=difficulty)
    for part, value in named.items():
        same = generate_level(seed, difficulty=difficulty, **{part: value})
        assert (same.kinds == level.kinds).all()
    # Metal replaces other bricks.
    plain = generate_level(seed, **(parts | {"silver": 0.0, "gold": 0.0})).kinds
    metallic = generate_level(seed, **parts).kinds
    assert ((plain > 0) == (metallic > 0)).all()
    coloured = (metallic > 0) & (metallic < SILVER)
    assert (plain[coloured] == metallic[coloured]).all()


@PROPERTY
@given(SEEDS, st.floats(0.0, 1.0))
def test_games_play_the_same_level(seed: int, difficulty: float) -> None:
    kinds = np.full(198, 7, np.uint8)  # what was there before does not matter
    lay_level(kinds, seed, difficulty)
    assert (generate_level(seed, difficulty=difficulty).kinds.ravel() == kinds).all()


@PROPERTY
@given(SEEDS, PARTS)
def test_motifs_have_their_own_looks(seed: int, parts: dict[str, Any]) -> None:
    levels = {generate_level(seed, **(parts | {"motif": m})).kinds.tobytes() for m in MOTIFS}
    assert len(levels) >= 4


def test_stripes_may_be_vertical_and_rings_closed() -> None:
    """Two known looks: whole columns of one colour, and rings around empty rings."""
    vertical = closed = 0
    for seed in range(200):
        stripes = cropped(generate_level(seed, "stripes", 8, 0.6, "mirror", 0.0, 0.0))
        vertical += (stripes.all(axis=0) & (stripes == stripes[0]).all(axis=0)).sum() >= 4
        rings = cropped(generate_level(seed, "rings", 9, 0.6, "both", 0.0, 0.0)) > 0
        filled = ndimage.binary_fill_holes(rings)
        closed += (filled & ~rings).sum() >= 4
    assert vertical >= 10
    assert closed >= 10


def test_a_level_has_a_name_and_its_comment_is_its_recipe() -> None:
    level = generate_level(42, "rings", 8, 0.6, "both", 0.1, 0.05)
    assert level.name == "Rings 42"
    assert level.comment == (
        "Generated: 8 rows, density 0.60, symmetry both, silver 0.10, gold 0.05."
    )
    assert not level.boss


@pytest.mark.parametrize(
    ("arguments", "error", "message"),
    [
        ({"seed": -1}, ValueError, "seed must be between 0 and 9223372036854775807; got -1"),
        ({"seed": 2**63}, ValueError, "seed must be between 0 and"),
        ({"seed": 1.0}, TypeError, "seed must be an integer; got 1.0"),
        ({"seed": True}, TypeError, "seed must be an integer; got True"),
        ({"motif": "spirals"}, ValueError, "motif must be one of 'wave', 'rings', .*'spirals'"),
        ({"symmetry": "left"}, ValueError, "symmetry must be one of 'none', 'mirror', 'turn'"),
        ({"rows": 3}, ValueError, "rows must be between 4 and 12; got 3"),
        ({"rows": 13}, ValueError, "rows must be between 4 and 12; got 13"),
        ({"rows": 8.5}, TypeError, "rows must be an integer; got 8.5"),
        ({"density": 0.3}, ValueError, "density must be between 0.35 and 0.9; got 0.3"),
        ({"density": float("nan")}, ValueError, "density must be between 0.35 and 0.9; got nan"),
        ({"silver": 0.31}, ValueError, "silver must be between 0 and 0.3; got 0.31"),
        ({"gold": 0.2}, ValueError, "gold must be between 0 and 0.15; got 0.2"),
        ({"gold": "much"}, TypeError, "gold must be a number; got 'much'"),
        ({"difficulty": 1.5}, ValueError, "difficulty must be between 0 and 1; got 1.5"),
    ],
)
def test_illegal_parts_are_refused(
    arguments: dict[str, Any], error: type[Exception], message: str
) -> None:
    with pytest.raises(error, match=message):
        generate_level(**({"seed": 1} | arguments))


def test_numpy_numbers_are_numbers() -> None:
    level = generate_level(np.int64(3), rows=np.int32(6), density=np.float32(0.5))
    assert (level.kinds == generate_level(3, rows=6, density=0.5).kinds).all()


HASH = """
import hashlib, sys
import numpy as np
from arkanoid.envs.levels.generator import lay_level

digest = hashlib.sha256()
kinds = np.zeros(198, np.uint8)
for seed in [*range(int(sys.argv[1])), 1_000_000, 2**63 - 1]:
    for difficulty in (0.0, 0.4, 0.7, 1.0):
        lay_level(kinds, seed, difficulty)
        digest.update(kinds.tobytes())
print(digest.hexdigest())
"""


def test_levels_are_the_same_everywhere() -> None:
    """If this hash changes, all levels change, and old results on them are void."""
    golden = "9559d239c651d9cc0bb804e46ae9ecde37e7eca49994fe5fa71c4f00ebc3aa3d"
    for mode in (COMPILED, INTERPRETED):
        assert run_program(HASH, "100", changes=mode).stdout.strip() == golden


def noise_table(seeds: int, indices: int) -> NDArray[np.float64]:
    keys = [np.uint64(noise_key(seed)) for seed in range(seeds)]
    return np.array([[noise(key, index) for index in range(indices)] for key in keys])


def test_noise_is_even_and_without_pattern() -> None:
    """Uniform; neighbouring seeds and neighbouring indices are uncorrelated."""
    table = noise_table(500, 64)
    assert table.min() >= 0.0
    assert table.max() < 1.0
    counts, _ = np.histogram(table, 20, (0.0, 1.0))
    expected = table.size / 20
    # Chi-squared with 19 degrees of freedom exceeds 43.8 once in a thousand times.
    assert ((counts - expected) ** 2 / expected).sum() < 43.8
    bound = 4.0 / np.sqrt(table.size)
    for one, other in ((table[1:], table[:-1]), (table[:, 1:], table[:, :-1])):
        assert abs(np.corrcoef(one.ravel(), other.ravel())[0, 1]) < bound


def test_noise_differs_from_seed_to_seed_at_every_index() -> None:
    """At index 0, the motif's, noise was 0 for every seed below 2^32: all motifs were waves.

    The key's upper half was the mixed lower half, and the noise at index 0 was their difference.
    """
    means = noise_table(500, 1000).mean(axis=0)
    # One sigma of the mean of 500 uniform numbers is 0.0129; none of 1000 means is five off.
    assert np.abs(means - 0.5).max() < 5 * 0.0129


def test_seeds_have_different_keys() -> None:
    seeds = [*range(20_000), *(2**32 + np.arange(20_000)), *(2**40 * np.arange(1, 1000)), MAX_SEED]
    assert len({int(noise_key(int(seed))) for seed in seeds}) == len(seeds)


def test_a_seed_and_a_recipe_determine_a_level() -> None:
    kinds = np.zeros(198, np.uint8)
    lay_recipe(kinds, 5, Recipe(MOTIFS["wave"], 6, 0.5, SYMMETRIES["mirror"], 0.1, 0.0))
    asked = generate_level(5, "wave", 6, 0.5, "mirror", 0.1, 0.0)
    assert hashlib.sha256(kinds).digest() == hashlib.sha256(asked.kinds.tobytes()).digest()
