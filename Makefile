# Two commands do everything: `make demo` and `make test`. Both set up .venv first, from the hashed lock.

VENV := .venv
BIN := $(VENV)/bin
STAMP := $(VENV)/.installed
PYTHONS := python3.12 python3.11 python3 python

# The first of PYTHONS that runs and is a version that Deixis supports, with venv.
FIND_PYTHON = for p in $(PYTHON) $(PYTHONS); do \
	"$$p" -c 'import sys, venv, ensurepip; sys.exit(not (3, 11) <= sys.version_info[:2] < (3, 13))' >/dev/null 2>&1 \
	&& { command -v "$$p"; break; }; done

.PHONY: demo test coverage lint docs lock bench report clean

demo: $(STAMP)
	@$(BIN)/deixis demo

test: $(STAMP)
	@$(BIN)/python -m pytest -n auto --dist loadfile -m "not kills and not long"

# All tests, the long ones and those that kill processes too, with coverage by line and branch; fails below the floor in pyproject.toml.
coverage: $(STAMP)
	@$(BIN)/python -m pytest -n auto --dist loadfile --cov --cov-report=term:skip-covered

lint: $(STAMP)
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/python tools/check_style.py
	$(BIN)/mypy
	$(BIN)/basedpyright
	$(BIN)/lint-imports

# Writes the documentation site, docs/_build/html/index.html. Warnings are errors; nothing is fetched.
docs: $(STAMP)
	@rm -rf docs/_build docs/_pictures
	$(BIN)/python -m sphinx --quiet --fail-on-warning --keep-going --builder html docs docs/_build/html
	$(BIN)/python tools/documentation/site_links.py docs/_build/html

# Runs all benchmarks one after the other (hours) and records their figures; `make report` makes the page of them.
bench: $(STAMP)
	@$(BIN)/python benchmarks/records.py --list | while read -r python command; do \
		echo "== $$command"; $(BIN)/python $$command || exit 1; done

report: $(STAMP)
	@$(BIN)/python benchmarks/records.py

$(STAMP): requirements.lock pyproject.toml setup.py
	@python=$$($(FIND_PYTHON)); \
	if [ -z "$$python" ]; then \
		echo "Deixis needs Python 3.11 or 3.12 with the venv module (on Debian: python3-venv); none was found." >&2; \
		echo "Install one, or name it: make PYTHON=/path/to/python3.12 $(MAKECMDGOALS)" >&2; exit 1; fi; \
	echo "Setting up $(VENV) with $$python (once; a few minutes)"; \
	rm -rf $(VENV) && "$$python" -m venv $(VENV)
	@$(BIN)/python -m pip install --quiet --disable-pip-version-check --require-hashes --no-deps -r requirements.lock
	@$(BIN)/python -m pip install --quiet --disable-pip-version-check --no-deps --no-build-isolation --editable .
	@$(BIN)/python -m deixis.kernels
	@touch $(STAMP)

# Writes the lock: name==version and hashes, no address. Needs uv.
lock:
	uv pip compile --universal --python-version 3.11 --generate-hashes --no-header --no-annotate \
		--no-emit-index-url --no-emit-find-links --extra dev --quiet pyproject.toml --output-file requirements.lock

clean:
	rm -rf $(VENV) build dist out docs/_build docs/_pictures docs/reference/python .pytest_cache .mypy_cache .ruff_cache .hypothesis
