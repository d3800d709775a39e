"""The keywords that are not the configuration's, and what an unknown one may mean."""

from collections.abc import Collection
from difflib import get_close_matches

# Keywords of the vector environments that are no part of a `Config`.
BATCH_KEYWORDS = (
    "device",
    "render_mode",
    "render_size",
    "autoreset_mode",
    "copy",
    "threads",
    "max_episode_steps",
)
# Keywords of other environments and wrappers, and what they are called here.
_CALLED_HERE = {
    "frame_stack": "stack",
    "frameskip": "frame_skip",
    "gray": "grey",
    "grayscale": "grey",
    "grayscale_obs": "grey",
    "max_episode_steps": "max_decisions",
    "num_stack": "stack",
    "obs_type": "observation",
    "repeat_action_probability": "sticky_action",
    "screen_size": "size",
    "stack_size": "stack",
    "terminal_on_life_loss": "episodic_life",
}
_WHERE = {
    "options": "reset(options=...) takes them",
    "seed": "reset(seed=...) takes it",
    "num_envs": "gym.make_vec(...) makes several games, ArkanoidVectorEnv(num_envs) does",
    "autoreset_mode": "gym.make_vec(...) takes it, for several games",
    "device": "gym.make_vec(...) takes it, for several games",
    "copy": "gym.make_vec(...) takes it, for several games",
    "threads": "gym.make_vec(...) takes it, for several games",
}


def keyword_hint(name: str, known: Collection[str]) -> str:
    """Return what an error says about an unknown keyword, given the known ones."""
    if name in _WHERE:
        return _WHERE[name]
    called = _CALLED_HERE.get(name)
    if called in known:
        return f"did you mean {called!r}?"
    # Words must be alike: "thread" does not mean "reward".
    near = get_close_matches(name, known, 1, cutoff=0.75)
    return f"did you mean {near[0]!r}?" if near else f"known are {', '.join(known)}."
