# The one list of commands. Each sets up .venv itself; nothing but Python 3.11+ and make is needed.
PYTHON ?= python3
JOBS ?= 2
VENV := .venv
BIN := $(VENV)/bin
# Parallelism is over processes; threads inside them would only compete.
export OMP_NUM_THREADS ?= 1
export OPENBLAS_NUM_THREADS ?= 1

.PHONY: study test sweep check bench calibration blind notebooks docs clean

study: $(VENV)/.installed ## discover on the shipped campaign; prints the verdict and the report's path
	@$(BIN)/inerter discover # its files are small: one process has read them before others have begun

test: $(VENV)/.installed-dev ## all tests and doctests but the sweeps
	$(BIN)/python -m pytest -n $(JOBS) --dist worksteal -m 'not sweep'

sweep: $(VENV)/.installed-dev ## a part of make calibration and make blind, held to their bars, and what takes long alone
	$(BIN)/python -m pytest -n $(JOBS) --dist loadfile --no-loadscope-reorder -m sweep tests # a study that tests share is made once

check: $(VENV)/.installed-dev ## style, types and layers
	$(BIN)/ruff check .
	$(BIN)/mypy
	$(BIN)/lint-imports

bench: $(VENV)/.installed-dev ## times and errors beside other packages; keeps the table
	$(BIN)/python -m tests.benchmarks

calibration: $(VENV)/.installed-dev ## the calibration study of structures; a run that was stopped goes on from build/
	$(BIN)/python -m tests.calibration.structures --jobs $(JOBS)

blind: $(VENV)/.installed-dev ## the blind study of missing effects, both sets; a run that was stopped goes on from build/
	$(BIN)/python -m tests.calibration.gap --set both --jobs $(JOBS)

notebooks: $(VENV)/.installed-notebooks ## run every notebook and keep its pictures
	printf '%s\n' notebooks/*.ipynb | xargs -P $(JOBS) -n 1 $(BIN)/jupyter nbconvert --to notebook --execute --inplace

docs: $(VENV)/.installed-docs ## the documentation's pages, in build/docs; a warning stops it
	$(BIN)/python -m sphinx -W --keep-going -q -E -d build/doctrees docs build/docs
	@echo build/docs/index.html

clean: ## remove the environment and caches
	rm -rf $(VENV) build dist .pytest_cache .mypy_cache .ruff_cache .import_linter_cache

$(BIN)/python:
	$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11) and "Python 3.11 or newer is needed, found " + sys.version.split()[0] + "; set PYTHON=...")'
	$(PYTHON) -m venv $(VENV)

$(VENV)/.installed: pyproject.toml | $(BIN)/python
	$(BIN)/python -m pip install --quiet --disable-pip-version-check -e .
	@touch $@

$(VENV)/.installed-dev: pyproject.toml | $(BIN)/python
	$(BIN)/python -m pip install --quiet --disable-pip-version-check -e '.[dev]'
	@touch $@ $(VENV)/.installed

$(VENV)/.installed-docs: pyproject.toml | $(BIN)/python
	$(BIN)/python -m pip install --quiet --disable-pip-version-check -e '.[docs]'
	@touch $@ $(VENV)/.installed

$(VENV)/.installed-notebooks: pyproject.toml | $(BIN)/python
	$(BIN)/python -m pip install --quiet --disable-pip-version-check -e '.[notebooks]'
	@touch $@ $(VENV)/.installed
