"""Where a robot's help is lost, from the trace of its run."""
