"""The measures that ship: each file here is one, found by its name (see `coopera.evaluation.measuring`)."""
