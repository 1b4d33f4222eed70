"""Replace one prompt by a folder of your own, without touching code, and see it in the trace.

Run it with `.venv/bin/python examples/swap_a_prompt.py`.

The offline routine model reads a prompt's variables rather than its words, so here only the trace changes; a
language model (`--model openai:…`) would answer to the new words.
"""

from __future__ import annotations

import tempfile
from pathlib import Path

from coopera import Config, run_study
from coopera.prompts.loader import SHIPPED
from coopera.rundir.directory import RunDir

NAME = "human/intention"


def main() -> None:
    """Run an hour with a reworded intention prompt and print what the model was sent."""
    with tempfile.TemporaryDirectory() as folder:
        mine = Path(folder) / "prompts" / f"{NAME}.md"
        mine.parent.mkdir(parents=True)
        mine.write_text((SHIPPED / f"{NAME}.md").read_text() + "\nAnswer as if it were a rainy day.\n")
        config = Config(days=1, hours=1, pictures="none", prompts=mine.parents[1], out=Path(folder) / "run")
        run_study(config)
        [hour] = RunDir.open(Path(folder) / "run").read_day(0)
        [call] = [call for call in hour.calls if call.prompt == NAME]
        print(call.messages[0]["content"][-400:])


if __name__ == "__main__":
    main()
