"""Build the day graph, live one day with it and print each node as it ends.

.venv/bin/python examples/stream_a_day.py
"""

from __future__ import annotations

import tempfile
from pathlib import Path

from coopera.config.schema import Config
from coopera.graphs import build_day_graph, first_day
from coopera.studies.study import new_run, plan_days


def main() -> None:
    """Live three hours of the first shipped person."""
    with tempfile.TemporaryDirectory() as folder:
        config = Config(days=1, hours=3, pictures="none", out=Path(folder) / "run")
        with new_run(config) as (run, services):
            plan = plan_days(run.config)[0]
            stream = build_day_graph().stream(first_day(plan), context=services, stream_mode="updates", subgraphs=True)
            for namespace, update in stream:
                for node in update:
                    print("    " * len(namespace) + node)
            for hour in run.read_day(plan.day):
                print(f"{hour.hour}:00", hour.human.intention.text if hour.human else hour.reason)


if __name__ == "__main__":
    main()
