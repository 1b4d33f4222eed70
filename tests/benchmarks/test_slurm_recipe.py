from __future__ import annotations

import os
import subprocess
from pathlib import Path

SCRIPT = Path(__file__).parents[2] / "examples" / "slurm" / "grid.sbatch"
FAKES = {
    "coopera": 'echo "coopera $*" >> "$LOG"',
    "scontrol": "printf 'node-a\\nnode-b\\n'",
    "srun": 'while [[ $1 == --* ]]; do shift; done; exec "$@"',
    "ray": 'echo "ray $*" >> "$LOG"; exec sleep 60',
    "python": 'grep -c "^ray" "$LOG" || true',
}


def submitted(folder: Path, **slurm: str) -> list[str]:
    """What the script ran where Slurm had started it with these variables, in order."""
    for name, text in FAKES.items():
        fake = folder / name
        fake.write_text(f"#!/bin/bash\n{text}\n")
        fake.chmod(0o755)
    log = folder / "log"
    log.touch()
    given = {**os.environ, **slurm, "LOG": str(log), "PATH": f"{folder}:{os.environ['PATH']}"}
    subprocess.run(["bash", str(SCRIPT), "grid.yaml", "out"], env=given, check=True, timeout=120)
    return log.read_text().splitlines()


def test_one_node_works_with_as_many_processes_as_it_has_cores(tmp_path: Path) -> None:
    ran = submitted(tmp_path, SLURM_JOB_NUM_NODES="1", SLURM_CPUS_PER_TASK="16")
    assert ran == ["coopera benchmark grid.yaml --workers 16 --out out"]


def test_several_nodes_are_joined_before_the_grid_begins_and_let_go_after_it(tmp_path: Path) -> None:
    ran = submitted(
        tmp_path,
        SLURM_JOB_NUM_NODES="2",
        SLURM_CPUS_PER_TASK="8",
        SLURM_JOB_ID="1042",
        SLURM_JOB_NODELIST="node-[a-b]",
    )
    assert ran == [
        "ray start --block --num-cpus=8 --head --port=6421",
        "ray start --block --num-cpus=8 --address=node-a:6421",
        "coopera benchmark grid.yaml --ray node-a:6421 --out out",
    ]
