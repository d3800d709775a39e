# Every target works on a fresh machine: it makes .venv first, and installs what it needs.
# Another interpreter or place:  make PYTHON=python3.12 VENV=/tmp/arkanoid train

VENV ?= .venv
BIN = $(VENV)/bin
# The first Python that is new enough.
PYTHON ?= $(shell for python in python3 python3.14 python3.13 python3.12 python3.11 python; do \
	$$python -c 'import sys; sys.exit(sys.version_info < (3, 11))' 2>/dev/null \
	&& echo $$python && break; done)
INSTALL = $(BIN)/python -m pip install --constraint constraints.txt --editable
NOX = $(BIN)/python -m nox --noxfile tests/noxfile.py --session
# What decides which packages are installed, and what an editable install remembers.
REQUIREMENTS = pyproject.toml constraints.txt version.py

.DEFAULT_GOAL = help
.PHONY: help train web test lint types format docs check distcheck bench compat ray lock clean

help:  ## Show the targets
	@awk -F ':.*## ' '/^[a-z]+:.*## / { printf "make %-9s %s\n", $$1, $$2 }' Makefile

train: $(VENV)/train  ## Train an agent for about a minute, and show how well it plays
	$(BIN)/arkanoid warm-up
	$(BIN)/arkanoid train quick

web: $(VENV)/web  ## Play in the browser, and watch the trained agents
	$(BIN)/arkanoid web

# Each process begins with a half of the tests, so that most of what a file shares is made once.
test: $(VENV)/dev  ## Run the tests (PYTEST="-k paddle" passes options on)
	$(BIN)/python -m pytest -n 2 --dist worksteal $(PYTEST)

lint: $(VENV)/dev  ## Check style and format, and the files for GitHub
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/check-jsonschema --builtin-schema vendor.github-workflows .github/workflows/*.yml
	$(BIN)/check-jsonschema --builtin-schema vendor.github-issue-forms \
		.github/ISSUE_TEMPLATE/bug.yml .github/ISSUE_TEMPLATE/idea.yml
	$(BIN)/check-jsonschema --builtin-schema vendor.github-issue-config \
		.github/ISSUE_TEMPLATE/config.yml
	$(BIN)/check-jsonschema --builtin-schema vendor.citation-file-format CITATION.cff

# A type checker finds a package by the name of its folder, but a clone may have any name. So this
# makes a folder `arkanoid` with links to the packages; where there are no links, with copies.
types: $(VENV)/dev  ## Check types
	rm -rf build/types && mkdir -p build/types/arkanoid
	for name in py.typed *.py */__init__.py; do \
		name=$${name%/__init__.py}; ln -s "../../../$$name" build/types/arkanoid || \
			cp -R "$$name" build/types/arkanoid || exit; done
	$(BIN)/mypy
	$(BIN)/basedpyright --pythonpath $(BIN)/python

format: $(VENV)/dev  ## Format the sources, and correct what can be corrected automatically
	$(BIN)/ruff check --fix .
	$(BIN)/ruff format .

docs: $(VENV)/docs  ## Build the documentation's site, build/docs/index.html
	rm -rf build/docs # Sphinx keeps old pages
	$(BIN)/sphinx-build -W --keep-going -q -E -c docs/site -d build/doctrees docs build/docs

check: lint types docs test  ## All of lint, types, docs and test

distcheck: $(VENV)/dev  ## Build wheel and sdist, and run the tests against each (PYTEST="-x")
	$(NOX) distcheck -- $(PYTEST)

bench: $(VENV)/bench  ## Run the benchmarks
	for benchmark in tests/benchmarks/*.py; do $(BIN)/python $$benchmark || exit; done

compat: $(VENV)/dev  ## Try the environment with every trainer, each installed apart (PEER=torchrl)
	$(NOX) $(if $(PEER),'compat($(PEER))',compat)

ray: $(VENV)/dev  ## Train with RLlib on several processes and two nodes (RAY="scaling")
	$(NOX) ray -- $(RAY)

lock: $(VENV)/dev  ## Pin the versions that make installs (LOCK=--upgrade for the newest)
	$(NOX) lock -- $(LOCK)

clean:  ## Remove what was built and installed (not runs/)
	rm -rf $(VENV) build dist *.egg-info .hypothesis .mypy_cache .pytest_cache .ruff_cache
	find . -name __pycache__ -type d -prune -exec rm -rf {} +

$(VENV)/train: $(REQUIREMENTS) | $(VENV)/made
	$(INSTALL) '.[train,play]'
	touch $@

$(VENV)/web: $(REQUIREMENTS) | $(VENV)/made
	$(INSTALL) '.[train,web]'
	touch $@

$(VENV)/dev: $(REQUIREMENTS) | $(VENV)/made
	$(INSTALL) '.[dev]'
	touch $@ $(VENV)/train $(VENV)/web

$(VENV)/docs: $(REQUIREMENTS) | $(VENV)/made
	$(INSTALL) '.[docs]'
	touch $@

$(VENV)/bench: $(REQUIREMENTS) | $(VENV)/made
	$(INSTALL) '.[bench]'
	touch $@

# An environment that was interrupted while it was made has a Python, but not this file.
$(VENV)/made:
	@$(or $(PYTHON),false) -c 'import sys; sys.exit(sys.version_info < (3, 11))' || { \
		echo 'arkanoid needs Python 3.11 or newer.' \
		'Install it, or name it: make PYTHON=/path/to/python3.12 $(MAKECMDGOALS)' >&2; exit 1; }
	$(PYTHON) -m venv $(VENV)
	touch $@
