"""How fast and how exact is the memory? `python -m benchmarks.memory_stream [--quick] [--store DIR] [--out FILE]`.

One run measures everything that is compared. Calls on the different sizes alternate, so that a busy machine slows all
of them alike; first ours among themselves, then the rivals, which sweep the processor's caches. Records are six per
waking hour, thirteen hours a day, so that a million are 35 years; their texts are drawn from 4,000 with MiniLM vectors
of household sentences, since people say the same again and again. Texts are encoded beforehand: what is timed is the
recall with its texts (or the baseline's answer), not the encoding. Times are milliseconds of processor, of all threads
of the process, and by the clock.

Baselines, each asked the same questions about the same records:
- `brute force`: score every record in numpy, float32, vectors in RAM;
- `LangChain`: TimeWeightedVectorStoreRetriever over Chroma (needs `pip install langchain-classic langchain-chroma`;
  skipped with a word if they are not there), up to `--langchain-most` records, each of which is a vector in its index.
  A size to which its index has not grown after `--langchain-minutes` of processor is left out, and the run says so.
  What it rewrites in reading is put back before each question;
- `encode everything`: encode the whole history at each question, as the paper's published code does. Measured on 60
  records; for other sizes that time is scaled, and marked so.
"""

from __future__ import annotations

import argparse
import itertools
import json
import shutil
import tempfile
import time
from collections.abc import Callable, Sequence
from datetime import datetime, timedelta
from importlib import import_module
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt
from langchain_core.documents import Document
from langchain_core.embeddings import Embeddings
from typing_extensions import override

from coopera.memory import MemoryStream, Record, bundled
from coopera.memory.embeddings import unit
from coopera.memory.minilm import Vector, shared
from coopera.memory.scan import ArrayRows, top

DECAY = 0.95
K = 5
IN_PROCESS = "ours in process"
LONG_AGO = "ours, of a day long ago"
NAMES = ("ours", IN_PROCESS, LONG_AGO, "brute force", "LangChain", "encode everything")
WARM_UP, SLOW_ROUNDS = 2, 40
PER_HOUR, HOURS_PER_DAY = 6, 13
PAGE, DIFFERENT = 4000, 4000
ACTIVITIES = (
    "make a cup of tea", "read a novel", "water the plants", "cook pasta for dinner", "play the guitar",
    "do some yoga", "clean the kitchen counter", "write in a diary", "watch a film", "fold the laundry",
    "call a friend", "paint a landscape", "repair a radio", "bake bread", "feed the cat", "take a nap",
    "sort old photographs", "study for an exam", "lift weights", "plan the week",
)  # fmt: skip
DETAILS = (
    "in the kitchen", "on the sofa", "by the window", "at the desk", "in the living room", "before breakfast",
    "after lunch", "slowly and with care", "in a hurry", "with some music", "to relax", "to be kind to a guest",
    "while it rains", "with the door open", "once more", "for the first time", "with a favourite mug",
    "in silence", "late in the day", "as every week",
)  # fmt: skip
QUESTIONS = (
    "something warm to drink", "physical exercise", "a quiet evening", "tidy up the home", "creative hobby",
    "prepare a meal", "care for animals and plants", "learn something new", "contact with other people", "rest",
)  # fmt: skip


class Prepared(Embeddings):
    """Embeddings looked up by the text's number ("… #17"): sentences that repeat, each a little different."""

    model_id, dimension = "benchmark", 384

    def __init__(self, sentences: Vector, questions: dict[str, Vector]) -> None:
        rng = np.random.default_rng(0)
        chosen = sentences[rng.integers(0, len(sentences), DIFFERENT)]
        noise = 0.01 * rng.standard_normal(chosen.shape).astype(np.float32)
        self.vectors: Vector = unit(chosen + noise, [""] * DIFFERENT)
        self._questions = questions

    @override
    def embed_documents(self, texts: list[str]) -> list[list[float]]:
        if texts[0] in self._questions:
            return [self._questions[text].tolist() for text in texts]
        vectors: list[list[float]] = self.vectors[[int(text.rpartition("#")[2]) for text in texts]].tolist()
        return vectors

    @override
    def embed_query(self, text: str) -> list[float]:
        return self.embed_documents([text])[0]


def said(size: int) -> npt.NDArray[np.int64]:
    """The number of each record's text, the same for each size as far as it goes; shape (size,)."""
    return np.random.default_rng(1).integers(0, DIFFERENT, size)


def exactly(rows: ArrayRows, query: Vector, now: int) -> list[int]:
    """Return the best records' positions by the windowed scan."""
    return [hit.position for hit in top(rows, query, K, now=now, decay=DECAY).hits]


def hour_of(number: int) -> int:
    """Return the hour of a record: nights pass without records."""
    day, within = divmod(number, PER_HOUR * HOURS_PER_DAY)
    return day * 24 + 9 + within // PER_HOUR


class Spent(NamedTuple):
    """Milliseconds of processor and by the clock."""

    cpu: float
    clock: float


def spent(ask: Callable[[], Any]) -> tuple[Spent, Any]:
    """What a call takes, and what it returns."""
    cpu, clock = time.process_time(), time.perf_counter()
    answer = ask()
    return Spent((time.process_time() - cpu) * 1e3, (time.perf_counter() - clock) * 1e3), answer


def summary(times: Sequence[Spent]) -> dict[str, float]:
    """Medians, and the 95th percentile by the clock."""
    cpu, clock = zip(*times, strict=True)
    return {
        "cpu_ms": round(float(np.median(cpu)), 3),
        "p50_ms": round(float(np.median(clock)), 3),
        "p95_ms": round(float(np.percentile(clock, 95)), 3),
    }


def build(folder: Path, size: int, embeddings: Prepared) -> tuple[MemoryStream, dict[str, float]]:
    """Return an open stream of `size` records, made if it is not there, and how fast it was made and opened."""
    took: dict[str, float] = {}
    path = folder / str(size)
    with MemoryStream.open(path, "life", embeddings, DECAY) as stream:
        missing = range(len(stream), size, PAGE)
        texts, start = said(size), time.process_time()
        for page in missing:
            numbers = range(page, min(page + PAGE, size))
            stream.extend([Record(f"record #{texts[n]}", hour_of(n), {"number": n}) for n in numbers])
        if missing:
            took["inserted_per_cpu_s"] = round((size - missing[0]) / (time.process_time() - start))
    opened, stream = spent(lambda: MemoryStream.open(path, "life", embeddings, DECAY))
    took["open_cpu_ms"] = round(opened.cpu)
    took["mb_on_disk"] = round(sum(file.stat().st_size for file in path.rglob("*") if file.is_file()) / 1e6, 1)
    return stream, took


def brute_force(vectors: Vector, hours: np.ndarray, query: Vector, now: int) -> list[int]:
    """Score everything; return the positions of the best."""
    scores = (vectors @ query) * DECAY ** (now - hours)
    best = np.argpartition(scores, -K)[-K:]
    return [int(place) for place in best[np.argsort(-scores[best])]]


def langchain_retriever(
    folder: Path, size: int, embeddings: Prepared, minutes: float
) -> tuple[Callable[[str], list[int]], Callable[[], None]] | str:
    """Return two functions: one asks LangChain's retriever, one undoes what reading changed; or why there are none."""
    try:
        retrievers: Any = import_module("langchain_classic.retrievers")
        store: Any = import_module("langchain_chroma")
    except ModuleNotFoundError:
        return "not installed (langchain-classic, langchain-chroma)"
    chroma = store.Chroma(
        f"langchain-{size}",
        embeddings,
        persist_directory=str(folder / f"langchain-{size}"),
        collection_metadata={"hnsw:space": "cosine"},
    )
    now = datetime.now()
    last = hour_of(size - 1) + 1
    documents = []
    for number, text in enumerate(said(size).tolist()):
        when = now - timedelta(hours=last - hour_of(number))
        documents.append(Document(f"record #{text}", metadata={"buffer_idx": number, "last_accessed_at": when}))
    began, there = time.process_time(), chroma._collection.count()
    for start in range(there, size, PAGE):
        if (spent_s := time.process_time() - began) > 60 * minutes:
            return (
                f"stopped at {start:,} records after {spent_s / 60:.1f} min of processor for {start - there:,} of them"
            )
        page = documents[start : start + PAGE]
        chroma.add_texts([d.page_content for d in page], [{"buffer_idx": d.metadata["buffer_idx"]} for d in page])
    if there < size:
        filled = time.process_time() - began
        print(f"LangChain's with {size:,} records: filled in {filled:.0f} s of processor", flush=True)
    retriever = retrievers.TimeWeightedVectorStoreRetriever(
        vectorstore=chroma, decay_rate=1 - DECAY, k=K, memory_stream=documents
    )
    times = [document.metadata["last_accessed_at"] for document in documents]
    changed: list[int] = []

    def ask(query: str) -> list[int]:
        changed[:] = [document.metadata["buffer_idx"] for document in retriever.invoke(query)]
        return list(changed)

    def undo() -> None:
        for number in changed:
            documents[number].metadata["last_accessed_at"] = times[number]

    return ask, undo


def encode_everything_ms() -> float:
    """Return the ms per record of encoding the history at each question, measured on 60 records."""
    texts = [f"{activity} {detail}" for activity, detail in itertools.product(ACTIVITIES[:6], DETAILS[:10])]
    encode = shared().encode
    encode("warm up")
    return spent(lambda: [encode(text) for text in texts])[0].cpu / len(texts)


class Race:
    """Asks all contestants the same questions in turns."""

    def __init__(self, folder: Path, sizes: list[int], langchain_most: int, langchain_minutes: float) -> None:
        """Build what is missing."""
        texts = [f"{activity} {detail}" for activity, detail in itertools.product(ACTIVITIES, DETAILS)]
        with bundled(folder / "embeddings.sqlite") as plain:
            sentences = plain.array(texts)
            self.questions = dict(zip(QUESTIONS, plain.array(QUESTIONS), strict=True))
        self.sizes = sizes
        embeddings = Prepared(sentences, self.questions)
        self.streams: dict[int, MemoryStream] = {}
        self.built: dict[int, dict[str, Any]] = {}
        for size in sizes:
            self.streams[size], self.built[size] = build(folder, size, embeddings)
            print(f"{size} records: {self.built[size]}", flush=True)
        self.vectors = embeddings.vectors[said(max(sizes))]
        self.hours = np.array([hour_of(number) for number in range(max(sizes))], np.int64)
        some = [size for size in sizes if size <= langchain_most]
        self.rivals = {size: langchain_retriever(folder, size, embeddings, langchain_minutes) for size in some}
        self.without = dict.fromkeys({*sizes} - {*some}, f"more than {langchain_most:,} were not asked for")
        self.without |= {size: rival for size, rival in self.rivals.items() if isinstance(rival, str)}
        for size, reason in sorted(self.without.items()):
            print(f"LangChain's with {size:,} records is skipped: {reason}", flush=True)
        self.times: dict[tuple[str, int], list[Spent]] = {}
        self.found: dict[tuple[str, int], list[float]] = {}

    def run(self, rounds: int) -> dict[str, Any]:
        """Ask, and return the figures; the first two rounds warm up."""
        for ask in (self._ask_in_process, self._ask_ours, self._ask_long_ago, self._ask_rivals):
            for number in range(rounds + WARM_UP):
                for size in self.sizes[:: 1 if number % 2 else -1]:
                    ask(number, size)
        result: dict[str, Any] = {"streams": dict(self.built), "rounds": rounds, "without LangChain": self.without}
        for (name, size), values in sorted(self.times.items()):
            found = round(float(np.mean(self.found[name, size])), 3)
            result["streams"][size][name] = {**summary(values[WARM_UP:]), "recall_at_5": found}
        per_record = encode_everything_ms()
        for size, stream in self.streams.items():
            result["streams"][size]["encode everything"] = {"cpu_ms": round(per_record * size, 1)}
            stream.close()
        return result

    def _question(self, number: int, size: int) -> tuple[str, int, list[int]]:
        """Return a round's question, when it is asked (an hour before the last one), and the right answer."""
        question = QUESTIONS[number % len(QUESTIONS)]
        now = hour_of(size - 1) + 1 - number % 200
        return question, now, exactly(self._rows(size), self.questions[question], now)

    def _rows(self, size: int) -> ArrayRows:
        return ArrayRows(self.vectors[:size], self.hours[:size])

    def _ask_in_process(self, number: int, size: int) -> None:
        question, now, answer = self._question(number, size)
        rows, query = self._rows(size), self.questions[question]
        self._turn(IN_PROCESS, size, answer, lambda: exactly(rows, query, now))

    def _ask_ours(self, number: int, size: int) -> None:
        recall = self.streams[size].recall
        question, now, answer = self._question(number, size)
        self._turn("ours", size, answer, lambda: [one.metadata["number"] for one in recall(question, now, K)])

    def _ask_long_ago(self, number: int, size: int) -> None:
        recall = self.streams[size].recall
        past = int(np.random.default_rng(number).integers(24, hour_of(size - 1)))
        question = QUESTIONS[number % len(QUESTIONS)]
        answer = exactly(self._rows(size), self.questions[question], past)
        self._turn(LONG_AGO, size, answer, lambda: [one.metadata["number"] for one in recall(question, past, K)])

    def _ask_rivals(self, number: int, size: int) -> None:
        if number >= SLOW_ROUNDS:
            return
        question, now, answer = self._question(number, size)
        query = self.questions[question]
        end = int(np.searchsorted(self.hours[:size], now, "right"))
        vectors, hours = self.vectors[:end], self.hours[:end]
        self._turn("brute force", size, answer, lambda: brute_force(vectors, hours, query, now))
        rival = self.rivals.get(size)
        if rival is not None and not isinstance(rival, str):  # it knows no other time than the present
            ask, undo = rival
            present = exactly(self._rows(size), query, hour_of(size - 1) + 1)
            self._turn("LangChain", size, present, lambda: ask(question))
            undo()

    def _turn(self, name: str, size: int, exact: list[int], ask: Callable[[], list[int]]) -> None:
        """Ask one contestant, and note what it took and how many of the best it found."""
        took, answer = spent(ask)
        self.times.setdefault((name, size), []).append(took)
        self.found.setdefault((name, size), []).append(len({*answer} & {*exact}) / K)


def report(result: dict[str, Any], sizes: list[int]) -> dict[str, float]:
    """Print the table; return the ratios that the project promises, of processor time."""
    print(f"\n{'records':>9} " + " ".join(f"{name + ' (recall@5)':>28}" for name in NAMES))
    for size, row in result["streams"].items():
        cells = []
        for name in NAMES:
            entry = row.get(name, {})
            share = f" ({entry['recall_at_5']:.2f})" if "recall_at_5" in entry else " (scaled)"
            cells.append(f"{entry['cpu_ms']:.3f}{share}" if entry else "-")
        print(f"{size:>9} " + " ".join(f"{cell:>28}" for cell in cells))
    took = {
        (name, size): row[name]["cpu_ms"] for size, row in result["streams"].items() for name in NAMES if name in row
    }
    ratios = {}
    for name, measure in (("growth", "ours"), ("growth in process", IN_PROCESS)):
        ratios[name] = round(took[measure, sizes[-1]] / took[measure, sizes[0]], 3)
    for name in ("brute force", "LangChain"):
        for size in sizes:
            if (name, size) in took:
                ratios[f"{name} / ours at {size}"] = round(took[name, size] / took["ours", size], 1)
    for name, ratio in ratios.items():
        print(f"{name}: {ratio}")
    return ratios


def main() -> None:
    """Parse the command line, measure, print and perhaps write."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--quick", action="store_true", help="up to 100,000 records, and 10,000 of LangChain's")
    parser.add_argument("--rounds", type=int, default=200, help="questions per size")
    parser.add_argument("--sizes", type=int, nargs="+", help="numbers of records, the least first")
    parser.add_argument("--langchain-most", type=int, help="records [default: 100,000]")
    parser.add_argument("--langchain-minutes", type=float, default=15, help="of processor, to fill its index at a size")
    parser.add_argument("--store", type=Path, help="folder that keeps the stores for another run")
    parser.add_argument("--out", type=Path, help="JSON file for the figures")
    given = parser.parse_args()
    sizes = given.sizes or [1000, 10_000, 100_000, *([] if given.quick else [1_000_000])]
    most = given.langchain_most or (10_000 if given.quick else 100_000)
    folder = given.store or Path(tempfile.mkdtemp(prefix="memory-benchmark-"))
    try:
        result = Race(folder, sizes, most, given.langchain_minutes).run(given.rounds)
        result["ratios"] = report(result, sizes)
        if given.out:
            given.out.write_text(json.dumps(result, indent=1))
    finally:
        if given.store is None:
            shutil.rmtree(folder)


if __name__ == "__main__":
    main()
