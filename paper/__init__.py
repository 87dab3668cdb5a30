"""The paper's figures and trends, recomputed: `python -m paper` writes docs/paper.md."""
