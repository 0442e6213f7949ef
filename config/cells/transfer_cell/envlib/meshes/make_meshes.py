#!/usr/bin/env python3
"""Makes the meshes of this cell as binary STL, in metres: closed solids that nobody has to unzip.

  make_meshes.py [--detail N] [--into FOLDER]

--detail 5 divides curves and lengths so finely that there are about 5 times as many triangles; --into: where the files
go (this folder). Python's standard library is all it needs."""
import argparse
import math
import pathlib
import sys

from solids import Detail, bolt_ring, girder, loft, ring, rounded, section, tube


def manutec(d):
    """The housings of the arm by their joints' frames (manutec_r3.mpc)."""
    yield "manutec_foot", bolt_ring(0.10, 0.18, 0.155, 0.009, 8, 0.0, 0.03, d, 2)
    yield "manutec_base", loft(rounded([
        section(0.0, 0.14), section(0.26, 0.12), section(0.27, 0.14), section(0.38, 0.14), section(0.39, 0.125),
        section(0.50, 0.125)], 0.012, d, 2), 28, d, 0.2)
    yield "manutec_shoulder", loft(rounded([
        section(-0.165, 0.13, 0.12, 3), section(-0.12, 0.15, 0.13, 5), section(-0.02, 0.15, 0.13, 6),
        section(-0.012, 0.142, 0.122, 6), section(0.005, 0.142, 0.122, 6), section(0.013, 0.15, 0.13, 6),
        section(0.13, 0.14, 0.12, 5)], 0.025, d, 2), 24, d)
    yield "manutec_upper_arm", loft(rounded([
        section(-0.05, 0.080, 0.075, 4), section(0.06, 0.085, 0.080, 5), section(0.12, 0.070, 0.080, 5),
        section(0.30, 0.065, 0.070, 5), section(0.36, 0.075, 0.060, 4), section(0.41, 0.075, 0.050, 3)],
        0.015, d, 2), 24, d)
    yield "manutec_elbow", loft(rounded([
        section(-0.11, 0.085), section(-0.07, 0.085), section(-0.065, 0.10), section(0.065, 0.10),
        section(0.07, 0.085), section(0.11, 0.085)], 0.01, d, 2), 24, d, 0.2).along("x")
    yield "manutec_forearm", loft(rounded([
        section(0.10, 0.070, 0.070, 4), section(0.22, 0.075, 0.075, 4), section(0.26, 0.060, 0.060, 3),
        section(0.62, 0.048, 0.048, 2), section(0.64, 0.060, 0.060, 2), section(0.70, 0.060, 0.060, 2)],
        0.012, d, 2), 24, d)
    yield "hand_flange", loft(rounded([
        section(-0.01, 0.065), section(0.005, 0.065)], 0.003, d, 1), 24, d)
    yield "hand_bolts", bolt_ring(0.016, 0.050, 0.033, 0.0045, 6, 0.003, 0.02, d, 2)


def puma(d):
    """Upper arm along x and forearm along y of their joints' frames (puma_762.mpc)."""
    yield "puma_foot", bolt_ring(0.13, 0.20, 0.18, 0.010, 8, 0.0, 0.035, d, 2)
    yield "puma_column", loft(rounded([
        section(0.0, 0.165), section(0.10, 0.165), section(0.12, 0.15), section(0.80, 0.15), section(0.82, 0.17),
        section(0.93, 0.17)], 0.012, d, 2), 28, d, 0.2)
    yield "puma_shoulder", loft(rounded([
        section(-0.17, 0.16), section(-0.10, 0.19), section(0.08, 0.19), section(0.17, 0.15)], 0.03, d, 3), 28, d)
    yield "puma_drum", loft(rounded([section(0.10, 0.13), section(0.20, 0.12), section(0.275, 0.12)], 0.01, d, 2),
                            24, d).along("y")
    yield "puma_upper_arm", loft(rounded([
        section(-0.16, 0.100, 0.055, 3, y=0.34), section(-0.02, 0.125, 0.060, 5, y=0.34),
        section(0.12, 0.120, 0.060, 6, y=0.34), section(0.40, 0.095, 0.050, 6, y=0.34),
        section(0.62, 0.100, 0.055, 5, y=0.34), section(0.75, 0.070, 0.050, 3, y=0.34)], 0.02, d, 3), 28, d).along("x")
    yield "puma_forearm", loft(rounded([
        section(-0.15, 0.055, 0.070, 3), section(-0.02, 0.075, 0.100, 4), section(0.08, 0.075, 0.090, 5),
        section(0.40, 0.060, 0.070, 5), section(0.50, 0.050, 0.050, 3), section(0.56, 0.045, 0.045, 2)],
        0.015, d, 3), 28, d).along("y")


def gantry(d):
    yield "gantry_rail", girder(13.0, 0.125, 0.15, 0.022, 0.010, 7, d)
    yield "gantry_post", loft([
        section(0.0, 0.125, power=8), section(0.025, 0.125, power=8), section(0.026, 0.09, power=8),
        section(3.674, 0.09, power=8), section(3.675, 0.125, power=8), section(3.70, 0.125, power=8)], 16, d, 1.5)
    yield "gantry_bridge", girder(6.4, 0.06, 0.15, 0.018, 0.006, 6, d).across()
    yield "gantry_trolley", loft(rounded([
        section(-0.175, 0.43, 0.38, 10), section(-0.05, 0.45, 0.40, 10), section(-0.045, 0.43, 0.38, 10),
        section(0.05, 0.43, 0.38, 10), section(0.055, 0.45, 0.40, 10), section(0.175, 0.45, 0.40, 10)], 0.03, d, 2),
        28, d, 0.3)
    yield "gantry_mast", loft([
        section(-1.10, 0.185, power=6), section(-1.075, 0.185, power=6), section(-1.07, 0.10, power=8),
        section(1.07, 0.10, power=8), section(1.075, 0.14, power=8), section(1.10, 0.14, power=8)], 24, d, 0.5)


def crane(d):
    yield "crane_beam", girder(6.0, 0.15, 0.175, 0.025, 0.012, 6, d)
    yield "crane_trolley", loft(rounded([
        section(-0.125, 0.22, 0.18, 8), section(-0.06, 0.25, 0.20, 8), section(0.125, 0.25, 0.20, 8)], 0.02, d, 2),
        24, d)
    yield "crane_slewing_ring", bolt_ring(0.06, 0.13, 0.105, 0.008, 8, -0.16, -0.12, d, 2)
    yield "crane_arm", loft(rounded([
        section(-0.10, 0.080, 0.080, 4), section(0.10, 0.080, 0.080, 5), section(0.20, 0.070, 0.075, 6),
        section(1.05, 0.055, 0.060, 6), section(1.10, 0.070, 0.075, 4), section(1.28, 0.070, 0.075, 4)],
        0.015, d, 2), 20, d, 0.2).along("x")
    arc = [(0.06 * math.cos(a), -0.15 + 0.06 * math.sin(a))
           for a in (math.pi / 2 - math.radians(240 * i / d.steps(16)) for i in range(d.steps(16) + 1))]
    yield "hook", tube([(0.0, 0.05), (0.0, 0.02), (0.0, -0.02)] + arc, 0.018, 12, d)


def surroundings(d):
    yield "flange", bolt_ring(0.07, 0.15, 0.125, 0.009, 12, 0.0, 0.03, d, 3)
    yield "flange_face", ring([(0.07, 0.03), (0.10, 0.03), (0.10, 0.04), (0.07, 0.04)], 36, d)
    yield "holder", loft(rounded([section(0.0, 0.16), section(0.03, 0.16), section(0.035, 0.11), section(0.085, 0.11),
                                  section(0.09, 0.14), section(0.10, 0.14)], 0.004, d, 2), 28, d)
    yield "leg", loft([
        section(0.0, 0.075, power=6), section(0.015, 0.075, power=6), section(0.02, 0.045, power=8),
        section(0.80, 0.045, power=8), section(0.82, 0.065, power=8)], 16, d, 0.5)
    yield "tool_rack", loft(rounded([
        section(0.0, 0.42, 0.17, 10), section(0.08, 0.42, 0.17, 10), section(0.085, 0.45, 0.20, 10),
        section(0.40, 0.45, 0.20, 10), section(0.405, 0.44, 0.19, 10), section(0.415, 0.44, 0.19, 10),
        section(0.42, 0.45, 0.20, 10), section(0.80, 0.45, 0.20, 10)], 0.015, d, 2), 28, d, 0.3)
    yield "coupling", bolt_ring(0.012, 0.050, 0.034, 0.005, 6, 0.0, 0.04, d, 2)
    yield "screwdriver", loft([
        section(0.035, 0.020), section(0.06, 0.025), section(0.12, 0.025), section(0.125, 0.018), section(0.14, 0.018),
        section(0.145, 0.022), section(0.20, 0.012), section(0.205, 0.006), section(0.24, 0.006)], 16, d)
    yield "cupboard", loft(rounded([
        section(0.0, 0.57, 0.27, 12), section(0.10, 0.57, 0.27, 12), section(0.11, 0.60, 0.30, 12),
        section(1.00, 0.60, 0.30, 12), section(1.005, 0.59, 0.29, 12), section(1.02, 0.59, 0.29, 12),
        section(1.025, 0.60, 0.30, 12), section(1.90, 0.60, 0.30, 12)], 0.015, d, 2), 28, d, 0.5)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--detail", type=float, default=1.0, metavar="N")
    parser.add_argument("--into", type=pathlib.Path, default=pathlib.Path(__file__).parent, metavar="FOLDER")
    options = parser.parse_args()
    if not 0.1 <= options.detail <= 1000.0:
        parser.error("--detail is from 0.1 to 1000")
    options.into.mkdir(parents=True, exist_ok=True)
    detail = Detail(options.detail)
    total = 0
    for part in (manutec, puma, gantry, crane, surroundings):
        for name, mesh in part(detail):
            fault = mesh.fault()
            if fault:
                sys.exit(f"{name}: {fault}")
            mesh.write_stl(options.into / f"{name}.stl")
            total += len(mesh.triangles)
            print(f"{len(mesh.triangles):7d}  {name}")
    print(f"{total:7d}  together")


if __name__ == "__main__":
    main()
