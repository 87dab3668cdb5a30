"""Verdicts under changed unstated parameters."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from matplotlib.colors import ListedColormap
from matplotlib.figure import Figure

from paper.verdict.rules import Judgement

LEVEL = {"not": 0, "partly": 1, "reproduced": 2}
COLOURS = ListedColormap(["#d95f5f", "#f2d16b", "#6bb36b"])


def figure_sensitivity(title: str, table: Mapping[str, Mapping[str, Judgement]]) -> Figure:
    """One row a change, one column a part of a trend: red not, yellow partly, green reproduced, white not computed."""
    rows, columns = list(table), list(next(iter(table.values())))
    levels = np.full((len(rows), len(columns)), np.nan)
    for i, row in enumerate(rows):
        for j, column in enumerate(columns):
            if column in table[row]:
                levels[i, j] = LEVEL[table[row][column].verdict]
    figure = Figure(figsize=(12, 0.24 * len(rows) + 1.2), layout="constrained")
    axes = figure.subplots()
    axes.pcolormesh(levels, cmap=COLOURS, vmin=0, vmax=2, edgecolors="white", linewidth=0.5)
    axes.set_xticks(np.arange(len(columns)) + 0.5, columns, fontsize=7)
    axes.set_yticks(np.arange(len(rows)) + 0.5, rows, fontsize=7)
    axes.invert_yaxis()
    axes.set_title(title, fontsize=9)
    return figure
