# %% [markdown]
# # Buckling of a column that can be compressed
#
# A cantilever under a dead load along its axis stays straight up to a critical load, which for a
# beam that can be compressed is above Euler's. There the path forks; the program finds the fork and
# goes on along the path of the buckled column.

# %%
import os
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

import pantograph_fem as pf

RESULTS = Path(os.environ.get("PANTOGRAPH_RESULTS", "results/examples"))
L, K_e, K_b = 1.0, 1e5, 1e3  # m, N, N m²

# %% [markdown]
# The critical load is the smaller root of N (1 - N / K_e) = K_b k², with k = π / 2L.

# %%
k = np.pi / (2 * L)
exact = K_e / 2 * (1 - np.sqrt(1 - 4 * K_b * k**2 / K_e))
largest = 1.5 * exact
case = {
    "name": "buckling_column",
    "kind": "beam",
    "beam": {"length": L},
    "material": {"stretch": K_e, "bending": K_b},
    "ends": {"right": {"support": "free", "force": [-largest, 0.0]}},
    "mesh": {"size": L / 16},
    "continuation": {"on_instability": "branch", "max_step": 0.1, "stops": [1.0]},
    "output": {"figures": False, "eigenvalues": True},
}
result = pf.run(case, RESULTS / "buckling_column")

# %%
(fork,) = result.summary["critical_points"]
found = fork["load"] * largest
error = found / exact - 1
print(f"{fork['kind']} at {found:.2f} N; exact {exact:.2f} N; Euler {K_b * k**2:.2f} N")
print(f"relative error {error:.1e}; stable at the end: {result.last['stable']}")

# %%
figure, axes = plt.subplots(figsize=(5, 4), layout="constrained")
history = result.history
axes.plot(np.abs(history["tip_uy"]), history["load"] * largest / exact, "o-", markersize=3)
axes.axhline(1.0, color="0.6", linestyle="dotted")
axes.set(xlabel="deflection of the tip (m)", ylabel="load / critical load")
figure.savefig(RESULTS / "buckling_column.png", dpi=120)
