#!/usr/bin/env bash
# Draws the figures of README and docs anew, but those of the benchmarks (benchmarks/README.md).
#
#   docs/figures.sh               all of them, in two hours
#   docs/figures.sh accuracy      one part: pictures, springs, accuracy, sweeps or experiments
set -euo pipefail
cd "$(dirname "$0")/.."
figures=docs/figures
export OMP_NUM_THREADS=1 OPENBLAS_NUM_THREADS=1

pantograph() { .venv/bin/pantograph "$@" --quiet; }

pictures() {
    local case
    for case in a_bias_extension beam_arc lattice_bias_extension; do
        pantograph run cases/$case.toml
    done
    cp results/a_bias_extension/figures/{shear_angle_100,energy_density_100,force_displacement}.png $figures
    cp results/beam_arc/figures/shapes.png $figures/beam_arc_shapes.png
    .venv/bin/python docs/paraview.py
}

springs() {
    local study
    for study in chain_to_beam lattice_to_sheet lattice_to_sheet_resolved inextensible_limit; do
        pantograph compare studies/$study.toml
    done
    for study in chain_to_beam lattice_to_sheet_resolved; do
        cp results/$study/convergence.png $figures/${study}_convergence.png
    done
    for study in lattice_to_sheet inextensible_limit; do
        cp results/$study/curves.png $figures/${study}_curves.png
    done
}

accuracy() {
    local meshes=(--mesh 0.0124/0.00031 --mesh 0.0088/0.00022 --mesh 0.0062/0.000155
        --mesh 0.0044/0.00011)
    local pivots=discretisation.quadrature_degree
    reference a_bias_extension 0.0044 0.00005
    work_precision a_bias_extension a_bias_extension a_bias_extension_work_precision \
        --degree 2 --degree 3 "${meshes[@]}"
    work_precision a_bias_extension high_degrees a_bias_extension_high_degrees \
        --degree 4 --degree 5 --set mesh.growth=0.5 --mesh 0.034/0.0025 --mesh 0.025/0.001 \
        --mesh 0.025/0.0005 --mesh 0.025/0.0002
    reference b_shear 0.0062 0.00008
    work_precision b_shear b_shear b_shear_work_precision --degree 3 --degree 4 "${meshes[@]}"
    reference c_rotation_45 0.0062 0.00008
    work_precision c_rotation_45 c_rotation_45 c_rotation_45_work_precision \
        --degree 3 --degree 4 "${meshes[@]}"
    reference d_compression_3 0.0062 0.00008 --set $pivots=11
    work_precision d_compression_3 d_compression_3 d_compression_3_work_precision \
        --degree 3 --degree 4 "${meshes[@]}" --set $pivots=9
    pantograph study cases/beam_arc.toml --scheme micromorphic --scheme hinge \
        --degree 2 --degree 3 --degree 4
    cp results/study_beam_arc/work_precision.png $figures/beam_arc_work_precision.png
}

# What errors of a case are taken against: the hinge scheme of degree 5, with these sizes.
reference() {
    local case=$1 size=$2 corner_size=$3
    shift 3
    pantograph run cases/$case.toml --set discretisation.scheme=hinge \
        --set discretisation.degree=5 --set mesh.size=$size --set mesh.corner_size=$corner_size \
        --set output.fields=none --set output.figures=false "$@" --output results/reference_$case
}

work_precision() {
    local case=$1 study=$2 figure=$3
    shift 3
    pantograph study cases/$case.toml --scheme micromorphic --scheme hinge "$@" \
        --reference results/reference_$case --output results/study_$study
    cp results/study_$study/work_precision.png $figures/$figure.png
}

sweeps() {
    pantograph sweep studies/sweep_grid.toml
    pantograph sweep studies/sweep_constants.toml
    cp results/sweep_grid/sweep.png $figures/sweep_grid.png
    cp results/sweep_constants/indices.png $figures/sweep_constants_indices.png
}

experiments() {
    local figure
    pantograph identify studies/identify_bias.toml
    pantograph identify studies/identify_force_alone.toml
    for figure in fit residuals states profile; do
        cp results/identify_bias/$figure.png $figures/identify_bias_$figure.png
    done
    cp results/identify_force_alone/fit.png $figures/identify_force_alone_fit.png
}

[ $# -gt 0 ] || set -- pictures springs accuracy sweeps experiments
for part; do
    case $part in
        pictures | springs | accuracy | sweeps | experiments) "$part" ;;
        *)
            echo "docs/figures.sh: $part: must be pictures, springs, accuracy, sweeps or experiments" >&2
            exit 2
            ;;
    esac
done
