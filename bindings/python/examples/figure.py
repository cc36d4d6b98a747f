"""From a tracing to a figure: the cell, its Sholl diagram and its dendrogram.

python figure.py OUT [CELL.swc]
"""

# %%
from __future__ import annotations

import sys
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

import neurotess as nt

out = Path(sys.argv[1] if len(sys.argv) > 1 else ".")

# %% A tracing of yours, or one that is grown.
cell = nt.read(sys.argv[2]) if len(sys.argv) > 2 else nt.synth("pyramidal", seed=4, points=1500)
print(cell, cell.soma)

# %% The picture is an array that matplotlib shows.
picture = nt.render(cell, size=(600, 800), color_by="type", scale_bar=True)

figure, (left, middle, right) = plt.subplots(1, 3, figsize=(12, 5), layout="constrained")
left.imshow(np.asarray(picture))
left.set_axis_off()
nt.plot.sholl(cell, step=10.0, ax=middle)
nt.plot.dendrogram(cell, ax=right)
figure.savefig(out / "figure.pdf")
