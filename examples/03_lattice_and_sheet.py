# %% [markdown]
# # A lattice of springs, and the sheet that is its limit
#
# The continuum of energy (31) is the limit of the lattice of energy (19) with the constants (30) as
# the spacing of its nodes goes to 0. Both are sheared here by a motion of the top grip to the side,
# and their forces are compared at two spacings.

# %%
import os
from pathlib import Path

import matplotlib.pyplot as plt

import pantograph_fem as pf

RESULTS = Path(os.environ.get("PANTOGRAPH_RESULTS", "results/examples"))

# %%
specimen = {
    "sheet": {"width": 0.068, "height": 0.204},
    "material": {"stretch": 1.34e5, "bending": 1.92e-2, "shear": 159.0, "shear_exponent": 2.0},
    "grips": {"top": {"translation": [0.034, 0.0]}},
    "continuation": {"stops": [0.5, 1.0]},
    "output": {"figures": False, "fields": "none"},
}
sheet = {
    **specimen,
    "name": "sheet",
    "kind": "sheet",
    "mesh": {"size": 0.01, "corner_size": 0.002},
    "discretisation": {"scheme": "hinge", "degree": 2},
}
spacings = [0.0096, 0.0048]  # m
results = {"sheet": pf.run(sheet, RESULTS / "lattice_and_sheet" / "sheet")}
for spacing in spacings:
    name = f"lattice, {1e3 * spacing:g} mm"
    lattice = {**specimen, "name": "lattice", "kind": "lattice", "lattice": {"spacing": spacing}}
    folder = RESULTS / "lattice_and_sheet" / f"lattice_{1e3 * spacing:g}_mm"
    results[name] = pf.run(lattice, folder)

# %%
force = {name: result.last["force_x"] for name, result in results.items()}
difference = {name: value / force["sheet"] - 1 for name, value in force.items()}
for name, value in force.items():
    print(f"{name:18}  force {value:7.3f} N  {difference[name]:+.2%}")

# %%
figure, axes = plt.subplots(figsize=(5, 4), layout="constrained")
for name, result in results.items():
    axes.plot(
        34 * result.history["load"], result.history["force_x"], "o-", markersize=3, label=name
    )
axes.set(xlabel="grip displacement (mm)", ylabel="force in x (N)")
axes.legend()
figure.savefig(RESULTS / "lattice_and_sheet.png", dpi=120)
