# Every target works alone on a fresh machine: it makes .venv and installs what it needs, first.
# Another interpreter or place:  make PYTHON=python3.12 VENV=/tmp/arkanoid train

VENV ?= .venv
BIN = $(VENV)/bin
RAY_VENV ?= build/ray
# (Refused in a variable's value: there another make reads over it, and on to its own message.)
COLON = :
CHECKED := $(if $(filter-out 1,$(words $(VENV))$(findstring $(COLON),$(VENV))),\
	$(error VENV must be a path without spaces and colons, but is '$(VENV)'))
# The first Python that is new enough.
PYTHON ?= $(shell for python in python3 python3.14 python3.13 python3.12 python3.11 python; do \
	$$python -c 'import sys; sys.exit(sys.version_info < (3, 11))' 2>/dev/null \
	&& echo $$python && break; done)
# An environment that was interrupted while it was made, or is another tool's, may lack pip.
INSTALL = $(BIN)/python -c 'import pip' 2>/dev/null || $(BIN)/python -m ensurepip; \
	$(BIN)/python -m pip install --constraint constraints.txt --editable
# What decides which packages are installed, and what an editable install remembers.
REQUIREMENTS = pyproject.toml constraints.txt version.py

.DEFAULT_GOAL = help
.PHONY: help train test lint types format docs check distcheck bench compat ray clean

help:  ## Show the targets
	@awk -F ':.*## ' '/^[a-z]+:.*## / { printf "make %-9s %s\n", $$1, $$2 }' Makefile

train: $(VENV)/train  ## Train an agent for about two minutes, and show how it does
	$(BIN)/arkanoid train quick

test: $(VENV)/dev  ## Run the tests (PYTEST="-k paddle" passes options on)
	$(BIN)/python -m pytest -n 2 $(PYTEST)

lint: $(VENV)/dev  ## Check style and format
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .

# A type checker finds a package by the name of its folder, and a clone's may be any: so a folder
# `arkanoid` with links to the packages is made (where there are no links, with copies).
types: $(VENV)/dev  ## Check types
	rm -rf build/types && mkdir -p build/types/arkanoid
	for name in py.typed *.py */__init__.py; do \
		name=$${name%/__init__.py}; ln -s "../../../$$name" build/types/arkanoid || \
			cp -R "$$name" build/types/arkanoid || exit; done
	$(BIN)/mypy
	$(BIN)/basedpyright --pythonpath $(BIN)/python

format: $(VENV)/dev  ## Put the sources into format, mend what can be mended
	$(BIN)/ruff check --fix .
	$(BIN)/ruff format .

# The same for what is published, each installed in a fresh environment.
distcheck: $(VENV)/dev  ## Build wheel and sdist, and run the tests against each
	$(BIN)/python tests/distributions.py $(PYTEST)

docs: $(VENV)/docs  ## Make the documentation's site, build/docs/index.html
	$(BIN)/sphinx-build -W --keep-going -q -E -c docs/site -d build/doctrees docs build/docs
	$(BIN)/python docs/site/check_links.py build/docs

check: lint types docs test  ## All of lint, types, docs and test

bench: $(VENV)/bench  ## Run the benchmarks
	for benchmark in tests/benchmarks/*.py; do $(BIN)/python $$benchmark || exit; done

compat: $(VENV)/dev  ## Try the environment with every trainer, each installed apart (PEER=torchrl)
	$(BIN)/python tests/compat/run.py $(PEER)

# RLlib wants a Gymnasium of its own, and so an environment of its own.
ray:  ## Train with RLlib on several processes and two nodes, and measure it (RAY="scaling")
	$(MAKE) VENV=$(RAY_VENV) $(RAY_VENV)/ray
	$(RAY_VENV)/bin/python tests/cluster/run.py $(RAY)

clean:  ## Remove what was built and installed (not runs/)
	rm -rf $(VENV) build dist *.egg-info .hypothesis .mypy_cache .pytest_cache .ruff_cache
	find . -name __pycache__ -type d -prune -exec rm -rf {} +

$(VENV)/train: $(REQUIREMENTS) | $(BIN)/python
	$(INSTALL) '.[train,play]'
	touch $@

$(VENV)/dev: $(REQUIREMENTS) | $(BIN)/python
	$(INSTALL) '.[dev]'
	touch $@ $(VENV)/train

$(VENV)/docs: $(REQUIREMENTS) | $(BIN)/python
	$(INSTALL) '.[docs]'
	touch $@

$(VENV)/bench: $(REQUIREMENTS) | $(BIN)/python
	$(INSTALL) '.[bench]'
	touch $@

$(VENV)/ray: pyproject.toml constraints-ray.txt version.py | $(BIN)/python
	$(INSTALL:constraints.txt=constraints-ray.txt) '.[ray,train]'
	touch $@

# Another make than GNU's takes the sign of an order-only prerequisite for a file, and makes it.
|:
	@echo 'This Makefile needs GNU make; where make is another, GNU make is often called gmake.' \
		>&2; exit 1

$(BIN)/python:
	@test -n '$(PYTHON)' || { echo 'arkanoid needs Python 3.11 or newer, and none was found.' \
		'Install one, or name it: make PYTHON=/path/to/python3.12 $(MAKECMDGOALS)' >&2; exit 1; }
	@$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11))' 2>/dev/null || { \
		echo 'arkanoid needs Python 3.11 or newer; $(PYTHON) is older or missing.' \
		'Name another: make PYTHON=/path/to/python3.12 $(MAKECMDGOALS)' >&2; exit 1; }
	@$(PYTHON) -c 'import ensurepip, venv' 2>/dev/null || { \
		echo '$(PYTHON) lacks the venv module: install it (Debian, Ubuntu: apt install' \
		'python3-venv), or name another Python: make PYTHON=/path/to/python3.12 $(MAKECMDGOALS)' >&2; \
		exit 1; }
	$(PYTHON) -m venv $(VENV)
