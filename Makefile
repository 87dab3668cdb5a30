# Doors of the project. `make run` and `make test` are all a newcomer needs.
PYTHON ?= $(shell command -v python3.11 || command -v python3.12 || command -v python3.13 || command -v python3)
VENV := .venv
BIN := $(VENV)/bin
PORT ?= 8000
OPEN ?= --open
# Says now and then how many of the packages named in a lock file were fetched; a failure of pip stays one.
FETCHED = { n=0; while read -r word rest; do case "$$word $$rest" in \
  Collecting*|Processing*) n=$$((n + 1)); [ $$((n % 10)) != 0 ] || echo "      $$n of $$(grep -c == $(1)) packages fetched";; \
  "Installing collected"*) echo "      unpacking them";; "pip failed") exit 1;; esac; done; }
PIP = PYTHONUNBUFFERED=1 $(BIN)/python -m pip install --disable-pip-version-check --progress-bar off
# What a lock file names, which is whole: to look for what its packages need takes longer than to fetch them.
# One half beside the other: unpacking is work for one core.
HALF = awk '/==/ && ++n % 2 == $(2)' $(1) >$(VENV)/half$(2).txt && $(PIP) --no-deps --no-compile -r $(VENV)/half$(2).txt
LOCKED = { { $(call HALF,$(1),0) & } && half=$$!; $(call HALF,$(1),1); found=$$?; \
  wait $$half && [ $$found = 0 ] || echo "pip failed"; } | $(call FETCHED,$(1))
# Another Python or machine may need a package more; then pip looks.
WHOLE = $(BIN)/python -m pip check >/dev/null 2>&1 || $(PIP) --quiet --no-compile -c constraints.txt -r $(1)
# On all cores, and without the packages' own tests.
COMPILED = $(BIN)/python -m compileall -q -j 0 -x '/tests?/' $(VENV)/lib >/dev/null || true

.DELETE_ON_ERROR:
.PHONY: run setup env dev browser lint kernels collected fast test further bench cost paper proof tests-atlas proof-real proof-made sim2real openapi lock clean help

run: setup  ## start the service, simulate the demo through the queue, open its page (PORT=8001, OPEN= for no browser)
	@echo "[4/4] starting broker, workers and HTTP server on port $(PORT)"
	@$(BIN)/sideband serve --port $(PORT) --demo $(OPEN)

setup: env  ## environment, and the kernels compiled into their cache
	@echo "[3/4] numerical kernels: loading, or compiling them once (20 s to a minute)"
	@$(BIN)/python -m workers.warm

env: $(VENV)/.installed

$(VENV)/.installed: requirements.lock pyproject.toml
	@test -n "$(PYTHON)" || { echo "no python3 found: Python 3.11 or newer is needed, or name one: make PYTHON=/path/to/python3"; exit 1; }
	@$(PYTHON) -c 'import sys; sys.exit("Python 3.11 or newer is needed, this is %d.%d; name another: make PYTHON=/path/to/python3" % sys.version_info[:2] if sys.version_info < (3, 11) else 0)'
	@echo "[1/4] creating the environment in $(VENV) ($(PYTHON))"
	@test -x $(BIN)/python || $(PYTHON) -m venv $(VENV) || { rm -rf $(VENV); \
	  echo "python's venv module is missing (on Debian and Ubuntu: apt-get install python3-venv)"; exit 1; }
	@echo "[2/4] installing the locked packages (once; about a minute, depending on the network)"
	@$(call LOCKED,requirements.lock)
	@$(PIP) --quiet --no-deps -e .
	@$(call WHOLE,requirements.lock)
	@$(COMPILED)
	@touch $@

dev: $(VENV)/.developed
$(VENV)/.developed: requirements-dev.lock $(VENV)/.installed
	@echo "installing the developers' tools (once; about a minute)"
	@$(call LOCKED,requirements-dev.lock)
	@$(call WHOLE,requirements-dev.lock)
	@touch $@

browser:  ## what the browser tests need (Debian; needs root)
	@command -v chromium >/dev/null && command -v chromedriver >/dev/null || \
	  { [ "$$(id -u)" = 0 ] && command -v apt-get >/dev/null && \
	    apt-get update -qq && DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends \
	    chromium chromium-driver fonts-dejavu-core >/dev/null; } || echo "no browser: browser tests will be skipped"

lint: dev  ## style, types, import rules
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/mypy
	$(BIN)/lint-imports --no-logo

kernels: env  # as `setup`, and those of machines side by side, with which two groups of tests begin
	@echo "[3/4] numerical kernels: loading, or compiling them once (about a minute)"
	@$(BIN)/python -m workers.warm --lanes

collected: dev kernels  # compiles the tests once, not in every process; what is wrong with them, the run itself says
	@PYTHONDONTWRITEBYTECODE= $(BIN)/python -m pytest -q --collect-only >/dev/null || true

# glibc keeps what is freed for the next array: to ask the system for its pages again takes a thirtieth of the time.
KEEPING = MALLOC_MMAP_THRESHOLD_=33554432 MALLOC_TRIM_THRESHOLD_=1073741824

fast: dev  ## the loop while working: without the slow tests (half a minute on two cores)
	$(KEEPING) PYTHONDONTWRITEBYTECODE= $(BIN)/python -m pytest -q -n 2 -m "not slow"

# A browser comes beside the packages; then kernels and after them the tests' own code are compiled on one core, while
# tools are fetched and types checked on the other.
test:  ## lint and the tests; what CI runs
	@$(MAKE) --no-print-directory browser & fetching=$$!; \
	  { $(MAKE) --no-print-directory env && $(MAKE) --no-print-directory -j 2 -O kernels lint collected; }; \
	  found=$$?; wait $$fetching || found=$$?; exit $$found
	$(KEEPING) PYTHONDONTWRITEBYTECODE= $(BIN)/python -m pytest -q -n 4 --dist loadgroup --no-loadscope-reorder  # on two cores: many tests wait for servers and workers

further: dev browser kernels  ## the costlier examples that `make test` leaves out (tests/further.txt; ten minutes on two cores)
	$(KEEPING) PYTHONDONTWRITEBYTECODE= $(BIN)/python -m pytest -q -n 4 --dist loadgroup --no-loadscope-reorder -m further

bench: dev setup  ## speed and accuracy; ends with one line of JSON
	$(BIN)/python -m bench

cost: setup  ## measure again what a simulation costs (jobs/cost.json, from which requests are estimated)
	$(BIN)/python -m bench.cost

paper: dev setup  ## the paper's figures and trends, recomputed into docs/
	$(BIN)/python -m paper

BUDGET ?= quick
# Names of cases tell their split; without them it is all of one. Stored answers are compared, and replaced by nothing:
# KEEP=name stores a run under a section's name of its own.
CASES_OF = $(if $(SPLIT)$(if $(CASES),,all),--split $(or $(SPLIT),engraver)) --cases "$(CASES)"
proof: dev setup  ## concealed cases: make them, run the engine, hold its answers against the stored ones (CASES=s001,s002 single ones, SPLIT=engraver)
	$(BIN)/python -m proof generate $(CASES_OF)
	$(BIN)/python -m proof run $(CASES_OF) --budget $(BUDGET) $(if $(CASES),--fresh)
	$(BIN)/python -m proof score $(CASES_OF) $(if $(KEEP),--keep --name $(KEEP)) > /dev/null
	$(if $(KEEP),$(BIN)/python -m proof page)

tests-atlas: dev setup  ## simulate again the small atlases that stand beside tests
	$(BIN)/python -m tests.reconcile.machine.make_atlas
	$(BIN)/python -m tests.proof.make_atlas

proof-real: dev setup  ## the engine on real recordings beside the project, labels withheld; writes docs/proof-real.md
	$(BIN)/python -m proof.real --docs docs/proof-real.md

proof-made: dev setup  ## the engine on made rigs of which a drawing is known; writes docs/proof-made.md
	$(BIN)/python -m proof.made --docs docs/proof-made.md

sim2real: setup  ## train on simulations only, test on real recordings beside the project; tables into docs/sim2real.md
	$(BIN)/python -m learn.sim2real --docs docs/sim2real.md

openapi: dev  ## write openapi/openapi.json
	$(BIN)/python -m app.openapi

LOCK = $(BIN)/pip-compile --quiet -c constraints.txt --no-emit-index-url --no-emit-find-links --strip-extras --no-header $(UPGRADE)
SERVER = --extra postgres --extra s3 --extra formats --extra datasets
lock: dev  ## new lock files from pyproject.toml (keeps what is locked; add UPGRADE=--upgrade to renew)
	$(LOCK) -o requirements.lock pyproject.toml
	$(LOCK) $(SERVER) -o requirements-server.lock pyproject.toml
	$(LOCK) $(SERVER) --extra mdf --extra dev -o requirements-dev.lock pyproject.toml

clean:  ## remove what the doors made in this folder (not the kernel cache, not data)
	rm -rf $(VENV) .mypy_cache .ruff_cache .pytest_cache .hypothesis .import_linter_cache build *.egg-info

help:  ## this list
	@sed -nE 's/^([a-z0-9-]+):.*## (.*)/\1\t\2/p' $(MAKEFILE_LIST) | sort -u | expand -t 14
