"""List the bearing catalogue, or explain one bearing: its geometry, orders and source.

Example: sideband bearings 6205
"""

from __future__ import annotations

import argparse
import math

from app.cli.files import json_text
from sim.core.errors import SpecError
from sim.parts.bearing import CatalogueRow, catalogue, defect_orders, lookup, missing
from sim.parts.bearing.uncatalogued import uncatalogued


def configure(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments."""
    parser.add_argument("name", metavar="NAME", nargs="?", help="explain this one")
    parser.add_argument("--json", action="store_true", help="print JSON")


def run(arguments: argparse.Namespace) -> int:
    """Run the command."""
    if arguments.name is not None:
        unknown = uncatalogued(arguments.name, "NAME")
        if unknown is not None:
            raise SpecError(unknown)
        row = lookup(arguments.name)
        print(json_text(_document(row)) if arguments.json else _explained(row), end="" if arguments.json else "\n")
        return 0
    if arguments.json:
        rows = [_document(row) for row in catalogue().values()]
        print(json_text({"bearings": rows, "missing": dict(missing())}), end="")
        return 0
    print(f"{'designation':<14} {'balls':>5} {'ball mm':>8} {'pitch mm':>9} {'BPFO':>7} {'BPFI':>7}  basis      maker")
    for row in catalogue().values():
        orders = defect_orders(row.geometry())
        print(
            f"{row.designation:<14} {row.balls:>5} {1e3 * row.ball_diameter_m:>8.3f} {1e3 * row.pitch_diameter_m:>9.3f}"
            f" {orders.outer_pass:>7.4f} {orders.inner_pass:>7.4f}  {row.basis:<9}  {row.maker}"
        )
    if missing():
        print(f"left out for want of a source: {', '.join(missing())} (see --json)")
    return 0


def _document(row: CatalogueRow) -> dict[str, object]:
    orders = defect_orders(row.geometry())
    computed = {"ftf": orders.cage, "bpfo": orders.outer_pass, "bpfi": orders.inner_pass, "bsf": orders.ball_spin}
    return {**vars(row), "published_orders": dict(row.published_orders), "orders": computed}


def _explained(row: CatalogueRow) -> str:
    orders = defect_orders(row.geometry())
    ball, pitch = 1e3 * row.ball_diameter_m, 1e3 * row.pitch_diameter_m
    angle = math.degrees(row.contact_angle_rad)
    lines = [f"{row.designation} ({row.maker}): {row.balls} {row.element}s of {ball:.4g} mm, {row.basis}"]
    lines += [f"  pitch circle {pitch:.4g} mm, contact angle {angle:.3g} deg"]
    lines += [f"  orders: FTF {orders.cage:.5g}, BPFO {orders.outer_pass:.5g}, BPFI {orders.inner_pass:.5g}"]
    lines += [f"  BSF {orders.ball_spin:.5g} (ball defects show at twice this)", f"  source: {row.source}"]
    return "\n".join(lines)
