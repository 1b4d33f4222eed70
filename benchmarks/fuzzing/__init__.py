"""What `benchmarks.fuzz` tries: readers of files from elsewhere, some good files for each, and how to change them.

A module for each kind of file names its readers in `READERS`; `kit` says what a reader is, `mutations` changes bytes.
"""

from benchmarks.fuzzing import bodies, homes, imports, models, people, runs, shapes, studies
from benchmarks.fuzzing.kit import Reader

READERS: dict[str, Reader] = {
    **people.READERS,
    **studies.READERS,
    **homes.READERS,
    **bodies.READERS,
    **shapes.READERS,
    **imports.READERS,
    **models.READERS,
    **runs.READERS,
}
"""All of them by name."""
