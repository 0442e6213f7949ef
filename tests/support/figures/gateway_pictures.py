"""Pictures that `cellmirror snapshot` takes of a running gateway, with simulated devices beside it."""

import subprocess
import sys
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parents[3]
sys.path[:0] = [str(ROOT / "tests" / "support")]
import gateway as g  # noqa: E402
from run_documented import move_into_own_namespaces  # noqa: E402

# name: (cell, seconds until then, commands, options of snapshot). Lengths of SCRIPT are in mm. Each begins with the cell as
# it starts by itself; "> DEVICE ends" ends a simulated device.
PICTURES = {
    "cell_mirrored": ("transfer_cell", 2, ["STVW 0 VP 600 -11800 6000 LP 5200 400 1300 VA 38"], ["--view", "0"]),
    "display_two": ("transfer_cell", 2, ["STDP 2"], []),
    "distances": ("transfer_cell", 1, [
        "ROBOT MANTEC_R3 offline", "POS_ROB MANTEC_R3 JOINT_ABS 0 0 0 0 0 0", "SET_COLLPAR warning 150", "POS_ROB TRAEGERSYSTEM JOINT_ABS 2000 -2000 600",
        "POS_ROB MANTEC_RM3 JOINT_ABS 0 40.1 68.8 0 30 0", "STVW 0 VP 600 -4300 2900 LP 2000 -1500 1650 VA 40"], ["--view", "0"]),
    "range_cones": ("transfer_cell", 1, [
        *(f"SET_USSPAR active {sensor} 1" for sensor in ("USS_1B", "USS_2", "USS_3", "USS_5", "USS_6")),
        "STVW 0 VP 1500 -7500 4200 LP 4600 600 900 VA 40"], ["--view", "0"]),
    "camera_pyramid": ("transfer_cell", 3, ["CAM_VIEW_PYRAMID UMG_Kamera_1 on", "STVW 0 VP 1000 -6000 4800 LP 3900 1500 1600 VA 40"],
                       ["--view", "0"]),
    "camera_view": ("transfer_cell", 3, [], ["--camera", "UMG_Kamera_1"]),
    "force_arrows": ("transfer_cell", 2, ["SET_FORCE_ARROW 4 4 0", "STVW 0 VP 1300 -5600 2900 LP 3900 700 700 VA 34"], ["--view", "0"]),
    "trace": ("transfer_cell", 1, [
        "ROBACT MANTEC_RM3", "SET_MODE SMEAR on", "SET_MODE TCP_DRAW on", "STVW 0 VP 600 -3500 2600 LP 1500 1500 1500 VA 40",
        "POS_ROB MANTEC_RM3 JOINT_ABS 40 40 80 0 30 0", "POS_ROB MANTEC_RM3 JOINT_ABS -40 10 60 0 60 0"], ["--view", "0"]),
    "ghost": ("transfer_cell", 2, ["> PUMA_762 ends", "STVW 0 VP 5000 -4200 2600 LP 7600 600 900 VA 40"], ["--view", "0"]),
    "can_cell": ("can_cell", 0, [], []),
    "tissue_network": ("trainer", 3, ["eladyn_show_def 1", "STVW 0 VP -120 -200 200 LP 5 20 40 VA 34"], ["--view", "0"]),
    "volume_cell": ("volume_cell", 1, ["VV_SET_LUT MEDICAL_LUT", "VV_SET_LUT_PAR MEDICAL_LUT 0 0 0.28 1", "STVW 0 VP 520 -620 480 LP 0 0 110 VA 32"],
                    ["--view", "0"]),
    "volume_slice": ("volume_cell", 1, [
        "VV_CLIP_POS CLP5 ELE 90 AZI 0 DIST -66", "VV_CLIP_POS CLP6 ELE 90 AZI 0 DIST -86", "VV_CLIP CLP5 active", "VV_CLIP CLP6 reverse",
        "VV_SET_LUT_PAR MEDICAL_LUT 0 0.4 0.4 1", "STVW 0 VP 260 -420 420 LP 0 0 60 VA 36"], ["--view", "0"]),
    "haptic_touch": ("phantom_trainer", 5, ["SET_FORCE_ARROW 0 0 4", "STVW 0 VP -200 -320 260 LP 0 0 50 VA 30"], ["--view", "0"]),
}
SIZE = "880x560"
INSTANCE = "default"  # whose keys the simulated devices know; take_all() gives it a namespace of its own


def simulators(cell):
    """By their names. Pedals write messages into the picture, and a bus vcan0 is not everywhere: both are left out."""
    file = g.CELLS / cell / "simulators.txt"
    lines = file.read_text().splitlines() if file.exists() else []
    words = [line.split() for line in lines if line.strip() and not line.startswith(("#", "PEDALS")) and "vcan0" not in line]
    return {name: g.Process([g.BIN / program, *arguments, "--no-input", "--quiet"]) for name, program, *arguments in words}


def command(scratch, devices, text):
    if text.startswith("> "):
        devices[text.split()[1]].kill()
        time.sleep(3)
        return
    answer = scratch.send(text, instance=INSTANCE)
    if answer.returncode != 0:
        raise SystemExit(f"{text}: {answer.stderr}")


def snapshot(scratch, target, options):
    done = scratch.cellmirror("snapshot", "--instance", INSTANCE, "--size", SIZE, "--quality", "86", "-o", str(target), *options)
    if done.returncode != 0:
        raise SystemExit(done.stderr)


def take(name, target):
    cell, seconds, commands, options = PICTURES[name]
    scratch = g.Scratch(cell, startup=True)
    devices = simulators(cell)
    gateway = g.Gateway(scratch, pictures=True, instance=INSTANCE)
    try:
        time.sleep(seconds)
        for text in commands:
            command(scratch, devices, text)
        time.sleep(1)
        snapshot(scratch, target, options)  # from now on there is a viewer
        time.sleep(1)
        snapshot(scratch, target, options)
    finally:
        gateway.close()
        for device in devices.values():
            device.close()
        scratch.remove()


def take_all(names, folder):
    """In namespaces of their own, so that robots and gateways of this machine are in no picture."""
    command = [sys.executable, "-B", __file__, str(folder), *names]
    subprocess.run(command, check=True)


if __name__ == "__main__":
    move_into_own_namespaces()
    for name_of in sys.argv[2:]:
        take(name_of, Path(sys.argv[1]) / f"{name_of}.jpg")
