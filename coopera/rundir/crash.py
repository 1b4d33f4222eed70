"""What went wrong in one sentence, whatever it was, and a log file where nobody foresaw it.

Errors of ours are sentences already. What the system refuses, such as room on a disk, is named with its file. All else
is a fault of coopera's: the sentence names the place, and the log has the traceback, without what must stay secret.
"""

from __future__ import annotations

import errno
import os
import platform
import re
import sqlite3
import tempfile
import traceback
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager, suppress
from datetime import UTC, datetime
from pathlib import Path

from coopera.config.files import reason
from coopera.core.errors import BudgetError, ConfigError, CooperaError, RunError, StoppedError, WaitingError
from coopera.core.setting import default_data_dir
from coopera.core.version import __version__

_FULL = (errno.ENOSPC, errno.EDQUOT)
_SYSTEM = (
    *_FULL,
    errno.EACCES,
    errno.EFBIG,
    errno.EIO,
    errno.EMFILE,
    errno.ENAMETOOLONG,
    errno.ENFILE,
    errno.ENOENT,
    errno.ENOTDIR,
    errno.EPERM,
    errno.EPIPE,
    errno.EROFS,
)
"""Numbers of the system's refusals that say by themselves what is to be done."""
_SECRET = re.compile(r"KEY|TOKEN|SECRET|PASSWORD|PASSWD|CREDENTIAL", re.IGNORECASE)
_IN_URL = re.compile(r"(?<=://)[^/\s@'\"]+@")
_SHORT = 4
"""Characters that a secret has at least: what is shorter stands in too many innocent words."""


def in_words(err: BaseException) -> str:
    """What went wrong, in one sentence."""
    if isinstance(err, CooperaError):
        return str(err)
    if isinstance(err, OSError) and err.errno is not None:
        where = os.fsdecode(err.filename) if isinstance(err.filename, str | bytes) else ""
        more = "; make room, and go on" if err.errno in _FULL else ""
        return f"{where or 'The system refuses this'}: {reason(err)}{more}."
    if isinstance(err, sqlite3.Error):
        return f"A database cannot be used: {err}."
    return " ".join(f"{type(err).__name__}: {err}".split())


def how_it_ended(error: BaseException | None) -> tuple[str, str]:
    """The state of a run whose work ended before it was complete, and why."""
    if isinstance(error, (BudgetError, StoppedError, WaitingError)):
        return "stopped", str(error)
    if isinstance(error, BrokenPipeError):
        return "stopped", "nobody reads its output any more"
    if error is None or isinstance(error, KeyboardInterrupt | SystemExit | GeneratorExit):
        return "stopped", "interrupted" if error else "the work ended before it was complete"
    return "failed", in_words(error)


@contextmanager
def refusals_told() -> Iterator[None]:
    """Turn what the system refuses while a run works into our error.

    Raises:
        RunError: Instead of an `OSError` or an error of a database. A reader who has gone is none.
    """
    try:
        yield
    except BrokenPipeError:
        raise
    except (OSError, sqlite3.Error) as err:
        raise RunError(in_words(err)) from err


def told(err: BaseException, args: Sequence[str]) -> tuple[str, int]:
    """What went wrong in one sentence, and the exit code; where nobody foresaw it a log is written and named.

    Args:
        err: Anything but `KeyboardInterrupt` and its like.
        args: What was asked for.
    """
    if isinstance(err, CooperaError):
        return str(err), 2 if isinstance(err, ConfigError) else 1
    if isinstance(err, OSError) and err.errno in _SYSTEM:
        return without_secrets(in_words(err)), 1
    place = next(reversed(traceback.extract_tb(err.__traceback__)), None)
    where = f" ({Path(place.filename).name}, line {place.lineno})" if place else ""
    sentence = without_secrets(f"coopera failed unexpectedly{where}: {in_words(err)}").rstrip(".")[:600]
    log = write_log(err, args)
    return f"{sentence}. {f'Details: {log}' if log else 'No log of it could be written'}.", 1


def write_log(err: BaseException, args: Sequence[str]) -> Path | None:
    """Write a traceback, for its owner's eyes only, to the data folder or else the folder for temporary files.

    Returns:
        The file; None where neither folder could be written.
    """
    now = datetime.now(UTC)
    text = without_secrets(
        f"coopera {__version__}, Python {platform.python_version()}, {platform.platform()}\n"
        f"{now.isoformat(timespec='seconds')}\ncoopera {' '.join(args)}\n\n" + "".join(traceback.format_exception(err))
    )
    folders: tuple[Callable[[], Path], ...] = (
        lambda: default_data_dir() / "crashes",
        lambda: Path(tempfile.gettempdir()),
    )
    for folder in folders:
        with suppress(OSError, RuntimeError, ValueError):
            file = folder() / f"coopera-{now:%Y%m%dT%H%M%S%f}-{os.getpid()}.log"
            file.parent.mkdir(parents=True, exist_ok=True)
            try:
                _write(file, text)
            except OSError:
                file.unlink(missing_ok=True)
                raise
            return file
    return None


def _write(file: Path, text: str) -> None:
    number = os.open(file, os.O_WRONLY | os.O_CREAT | os.O_EXCL | os.O_NOFOLLOW, 0o600)
    with open(number, "w", encoding="utf-8", errors="backslashreplace") as log:
        log.write(text)


def without_secrets(text: str) -> str:
    """A text without names and passwords in addresses, and without what the environment holds as secret."""
    text = _IN_URL.sub("***@", text)
    secrets = {value for name, value in os.environ.items() if _SECRET.search(name) and len(value) >= _SHORT}
    for value in sorted(secrets, key=len, reverse=True):
        text = text.replace(value, "***")
    return text
