"""The viewer: a folder of runs and benchmarks as pages, from a small server or as files that need none.

`site` answers every address; the page of each kind is made in a module of its own, from `desk` and `shelf`.
"""
