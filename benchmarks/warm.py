"""What a process has done once it is warm: imported all that a run needs, and read what is shipped.

To be imported by the server of processes of `benchmarks.one_life` before it forks one. Nothing is computed or opened
here, since threads and connections do not outlive a fork.
"""

from importlib import import_module

from coopera.models.offline.household.knowledge import robots, shipped

for name in (
    "chromadb.api.rust",
    "coopera.commands.run",
    "coopera.report.page",
    "coopera.studies.study",
    "langgraph.checkpoint.sqlite",
    "pybullet_data",
    "sklearn.feature_extraction.text",
    "sklearn.linear_model",
):
    import_module(name)
shipped()
robots()
