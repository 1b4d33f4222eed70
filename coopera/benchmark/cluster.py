"""The same jobs on a Ray cluster whose machines share a file system (the optional extra `ray`)."""

from __future__ import annotations

import os
import socket
from collections.abc import Generator, Sequence
from typing import Any

from coopera.core.errors import ConfigError, RunError
from coopera.studies.workers import TRIES, Done, Queue, Work, attempt

_PATIENCE = 10.0  # seconds


def work_on_ray(
    jobs: Sequence[Any], work: Work, *, address: str, workers: int = 1, deadline: float | None = None
) -> Generator[Done]:
    """Do all jobs as Ray tasks of one core each, yielding each as it ends; one whose worker dies is tried again.

    Args:
        jobs: In the order in which they are to be started.
        work: What does one, on any machine of the cluster: its folders must be there under the same paths.
        address: As `ray.init` takes it ("auto", "ray://host:10001"), or "local" for a cluster of this process's own.
        workers: Cores of such a local cluster.
        deadline: By `time.monotonic`; no job is started after it.

    Raises:
        ConfigError: If Ray is not installed or the cluster cannot be reached.
        RunError: If the cluster goes away meanwhile.
    """
    try:
        import ray  # noqa: PLC0415 - an optional extra
    except ImportError:
        raise ConfigError("--ray needs the package ray: pip install -c constraints.txt -e '.[ray]'") from None
    local = address == "local"
    _refuse_silent(address)
    os.environ.setdefault("RAY_USAGE_STATS_ENABLED", "0")  # nothing is reported to anybody unless the user wants it
    try:
        ray.init(
            address=address,
            num_cpus=workers if local else None,
            include_dashboard=False,
            log_to_driver=False,
        )
    except (ConnectionError, ValueError, RuntimeError) as err:
        raise ConfigError(f"--ray {address}: there is no cluster that can be reached ({err}).") from None
    try:
        resources: Any = ray.cluster_resources  # untyped in ray
        slots = max(1, int(resources().get("CPU", 1)))
        task = ray.remote(num_cpus=1, max_retries=TRIES - 1)(attempt)
        queue, running = Queue(list(jobs)), dict[Any, Any]()
        while queue.jobs or running:
            queue.end_at(deadline)
            while len(running) < slots and (job := queue.take()) is not None:
                running[task.remote(work, job)] = job
            if not running:
                break
            [ended], _ = _heard(ray, list(running), address)
            job = running.pop(ended)
            try:
                error = ray.get(ended)
            except ray.exceptions.LocalRayletDiedError as err:
                raise _gone(address, err) from err
            except ray.exceptions.RayError as err:
                error = f"its process died {TRIES} times ({type(err).__name__})"
            yield from queue.close(job, error)
    finally:
        ray.shutdown()


def _heard(ray: Any, running: list[Any], address: str) -> tuple[list[Any], list[Any]]:
    """The first task that has ended, whether its process lives or not, and the others."""
    try:
        ended: tuple[list[Any], list[Any]] = ray.wait(running)
    except (ray.exceptions.RayError, ConnectionError) as err:
        raise _gone(address, err) from err
    return ended


def _gone(address: str, err: Exception) -> RunError:
    return RunError(f"--ray {address}: the cluster is gone ({type(err).__name__}); run the same command again.")


def _refuse_silent(address: str) -> None:
    """Refuse a host and port at which nothing answers: Ray itself would go on trying for minutes."""
    host, _, port = address.removeprefix("ray://").rpartition(":")
    if host and port.isdigit():
        try:
            socket.create_connection((host, int(port)), timeout=_PATIENCE).close()
        except (OSError, OverflowError) as err:
            raise ConfigError(f"--ray {address}: nothing answers there ({err}).") from None
