# %% [markdown]
# # A cantilever rolled up to a circle
#
# An end moment M bends an inextensible cantilever to an arc of curvature M / K_b. The beam here can
# stretch, but nothing pulls it: the arc is an exact solution, and at M = 2π K_b / L it closes.

# %%
import os
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

import pantograph_fem as pf

RESULTS = Path(os.environ.get("PANTOGRAPH_RESULTS", "results/examples"))
L, K_e, K_b = 1.0, 4.05e8, 7.59e5  # m, N, N m²

# %% [markdown]
# A case is what a case file holds, as nested dictionaries.

# %%
case = {
    "name": "cantilever_arc",
    "kind": "beam",
    "beam": {"length": L},
    "material": {"stretch": K_e, "bending": K_b},
    "ends": {"right": {"support": "free", "moment": 2 * np.pi * K_b / L}},
    "mesh": {"size": L / 16},
    "continuation": {"stops": [0.25, 0.5, 0.75, 1.0], "max_step": 0.1},
    "output": {"figures": False},
}
result = pf.run(case, RESULTS / "cantilever_arc")

# %% [markdown]
# The direction of the tip is 2π times the load, whatever the load; its place is on the arc.

# %%
angle = 2 * np.pi * result.history["load"]
exact_ux = L * np.sinc(angle / np.pi) - L  # L sin(angle) / angle - L
exact_uy = L * angle / 2 * np.sinc(angle / (2 * np.pi)) ** 2  # L (1 - cos(angle)) / angle
angle_error = np.abs(result.history["tip_angle"] - angle).max()
place_error = max(
    np.abs(result.history["tip_ux"] - exact_ux).max(),
    np.abs(result.history["tip_uy"] - exact_uy).max(),
)
print(f"largest errors: direction {angle_error:.1e} rad, place {place_error:.1e} m")

# %%
figure, axes = plt.subplots(figsize=(7, 4), layout="constrained")
for state in result.fields():
    if np.isclose(4 * state.load, round(4 * state.load)):
        order = np.argsort(state.points[:, 0])
        axes.plot(*state.deformed[order].T, label=f"M = {state.load:.2f} · 2π K_b/L")
axes.set(aspect="equal", xlabel="x (m)", ylabel="y (m)")
axes.legend(loc="upper left", bbox_to_anchor=(1.02, 1.0))
figure.savefig(RESULTS / "cantilever_arc.png", dpi=120)
