"""The command line. Nothing heavy is imported before a command needs it, so that `--help` answers at once."""

from __future__ import annotations

import atexit
import gc
import logging
import os
import select
import sys
import warnings
from collections.abc import Callable, Sequence
from contextlib import suppress
from functools import partial
from typing import Annotated, Any, TextIO

import typer

from coopera.commands import (
    analyse,
    benchmark,
    doctor,
    humans,
    listing,
    memory,
    models,
    prompts,
    rate,
    replay,
    reports,
    run,
    scenes,
    sharing,
    view,
)
from coopera.commands.options import STOPPED
from coopera.core.errors import OldWordWarning
from coopera.core.naming import printable
from coopera.core.version import __version__
from coopera.studies.heap import rare_collections

app = typer.Typer(
    name="coopera",
    help="A person with a personality lives in a simulated home, and a robot learns to help that person.",
    epilog="Exit codes: 0 done, 1 the work failed, 2 the input is wrong, 130 stopped by Ctrl-C.",
    no_args_is_help=True,
    rich_markup_mode=None,  # help names values and defaults in brackets, which Rich would take for its own
    pretty_exceptions_enable=False,
)


def _say_version(wanted: bool) -> None:
    if wanted:
        typer.echo(f"coopera {__version__}")
        raise typer.Exit


@app.callback()
def _coopera(
    version: Annotated[
        bool, typer.Option("--version", callback=_say_version, is_eager=True, help="Show the version and exit.")
    ] = False,
) -> None:
    """Take what stands before a command."""


app.command()(run.run)
app.command()(run.resume)
app.command("list")(listing.list_what)
app.command()(reports.trace)
app.command()(reports.report)
app.command()(doctor.doctor)
app.command()(benchmark.benchmark)
app.command()(replay.replay)
app.command()(view.view)
app.command()(sharing.leaderboard)
app.command()(sharing.recheck)
app.command()(sharing.export)
app.add_typer(humans.app, name="humans")
app.add_typer(scenes.app, name="scenes")
app.add_typer(prompts.app, name="prompts")
app.add_typer(models.app, name="models")
app.add_typer(memory.app, name="memory")
app.add_typer(analyse.app, name="analyse")
app.add_typer(rate.app, name="rate")


def main(args: Sequence[str] | None = None) -> int:
    """Run one command and return its exit code: 0 done, 1 the work failed, 2 the input is wrong, 130 stopped.

    What is wrong is said in one sentence on standard error; what nobody foresaw stands in a log file that it names.
    """
    _log_plainly()
    rare_collections()
    atexit.register(gc.freeze)  # to look for garbage once more would hold the end up by a second
    with warnings.catch_warnings():
        warnings.showwarning = partial(_say_warning, warnings.showwarning)
        return _run(list(sys.argv[1:] if args is None else args))


class _Plain(logging.Formatter):
    """Messages of the log without control characters: they name files, and tell what models said."""

    def format(self, record: logging.LogRecord) -> str:
        return printable(super().format(record))


def _log_plainly() -> None:
    if logging.lastResort is not None:
        logging.lastResort.setFormatter(_Plain())


def _run(args: list[str]) -> int:
    streams = sys.stdout, sys.stderr
    try:
        code = app(args, prog_name="coopera", standalone_mode=False)
        for stream in _streams():  # what they refuse is to show here, not when Python ends
            stream.flush()
    except typer.TyperException as err:
        return _fail(err.format_message(), 2)
    except (KeyboardInterrupt, typer.Abort):
        return _fail("", STOPPED)
    except SystemExit as err:
        if not isinstance(err.__context__, BrokenPipeError):
            raise
        sys.stdout, sys.stderr = streams  # Typer takes every broken pipe for one of these, and replaces them
        return _fail_with(err.__context__, args)
    except BaseException as err:  # noqa: BLE001 - whatever it is, it is told in one sentence
        return _fail_with(err, args)
    return code if isinstance(code, int) else 0


def _fail_with(err: BaseException, args: list[str]) -> int:
    if isinstance(err, BrokenPipeError) and any(map(_unread, _streams())):
        return _fail("", 1)  # the reader of a pipe, such as `head`, has seen enough
    from coopera.rundir.crash import told

    return _fail(*told(err, args))


def _streams() -> list[TextIO]:
    """Standard output and standard error, as far as there are any."""
    return [stream for stream in (sys.stdout, sys.stderr) if stream is not None and not stream.closed]


def _unread(stream: TextIO) -> bool:
    """Whether nobody is at the other end of a stream any more."""
    with suppress(OSError, ValueError):
        poller = select.poll()
        poller.register(stream.fileno(), 0)
        return any(event & (select.POLLERR | select.POLLHUP) for _, event in poller.poll(0))
    return False


def _silence() -> None:
    """Have what is still to be written go nowhere, so that Python does not fail with it when it ends."""
    for stream in _streams():
        try:
            stream.flush()
        except (OSError, ValueError):
            with suppress(OSError, ValueError), open(os.devnull, "w", encoding="utf-8") as nowhere:
                os.dup2(nowhere.fileno(), stream.fileno())


def _say_warning(usual: Callable[..., None], message: Warning | str, category: type[Warning], *where: Any) -> None:
    """Say that a word is old in one sentence, as errors are said; other warnings are shown as usual."""
    if issubclass(category, OldWordWarning):
        typer.echo(printable(f"coopera: {message}"), err=True)
    else:
        usual(message, category, *where)


def _fail(sentence: str, code: int) -> int:
    with suppress(OSError, ValueError):
        if sentence:
            readable = " ".join(sentence.split()).encode(errors="backslashreplace").decode()
            typer.echo(printable(f"coopera: {readable}"), err=True)
    _silence()
    return code


if __name__ == "__main__":
    sys.exit(main())
