# make run    installs what is missing and runs the bias extension test of Fig. 7
# make test   installs what is missing, checks the code and runs the tests, the core on two processes
# make core   the tests of the core, on PROCESSES=2 processes
# make lint   style and types alone
# make hard   runs the hard cases and puts their table into docs/hard_cases.md, in ten minutes
# make docs   builds the reference of the Python interface into build/docs
# make figures   draws the figures of README and docs anew, in three hours

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
	.venv/bin/pantograph run cases/a_bias_extension.toml --quiet
	.venv/bin/pantograph run cases/beam_arc.toml --quiet
	.venv/bin/pantograph run cases/lattice_bias_extension.toml --quiet
	$(PYTHON) docs/paraview.py
	for study in chain_to_beam lattice_to_sheet lattice_to_sheet_resolved inextensible_limit; do \
		.venv/bin/pantograph compare studies/$$study.toml --quiet || exit; done
	.venv/bin/pantograph study cases/a_bias_extension.toml --quiet --scheme micromorphic \
		--scheme hinge --degree 2 --degree 3 --mesh 0.0124/0.00031 --mesh 0.0088/0.00022 \
		--mesh 0.0062/0.000155 --mesh 0.0044/0.00011
	cp results/study_a_bias_extension/work_precision.png \
		docs/figures/a_bias_extension_work_precision.png
	.venv/bin/pantograph study cases/a_bias_extension.toml --quiet --scheme micromorphic \
		--scheme hinge --degree 4 --degree 5 --set mesh.growth=0.5 --mesh 0.034/0.0025 \
		--mesh 0.025/0.001 --mesh 0.025/0.0005 --output results/study_high_degrees
	cp results/study_high_degrees/work_precision.png \
		docs/figures/a_bias_extension_high_degrees.png
	.venv/bin/pantograph study cases/b_shear.toml --quiet --scheme micromorphic \
		--scheme hinge --degree 3 --degree 4
	cp results/study_b_shear/work_precision.png docs/figures/b_shear_work_precision.png
	.venv/bin/pantograph study cases/d_compression_3.toml --quiet --scheme micromorphic \
		--scheme hinge --degree 3 --degree 4 --set discretisation.quadrature_degree=9
	cp results/study_d_compression_3/work_precision.png \
		docs/figures/d_compression_3_work_precision.png
	.venv/bin/pantograph study cases/c_rotation_45.toml --quiet --scheme micromorphic \
		--scheme hinge --degree 3 --degree 4
	cp results/study_c_rotation_45/work_precision.png docs/figures/c_rotation_45_work_precision.png
	.venv/bin/pantograph study cases/beam_arc.toml --quiet --scheme micromorphic --scheme hinge \
		--degree 2 --degree 3 --degree 4
	cp results/study_beam_arc/work_precision.png docs/figures/beam_arc_work_precision.png
	for study in grid constants; do \
		.venv/bin/pantograph sweep studies/sweep_$$study.toml --quiet || exit; done
	cp results/sweep_grid/sweep.png docs/figures/sweep_grid.png
	cp results/sweep_constants/indices.png docs/figures/sweep_constants_indices.png
	for study in bias force_alone; do \
		.venv/bin/pantograph identify studies/identify_$$study.toml --quiet || exit; done
	for figure in fit residuals states profile; do \
		cp results/identify_bias/$$figure.png docs/figures/identify_bias_$$figure.png; done
	cp results/identify_force_alone/fit.png docs/figures/identify_force_alone_fit.png
	cd results && cp a_bias_extension/figures/{shear_angle_100,energy_density_100,force_displacement}.png \
		../docs/figures
	cp results/beam_arc/figures/shapes.png docs/figures/beam_arc_shapes.png
	for study in chain_to_beam lattice_to_sheet_resolved; do \
		cp results/$$study/convergence.png docs/figures/$${study}_convergence.png; done
	for study in lattice_to_sheet inextensible_limit; do \
		cp results/$$study/curves.png docs/figures/$${study}_curves.png; done

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
