"""The front door: command line, configuration, run directory, trace and report.

Names are loaded when they are first used, so that `import coopera` costs nothing.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from core.lazy import lazy_names

if TYPE_CHECKING:
    from coopera.config import Config
    from coopera.conformance import check_method
    from coopera.rundir import RunDir
    from coopera.studies import run_studies
    from coopera.study import resume_study, run_study

__all__ = ["Config", "RunDir", "check_method", "resume_study", "run_studies", "run_study"]
__version__ = "0.1.0"

_HOME = {
    "Config": "coopera.config",
    "check_method": "coopera.conformance",
    "RunDir": "coopera.rundir",
    "run_studies": "coopera.studies",
    "resume_study": "coopera.study",
    "run_study": "coopera.study",
}

__getattr__ = lazy_names(__name__, _HOME)
