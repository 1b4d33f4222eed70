"""Several studies at once, so that a server which answers many requests together is kept busy."""

from __future__ import annotations

import threading
from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import Future, ThreadPoolExecutor, wait
from typing import Any, TypeAlias

from coopera.catalogues import resolve
from coopera.config import Config
from coopera.stopping import Stop
from coopera.study import run_study
from core.errors import ConfigError, CooperaError

Event: TypeAlias = Mapping[str, Any]


def run_studies(
    configs: Sequence[Config], *, at_once: int = 8, on_event: Callable[[int, Event], None] | None = None
) -> list[dict[str, Any] | CooperaError]:
    """Run studies in threads of this process; none depends on which ends first.

    The threads share weights, the text encoder and the pace towards servers; what a home computes takes turns, so this
    pays where models are slow. One that fails does not stop the others.

    Args:
        configs: Each with an `out` of its own.
        at_once: How many run at the same time.
        on_event: Told the number of the study and each node that ends; called from the threads, one at a time.

    Returns:
        In the order of `configs`, what `run_study` returns, or the error that ended it.

    Raises:
        ConfigError: If a configuration is wrong, or two have the same folder; nothing has then been begun.
        KeyboardInterrupt: If Ctrl-C was pressed; each run ends with its next node, as failed, and can be resumed.
    """
    resolved = [resolve(config) for config in configs]
    folders = [config.out for config in configs]
    if None in folders or len(set(folders)) < len(folders):
        raise ConfigError("out: each of several studies needs a folder of its own.")
    telling = threading.Lock()

    def one(number: int) -> dict[str, Any] | CooperaError:
        def tell(event: Event) -> None:
            stop.check()
            if on_event is not None:
                with telling:
                    on_event(number, event)

        try:
            return run_study(resolved[number], on_event=tell)
        except CooperaError as err:
            return err

    with Stop() as stop, ThreadPoolExecutor(max(1, at_once), thread_name_prefix="study") as pool:
        futures: list[Future[dict[str, Any] | CooperaError]] = [pool.submit(one, n) for n in range(len(resolved))]
        try:
            wait(futures)
        except KeyboardInterrupt:
            pool.shutdown(wait=False, cancel_futures=True)
            raise
        return [future.result() for future in futures]
