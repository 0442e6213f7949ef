#!/usr/bin/python3
"""Makes the figures of the documents, docs/figures/. The lists below name all of them: a test compares.

    figures.py --list           every figure with what makes it
    figures.py NAME...          these, after ./run has built the programs; those of benches need ninja -C build benches
    figures.py --diagrams       all that are drawn from the sources: seconds, and the same bytes everywhere
    figures.py --made           all but those of measurements, which belong to an idle machine
"""

import argparse
import math
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent))
import gateway_pictures  # noqa: E402
import geometry  # noqa: E402
import protocols  # noqa: E402
import structure  # noqa: E402

ROOT = Path(__file__).resolve().parents[3]
FIGURES = ROOT / "docs" / "figures"
DIAGRAMS = {f"{name}.svg": draw for part in (structure, protocols, geometry) for name, draw in part.DIAGRAMS.items()}
PICTURES = {f"{name}.jpg": name for name in gateway_pictures.PICTURES}
TRANSFER = "config/cells/transfer_cell/cell.toml"
# Commands in the source root; FILE is the figure, SCRATCH a folder, in it postures.csv: the gantry lowers its arm into the floor, twice.
PLOTS = {
    "ik_plot.png": "build/bin/cellmirror ik --urdf config/cells/ros2_cell/robots/demo_arm/demo_arm.urdf --base base_link --tip tool0 "
                   "--samples 1000 --method ipopt --timeout-ms 50 --plot FILE",
    "simulate_plot.png": f"build/bin/cellmirror simulate --cell {TRANSFER} --script two_languages.spt --plot FILE",
    "collide_plot.png": f"build/bin/cellmirror collide --cell {TRANSFER} --poses SCRATCH/postures.csv --plot FILE",
    "range_plot.png": f"build/bin/cellmirror range --cell {TRANSFER} --poses SCRATCH/postures.csv --plot FILE",
    "volume_plot.png": "build/bin/cellmirror volume info config/cells/volume_cell/envlib/phantom.nrrd --plot FILE",
    "wall.png": "/usr/bin/python3 -B tests/support/wall_figure.py FILE",
}
PAGE = {name: "tests/support/page_figure.py" for name in ("monitor_page.png", "monitor_page_3d.png", "monitor_page_phone.png")}
MEASURED = {
    "engine_tick.png": "build/bin/engine_tick SCRATCH/t.csv FILE",
    "tissue_steps.png": "build/bin/tissue_steps SCRATCH/t.csv FILE",
    "volume_sizes.png": "for size in 128 192 256 384 512 768 1024; do build/bin/volume_pictures --size $size SCRATCH/t.csv FILE; done",
    "haptic_stiffness.png": "build/bin/haptics_stiffness SCRATCH/t.csv FILE",
    "recorded_joints.png": "/usr/bin/python3 -B tests/support/recording_figure.py FILE",
    "trainer.webp": "/usr/bin/python3 -B tests/bench/gateway/trainer_bench.py 38 --film SCRATCH/t.mp4 && ffmpeg -y -loglevel error -i SCRATCH/t.mp4 "
                    "-vf setpts=PTS/3.8,fps=12,scale=480:-1 -quality 50 -loop 0 FILE",
}
ALL = {**{name: "figures.py" for name in DIAGRAMS}, **{name: "cellmirror snapshot, see gateway_pictures.py" for name in PICTURES}, **PLOTS, **PAGE, **MEASURED}


def smaller(file):
    """256 colours are enough for charts and for the page."""
    subprocess.run(["ffmpeg", "-y", "-loglevel", "error", "-i", file, "-vf", "split[a][b];[a]palettegen=max_colors=256[p];[b][p]paletteuse=dither=none",
                    f"{file}.png"], check=True)
    shutil.move(f"{file}.png", file)


def write_postures(file):
    rows = [f"{0.02 * i:.3f},{1.15 + 0.35 * math.sin(0.06 * i):.4f}" for i in range(201)]
    file.write_text("\n".join(["TRAEGERSYSTEM.J_0,TRAEGERSYSTEM.J_2", *rows]) + "\n")


def keep(file):
    if file.suffix == ".png":
        smaller(file)
    shutil.copy(file, FIGURES / file.name)


def by_command(name, command):
    with tempfile.TemporaryDirectory() as scratch:
        write_postures(Path(scratch) / "postures.csv")
        file = Path(scratch) / name
        subprocess.run(["bash", "-euc", command.replace("FILE", str(file)).replace("SCRATCH", scratch)], cwd=ROOT, check=True, stdout=subprocess.DEVNULL)
        keep(file)


def of_the_page(names):
    with tempfile.TemporaryDirectory() as scratch:
        subprocess.run(["/usr/bin/python3", "-B", "tests/support/page_figure.py", scratch], cwd=ROOT, check=True)
        for name in names:
            keep(Path(scratch) / name)


def make(names):
    for name in names:
        if name in DIAGRAMS:
            (FIGURES / name).write_bytes(DIAGRAMS[name]().bytes())
        elif name in PLOTS or name in MEASURED:
            by_command(name, ALL[name])
    if page := [name for name in names if name in PAGE]:
        of_the_page(page)
    if pictures := [PICTURES[name] for name in names if name in PICTURES]:
        gateway_pictures.take_all(pictures, FIGURES)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("names", nargs="*", metavar="NAME", help="as in docs/figures: tick.svg")
    for option in ("--list", "--diagrams", "--made"):
        parser.add_argument(option, action="store_true")
    wanted = parser.parse_args()
    if wanted.list:
        print("\n".join(f"{name:26} {how}" for name, how in sorted(ALL.items())))
        return 0
    names = wanted.names or (list(DIAGRAMS) if wanted.diagrams else [name for name in ALL if name not in MEASURED] if wanted.made else [])
    if unknown := [name for name in names if name not in ALL]:
        parser.error(f"there is no figure {unknown[0]}; --list shows them")
    if not names:
        parser.error("which figures? See --help")
    make(names)
    return 0


if __name__ == "__main__":
    sys.exit(main())
