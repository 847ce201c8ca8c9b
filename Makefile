# Everything one does here. Needs make and Python 3.11; the rest is installed into .venv.
# What is done leaves a stamp, so that a second call only does what has changed.

PYTHON ?= python3
VENV := .venv
RUN := $(VENV)/bin/python
PIP := $(RUN) -m pip install --quiet --disable-pip-version-check
NPM := $(RUN) tools/npm.py
PYTEST := $(RUN) -m pytest

CLIENT := server/client_assets/index.html
CLIENT_SOURCES := $(shell find client_web -type f -not -path '*/node_modules/*' -not -path '*/tests/*')
BENCHMARKS ?= $(patsubst benchmarks/%.py,%,$(wildcard benchmarks/[a-z]*.py))

.DEFAULT_GOAL := help
.DELETE_ON_ERROR:
.PHONY: help serve test test-boundscheck test-nojit check bench format client clean

help:  ## show what there is to do
	@echo "Esplanade: people and computer-run actors walk among each other."
	@echo
	@echo "  make serve   is the first thing to try: then open http://localhost:8080"
	@echo
	@awk -F ':.*## ' '/^[a-z-]+:.*## / { printf "  make %-17s %s\n", $$1, $$2 }' $(MAKEFILE_LIST)
	@echo
	@echo "Options go in ARGS:  make serve ARGS='--port 9000 --actors 30'"
	@echo "                     make test ARGS='tests/planning -k risk'"
	@echo "                     make bench BENCHMARKS=server"

serve: $(VENV)/.serve $(CLIENT)  ## run the demo world at http://localhost:8080
	@exec $(RUN) -m esplanade demo $(ARGS)

test: $(VENV)/.test $(CLIENT)  ## run all tests, in a real browser too
	@ESPLANADE_CHROMIUM="$$($(RUN) tools/ensure_browser.py)" $(PYTEST) --numprocesses 2 $(ARGS)

test-boundscheck: $(VENV)/.test  ## run the planning tests with every array access checked
	NUMBA_BOUNDSCHECK=1 $(PYTEST) tests/planning $(ARGS)

test-nojit: $(VENV)/.test  ## run the planning tests uncompiled, for branch coverage
	NUMBA_DISABLE_JIT=1 $(RUN) -m coverage run -m pytest tests/planning $(ARGS)
	$(RUN) -m coverage report

check: $(VENV)/.dev client_web/node_modules/.installed  ## lint, types, import arrows; the client's too
	$(RUN) -m ruff check
	$(RUN) -m ruff format --check
	$(RUN) -m mypy
	$(VENV)/bin/lint-imports
	$(NPM) run --silent typecheck
	$(NPM) run --silent lint
	$(NPM) run --silent format:check
	$(NPM) run --silent test

bench: $(VENV)/.test  ## measure what must stay fast, each part by itself
	@for name in $(BENCHMARKS); do \
	  echo "--- $$name"; $(RUN) -m benchmarks.$$name $(ARGS) || exit; \
	done

format: $(VENV)/.dev client_web/node_modules/.installed  ## format all sources
	$(RUN) -m ruff check --fix-only
	$(RUN) -m ruff format
	$(NPM) run --silent format

client: $(CLIENT)  ## build the web client

clean:  ## remove what was built, and the virtual environment
	rm -rf $(VENV) server/client_assets client_web/node_modules benchmarks/recast/node_modules
	rm -rf build dist
	rm -rf .coverage .hypothesis .import_linter_cache .mypy_cache .pytest_cache .ruff_cache
	find . -name __pycache__ -type d -prune -exec rm -rf {} +

$(VENV)/.created:
	@echo "Making the virtual environment ..."
	@$(PYTHON) tools/create_venv.py $(VENV)
	@touch $@

# The environment grows as it is needed: for running, for testing, for developing.
$(VENV)/.serve: $(VENV)/.created pyproject.toml hatch_build.py
	@echo "Installing Esplanade and what it runs on ..."
	@$(PIP) --editable '.[client]'
	@touch $@

$(VENV)/.test: $(VENV)/.serve
	@echo "Installing what the tests take ..."
	@$(PIP) --editable '.[test]'
	@touch $@

$(VENV)/.dev: $(VENV)/.test
	@echo "Installing linters and type checkers ..."
	@$(PIP) --editable '.[dev]'
	@touch $@

# An editable install does not build the web client: here is its own step.
client_web/node_modules/.installed: client_web/package-lock.json | $(VENV)/.serve
	@echo "Installing what the web client is built from ..."
	@$(NPM) ci --include=dev --no-audit --no-fund --loglevel=error
	@touch $@

$(CLIENT): $(CLIENT_SOURCES) client_web/node_modules/.installed
	@echo "Building the web client ..."
	@$(NPM) run --silent build -- --logLevel warn
	@touch $@
