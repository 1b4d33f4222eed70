"""The measures of success that ship. Each file here is one, found by its name (`coopera.evaluation.measuring`)."""
