"""Long measurements, too long for the suite: every piece prints its figures and fails where one is beyond its bound.

python tests/long.py                           # what there is
python tests/long.py NAME [PART]               # a piece, or one of its parts
python tests/long.py [NAME] --minutes 6 --choice TEXT # as many parts as fit, of all pieces or one, in an order of TEXT
"""

import argparse
import random
import sys
import time
from pathlib import Path
from typing import Any

sys.path.insert(0, str(Path(__file__).parents[1]))

from tests import ten_minutes
from tests.collision import many_labels
from tests.docs import whole_gallery
from tests.engine import closed_form_poses, free_joint_sweeps, open_wrist_poses
from tests.reach import near_limits, posture_peers, refutations, self_motion_sweeps
from tests.robots import model_packages
from tests.server import soak, webhook_deliveries
from tests.server.hostile import collection
from tests.viewer import largest_picture

# By name: a module with ``PARTS``, functions by name that return figures, and ``violations(figures by part)``.
PIECES = {
    "near_limits": near_limits,
    "model_packages": model_packages,
    "collision_labels": many_labels,
    "free_joint": free_joint_sweeps,
    "closed_form_poses": closed_form_poses,
    "posture_peers": posture_peers,
    "self_motions": self_motion_sweeps,
    "open_wrist_poses": open_wrist_poses,
    "refutations": refutations,
    "hostile": collection,
    "soak": soak,
    "webhooks": webhook_deliveries,
    "largest_picture": largest_picture,
    "ten_minutes": ten_minutes,
    "gallery": whole_gallery,
}


def main() -> int:
    """Run a piece; 1 where it is violated."""
    arguments = _parser().parse_args()
    if arguments.minutes is not None:
        return _measured(_chosen(arguments.choice, arguments.piece), 60 * arguments.minutes)
    if not arguments.piece:
        for name, piece in PIECES.items():
            print(f"{name}: {piece.__doc__}\n  " + "; ".join(piece.PARTS))
        return 0
    parts = [(arguments.piece, part) for part in arguments.parts or PIECES[arguments.piece].PARTS]
    return _measured(parts)


def _measured(parts: list[tuple[str, str]], seconds: float = float("inf")) -> int:
    """Run parts of pieces until the time is over; 1 where a piece is violated."""
    began = time.perf_counter()
    figures: dict[str, dict[str, Any]] = {}
    for name, part in parts:
        if (start := time.perf_counter()) > began + seconds:
            break
        figures.setdefault(name, {})[part] = PIECES[name].PARTS[part]()
        print(f"{name}, {part} ({time.perf_counter() - start:.0f} s): {figures[name][part]}", flush=True)
    found = [fault for name, of_parts in figures.items() for fault in PIECES[name].violations(of_parts)]
    print("\n".join(found) or "within their bounds")
    return 1 if found else 0


def _chosen(text: str, only: str | None = None) -> list[tuple[str, str]]:
    """All parts of all pieces but those that are too long, or of one, in an order that follows from the text."""
    parts = [
        (name, part)
        for name, piece in PIECES.items()
        for part in piece.PARTS
        if only in (None, name) and part not in getattr(piece, "TOO_LONG", ())
    ]
    random.Random(text).shuffle(parts)
    return parts


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("piece", nargs="?", choices=PIECES)
    parser.add_argument("parts", nargs="*", metavar="part")
    parser.add_argument("--minutes", type=float, help="begin no part after so many minutes")
    parser.add_argument("--choice", default="", help="a text that the order of the parts follows from")
    return parser


if __name__ == "__main__":
    sys.exit(main())
