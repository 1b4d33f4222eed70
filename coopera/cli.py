"""The command line. Nothing heavy is imported before a command needs it, so that `--help` answers at once."""

from __future__ import annotations

import sys
import warnings
from collections.abc import Callable, Sequence
from functools import partial
from typing import Annotated, Any

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
    replay,
    reports,
    run,
    scenes,
    sharing,
)
from coopera.core.errors import ConfigError, CooperaError, OldWordWarning
from coopera.core.version import __version__

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
app.command()(sharing.leaderboard)
app.command()(sharing.export)
app.add_typer(humans.app, name="humans")
app.add_typer(scenes.app, name="scenes")
app.add_typer(prompts.app, name="prompts")
app.add_typer(models.app, name="models")
app.add_typer(memory.app, name="memory")
app.add_typer(analyse.app, name="analyse")


def main(args: Sequence[str] | None = None) -> int:
    """Run one command and return its exit code: 0 done, 1 the work failed, 2 the input is wrong, 130 stopped.

    What is wrong is said in one sentence on standard error.
    """
    with warnings.catch_warnings():
        warnings.showwarning = partial(_say_warning, warnings.showwarning)
        return _run(list(sys.argv[1:] if args is None else args))


def _run(args: list[str]) -> int:
    try:
        code = app(args, prog_name="coopera", standalone_mode=False)
    except ConfigError as err:
        return _fail(str(err), 2)
    except CooperaError as err:
        return _fail(str(err), 1)
    except typer.TyperException as err:
        return _fail(err.format_message(), 2)
    except BrokenPipeError:  # the reader of a pipe, such as `head`, has seen enough
        sys.stderr.close()
        return 1
    return code if isinstance(code, int) else 0


def _say_warning(usual: Callable[..., None], message: Warning | str, category: type[Warning], *where: Any) -> None:
    """Say that a word is old in one sentence, as errors are said; other warnings are shown as usual."""
    if issubclass(category, OldWordWarning):
        typer.echo(f"coopera: {message}", err=True)
    else:
        usual(message, category, *where)


def _fail(sentence: str, code: int) -> int:
    if sentence:
        typer.echo(f"coopera: {' '.join(sentence.split())}", err=True)
    return code


if __name__ == "__main__":
    sys.exit(main())
