"""What do other things look like? `python -m benchmarks.looks_alike` writes simulation/homes/looks_alike.yaml.

For each word of `benchmarks/samples/things.txt` that neither the catalogue nor looks.yaml knows, the bundled sentence
encoder finds the words that come nearest in meaning; those nearer than `LEAST` are written. The home reads the table
and needs no encoder. Prints the rows, to be looked at: it is meaning that is compared, not form.
"""

from __future__ import annotations

from pathlib import Path

from coopera.config.schema import default_data_dir
from coopera.memory import Search, bundled
from coopera.simulation.homes import magic_box
from coopera.simulation.homes.catalogue import SHAPES, catalogue

WORDS = Path(__file__).parent / "samples" / "things.txt"
LEAST = 0.6
"""Below this cosine a word is a labelled box."""
HEAD = """# Words for things, and the words of looks.yaml or of the catalogue that come nearest to them in meaning.
# Written by `python -m benchmarks.looks_alike`; edit benchmarks/samples/things.txt or looks.yaml instead.
"""


def main() -> None:
    """Write the table."""
    known = sorted({*(cls.replace("_", " ") for cls in catalogue().movable), *magic_box.looks()})
    words = [word for word in WORDS.read_text(encoding="utf-8").splitlines() if word]
    magic_box.ALIKE.write_text(HEAD, encoding="utf-8")
    magic_box.alike.forget()
    magic_box.shape_of.cache_clear()
    unknown = [word for word in words if magic_box.shape_of(word).cls not in SHAPES]
    rows = []
    with bundled(default_data_dir() / "embeddings.sqlite") as embeddings:
        search = Search(embeddings, known)
        for word in unknown:
            nearest, cosine = search.top(word, 1)[0]
            print(f"{'' if cosine >= LEAST else '-- '}{word}: {nearest} ({cosine:.2f})")
            if cosine >= LEAST:
                rows.append(f"{word}: {nearest}\n")
    magic_box.ALIKE.write_text(HEAD + "".join(rows), encoding="utf-8")
    print(f"{len(words)} words; {len(words) - len(unknown)} known already, {len(rows)} found, the others are boxes")


if __name__ == "__main__":
    main()
