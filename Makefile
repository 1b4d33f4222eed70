# Everything a newcomer needs: `make run` and `make test` set up .venv on first use.
PYTHON ?= python3.11
# Passed to pip. For a GPU build of torch see README, "Set-up".
PIP_ARGS ?=
BIN := .venv/bin
READY := .venv/ready

.PHONY: run test check bench clean

run: $(READY)
	$(BIN)/coopera run $(ARGS)

test: $(READY)
	$(BIN)/pytest -n 2 --dist worksteal $(ARGS)

check: $(READY)
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/mypy
	$(BIN)/lint-imports
	$(BIN)/python -m tests.house
	$(BIN)/pytest -n 2 --dist worksteal $(ARGS)

bench: $(READY)
	$(BIN)/python -m benchmarks.classifier
	$(BIN)/python -m benchmarks.memory_stream
	$(BIN)/python -m benchmarks.learning
	$(BIN)/python -m benchmarks.home

# torch comes first and pinned, so that nothing that depends on it brings another build.
$(READY): pyproject.toml constraints.txt
	$(PYTHON) -m venv .venv
	$(BIN)/python -m pip install -q --disable-pip-version-check $(PIP_ARGS) -c constraints.txt torch
	$(BIN)/python -m pip install -q --disable-pip-version-check $(PIP_ARGS) -c constraints.txt -e '.[dev]'
	touch $(READY)

clean:
	rm -rf .venv
