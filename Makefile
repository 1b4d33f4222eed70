# Everything a newcomer needs: `make run` and `make test` set up .venv on first use.
VENV ?= .venv
# The newest Python that really runs and will do, or the one that you name: `make test PYTHON=python3.12`.
PYTHON ?= $(shell for one in python3.13 python3.12 python3.11 python3; do $$one $(WILL_DO) && echo $$one && break; done)
WILL_DO = -c 'import ensurepip, sys; sys.exit(not (3, 11) <= sys.version_info < (3, 14))' 2>/dev/null
NO_PYTHON = "Python 3.11, 3.12 or 3.13 is needed, with venv (Debian: python3-venv): install it, or name it by PYTHON=FILE."
# Passed to pip. For a GPU build of torch see README, "Set-up".
PIP_ARGS ?=
BIN := $(VENV)/bin
READY := $(VENV)/ready
# With what tests and measurements need besides.
ALL_READY := $(VENV)/ready-to-test

.PHONY: run test check bench bench-learning audit clean

run: $(READY)
	$(BIN)/coopera run $(ARGS)

test: $(ALL_READY)
	$(BIN)/pytest -n 2 --dist worksteal $(ARGS)

check: $(ALL_READY)
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/mypy
	$(BIN)/lint-imports
	$(BIN)/python -m tests.house
	$(BIN)/pytest -n 2 --dist worksteal $(ARGS)

bench: $(ALL_READY)
	$(BIN)/python -m benchmarks.speed --out docs/performance.md $(ARGS)

# What is learned by whom, and what a robot does of what it is told: hours, of which speed is the least.
bench-learning: $(ALL_READY)
	$(BIN)/python -m benchmarks.home
	$(BIN)/python -m benchmarks.learning
	$(BIN)/python -m benchmarks.classifier

# Known weaknesses of what is installed: asked of the index, or, offline, of a copy of OSV's list
# (https://osv-vulnerabilities.storage.googleapis.com/PyPI/all.zip): make audit ADVISORIES=all.zip
audit: $(READY)
ifdef ADVISORIES
	$(BIN)/python -m benchmarks.audit constraints.txt $(ADVISORIES)
else
	$(PYTHON) -m venv $(VENV)-audit
	$(VENV)-audit/bin/python -m pip install -q --disable-pip-version-check pip-audit
	$(VENV)-audit/bin/pip-audit -r constraints.txt --no-deps --disable-pip --progress-spinner off
endif

# torch comes first and pinned, so that nothing that depends on it brings another build.
$(READY): pyproject.toml constraints.txt
	@$(BIN)/python $(WILL_DO) || $(or $(PYTHON),false) $(WILL_DO) || { echo $(NO_PYTHON) >&2; exit 1; }
	$(BIN)/python $(WILL_DO) || $(PYTHON) -m venv --clear $(VENV)
	$(BIN)/python -m pip install -q --disable-pip-version-check $(PIP_ARGS) -c constraints.txt torch
	$(BIN)/python -m pip install -q --disable-pip-version-check $(PIP_ARGS) -c constraints.txt -e .
	touch $(READY)

$(ALL_READY): $(READY)
	$(BIN)/python -m pip install -q --disable-pip-version-check $(PIP_ARGS) -c constraints.txt -e '.[dev]'
	touch $(ALL_READY)

clean:
	rm -rf $(VENV) $(VENV)-audit
