"""The front door: the command line, the configuration, the run directory, the reports, benchmarks and checks.

Its public names load when first used, so `import coopera` costs nothing.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

try:
    from coopera.core.lazy import lazy_names
    from coopera.core.version import __version__ as __version__
except ModuleNotFoundError as err:
    raise ImportError(
        f"{__path__[0]}/core is not the folder that belongs there: this copy of coopera lost its symbolic links. "
        "Clone it again with git (on Windows with core.symlinks=true), or install it from its wheel."
    ) from err

if TYPE_CHECKING:
    from coopera.checks.method import check_method
    from coopera.config.schema import Config
    from coopera.rundir.directory import RunDir
    from coopera.rundir.run import Run, open_run
    from coopera.studies.environment import make_env, recorded_life
    from coopera.studies.several import run_studies
    from coopera.studies.study import resume_study, run_study

__all__ = [
    "Config",
    "Run",
    "RunDir",
    "check_method",
    "make_env",
    "open_run",
    "recorded_life",
    "resume_study",
    "run_studies",
    "run_study",
]

_HOME = {
    "Config": "coopera.config.schema",
    "check_method": "coopera.checks.method",
    "Run": "coopera.rundir.run",
    "RunDir": "coopera.rundir.directory",
    "make_env": "coopera.studies.environment",
    "open_run": "coopera.rundir.run",
    "recorded_life": "coopera.studies.environment",
    "run_studies": "coopera.studies.several",
    "resume_study": "coopera.studies.study",
    "run_study": "coopera.studies.study",
}

__getattr__, __dir__ = lazy_names(__name__, _HOME)
