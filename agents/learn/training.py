"""A training run, from its beginning or a checkpoint to its end."""

import signal
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from types import FrameType
from typing import Any

from stable_baselines3.common.callbacks import BaseCallback
from stable_baselines3.common.logger import KVWriter, Logger, TensorBoardOutputFormat
from torch.utils.tensorboard import SummaryWriter

from ..adapter import GymnasiumVecEnv
from ..experiment.errors import SettingsError
from ..experiment.provenance import weights_hash
from ..experiment.runs import RunFolder
from ..experiment.settings import Experiment
from ..experiment.worlds import make_worlds
from ..measure.episodes import adapt
from .callbacks import GameStatistics, ProgressBar, StopRequest
from .checkpoints import Checkpoints, read_checkpoint, restore
from .curves import CurveWriter
from .model import make_model, save_model
from .periodic_validation import Judge, PeriodicValidation
from .stages import Stages, stage_options

INTERRUPTED = "interrupted"
FINISHED = "finished"


def train(
    experiment: Experiment,
    folder: RunFolder,
    resume: bool = False,
    on_measure: Judge | None = None,
) -> str:
    """Train until the budget is spent, validation ends it, or Ctrl-C; return how it ended.

    The outcome is `FINISHED`, `INTERRUPTED` or validation's reason; ``run.json`` has it, too.
    Ctrl-C ends the training between two decisions and leaves a checkpoint for ``resume``; a second
    one raises KeyboardInterrupt.

    Args:
        experiment: the run's settings.
        folder: gets model, checkpoint, curves and notes.
        resume: whether to begin with the folder's checkpoint.
        on_measure: gets each validation; it may return a reason to end the training.

    Raises:
        SettingsError: the environment refuses its arguments, or there is no checkpoint.
    """
    venv = adapt(make_worlds(experiment, experiment.training.worlds))
    try:
        return _train(experiment, folder, venv, resume, on_measure)
    finally:
        venv.close()


def _train(
    experiment: Experiment,
    folder: RunFolder,
    venv: GymnasiumVecEnv,
    resume: bool,
    on_measure: Judge | None,
) -> str:
    state = read_checkpoint(folder.checkpoint) if resume else None
    callback_state: dict[str, Any] = state["callbacks"] if state is not None else {}
    model = make_model(experiment, venv)
    stop = StopRequest()
    validation = _validation(experiment, folder, callback_state, stop, on_measure)
    if state is not None:
        restore(state, model, venv)
    else:
        venv.set_options(stage_options(experiment.curriculum, 0, venv.num_envs))
    first, started = model.num_timesteps, time.time()
    checkpoints = Checkpoints(
        folder.checkpoint,
        venv,
        experiment.training.checkpoint_every,
        callback_state,
        lambda last: folder.note_session(started, first, last),
    )
    # Checkpoints come after the callbacks whose state they hold.
    stages = Stages(experiment, venv, callback_state)
    callbacks: list[BaseCallback] = [GameStatistics(), stages]
    callbacks += [validation] if validation is not None else []
    callbacks += [checkpoints, ProgressBar(), stop]
    model.set_logger(_logger(folder, first))
    try:
        with _on_interrupt(lambda: stop.request(INTERRUPTED)):
            model.learn(
                experiment.training.timesteps - first,
                callback=callbacks,
                reset_num_timesteps=state is None,
            )
        complete = stop.reason is None
        if complete and validation is not None:
            validation.measure()
        last = checkpoints.finish(complete)
    finally:
        model.logger.close()
        if validation is not None:
            validation.close()
    outcome = stop.reason or FINISHED
    save_model(model, folder.model)
    hashed = None if outcome == INTERRUPTED else weights_hash(model.policy.state_dict())
    folder.add_notes(outcome=outcome, timesteps=last, weights=hashed)
    return outcome


def check_resumable(folder: RunFolder) -> None:
    """Raise `SettingsError` if the run has ended."""
    outcome = folder.read_notes().get("outcome")
    if outcome not in ("unfinished", INTERRUPTED):
        raise SettingsError(
            f"{folder.path}: nothing to resume: the run has ended ({outcome}); "
            f"to measure it: arkanoid evaluate {folder.path}"
        )


def _validation(
    experiment: Experiment,
    folder: RunFolder,
    callback_state: dict[str, Any],
    stop: StopRequest,
    on_measure: Judge | None,
) -> PeriodicValidation | None:
    if not experiment.validation.every:
        return None
    return PeriodicValidation(
        experiment,
        callback_state.setdefault("validation", {}),
        lambda model: save_model(model, folder.best),
        stop.request,
        on_measure,
    )


def _logger(folder: RunFolder, first: int) -> Logger:
    """Return a logger to TensorBoard and to the curves' file, from decision ``first`` on."""
    writers: list[KVWriter] = [TensorBoard(str(folder.log), first), _Curve(folder, first)]
    return Logger(str(folder.log), writers)


class TensorBoard(TensorBoardOutputFormat):
    """TensorBoard's events; it purges those that a killed run wrote after its checkpoint."""

    def __init__(self, folder: str, first: int) -> None:
        self.writer = SummaryWriter(folder, purge_step=first + 1 if first else None)
        self._is_closed = False


class _Curve(CurveWriter, KVWriter):
    """The curves' file as one of stable-baselines3's writers."""

    def __init__(self, folder: RunFolder, first: int) -> None:
        super().__init__(folder.curve, first)


@contextmanager
def _on_interrupt(request: Callable[[], None]) -> Iterator[None]:
    """Call ``request`` at the first Ctrl-C inside the block."""
    previous = signal.getsignal(signal.SIGINT)

    def handle(signal_number: int, frame: FrameType | None) -> None:
        signal.signal(signal.SIGINT, previous)
        request()

    try:
        signal.signal(signal.SIGINT, handle)
    except ValueError:
        # Only the main thread may handle signals.
        yield
        return
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, previous)
