"""What users install: one package under one name, whatever folders lie beside their own scripts."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import tarfile
import zipfile
from pathlib import Path

import pytest

from coopera import __version__

ROOT = Path(__file__).parents[1]
ROOMS = ("core", "evaluation", "graphs", "memory", "models", "prompts", "simulation")
SCRIPT = """
import sys
from pathlib import Path

import coopera, core, graphs, memory, models
from coopera import Config, run_study

assert core.MINE and graphs.MINE and memory.MINE and models.MINE
assert Path(coopera.__file__).is_relative_to(sys.argv[1]), coopera.__file__
summary = run_study(Config(days=1, hours=1, pictures="none", out=Path("run")))
assert summary["failed_hours"] == 0 and len(summary["days"]) == 1
"""


@pytest.fixture(scope="module")
def built(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with the wheel and the source distribution of what git would take (links as links)."""
    copy, dist = tmp_path_factory.mktemp("source"), tmp_path_factory.mktemp("dist")
    listed = subprocess.run(
        ["git", "ls-files", "-z", "--cached", "--others", "--exclude-standard"],
        cwd=ROOT,
        capture_output=True,
        check=True,
    )
    for name in filter(None, listed.stdout.decode().split("\0")):
        if (ROOT / name).exists():
            (copy / name).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy2(ROOT / name, copy / name, follow_symlinks=False)
    command = [sys.executable, "-m", "build", "--no-isolation", "--outdir", str(dist), str(copy)]
    subprocess.run(command, check=True, capture_output=True)
    return dist


@pytest.fixture(scope="module")
def installed(built: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder that holds what the wheel installs, and nothing else."""
    site = tmp_path_factory.mktemp("site")
    with zipfile.ZipFile(next(built.glob("*.whl"))) as wheel:
        wheel.extractall(site)
    return site


def test_the_wheel_brings_one_name_and_all_data_files(installed: Path) -> None:
    assert {path.name for path in installed.iterdir()} == {"coopera", f"coopera-{__version__}.dist-info"}
    tracked = {path.relative_to(ROOT) for room in ROOMS for path in (ROOT / room).rglob("*") if path.is_file()}
    wanted = {path for path in tracked if "__pycache__" not in path.parts}
    assert {path for path in wanted if not (installed / "coopera" / path).is_file()} == set()
    assert (installed / "coopera" / "py.typed").is_file()


def test_the_source_distribution_has_docs_examples_and_pins(built: Path) -> None:
    with tarfile.open(next(built.glob("*.tar.gz"))) as archive:
        names = {name.partition("/")[2] for name in archive.getnames()}
        assert not [member.name for member in archive.getmembers() if member.issym()]
    assert {"constraints.txt", "docs/memory.md", "examples/world_api.py", "Makefile", "coopera/graphs/day.py"} <= names


def test_folders_of_somebody_else_with_our_rooms_names_do_not_matter(
    installed: Path, tmp_path: Path, data_dir: Path
) -> None:
    for name in ("graphs", "memory", "models"):
        (tmp_path / name).mkdir()
        (tmp_path / name / "__init__.py").write_text("MINE = True\n")
    (tmp_path / "core.py").write_text("MINE = True\n")
    (tmp_path / "script.py").write_text(SCRIPT)
    environment = {**os.environ, "PYTHONPATH": str(installed), "COOPERA_DATA_DIR": str(data_dir)}
    done = subprocess.run(
        [sys.executable, "script.py", str(installed)],
        cwd=tmp_path, env=environment, capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr


def test_in_a_clone_a_room_under_its_folders_name_gives_the_very_same_objects() -> None:
    code = (
        "import graphs, coopera.graphs, simulation, coopera.simulation\n"
        "assert graphs.build_day_graph is coopera.graphs.build_day_graph\n"
        "from simulation import World; assert World is coopera.simulation.World\n"
        "try:\n    import graphs.day\nexcept ModuleNotFoundError:\n    pass\n"
        "else:\n    raise AssertionError('a second copy of graphs.day was loaded')\n"
    )
    subprocess.run([sys.executable, "-c", code], cwd=ROOT, check=True)


def test_a_copy_that_lost_its_links_says_so_in_one_sentence(tmp_path: Path) -> None:
    (tmp_path / "coopera").mkdir()
    shutil.copy(ROOT / "coopera" / "__init__.py", tmp_path / "coopera")
    (tmp_path / "coopera" / "core").write_text("../core")
    done = subprocess.run(
        [sys.executable, "-S", "-c", "import coopera"], cwd=tmp_path, capture_output=True, text=True, check=False
    )
    assert done.stderr.splitlines()[-1].startswith(f"ImportError: {tmp_path / 'coopera' / 'core'} is not the folder")


def test_the_package_lists_its_public_names() -> None:
    code = "import coopera, sys; sys.stdout.write(' '.join(dir(coopera)))"
    said = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True, cwd=ROOT).stdout
    assert {"Config", "RunDir", "check_method", "resume_study", "run_studies", "run_study"} <= set(said.split())
