"""Diagrams of what is exchanged and of what states there are: commands, streams, haptic devices, memories, trust, the service."""

from svg import FAINT, Drawing


def command_sequence():
    d = Drawing(880, 380, "A command over the message queues, and its acknowledgement")
    xs = {"client": 90, "queue 2351": 270, "cell owner": 450, "tick": 630, "queue 2352": 800}
    fills = {"client": "grey", "queue 2351": "blue", "cell owner": "amber", "tick": "red", "queue 2352": "blue"}
    for name, x in xs.items():
        d.box(x - 62, 16, 124, 34, name, fills[name])
        d.path([(x, 50), (x, 364)], "#b5bcc2", 1, dash=True)

    def message(y, sender, receiver, label):
        d.arrow((xs[sender], y), (xs[receiver], y), label=label)

    message(84, "client", "queue 2351", "@7 POS_ROB ...")
    message(116, "queue 2351", "cell owner", "command, tag 7")
    d.text(xs["cell owner"] + 8, 146, "parses, checks, plans", 12, "start", colour=FAINT)
    message(176, "cell owner", "tick", "move")
    d.text(xs["tick"] + 8, 206, "moves, tick by tick", 12, "start", colour=FAINT)
    message(236, "tick", "cell owner", "arrived")
    message(268, "cell owner", "queue 2352", "done")
    d.arrow((xs["queue 2352"], 304), (xs["client"], 304), label="message of type 7: done")
    d.text(90, 344, "If it cannot be executed: refused REASON, at once.", 12, "start", colour=FAINT)
    return d


def stream_states():
    d = Drawing(880, 400, "States of a mirrored joint")
    none = d.box(30, 60, 120, 52, "none\nnothing yet", "grey")
    fresh = d.box(330, 60, 150, 52, "fresh\nnew values", "green")
    stale = d.box(710, 60, 130, 52, "stale\nold", "amber")
    lost = d.box(710, 290, 130, 52, "lost\nvery old", "red")
    d.box(30, 290, 130, 52, "invalid\nrefused", "red")
    d.box(225, 290, 140, 52, "implausible\ncannot be true", "red")
    d.box(440, 290, 140, 52, "conflict\ntwo senders", "red")
    d.arrow(none.right_at(), fresh.left_at(), label="first value")
    d.arrow(fresh.right_at(0.3), stale.left_at(0.3), label="older than stale_after_s")
    d.arrow(stale.left_at(0.75), fresh.right_at(0.75), label="new value", at=(595, 117))
    d.arrow(stale.bottom_at(), lost.top_at(), label="older than\nlost_after_s", at=(782, 196), anchor="start")
    d.arrow(lost.left_at(0.3), (640, lost.y + 15.6), (640, 140), (460, 140), (460, 112), label="new value", at=(632, 225), anchor="end")
    d.arrow((340, 112), (340, 150), (80, 150), (80, 290), label="not finite, wrong length,\nwrong CRC or counter", at=(88, 172), anchor="start")
    d.arrow((110, 290), (110, 240), (352, 240), (352, 112), label="next good value", at=(118, 257), anchor="start")
    d.arrow((366, 112), (366, 265), (280, 265), (280, 290), dash=False, label="")
    d.arrow((320, 290), (320, 278), (384, 278), (384, 112), label="")
    d.text(230, 362, "outside of its bounds; over after\nplausible_after plausible values", 12, "start", colour=FAINT)
    d.arrow((420, 112), (420, 265), (480, 265), (480, 290))
    d.arrow((540, 290), (540, 240), (438, 240), (438, 112))
    d.text(470, 362, "over 1 s after the second\nsender was heard last", 12, "start", colour=FAINT)
    d.text(30, 28, "States of a mirrored joint. In all but fresh the robot is held where it was last good.", 13, "start")
    return d


def haptic_phases():
    d = Drawing(880, 330, "Phases of a haptic device")
    closed = d.box(20, 80, 120, 54, "0 closed\nforce zero", "grey")
    waiting = d.box(220, 80, 130, 54, "1 waiting\nforce zero", "blue")
    engaging = d.box(450, 80, 150, 54, "3 engaging\nforce fades in", "amber")
    active = d.box(720, 80, 140, 54, "4 active\nfull force", "green")
    faulted = d.box(450, 230, 150, 54, "5 faulted\nforce zero", "red")
    clutched = d.box(720, 230, 140, 54, "2 clutched\nforce zero", "blue")
    d.arrow(closed.right_at(), waiting.left_at(), label="online")
    d.arrow(waiting.right_at(), engaging.left_at(), label="sample and\nsurroundings", at=(400, 82))
    d.arrow(engaging.right_at(0.3), active.left_at(0.3), label="engage_time_s", at=(660, 90))
    d.arrow(active.left_at(0.75), engaging.right_at(0.75), label="a body has\nappeared", at=(660, 138))
    d.arrow(active.bottom_at(0.6), clutched.top_at(0.6), label="clutch button", at=(796, 190), anchor="end", size=11)
    d.arrow(clutched.left_at(), (690, 257), (690, 185), (592, 185), (592, 134), label="released", at=(645, 180), size=11)
    d.arrow(engaging.bottom_at(0.3), faulted.top_at(0.3), label="any fault,\nin any phase", at=(487, 175), anchor="end")
    d.arrow(faulted.top_at(0.5), engaging.bottom_at(0.5), label="RESET_HAPTIC,\nor it has passed", at=(531, 205), anchor="start", size=11)
    d.arrow((450, 265), (80, 265), (80, 134), label="offline, from any phase", at=(230, 284))
    d.text(20, 28, "Phases of a haptic device, with the number in the shared memory", 13, "start")
    return d


def haptic_memory():
    d = Drawing(880, 250, "The shared memory of a haptic device, 512 bytes")
    left, width = 30, 820
    sections = ((0, 76, "red", "force,\ntorques"), (76, 128, "white", ""), (128, 144, "grey", ""), (144, 256, "red", "force: time, phase, fault,\nforce of the device"),
                (256, 320, "white", ""), (320, 480, "blue", "device: time, buttons, position,\norientation, gripper, axes"), (480, 512, "white", ""))
    for begin, end, fill, words in sections:
        x = left + begin / 512 * width
        d.box(x, 70, (end - begin) / 512 * width, 64, words, fill, 12, dash=fill == "white", radius=2)
    for byte in (0, 76, 128, 144, 256, 320, 480, 512):
        x = left + byte / 512 * width
        d.path([(x, 134), (x, 142)], FAINT, 1)
        d.text(x + (3 if byte == 144 else -3 if byte == 128 else 0), 156, str(byte), 11, "start" if byte == 144 else "end" if byte == 128 else "middle", colour=FAINT)
    d.text(left + 136 / 512 * width, 52, "magic, version, size, gateway", 11, colour=FAINT)
    d.path([(left + 136 / 512 * width, 56), (left + 136 / 512 * width, 70)], FAINT, 1)
    d.text(left, 28, "Bytes of the shared memory of a haptic device", 13, "start")
    d.box(30, 180, 24, 20, "", "red")
    d.text(62, 195, "written by the gateway in every tick; odd force_lock (144) while it writes", 12, "start")
    d.box(30, 212, 24, 20, "", "blue")
    d.text(62, 227, "written by the device program; odd device_lock (320) while it writes", 12, "start")
    return d


def sensor_record():
    d = Drawing(880, 210, "Header of a record of the SENSOR channel, 40 bytes")
    left, width = 30, 820
    fields = ((0, 4, "magic"), (4, 6, "ver-\nsion"), (6, 8, "kind"), (8, 12, "length"), (12, 16, "reserved"), (16, 24, "sequence"), (24, 32, "time_ns"), (32, 40, "wall_time_ns"))
    scale = width / 48
    for begin, end, words in fields:
        d.box(left + begin * scale, 60, (end - begin) * scale, 56, "", "white" if words == "reserved" else "blue", radius=2)
        lines = words.split("\n")
        d.text(left + (begin + end) / 2 * scale, 92 - (len(lines) - 1) * 8, words, 11)
        d.text(left + begin * scale, 134, str(begin), 11, colour=FAINT)
    d.box(left + 40 * scale, 60, 8 * scale, 56, "data of its\nkind ...", "green", 11, radius=2)
    d.text(left + 40 * scale, 134, "40", 11, colour=FAINT)
    d.text(left, 30, "A record of the SENSOR channel: header of 40 bytes, then its data; little-endian", 13, "start")
    d.text(left, 168, "sequence: gaps are lost records.  time_ns: of the data, CLOCK_MONOTONIC.  wall_time_ns: the same instant, UTC.", 12, "start", colour=FAINT)
    d.text(left, 188, "length: of header and data together; the next record is the next message.", 12, "start", colour=FAINT)
    return d


def trust():
    d = Drawing(880, 440, "Who reaches the gateway, and what stands between")
    d.box(210, 50, 460, 370, "", "grey", dash=True, radius=12)
    d.text(440, 74, "this machine", 13, bold=True)
    gateway = d.box(350, 185, 180, 90, "gateway\nits user and root:\ntrusted", "green")
    robots = d.box(20, 200, 150, 60, "robots, buses\nCAN, DDS, RTDE", "amber")
    network = d.box(20, 330, 150, 60, "other machines\nof the network", "red")
    d.box(230, 335, 180, 66, "programs of\nthe same user", "green")
    d.box(450, 335, 200, 66, "other users\nof this machine", "amber")
    files = d.box(340, 92, 200, 50, "cell folder\nwho can write it decides", "green")
    browser = d.box(700, 200, 160, 60, "browser elsewhere\nby a proxy with TLS", "amber")
    d.arrow(robots.right_at(), gateway.left_at(), label="interface_address,\n[dds.security],\nallow_from", at=(280, 186), size=11)
    d.arrow(network.right_at(), (204, 360), label="refused", at=(190, 322), size=11)
    d.path([(208, 346), (208, 374)], "#b0453b", 4)
    d.arrow((380, 335), (380, 275), label="queues, memories,\nsocket: 0600", at=(372, 300), anchor="end", size=11)
    d.arrow((500, 335), (500, 275), label="may look at the page;\ncommands need its token", at=(508, 300), anchor="start", size=11)
    d.arrow(files.bottom_at(), gateway.top_at())
    d.arrow(browser.left_at(), gateway.right_at(), label="allow_remote, token", at=(602, 222), size=11)
    d.text(20, 28, "Who reaches the gateway, and what stands between. Loopback is the default everywhere.", 13, "start")
    return d


def service():
    d = Drawing(880, 330, "The gateway as a service")
    systemd = d.box(20, 60, 180, 66, "systemd\ncellmirror@NAME.service", "grey")
    gateway = d.box(340, 60, 200, 150, "cellmirror run\nuser cellmirror\n\nloop, SCHED_FIFO 80\npage and metrics on\n127.0.0.1:8420", "green")
    etc = d.box(20, 180, 180, 50, "/etc/cellmirror/cells/NAME\nthe cell, only read", "amber", 11)
    d.box(20, 260, 180, 50, "/var/lib/cellmirror/NAME\nrecords, saved views", "amber", 11)
    journal = d.box(340, 260, 200, 50, "journal\nCELLMIRROR_KIND=...", "grey")
    prometheus = d.box(680, 60, 180, 60, "Prometheus\nGET /metrics", "blue")
    health = d.box(680, 150, 180, 60, "a load balancer, a script\nGET /healthz", "blue", 12)
    d.box(680, 250, 180, 60, "browser\nthe page", "blue")
    d.arrow(systemd.right_at(0.3), gateway.left_at(0.13), label="starts, watchdog", at=(270, 72))
    d.arrow(gateway.left_at(0.32), systemd.right_at(0.75), label="ready, status", at=(270, 124))
    d.arrow(etc.right_at(), (gateway.x, 190))
    d.arrow((360, 210), (360, 245), (300, 245), (300, 285), (200, 285))
    d.arrow(gateway.bottom_at(0.6), journal.top_at(0.6))
    d.arrow(prometheus.left_at(), (540, 90))
    d.arrow(health.left_at(), (540, 150))
    d.arrow((680, 270), (610, 270), (610, 195), (540, 195))
    d.text(20, 28, "One instance of the unit for each cell", 13, "start")
    return d


def plant():
    d = Drawing(880, 400, "A plant: cells, discovery servers, and who reads the summaries")
    cells = [d.box(20, 40 + 110 * i, 190, 80, f"cell {name}\nrobots\ngateway", "green") for i, name in enumerate(("1", "2", "30"))]
    d.text(115, 253, "...", 16)
    servers = [d.box(320, 14 + 44 * i, 190, 38, f"discovery server {i}\nUDP 11811", "grey", 12) for i in range(2)]
    broker = d.box(320, 330, 190, 50, "MQTT broker\nTCP 8883", "grey", 12)
    wall = d.box(620, 160, 230, 76, "cellmirror wall\none page for all cells\nmetrics of all", "blue")
    ros = d.box(620, 40, 230, 50, "ROS 2 programs", "blue")
    other = d.box(620, 330, 230, 50, "programs of the plant", "blue")
    opcua = d.box(620, 260, 230, 50, "cellmirror-opcua\nTCP 4840", "amber", 12)
    for cell in cells:
        d.arrow(cell.right_at(0.2), servers[0].left_at(), dash=True)
        d.arrow(cell.right_at(0.2), servers[1].left_at(), dash=True)
        d.arrow(cell.right_at(0.75 if cell is cells[0] else 0.55), wall.left_at(0.5))
        d.arrow(cell.right_at(0.92), broker.left_at())
    for server in servers:
        d.arrow(wall.top_at(0.1), server.right_at(), dash=True)
        d.arrow(ros.left_at(), server.right_at(), dash=True)
    d.arrow(broker.right_at(), other.left_at())
    d.arrow(cells[2].right_at(0.7), opcua.left_at())
    d.text(400, 184, "summaries (DDS)", 12, colour=FAINT)
    d.text(565, 28, "who is there", 12, colour=FAINT)
    return d


DIAGRAMS = {"command_sequence": command_sequence, "stream_states": stream_states, "haptic_phases": haptic_phases, "haptic_memory": haptic_memory,
            "sensor_record": sensor_record, "trust": trust, "service": service, "plant": plant}
