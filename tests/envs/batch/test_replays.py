"""Recorded games: small files, and each is played again bit for bit or refused."""

import dataclasses
from pathlib import Path

import numpy as np
import pytest
from arkanoid import __version__
from arkanoid.envs import (
    ArkanoidEnv,
    ArkanoidVectorEnv,
    Replay,
    ReplayDivergedError,
    play_replay,
    replay_frames,
)
from arkanoid.envs.batch import replays
from arkanoid.envs.batch.playback import replay_states
from arkanoid.envs.batch.replays import NOTE_EVERY
from gymnasium.error import ResetNeeded
from helpers.interrupts import interrupted_at
from helpers.processes import INTERPRETED, run_program
from hypothesis import given, settings
from hypothesis import strategies as st

GOLDEN = Path(__file__).with_name("golden.replay")
LIVELY = {"lives": 2, "sticky_action": 0.25, "speed": 2.0, "capsule_rate": 1.0}


def record(decisions=200, seed=0, options=None, **keywords):
    """Return a replay of random play, which may end before that many decisions."""
    env = ArkanoidEnv(**LIVELY | keywords)
    recorder = env.record()
    env.reset(seed=seed, options=options)
    play(env, decisions, seed)
    return recorder.replay()


def play(env, decisions, seed=0):
    env.action_space.seed(seed)
    for _ in range(decisions):
        if env.state["done"]:
            break
        env.step(env.action_space.sample())


def test_the_golden_game_is_played_again_bit_for_bit():
    """On every machine, with every release of these rules.

    If this fails after a change of the rules: raise `RULES_VERSION` in envs/rules.py, and record
    the game anew with ``python tests/envs/batch/golden_replay.py``; the numbers below follow. If
    nothing of the rules was to change, then the change has changed the game.
    """
    result = play_replay(GOLDEN)
    assert (result.decisions, result.score, result.round) == (2781, 44030, 3)
    assert result.terminated
    assert GOLDEN.stat().st_size < 2500


def test_the_golden_game_comes_out_the_same_interpreted():
    program = f"""
import itertools
from arkanoid.envs.batch.playback import replay_states
states = itertools.islice(replay_states({str(GOLDEN)!r}), {NOTE_EVERY} + 2)
print(sum(1 for _ in states))
"""
    done = run_program(program, warnings="default", changes=INTERPRETED)
    assert int(done.stdout) == NOTE_EVERY + 2


@settings(max_examples=40, deadline=None)
@given(
    decisions=st.integers(0, 600),
    seed=st.integers(0, 10**6),
    actions=st.sampled_from(["discrete6", "discrete3", "box"]),
    levels=st.sampled_from(["campaign", "train", "seeds:3-5", "warden", ["spiral", "ripple"]]),
    frame_skip=st.integers(1, 5),
    options=st.sampled_from([None, {"level": "comb"}, {"level": 9}, {"seed": 4, "difficulty": 1}]),
)
def test_any_game_is_played_again_from_its_file(decisions, seed, options, **keywords):
    replay = record(decisions, seed, options, lives=3, **keywords)
    again = Replay.from_bytes(replay.to_bytes())
    assert again.to_bytes() == replay.to_bytes()
    assert again.commands.tobytes() == replay.commands.tobytes()
    assert play_replay(again) == replay.result
    assert len(replay.commands) == replay.result.decisions <= decisions


def test_the_result_is_what_the_player_saw():
    env = ArkanoidEnv(**LIVELY)
    recorder = env.record()
    env.reset(seed=3)
    env.action_space.seed(3)
    total, steps, over = 0.0, 0, False
    while not over:
        _, reward, terminated, truncated, info = env.step(env.action_space.sample())
        total, steps, over = total + reward, steps + 1, terminated or truncated
    result = recorder.replay().result
    assert (result.reward, result.decisions, result.terminated) == (total, steps, terminated)
    assert (result.score, result.lives, result.round) == (info["score"], 0, info["round"])
    assert recorder.finished is recorder.replay()
    with pytest.raises(ResetNeeded):
        env.step(0)
    assert recorder.replay().result == result


@pytest.mark.parametrize("mode", ["NextStep", "SameStep", "Disabled"])
@pytest.mark.parametrize("threads", [1, 3])
def test_one_world_of_a_vector_env_is_recorded_like_a_single_env(mode, threads):
    """Game after game, however the worlds are reset."""
    env = ArkanoidVectorEnv(9, autoreset_mode=mode, threads=threads, **LIVELY | {"lives": 1})
    single = ArkanoidEnv(**LIVELY | {"lives": 1})
    recorder, alone = env.record(5), single.record()
    env.reset(seed=10)
    single.reset(seed=15)
    env.action_space.seed(0)
    games, waits = 0, False
    for _ in range(600):
        actions = env.action_space.sample()
        _, _, terminated, truncated, _ = env.step(actions)
        if waits:  # this step was the reset
            waits = False
            continue
        single.step(actions[5])
        over = terminated | truncated
        if over[5]:
            games += 1
            assert recorder.finished.to_bytes() == alone.finished.to_bytes()
            assert play_replay(recorder.finished) == alone.finished.result
            single.reset()
            waits = mode == "NextStep"
        if mode == "Disabled" and over.any():
            env.reset(options={"reset_mask": over})
    assert games > 3
    assert recorder.replay().to_bytes() == alone.replay().to_bytes() or waits
    env.close()


def test_a_recording_needs_the_beginning_of_a_game():
    env = ArkanoidEnv(**LIVELY)
    never = env.record()
    env.reset(seed=0)
    late_but_in_time = env.record()
    play(env, 20)
    snapshot = env.snapshot()
    late = env.record()
    with pytest.raises(RuntimeError, match="begins when the world is reset"):
        late.replay()
    assert never.replay().to_bytes() == late_but_in_time.replay().to_bytes()
    env.restore(snapshot)
    for recorder in (never, late_but_in_time, late):
        with pytest.raises(RuntimeError, match="begins when the world is reset"):
            recorder.replay()
    never.stop()
    never.stop()
    env.reset()
    play(env, 20)
    with pytest.raises(RuntimeError, match="begins when the world is reset"):
        never.replay()
    assert late.replay().to_bytes() == late_but_in_time.replay().to_bytes()
    play_replay(late.replay())
    with pytest.raises(ValueError, match="world must be between 0 and 2"):
        ArkanoidVectorEnv(3).record(3)


def test_copies_are_not_recorded():
    env = ArkanoidEnv(**LIVELY)
    recorder = env.record()
    env.reset(seed=0)
    play(env.clone(), 20)
    play(env, 10)
    assert recorder.replay().result.decisions == 10


def test_how_a_game_was_seen_does_not_matter():
    """Nor does it to its file."""
    plain = record(100)
    seen = record(100, observation="rgb", size=16, grey=True)
    assert seen.to_bytes() == plain.to_bytes()
    assert seen.config.observation == "vector"


@pytest.mark.parametrize("actions", ["discrete6", "discrete3"])
def test_ten_minutes_are_a_few_kilobytes(actions):
    """Even of a player who could not be more restless."""
    replay = record(9000, lives=1000, actions=actions)
    assert replay.result.decisions == 9000
    assert len(replay.to_bytes()) < 5000
    assert len(replay.commands) / replay.frames_per_second == 600


def test_commands_keep_every_bit():
    """Minus zero, and more different commands than a palette holds."""
    luck = np.random.default_rng(0)
    for count in (0, 1, 256, 257, 3000):
        commands = np.stack([luck.uniform(-1, 1, count), luck.integers(0, 2, count)], axis=1)
        commands[: count // 3, 0] = [-0.0, 0.0, 1.0][count % 3]
        packed = replays._pack_commands(commands)
        assert replays._unpack_commands(*packed).tobytes() == commands.tobytes()


def test_level_files_are_in_the_replay(tmp_path):
    """So it can be played where the files are not, or not any more as they were."""
    first, second = tmp_path / "first.txt", tmp_path / "second.txt"
    first.write_text("...www.....\n")
    second.write_text("...X.X.....\n...XgX.....\n")
    replay = record(300, levels=[str(first)], options={"level": str(second)})
    replay.save(tmp_path / "game.replay")
    first.unlink()
    second.unlink()
    assert play_replay(tmp_path / "game.replay") == replay.result


def test_frames_are_what_the_player_saw():
    env = ArkanoidEnv(render_mode="rgb_array", **LIVELY | {"lives": 9})
    recorder = env.record()
    env.reset(seed=0)
    env.action_space.seed(0)
    seen = [env.render()]
    for _ in range(30):
        env.step(env.action_space.sample())
        seen.append(env.render())
    frames = list(replay_frames(recorder.replay()))
    assert len(frames) == len(seen) == 31
    assert all((one == other).all() for one, other in zip(frames, seen, strict=True))
    assert recorder.replay().frames_per_second == 15


@pytest.mark.parametrize("decision", [10, 300])
def test_another_course_is_noticed(decision):
    replay = record(600, lives=100)
    commands = replay.commands.copy()
    commands[decision, 0] = -commands[decision, 0] or 1.0
    tampered = dataclasses.replace(replay, commands=commands)
    between = r"0 and 256" if decision < 256 else r"256 and 512"
    with pytest.raises(ReplayDivergedError, match=f"another course .* between decisions {between}"):
        play_replay(tampered)


def test_another_beginning_and_another_end_are_noticed():
    replay = record(100)
    start = dataclasses.replace(replay.start, fields=replay.start.fields | {"start_round": 2})
    with pytest.raises(ReplayDivergedError, match="begins differently"):
        play_replay(dataclasses.replace(replay, start=start))
    result = dataclasses.replace(replay.result, score=replay.result.score + 1)
    with pytest.raises(ReplayDivergedError, match="ends differently"):
        play_replay(dataclasses.replace(replay, result=result))
    with pytest.raises(ReplayDivergedError, match="ends differently"):
        play_replay(dataclasses.replace(replay, commands=replay.commands[:-1]))
    over = record(5000, lives=1)
    more = np.concatenate([over.commands, over.commands[:1]])
    with pytest.raises(ReplayDivergedError, match=f"over after {len(over.commands)} decisions"):
        play_replay(dataclasses.replace(over, commands=more))


def test_the_states_on_the_way_are_at_hand():
    replay = record(40, lives=9)
    scores = [int(batch.worlds["score"][0]) for batch in replay_states(replay)]
    assert len(scores) == 41
    assert scores[-1] == replay.result.score


def test_replays_of_other_rules_are_refused(monkeypatch, tmp_path):
    path = tmp_path / "old.replay"
    monkeypatch.setattr(replays, "RULES_VERSION", 0)
    record(10).save(path)
    monkeypatch.undo()
    refusal = rf"old\.replay: .* version 0, recorded with release {__version__}, and this release"
    with pytest.raises(ValueError, match=refusal):
        play_replay(path)


@settings(max_examples=100, deadline=None)
@given(place=st.integers(0, GOLDEN.stat().st_size - 1), bit=st.integers(0, 7))
def test_a_changed_bit_is_noticed(place, bit):
    broken = bytearray(GOLDEN.read_bytes())
    broken[place] ^= 1 << bit
    with pytest.raises(ValueError, match=r"no replay|corrupt|format"):
        Replay.from_bytes(bytes(broken))


@pytest.mark.parametrize("command", [[np.nan, 0.0], [1.5, 0.0], [0.0, 0.5], [-np.inf, 1.0]])
def test_commands_that_no_player_could_give_are_refused(command):
    replay = record(10)
    commands = replay.commands.copy()
    commands[3] = command
    data = dataclasses.replace(replay, commands=commands).to_bytes()
    with pytest.raises(ValueError, match="is illegal"):
        Replay.from_bytes(data)


@pytest.mark.parametrize(
    "fields", [{"start": 4}, {"start_round": 0}, {"start_difficulty": 1e9}, {"start_seed": -1}]
)
def test_a_beginning_that_no_game_has_is_refused(fields):
    replay = record(10)
    start = dataclasses.replace(replay.start, fields=replay.start.fields | fields)
    with pytest.raises(ValueError, match=rf"start\.fields\.{next(iter(fields))} "):
        Replay.from_bytes(dataclasses.replace(replay, start=start).to_bytes())
    plan = dataclasses.replace(replay.plan, seeds=range(5, 5))
    with pytest.raises(ValueError, match="no game has such levels"):
        Replay.from_bytes(dataclasses.replace(replay, plan=plan).to_bytes())


def test_files_that_are_no_replays_are_refused_by_their_names(tmp_path):
    path = tmp_path / "some.replay"
    for content in (b"", b"text", GOLDEN.read_bytes()[:-1], GOLDEN.read_bytes() + b"more"):
        path.write_bytes(content)
        with pytest.raises(ValueError, match=r"some\.replay: .*(no replay|corrupt)"):
            Replay.load(path)
    with pytest.raises(FileNotFoundError, match=r"none\.replay"):
        play_replay(tmp_path / "none.replay")


def test_the_recording_changes_no_bit_of_the_game():
    """A recorded env shows what another one shows."""
    recorded, other = ArkanoidEnv(**LIVELY), ArkanoidEnv(**LIVELY)
    recorded.record()
    for env in (recorded, other):
        env.reset(seed=0)
        play(env, 100)
    assert recorded.snapshot() == other.snapshot()


@pytest.mark.parametrize("mode", ["single", "SameStep"])
@pytest.mark.parametrize("what", ["step", "last step", "reset"])
def test_a_recording_replays_wherever_ctrl_c_has_come(what, mode):
    """The recording lacked the step that Ctrl-C interrupted: 177 of 300 did not replay."""
    interrupted = event = 0
    came = True
    while came:
        event += 1
        single = mode == "single"
        keywords = LIVELY | {"max_decisions": 12, "lives": 9}
        env = (
            ArkanoidEnv(**keywords)
            if single
            else ArkanoidVectorEnv(1, autoreset_mode=mode, **keywords)
        )
        recorder = env.record()
        env.reset(seed=event)

        def step(env=env, single=single):
            env.step(3 if single else np.array([3]))

        for _ in range(11 if what == "last step" else 5):
            step()
        came = interrupted_at(event, env.reset if what == "reset" else step)
        for _ in range(2):
            try:
                replay = recorder.replay()
            except RuntimeError:
                interrupted += 1
            else:
                play_replay(replay)
            if not env.state["done"].any():
                step()
        # The next game is recorded again.
        env.reset()
        step()
        assert play_replay(recorder.replay()).decisions == 1
    assert event > 5
    assert interrupted > 2
