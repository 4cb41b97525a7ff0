#!/usr/bin/env python3
"""Makes the drawings of docs/masks.md: draw.py FOLDER

Writes an SVG for each drawing and numbers.json, the worked numbers of the text. All is computed
from the formulas and the constants of tree/masks. Pure Python, no packages; equal bytes on every
run.
tests/check_drawings.sh compares the committed files with a new run.
"""
import argparse
import json
import os
import sys

sys.dont_write_bytecode = True  # before the modules are read
sys.path.append(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))  # mask_constants

import answers
import nodes
import raster
import walk

MODULES = [raster, nodes, walk, answers]


def rounded(value):
    if isinstance(value, list):
        return [rounded(v) for v in value]
    return value if isinstance(value, int) else float(f"{value:.5g}")


def main():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", help="where the drawings and their numbers go")
    folder = parser.parse_args().folder
    os.makedirs(folder, exist_ok=True)
    numbers = {}
    for module in MODULES:
        for name, draw in module.DRAWINGS.items():
            with open(os.path.join(folder, name + ".svg"), "w", newline="\n") as out:
                out.write(draw(numbers).svg())
    with open(os.path.join(folder, "numbers.json"), "w", newline="\n") as out:
        json.dump({key: rounded(value) for key, value in numbers.items()}, out, indent=1)
        out.write("\n")


if __name__ == "__main__":
    main()
