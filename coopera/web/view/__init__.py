"""The viewer: a folder of runs and benchmarks as pages, from a small server or as files that need none."""
