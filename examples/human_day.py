"""Let a person live a day with the human graph alone, no robot and no run directory, and print it as Markdown.

.venv/bin/python examples/human_day.py [PERSON [COLLAB [MODEL [BASE_URL]]]]

PERSON is an id from `coopera humans list`, COLLAB 1 or 2, MODEL any model that coopera knows, such as offline or
openai:llama-3.1-8b.
"""

from __future__ import annotations

import sys
import tempfile
from pathlib import Path

from coopera.config.schema import Config, Models
from coopera.graphs import build_human_graph
from coopera.graphs.human import human_hour
from coopera.studies.study import new_run, plan_days


def main(person: str = "joan", collab: str = "2", model: str = "offline", base_url: str | None = None) -> None:
    """Live one day, hour by hour: the graph proposes, the person remembers."""
    with tempfile.TemporaryDirectory() as folder:
        config = Config(
            humans=[person],
            days=1,
            collab=2 if collab == "2" else 1,
            models=Models(human=model),
            base_url=base_url,
            pictures="none",
            out=Path(folder) / "run",
        )
        with new_run(config) as (run, services):
            plan = plan_days(run.config)[0]
            person_in_home, graph = services.human(plan), build_human_graph()
            for position in range(len(plan.hours)):
                clock = plan.clock(position)
                lived = human_hour(graph.invoke({"clock": clock, "hours": plan.hours}, context=person_in_home))
                person_in_home.memories.add(
                    lived.intention.text, [task.act.describe() for task in lived.tasks], clock.now
                )
                print(f"- **{clock.label}: {lived.intention.text}.** {lived.intention.reasons.human}")
                print(f"  {'; '.join(task.act.describe() for task in lived.tasks)}.")


if __name__ == "__main__":
    main(*sys.argv[1:])
