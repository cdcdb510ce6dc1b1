# %% [markdown]
# # Bias extension test
#
# The sheet of Fig. 7 of the paper on a coarse mesh: its top edge is pulled away from the bottom
# edge. The fibres turn until they nearly lock, and the force rises steeply. Most of the energy
# is that of the pivots; bending spreads what would be jumps of the shear angle.

# %%
import os
from pathlib import Path

import matplotlib.pyplot as plt

import pantograph_fem as pf

RESULTS = Path(os.environ.get("PANTOGRAPH_RESULTS", "results/examples"))
CASES = Path(__file__).resolve().parents[1] / "cases"

# %% [markdown]
# `pf.run` does what `pantograph run` does. Values of the case are replaced as by `--set`.

# %%
result = pf.run(
    CASES / "a_bias_extension.toml",
    RESULTS / "bias_extension",
    set=[
        "mesh.size=0.012",
        "mesh.corner_size=0.003",
        "discretisation.scheme=hinge",
        "discretisation.degree=2",
        "output.figures=false",
    ],
)
history = result.history
print(result.status, f"force {result.last['force_y']:.1f} N at 56.7 mm")

# %% [markdown]
# Columns of the history are arrays; states of the fields are found by their load.

# %%
state = result.fields().at(1.0)
pulled = 1e3 * result.case.grips.top.translation[1] * history["load"]

figure, (left, right) = plt.subplots(1, 2, figsize=(9, 4), layout="constrained")
left.plot(pulled, history["force_y"], "o-", color="0.2", markersize=3)
left.set(xlabel="grip displacement (mm)", ylabel="force (N)", ylim=(0, None))
energies = left.twinx()
effects = ("stretch", "bending", "shear")
energies.stackplot(pulled, [history[f"energy_{e}"] for e in effects], labels=effects, alpha=0.4)
energies.set(ylabel="energy (J)", ylim=(0, None))
energies.legend(loc="upper left")
colours = right.tripcolor(
    *(1e3 * state.deformed).T, state.cells, state["shear_angle"], shading="gouraud"
)
right.set(aspect="equal", xlabel="x (mm)", ylabel="y (mm)")
figure.colorbar(colours, label="shear angle (rad)")
figure.savefig(RESULTS / "bias_extension.png", dpi=120)
