#!/usr/bin/python3
"""From numpy arrays to a saved figure: a field of waves, seen from above, and how closed it is."""
import matplotlib
matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
import surfelao

side = 250
x, y = np.meshgrid(np.linspace(0, 10, side), np.linspace(0, 10, side))
z = np.sin(3 * x) * np.cos(2 * y) + 0.5 * np.sin(x * y / 3)
i = np.arange(side * side).reshape(side, side)[:-1, :-1].ravel()
faces = np.concatenate([np.stack(c, 1) for c in ((i, i + 1, i + side + 1), (i, i + side + 1, i + side))])
baked = surfelao.bake(np.stack([x, y, z], -1).reshape(-1, 3), faces)
plt.imshow(baked.occlusion.reshape(side, side), cmap="gray_r", extent=(0, 10, 0, 10), origin="lower")
plt.colorbar(label="occlusion, 0 = open")
plt.gca().set(xlabel="x", ylabel="y")
plt.title(f"seen error {baked.error['rmse']:.4f}, {baked.seconds['total']:.2f} s")
plt.savefig("waves.png", dpi=150)
