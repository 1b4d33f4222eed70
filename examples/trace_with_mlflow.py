"""Live two hours and look at each graph, node and call of a model as spans in MLflow, which runs on this machine.

.venv/bin/python examples/trace_with_mlflow.py [FOLDER]

MLflow is no dependency: install it in an environment of its own. `mlflow ui --backend-store-uri
sqlite:///FOLDER/mlflow.db` then shows the spans in a browser.
"""

from __future__ import annotations

import sys
import tempfile
from pathlib import Path

import mlflow
from mlflow.langchain.langchain_tracer import MlflowLangchainTracer

from coopera import Config, run_study


def main(folder: Path) -> None:
    """Trace a run into `folder`, and print the calls that took longest."""
    mlflow.set_tracking_uri(f"sqlite:///{folder / 'mlflow.db'}")
    mlflow.set_experiment("coopera")
    config = Config(humans=["amara"], days=1, hours=2, pictures="none", out=folder / "run")
    run_study(config, callbacks=[MlflowLangchainTracer()])
    mlflow.flush_trace_async_logging()
    trace = mlflow.get_trace(mlflow.get_last_active_trace_id())
    calls = [span for span in trace.data.spans if span.span_type == "CHAT_MODEL"]
    print(f"{len(trace.data.spans)} spans, {len(calls)} of them calls of a model; the longest:")
    for span in sorted(calls, key=lambda span: span.start_time_ns - span.end_time_ns)[:5]:
        about = span.attributes["metadata"]
        print(f"{(span.end_time_ns - span.start_time_ns) / 1e6:8.1f} ms  {about['hour']}:00 {span.name}")


if __name__ == "__main__":
    if len(sys.argv) > 1:
        main(Path(sys.argv[1]))
    else:
        with tempfile.TemporaryDirectory() as made:
            main(Path(made))
