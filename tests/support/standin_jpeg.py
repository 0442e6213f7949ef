"""Coarse pictures for page_standin.py: a baseline JPEG whose 8x8 blocks have one colour each, so that the standard
library is enough (ITU-T T.81: a DC coefficient a block, then end of block)."""

import math
import struct

FLOOR, SKY, ARM, HELD = (205, 210, 208), (232, 236, 238), (40, 110, 140), (210, 120, 40)


def segment(marker, data):
    return struct.pack(">BBH", 0xFF, marker, len(data) + 2) + data


def header(width, height):
    # Quantised by 8 the DC coefficient, 8 times the mean less 128, becomes that mean itself.
    quantisation = segment(0xDB, bytes([0]) + bytes([8] * 64))
    frame = segment(0xC0, struct.pack(">BHHB", 8, height, width, 3) + bytes([1, 0x11, 0, 2, 0x11, 0, 3, 0x11, 0]))
    # Twelve DC codes of four bits each; one AC code of one bit: end of block.
    dc = segment(0xC4, bytes([0x00, 0, 0, 0, 12] + [0] * 12) + bytes(range(12)))
    ac = segment(0xC4, bytes([0x10, 1] + [0] * 15) + bytes([0x00]))
    scan = segment(0xDA, bytes([3, 1, 0, 2, 0, 3, 0, 0, 63, 0]))
    return b"\xff\xd8" + quantisation + frame + dc + ac + scan


def encode(width, height, blocks):
    """blocks: rows of (red, green, blue), one for each 8x8 block."""
    bits, size, before = 0, 0, [0, 0, 0]
    out = bytearray()
    for row in blocks:
        for r, g, b in row:
            colour = (0.299 * r + 0.587 * g + 0.114 * b - 128, -0.1687 * r - 0.3313 * g + 0.5 * b, 0.5 * r - 0.4187 * g - 0.0813 * b)
            for i in range(3):
                value = round(colour[i])
                change = value - before[i]
                before[i] = value
                length = abs(change).bit_length()
                code = change if change >= 0 else change + (1 << length) - 1
                bits = ((bits << (5 + length)) | (length << (1 + length)) | (code << 1))
                size += 5 + length
                while size >= 8:
                    byte = (bits >> (size - 8)) & 0xFF
                    out.append(byte)
                    if byte == 0xFF:
                        out.append(0)
                    size -= 8
                bits &= (1 << size) - 1
    if size:
        out.append(((bits << (8 - size)) | ((1 << (8 - size)) - 1)) & 0xFF)
    return header(width, height) + bytes(out) + b"\xff\xd9"


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def projector(view, columns, rows):
    eye, target = view["viewpoint_m"], view["lookpoint_m"]
    away = [b - a for a, b in zip(eye, target)]
    reach = math.hypot(*away) or 1
    forward = [value / reach for value in away]
    right = cross(forward, (0, 0, 1))
    width = math.hypot(*right) or 1
    right = [value / width for value in right]
    up = cross(right, forward)
    scale = rows / 2 / math.tan(view.get("opening_angle_rad", 0.7) / 2)

    def project(point):
        ray = [a - b for a, b in zip(point, eye)]
        depth = sum(a * b for a, b in zip(ray, forward))
        if depth < 0.05:
            return None
        x = sum(a * b for a, b in zip(ray, right)) / depth * scale
        y = sum(a * b for a, b in zip(ray, up)) / depth * scale
        return columns / 2 + x, rows / 2 - y

    return project


def line(blocks, begin, end, colour):
    if not begin or not end:
        return
    steps = min(400, int(max(abs(begin[0] - end[0]), abs(begin[1] - end[1])) * 2) + 1)
    for i in range(steps + 1):
        x = int(begin[0] + (end[0] - begin[0]) * i / steps)
        y = int(begin[1] + (end[1] - begin[1]) * i / steps)
        if 0 <= y < len(blocks) and 0 <= x < len(blocks[0]):
            blocks[y][x] = colour


def why_not(wish):
    """What is wrong with a request, or None: as strict as the gateway (ipc/web/client_message.cpp) where a picture could
    not be drawn."""
    sizes = [wish.get("width"), wish.get("height")]
    if not all(isinstance(size, int) and 16 <= size <= most for size, most in zip(sizes, (1920, 1200))):
        return f"width and height {sizes} are no size of a picture"
    if wish.get("view", 0) not in range(7):
        return "views are 0 to 6"
    view = wish.get("free")
    if view is None:
        return None
    points = [view.get("viewpoint_m"), view.get("lookpoint_m")]
    number = lambda value: isinstance(value, (int, float)) and abs(value) <= 1e4
    if not all(isinstance(point, list) and len(point) == 3 and all(number(value) for value in point) for point in points):
        return f"the free view {points} is not two points within 10 km"
    if math.dist(*points) < 1e-6:
        return "viewpoint and lookpoint of the free view are the same"
    angle = view.get("opening_angle_rad", 0.7)
    return None if number(angle) and 1e-3 <= angle <= 3.1 else f"opening_angle_rad {angle} is out of range"


def picture(cell, wish):
    width, height = wish["width"], wish["height"]
    columns, rows = (width + 7) // 8, (height + 7) // 8
    view = wish.get("free") or cell.views[wish.get("view", 0)]
    project = projector(view, columns, rows)
    blocks = [[SKY if y < rows * 0.4 else FLOOR] * columns for y in range(rows)]
    for y in range(-4, 5):
        line(blocks, project((-2, y, 0)), project((14, y, 0)), (185, 192, 190))
    for i in range(len(cell.ids)):
        place = [2.0 * (i % 5), 2.0 * (i // 5) - 1, 0.0]
        turn, lean = cell.angle(i, 0), 0.0
        for k in range(3):
            lean += 0.4 + 0.6 * cell.angle(i, k + 1)
            reach = 0.7 * math.sin(lean)
            tip = [place[0] + reach * math.cos(turn), place[1] + reach * math.sin(turn), place[2] + 0.7 * math.cos(lean)]
            line(blocks, project(place), project(tip), ARM if cell.state(i) != "lost" else HELD)
            place = tip
    return encode(width, height, blocks)
