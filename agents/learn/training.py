"""A training run, from its beginning or a checkpoint to its end."""

import errno
import signal
import sys
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, contextmanager
from types import FrameType
from typing import Any

import torch
from stable_baselines3.common.callbacks import BaseCallback
from stable_baselines3.common.logger import KVWriter, Logger, TensorBoardOutputFormat
from torch.utils.tensorboard import SummaryWriter
from tqdm import tqdm  # type: ignore[import-untyped]

from ..adapter import GymnasiumVecEnv
from ..experiment.errors import SettingsError
from ..experiment.files import cause
from ..experiment.programs import arkanoid
from ..experiment.provenance import weights_hash
from ..experiment.runs import FINISHED, INTERRUPTED, RunFolder
from ..experiment.seeds import Purpose, spread_seeds
from ..experiment.settings import Experiment
from ..experiment.worlds import make_worlds
from ..interrupts import handled_interrupts
from ..measure.episodes import adapt
from .callbacks import GameStatistics, ProgressBar, StopRequest
from .checkpoints import Checkpoints, resume
from .collapse import CollapseWatch, Warn
from .curves import CurveWriter, numbers_of
from .levels.sampling import make_stages
from .model import make_model, save_model
from .periodic_validation import Judge, PeriodicValidation
from .playing import worlds_device
from .starting import begin

# Takes the number of decisions, and numbers by their names.
Log = Callable[[int, dict[str, float]], None]


def train(
    experiment: Experiment,
    folder: RunFolder,
    resumed: bool = False,
    on_measure: Judge | None = None,
    on_log: Log | None = None,
    shows_progress: bool = True,
) -> str:
    """Train until the budget is spent, validation ends it, or Ctrl-C; return how it ended.

    The outcome is `FINISHED`, `INTERRUPTED` or validation's reason; ``run.json`` has it, too.
    Ctrl-C ends the training between two decisions and leaves a checkpoint to resume from; a second
    one raises KeyboardInterrupt.

    Args:
        experiment: the run's settings.
        folder: gets model, checkpoint, curves and notes.
        resumed: whether to begin with the folder's checkpoint.
        on_measure: gets each validation; it may return a reason to end the training.
        on_log: gets the numbers of each point of the curves.
        shows_progress: whether there is a progress bar.

    Raises:
        SettingsError: the environment refuses its arguments, there is no checkpoint or a damaged
            one, another process trains this run, its files cannot be written, or a graphics card
            has too little memory.
    """
    with folder.locked():
        if resumed:
            folder.check_resumable()
        device = worlds_device(experiment)
        venv = adapt(make_worlds(experiment, experiment.training.worlds, device=device))
        try:
            with _quiet_writer():
                return _train(experiment, folder, venv, resumed, on_measure, on_log, shows_progress)
        except OSError as error:
            raise SettingsError(_cannot_write(folder, error)) from error
        except torch.OutOfMemoryError:
            raise SettingsError(
                "the graphics card has too little memory: take fewer 'training.worlds', fewer "
                "'ppo.n_steps' or a smaller 'ppo.batch_size'"
            ) from None
        finally:
            venv.close()


def _cannot_write(folder: RunFolder, error: OSError) -> str:
    """Return a sentence that says what stopped a training and how to go on."""
    full = error.errno in (errno.ENOSPC, errno.EDQUOT)
    what = f"writing {error.filename}" if error.filename else "writing"
    reason = "the disk is full" if full else f"{what} failed ({cause(error)})"
    start = "free some space, then go on with" if full else "go on with"
    if folder.checkpoint.is_file():
        return f"{folder.path}: {reason}; {start}: {arkanoid('train', '--resume', folder.path)}"
    return f"{folder.path}: {reason} before the first checkpoint; start a new run"


@contextmanager
def _quiet_writer() -> Iterator[None]:
    """Keep TensorBoard's thread from printing an error that the training raises, too."""
    previous = threading.excepthook

    def hook(arguments: threading.ExceptHookArgs) -> None:
        if not isinstance(arguments.exc_value, OSError):
            previous(arguments)

    threading.excepthook = hook
    try:
        yield
    finally:
        threading.excepthook = previous


def _train(
    experiment: Experiment,
    folder: RunFolder,
    venv: GymnasiumVecEnv,
    resumed: bool,
    on_measure: Judge | None,
    on_log: Log | None,
    shows_progress: bool,
) -> str:
    model = make_model(experiment, venv)
    model.set_logger(Logger(str(folder.log), []))
    callback_state: dict[str, Any] = {}
    if resumed:
        callback_state = resume(folder.checkpoint, model, venv, experiment)
    stages = make_stages(experiment, venv, callback_state)
    if not resumed:
        begin(model, experiment, folder)
        # stable-baselines3 has just given the worlds neighbouring seeds.
        venv.set_seeds(spread_seeds(experiment.seed, Purpose.TRAINING, venv.num_envs))
        venv.set_options(stages.options())
    stop = StopRequest(callback_state)

    def warn(message: str) -> None:
        tqdm.write(f"arkanoid: warning: {message}", file=sys.stderr)
        folder.add_warning(message)

    validation = _validation(experiment, folder, callback_state, stop, on_measure, warn)
    first, started = model.num_timesteps, time.time()
    checkpoints = Checkpoints(
        folder.checkpoint,
        venv,
        experiment.training.checkpoint_every,
        callback_state,
        lambda last: folder.note_session(started, first, last),
    )
    # Checkpoints come after the callbacks whose state they hold.
    watch = CollapseWatch(experiment, callback_state, warn)
    callbacks: list[BaseCallback] = [GameStatistics(), watch, stages]
    callbacks += [validation] if validation is not None else []
    progress = ProgressBar()
    callbacks += [checkpoints, *([progress] if shows_progress else []), stop]
    try:
        # Only now, with a state that fits: they remove what was written after the checkpoint.
        model.logger.output_formats.append(_Curve(folder, first))
        model.logger.output_formats.append(TensorBoard(str(folder.log), first))
        if on_log is not None:
            model.logger.output_formats.append(_Told(on_log))
        with _on_interrupt(stop.interrupt):
            model.learn(
                0 if stop.reason else experiment.training.timesteps - first,
                callback=callbacks,
                reset_num_timesteps=not resumed,
            )
        complete = stop.reason is None and not stop.interrupted
        if complete and validation is not None:
            validation.finish()
        last = checkpoints.finish(complete)
    except ValueError as error:
        # This is what torch says of probabilities that are not finite.
        if "found invalid values" not in str(error):
            raise
        raise SettingsError(
            f"{folder.path}: the training has diverged: its weights are too large; start a "
            f"new run with a smaller 'ppo.learning_rate' ({experiment.ppo.learning_rate:g})"
        ) from None
    finally:
        progress.close()
        if validation is not None:
            validation.close()
        model.logger.close()
    outcome = INTERRUPTED if stop.interrupted else stop.reason or FINISHED
    save_model(model, folder.model, experiment)
    hashed = None if outcome == INTERRUPTED else weights_hash(model.policy.state_dict())
    folder.add_notes(outcome=outcome, timesteps=last, weights=hashed)
    return outcome


def _validation(
    experiment: Experiment,
    folder: RunFolder,
    callback_state: dict[str, Any],
    stop: StopRequest,
    on_measure: Judge | None,
    warn: Warn,
) -> PeriodicValidation | None:
    if not experiment.validation.every:
        return None
    return PeriodicValidation(
        experiment,
        callback_state.setdefault("validation", {}),
        lambda model: save_model(model, folder.best, experiment),
        stop.request,
        on_measure,
        warn,
    )


class TensorBoard(TensorBoardOutputFormat):
    """TensorBoard's events; it purges those that a killed run wrote after its checkpoint."""

    def __init__(self, folder: str, first: int) -> None:
        self.writer = SummaryWriter(folder, purge_step=first + 1 if first else None)
        self._is_closed = False


class _Curve(CurveWriter, KVWriter):
    """The curves' file as one of stable-baselines3's writers."""

    def __init__(self, folder: RunFolder, first: int) -> None:
        super().__init__(folder.curve, first)


class _Told(KVWriter):
    """Tells a function the numbers that are logged."""

    def __init__(self, on_log: Log) -> None:
        self._on_log = on_log

    def write(
        self, key_values: dict[str, Any], key_excluded: dict[str, Any], step: int = 0
    ) -> None:
        """Tell them."""
        self._on_log(step, numbers_of(key_values))

    def close(self) -> None:
        """Nothing: whoever is told may want to know more after the training."""


def _on_interrupt(request: Callable[[], None]) -> AbstractContextManager[None]:
    """Call ``request`` at the first Ctrl-C inside the block."""
    previous = signal.getsignal(signal.SIGINT)

    def handle(signal_number: int, frame: FrameType | None) -> None:
        signal.signal(signal.SIGINT, previous)
        request()

    return handled_interrupts(handle)
