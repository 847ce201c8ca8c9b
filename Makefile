# Everything one does here. Needs make and Python 3.11; the rest is installed into .venv.
# What is done leaves a stamp, so that a second call only does what has changed.

PYTHON ?= python3
VENV := .venv
RUN := $(VENV)/bin/python
PIP := $(RUN) -m pip install --quiet --disable-pip-version-check
# Nothing is installed but what uv.lock names, what builds the package included (extra `client`).
SYNC := UV_PROJECT_ENVIRONMENT=$(VENV) $(VENV)/bin/uv sync --quiet --locked --inexact \
  --no-build-isolation-package esplanade
NPM := $(RUN) tools/npm.py
PYTEST := $(RUN) -m pytest

CLIENT := server/client_assets/index.html
CLIENT_SOURCES := $(shell find client_web -type f -not -path '*/node_modules/*' -not -path '*/tests/*')
BENCHMARKS ?= $(patsubst benchmarks/%.py,%,$(wildcard benchmarks/[a-z]*.py))

# Programs that start often would compile their Python sources each time.
unexport PYTHONDONTWRITEBYTECODE

.DEFAULT_GOAL := help
.DELETE_ON_ERROR:
.PHONY: help serve test test-boundscheck test-nojit fuzz-files test-lowest test-pythons test-base
.PHONY: check docs study release release-check audit bench chaos chaos-cluster cluster format lock client clean

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

cluster: $(VENV)/.test $(CLIENT)  ## run a world on several processes of this machine
	@exec $(RUN) -m tools.local_cluster $(ARGS)

test: $(VENV)/.test $(CLIENT)  ## run all tests, in a real browser too
	@ESPLANADE_CHROMIUM="$$($(RUN) tools/ensure_browser.py)" $(PYTEST) --numprocesses 3 --dist loadscope $(ARGS)

test-boundscheck: $(VENV)/.test  ## run tests of kernels with every array access checked
	NUMBA_BOUNDSCHECK=1 $(PYTEST) tests/planning tests/pedestrians $(ARGS)

test-nojit: $(VENV)/.test  ## run tests of kernels uncompiled, for branch coverage
	NUMBA_DISABLE_JIT=1 $(RUN) -m coverage run -m pytest tests/planning tests/pedestrians $(ARGS)
	$(RUN) -m coverage report

fuzz-files: $(VENV)/.test  ## read 100 000 mutated recordings, meshes and plans
	$(RUN) -m tests.files.fuzz $(ARGS)

test-lowest: $(VENV)/.test  ## run tests with the oldest releases that pyproject.toml allows
	$(RUN) -m tools.lowest

test-pythons: $(VENV)/.test  ## run an installed wheel on every Python that there is
	$(RUN) -m tools.pythons

test-base: $(VENV)/.test  ## run an installed wheel without any extra: every command and reader
	$(RUN) -m tools.base

release: $(VENV)/.test $(CLIENT) client_web/node_modules/.installed  ## make a release ready up to its upload; VERSION=…
	@$(RUN) -m tools.release $(VERSION)

audit: $(VENV)/.test  ## ask for known faults of what uv.lock names
	$(RUN) -m tools.audit

release-check: $(VENV)/.test  ## what takes too long for every change: lowest, pythons, audit
	$(RUN) -m tools.release_check

check: $(VENV)/.dev client_web/node_modules/.installed  ## lint, types, import arrows; the client's too
	$(VENV)/bin/uv lock --quiet --check
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

study: $(VENV)/.test  ## compare our actor with its peers among recorded and reacting people
	@$(RUN) -m benchmarks.study $(ARGS)

chaos: $(VENV)/.test $(CLIENT)  ## attack a server, and tell what a well-behaved client saw
	@$(RUN) -m chaos $(ARGS)

chaos-cluster: $(VENV)/.test  ## kill and freeze processes of a cluster; SEED=… SECONDS_LONG=…
	@$(RUN) -m chaos.cluster --seed $(or $(SEED),0) --seconds $(or $(SECONDS_LONG),120) $(ARGS)

docs: $(VENV)/.dev  ## build the pages of docs/ and a reference of the library as a site in site/
	@NO_MKDOCS_2_WARNING=1 $(RUN) -m mkdocs build --quiet --strict
	@echo "Open site/index.html, or call: $(RUN) -m http.server --directory site"

format: $(VENV)/.dev client_web/node_modules/.installed  ## format all sources
	$(RUN) -m ruff check --fix-only
	$(RUN) -m ruff format
	$(NPM) run --silent format

lock: $(VENV)/.installer  ## write uv.lock anew, with the newest releases that pyproject.toml allows
	$(VENV)/bin/uv lock --upgrade

client: $(CLIENT)  ## build the web client

clean:  ## remove what was built, and the virtual environment
	rm -rf $(VENV) server/client_assets client_web/node_modules benchmarks/*/node_modules
	rm -rf build dist site
	rm -rf .coverage .hypothesis .import_linter_cache .mypy_cache .pytest_cache .ruff_cache
	find . -name __pycache__ -type d -prune -exec rm -rf {} +

$(VENV)/.created:
	@echo "Making the virtual environment ..."
	@$(PYTHON) tools/create_venv.py $(VENV)
	@touch $@

$(VENV)/.installer: $(VENV)/.created tools/uv.txt
	@$(PIP) --require-hashes --requirement tools/uv.txt
	@touch $@

# The environment grows as it is needed: for running, for testing, for developing.
$(VENV)/.serve: $(VENV)/.installer pyproject.toml uv.lock hatch_build.py
	@echo "Installing Esplanade and what it runs on ..."
	@$(SYNC) --extra client
	@touch $@

$(VENV)/.test: $(VENV)/.serve
	@echo "Installing what the tests take ..."
	@$(SYNC) --extra test
	@touch $@

$(VENV)/.dev: $(VENV)/.test
	@echo "Installing linters and type checkers ..."
	@$(SYNC) --extra dev
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
