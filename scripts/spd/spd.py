#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Writes one of Eric Haines' Standard Procedural Databases as NFF to stdout.

Our own code, written from the published descriptions (IEEE CG&A, November 1987; SPD 3.14). Sizes mean
what they mean there; --corners asks for the 513 x 513 rays of the databases' table of ray counts.
"""
import argparse
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
sys.dont_write_bytecode = True

import balls
import gears
import mount
import rings
import teapot
import tetra
import tree
from nff import Writer

DATABASES = {"balls": balls, "gears": gears, "mount": mount, "rings": rings, "teapot": teapot,
             "tetra": tetra, "tree": tree}
LARGEST = {"balls": 8, "gears": 40, "mount": 12, "rings": 80, "teapot": 500, "tetra": 13,
           "tree": 22}


def parse_arguments():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("name", choices=DATABASES)
    parser.add_argument("--size", type=int, help="default: the usual one")
    parser.add_argument("--corners", action="store_true", help="513 x 513 rays at pixel corners")
    arguments = parser.parse_args()
    arguments.size = arguments.size or DATABASES[arguments.name].USUAL
    if not 1 <= arguments.size <= LARGEST[arguments.name]:
        parser.error(f"--size of {arguments.name}: give 1 to {LARGEST[arguments.name]}")
    return arguments


def main():
    arguments = parse_arguments()
    sys.stdout.write(f"# {arguments.name}, size {arguments.size}\n")
    DATABASES[arguments.name].write(Writer(sys.stdout, arguments.corners), arguments.size)


if __name__ == "__main__":
    main()
