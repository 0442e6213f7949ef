"""Diagrams of the program: folders, threads, the tick, the ways through the code, recordings."""

import re
from pathlib import Path

from svg import FAINT, INK, Drawing

ROOT = Path(__file__).resolve().parents[3]
GROUPS = ("rt_core", "config", "drivers", "ipc", "scripts", "sim_devices", "app")
FILL_OF = {"rt_core": "green", "config": "grey", "drivers": "blue", "ipc": "blue", "scripts": "amber", "sim_devices": "grey", "app": "red"}


def layers_of():
    text = (ROOT / "cmake/Layers.cmake").read_text()
    table = text[text.index("set(CELLMIRROR_LAYERS"):]
    rows = {folder: allowed.split() for folder, allowed in re.findall(r'"([^":]+):([^"]*)"', table[:table.index('")') + 2])}
    del rows["tests"]
    return rows


def levels_of(rows):
    """0: uses nothing of the project; else one more than the highest that it uses."""
    levels = {}

    def level(folder):
        if folder not in levels:
            levels[folder] = -1  # of itself
            used = [other for other in (rows if "*" in rows[folder] else rows[folder]) if other != folder]
            levels[folder] = 1 + max((level(other) for other in used), default=-1)
        return levels[folder]

    for folder in rows:
        level(folder)
    return levels


def layers():
    rows = layers_of()
    levels = levels_of(rows)
    wide = {"rt_core": 3, "config": 1, "drivers": 1, "ipc": 1, "scripts": 1, "sim_devices": 1, "app": 1}
    cell, gap, pitch = 106, 4, 20
    in_level = {}  # the names in one level and group
    for folder, level in levels.items():
        group = folder.split("/")[0]
        in_level.setdefault((level, group), []).append(folder.removeprefix(group + "/"))
    top = max(levels.values())
    heights = [max(-(-len(in_level.get((level, group), [])) // wide[group]) for group in GROUPS) * pitch + 8 for level in range(top + 1)]
    left, head = 20, 62
    width = left + sum(wide[group] * cell + 12 for group in GROUPS) + 4
    drawing = Drawing(width, head + sum(heights) + 14, "Folders by their level: each includes only folders of lower levels")
    drawing.text(left, 20, "A folder may include only folders that stand lower. cmake/Layers.cmake says which of them.", 13, "start")
    y = head
    for level in range(top, -1, -1):
        drawing.path([(left, y + heights[level] - 2), (width - 16, y + heights[level] - 2)], "#d5dade", 1)
        x = left
        for group in GROUPS:
            for i, name in enumerate(sorted(in_level.get((level, group), []))):
                row, column = divmod(i, wide[group])
                drawing.box(x + column * cell, y + 2 + row * pitch, cell - gap, pitch - 3, name, FILL_OF[group], 9.5, radius=3)
            x += wide[group] * cell + 12
        y += heights[level]
    x = left
    for group in GROUPS:
        drawing.text(x + (wide[group] * cell - gap) / 2, 52, group, 13, bold=True)
        x += wide[group] * cell + 12
    return drawing


def threads():
    d = Drawing(880, 470, "Threads of the gateway and the queues between them")
    streams = d.box(20, 60, 200, 62, "stream threads\nCAN, DDS, RTDE: one a device")
    device = d.box(20, 170, 200, 62, "device program\nhaptic device, another process", "grey")
    ways_in = d.box(20, 330, 200, 80, "threads of the ways in\nSCRIPT messages, page,\ncontrol socket, foot switches")
    tick = d.box(350, 60, 200, 172, "tick\nSCHED_FIFO, 1 kHz\n\nreads samples and commands,\nchecks, moves, computes\nforces, publishes", "red")
    owner = d.box(350, 330, 200, 80, "cell owner\nthe model of the cell, SCRIPT,\nplans of moves", "amber")
    workers = d.box(680, 60, 180, 80, "workers\ncollisions, ranging, forces,\ncontacts, tissue", "green")
    out = d.box(680, 185, 180, 62, "outputs\nDDS, SENSOR queue, page", "green")
    recorder = d.box(680, 290, 180, 62, "recorders\nrecordings, flight records", "green")
    d.box(680, 385, 180, 62, "render service\npictures", "green")
    d.arrow(streams.right_at(), tick.left_at(0.18), label="Fifo of samples")
    d.arrow(device.right_at(), (tick.x, device.middle_y), label="shared memory", both=True)
    d.arrow(ways_in.right_at(), owner.left_at(), label="locked list")
    d.arrow(owner.top_at(0.3), tick.bottom_at(0.3), label="Fifo of\ncommands", at=(owner.x + 48, 276), anchor="end")
    d.arrow(tick.bottom_at(0.7), owner.top_at(0.7), label="Broadcast\nof ticks", at=(owner.x + 142, 276), anchor="start")
    d.arrow(tick.right_at(0.15), workers.left_at(0.32), label="Broadcast of ticks", at=(612, 77))
    d.arrow(workers.left_at(0.75), (tick.right, workers.y + 0.75 * workers.height), label="Latest: contacts,\ntissue forces", at=(605, 140))
    d.arrow(tick.right_at(0.8), out.left_at(0.2), label="Broadcast", at=(605, 191))
    d.arrow(tick.right_at(0.95), (640, 223.4), (640, recorder.middle_y - 8), (recorder.x, recorder.middle_y - 8), label="Broadcast,\nRing", at=(634, 262), anchor="end")
    d.arrow(owner.right_at(0.6), (665, 378), (665, 132), (workers.x, 132), dash=True)
    d.path([(665, 236), (680, 236)], dash=True, arrow=True)
    d.path([(665, 340), (680, 340)], dash=True, arrow=True)
    d.path([(550, 396), (665, 396), (680, 404)], dash=True, arrow=True)
    d.text(602, 425, "snapshots of the cell\n(immutable, dashed)", 12, colour=FAINT)
    d.text(20, 28, "Nothing that the tick does waits for another thread. Queues that are full refuse or replace, and count.", 13, "start")
    return d


def tick():
    d = Drawing(880, 250, "One period of the loop")
    steps = (("commands", "of the owner, a\nbounded number", "amber"), ("samples", "of all streams; each\nvalue is checked", "blue"),
             ("haptics", "pose in,\nforce out", "red"), ("moves", "set points,\nlimited", "green"), ("followers", "of other robots\n(MASTER_SLAVE)", "green"),
             ("publish", "one TickState\nfor all readers", "blue"), ("record", "in the rings of the\nflight recorder", "grey"))
    d.text(20, 28, "One period of the loop, 1 ms at 1000 Hz (times not to scale)", 13, "start")
    x, width = 120, 88
    d.path([(20, 120), (862, 120)], FAINT, 1, arrow=True)
    d.text(862, 140, "time", 12, "end", colour=FAINT)
    for i, (name, more, fill) in enumerate(steps):
        d.box(x + i * width, 84, width - 4, 36, name, fill, 12)
        d.text(x + i * width + width / 2 - 2, 160 if i % 2 == 0 else 200, more, 11)
        d.path([(x + i * width + width / 2 - 2, 122), (x + i * width + width / 2 - 2, 147 if i % 2 == 0 else 187)], "#c3c9ce", 1)
    d.box(x + 7 * width, 84, 106, 36, "sleep", "white", 12, dash=True)
    d.path([(40, 60), (40, 132)], INK, 1.5)
    d.text(40, 54, "scheduled", 12)
    d.path([(x, 66), (x, 84)], FAINT, 1)
    d.arrow((40, 74), (x, 74), both=True)
    d.text(80, 68, "wake-up", 11, colour=FAINT)
    end = x + 7 * width - 4
    d.arrow((x, 62), (end, 62), both=True, label="tick (loop.compute_us)", at=((x + end) / 2, 56))
    d.path([(838, 60), (838, 132)], INK, 1.5)
    d.text(838, 54, "next", 12)
    return d


def paths():
    d = Drawing(880, 330, "Three ways through the code")
    lanes = (("A CAN frame, to a picture of the cell", "blue",
              (("drivers/can", "joint sample"), ("rt_core/engine", "tick state"), ("app/snapshot", "poses"), ("app/render", "scene"), ("drivers/display", "image"),
               ("ipc/web", "browser"))),
             ("A SCRIPT command, to its acknowledgement", "amber",
              (("ipc/sysv", "command"), ("app/owner", "in its turn"), ("scripts/runner", "parsed"), ("app/owner", "plan"), ("rt_core/engine", "moves, ends"),
               ("ipc/sysv", "done"))),
             ("The pose of a haptic device, to a force, within one tick", "red",
              (("drivers/haptic", "pose"), ("rt_core/engine", "channel"), ("rt_core/haptics", "force, limited"), ("drivers/haptic", "force"))))
    for lane, (title, fill, stations) in enumerate(lanes):
        y = 20 + lane * 104
        d.text(20, y + 8, title, 13, "start", bold=True)
        before = None
        for i, (folder, result) in enumerate(stations):
            box = d.box(20 + i * 143, y + 20, 125, 48, f"{folder}\n{result}", fill, 12)
            if before:
                d.arrow(before.right_at(), box.left_at())
            before = box
    return d


def recording():
    d = Drawing(880, 330, "From the tick to a recording")
    tick_box = d.box(20, 60, 130, 90, "tick", "red")
    results = d.box(20, 170, 130, 50, "workers, owner", "green")
    streams = d.box(20, 240, 130, 70, "streams\nCAN, DDS, RTDE", "blue")
    recorder = d.box(320, 80, 140, 150, "recorder\nencodes messages", "amber")
    buffer = d.box(530, 115, 120, 80, "buffer\n16 MiB", "grey")
    writer = d.box(720, 115, 140, 80, "recording\ncompresses, writes", "amber")
    d.arrow(tick_box.right_at(0.25), recorder.left_at(0.15), label="Broadcast: newest state", at=(235, 76))
    d.arrow(tick_box.right_at(0.75), recorder.left_at(0.4), label="ring of ticks, from 4 MiB", at=(235, 122))
    d.arrow(results.right_at(), recorder.left_at(0.75), label="boards", at=(235, 186))
    d.arrow(streams.right_at(), recorder.bottom_at(0.2), label="4,096 frames or 256 KiB a stream", at=(180, 292), anchor="start")
    d.arrow(recorder.right_at(), buffer.left_at())
    d.arrow(buffer.right_at(), writer.left_at())
    d.arrow(writer.bottom_at(), (790, 260), label="chunks in an MCAP file,\nat the latest after 0.5 s", at=(776, 222), anchor="end")
    d.box(730, 260, 120, 30, "F.mcap", "white", 12)
    d.text(20, 28, "The loop waits for none of them. What finds no room is left out and counted for its topic:", 13, "start")
    d.text(500, 62, "a quarter full: pictures;  half: /tf, forces, status;\nthree quarters: states;  full: log, commands, events, inputs", 11, "start", colour=FAINT)
    return d


DIAGRAMS = {"layers": layers, "threads": threads, "tick": tick, "paths": paths, "recording": recording}
