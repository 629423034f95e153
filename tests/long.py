"""Long measurements, too long for the suite: every piece prints its figures and fails where one is beyond its bound.

python tests/long.py              # what there is
python tests/long.py NAME [PART]  # a piece, or one of its parts
"""

import argparse
import sys
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1]))

from tests.reachability import near_limits
from tests.robots import model_packages

# By name: a module with ``PARTS``, functions by name that return figures, and ``violations(figures by part)``.
PIECES = {"near_limits": near_limits, "model_packages": model_packages}


def main() -> int:
    """Run a piece; 1 where it is violated."""
    arguments = _parser().parse_args()
    if not arguments.piece:
        for name, piece in PIECES.items():
            print(f"{name}: {piece.__doc__}\n  " + "; ".join(piece.PARTS))
        return 0
    piece = PIECES[arguments.piece]
    figures = {}
    for part in arguments.parts or piece.PARTS:
        start = time.perf_counter()
        figures[part] = piece.PARTS[part]()
        print(f"{part} ({time.perf_counter() - start:.0f} s): {figures[part]}", flush=True)
    found = piece.violations(figures)
    print("\n".join(found) or "within its bounds")
    return 1 if found else 0


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("piece", nargs="?", choices=PIECES)
    parser.add_argument("parts", nargs="*", metavar="part")
    return parser


if __name__ == "__main__":
    sys.exit(main())
