# Doors of the project. `make run` and `make test` are all a newcomer needs.
PYTHON ?= $(shell command -v python3.11 || command -v python3.12 || command -v python3.13 || command -v python3)
VENV := .venv
BIN := $(VENV)/bin
PACKAGES := sim signals jobs store workers app paper bench
PORT ?= 8000

.PHONY: run setup dev browser lint fast test full bench paper openapi lock clean

run: setup  ## start the service, simulate the demo through the queue, open its page
	$(BIN)/sideband serve --port $(PORT) --demo --open

setup: $(VENV)/.installed
	@$(BIN)/python -m workers.warm

$(VENV)/.installed: requirements.lock pyproject.toml
	$(PYTHON) -c 'import sys; sys.exit("Python 3.11 or newer is needed" if sys.version_info < (3, 11) else 0)'
	test -x $(BIN)/python || $(PYTHON) -m venv $(VENV)
	$(BIN)/python -m pip install --quiet --disable-pip-version-check -r requirements.lock
	$(BIN)/python -m pip install --quiet --disable-pip-version-check --no-deps -e .
	touch $@

dev: $(VENV)/.developed
$(VENV)/.developed: requirements-dev.lock $(VENV)/.installed
	$(BIN)/python -m pip install --quiet --disable-pip-version-check -r requirements-dev.lock
	touch $@

browser:  ## what the browser tests need (Debian; needs root)
	@command -v chromium >/dev/null && command -v chromedriver >/dev/null || \
	  { [ "$$(id -u)" = 0 ] && command -v apt-get >/dev/null && \
	    apt-get update -qq && DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends \
	    chromium chromium-driver fonts-dejavu-core >/dev/null; } || echo "no browser: browser tests will be skipped"

lint: dev
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/mypy
	$(BIN)/lint-imports

fast: dev  ## the loop while working: under half a minute
	$(BIN)/python -m pytest -q -n 2 -m "not slow and not browser"

test: dev browser setup lint  ## everything
	$(BIN)/python -m pytest -q -n 2 --dist loadgroup

bench: dev setup
	$(BIN)/python -m bench

paper: dev setup
	$(BIN)/python -m paper

openapi: dev
	$(BIN)/python -m app.openapi

lock: dev
	$(BIN)/pip-compile --quiet --no-emit-index-url --no-emit-find-links --strip-extras --no-header -o requirements.lock pyproject.toml
	$(BIN)/pip-compile --quiet --no-emit-index-url --no-emit-find-links --strip-extras --no-header --extra dev -o requirements-dev.lock pyproject.toml

clean:
	rm -rf $(VENV) .mypy_cache .ruff_cache .pytest_cache .hypothesis .import_linter_cache build *.egg-info
