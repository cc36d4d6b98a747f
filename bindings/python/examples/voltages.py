"""Voltages of a circuit: on the membrane at one moment, and of one cell over time.

python voltages.py OUT [CIRCUIT]
"""

# %%
from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

import neurotess as nt

out = Path(sys.argv[1] if len(sys.argv) > 1 else ".")

# %% A SONATA circuit of yours, or one that the command grows.
if len(sys.argv) > 2:
    folder = Path(sys.argv[2])
else:
    folder = out / "circuit"
    grow = [sys.executable, "-m", "neurotess", "synth", "circuit", "-o", str(folder)]
    grow += ["--neurons", "20", "--morphologies", "4", "--points", "150", "--quiet"]
    subprocess.run(grow, check=True)

# %% Nodes are a data frame, recordings are arrays.
circuit = nt.Circuit(folder)
print(circuit.nodes.head())
reports = [circuit.report(name) for name in circuit.reports]
voltages = next(report for report in reports if not report.is_of_spikes)
node = int(voltages.node_ids[0])
somata = voltages.values(node)[:, 0]
moment = float(voltages.times[int(np.argmax(somata))])

# %% The moment when the soma of this cell is most depolarized.
picture = circuit.render(report=voltages.path, time=moment, size=(800, 600))
figure, (left, right) = plt.subplots(1, 2, figsize=(12, 4), layout="constrained")
left.imshow(np.asarray(picture))
left.set_axis_off()
nt.plot.voltage(voltages, node, ax=right)
right.axvline(moment, color="gray", linewidth=0.5)
figure.savefig(out / "voltages.png", dpi=150)
