# make run    installs what is missing and runs the bias extension test of Fig. 7
# make test   installs what is missing, checks the code and runs the tests, the core on two processes
# make core   the tests of the core, on PROCESSES=2 processes
# make lint   style and types alone
# make hard   runs the hard cases and puts their table into docs/hard_cases.md, in ten minutes
# make docs   builds the reference of the Python interface into build/docs
# make figures   draws the figures of README and docs anew, but those of the benchmarks, in two hours
# make clean    removes what the others have made

SHELL := /bin/bash
.DELETE_ON_ERROR:
.PHONY: run test core lint hard docs figures packages clean

PYTHON := .venv/bin/python
PACKAGES := $(shell sed 's/\#.*//' apt-packages.txt)
SUDO := $(shell [ $$(id -u) = 0 ] || echo sudo)
# One thread each: the matrices are small, and MPI is how more cores are used.
export OMP_NUM_THREADS ?= 1
export OPENBLAS_NUM_THREADS ?= 1
PROCESSES := 2
# Open MPI, 4 or 5, for any user and on any number of cores.
export OMPI_ALLOW_RUN_AS_ROOT := 1
export OMPI_ALLOW_RUN_AS_ROOT_CONFIRM := 1
export OMPI_MCA_rmaps_base_oversubscribe := 1
export PRTE_MCA_rmaps_default_mapping_policy := :oversubscribe

run: .venv/installed
	.venv/bin/pantograph run cases/a_bias_extension.toml

test: lint
	$(PYTHON) -m pytest
	$(MAKE) --no-print-directory core

core: .venv/installed
	mpirun -n $(PROCESSES) $(PYTHON) -m pytest -p no:cacheprovider -m core

lint: .venv/installed
	$(PYTHON) -m ruff check .
	$(PYTHON) -m ruff format --check .
	$(PYTHON) -m mypy

hard: .venv/installed
	.venv/bin/pantograph stress --docs docs/hard_cases.md

docs: .venv/installed
	$(PYTHON) -m sphinx -W --keep-going -q -d build/doctrees docs/api build/docs
	@echo "build/docs/index.html"

figures: .venv/installed
	docs/figures.sh

# Asks dpkg rather than a file: a package may have been removed since.
packages:
	@missing=$$(for p in $(PACKAGES); do dpkg-query -W -f='$${Status}' $$p 2>/dev/null \
		| grep -q 'ok installed' || echo $$p; done); \
	if [ -n "$$missing" ]; then echo "Installing Debian packages:" $$missing; \
		$(SUDO) apt-get update -qq && \
		$(SUDO) env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq \
			--no-install-recommends $$missing; fi

# Debian's numpy stays: dolfinx and petsc4py are compiled against it.
.venv/installed: pyproject.toml apt-packages.txt | packages
	/usr/bin/python3 -m venv --system-site-packages .venv
	/usr/bin/python3 -c 'import numpy; print("numpy==" + numpy.__version__)' > .venv/constraints.txt
	.venv/bin/pip install --quiet --constraint .venv/constraints.txt --editable '.[dev]'
	touch $@

clean:
	rm -rf .venv build results .pytest_cache .mypy_cache .ruff_cache .hypothesis
