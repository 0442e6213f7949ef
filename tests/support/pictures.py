"""Reads PNG files and compares pictures, with the standard library alone."""

import struct
import sys
import zlib
from array import array
from itertools import accumulate


class Picture:
    """Rows from the top; a pixel is (red, green, blue)."""

    def __init__(self, width, height, pixels):
        self.width, self.height, self.pixels = width, height, pixels

    def at(self, x, y):
        return self.pixels[y * self.width + x]

    def box(self, left=0.0, top=0.0, right=1.0, bottom=1.0):
        """Part of it; 0 to 1."""
        columns = range(int(left * self.width), max(int(left * self.width) + 1, int(right * self.width)))
        rows = range(int(top * self.height), max(int(top * self.height) + 1, int(bottom * self.height)))
        return Picture(len(columns), len(rows), [self.at(x, y) for y in rows for x in columns])

    def turned_round(self):
        return Picture(self.width, self.height, self.pixels[::-1])

    def share(self, wanted):
        """Of the pixels for which wanted(red, green, blue) is true."""
        return sum(1 for pixel in self.pixels if wanted(*pixel)) / len(self.pixels)

    def mean(self):
        n = len(self.pixels)
        return tuple(sum(pixel[i] for pixel in self.pixels) / n for i in range(3))

    def colours(self):
        return len(set(self.pixels))


def difference_mask(a, b, threshold=12):
    assert (a.width, a.height) == (b.width, b.height)
    if a.pixels == b.pixels:
        return [False] * len(a.pixels)
    return [p is not q and p != q and max(abs(p[0] - q[0]), abs(p[1] - q[1]), abs(p[2] - q[2])) > threshold
            for p, q in zip(a.pixels, b.pixels)]


def difference(a, b, threshold=12):
    """Share of pixels that differ by more than the threshold in any colour."""
    return sum(difference_mask(a, b, threshold)) / len(a.pixels)


def changed_box(a, b, threshold=12):
    """Left, top, right, bottom of what differs, 0 to 1; None where nothing does."""
    mask = difference_mask(a, b, threshold)
    at = [i for i, changed in enumerate(mask) if changed]
    if not at:
        return None
    columns, rows = [i % a.width for i in at], [i // a.width for i in at]
    return min(columns) / a.width, min(rows) / a.height, (max(columns) + 1) / a.width, (max(rows) + 1) / a.height


def changed_centre(a, b, threshold=12):
    """Mean place of what differs, 0 to 1."""
    at = [i for i, changed in enumerate(difference_mask(a, b, threshold)) if changed]
    return (sum(i % a.width for i in at) / len(at) / a.width, sum(i // a.width for i in at) / len(at) / a.height)


def _unfiltered(raw, height, stride, step):
    """PNG, third edition, 9.2: the filters of scan lines."""
    before, rows, at = bytearray(stride), [], 0
    for _ in range(height):
        kind, line = raw[at], bytearray(raw[at + 1 : at + 1 + stride])
        at += 1 + stride
        if kind == 1:
            for i in range(step):  # the lowest bytes of the running sums
                sums = array("I", accumulate(line[i::step]))
                lowest = 0 if sys.byteorder == "little" else sums.itemsize - 1
                line[i::step] = sums.tobytes()[lowest :: sums.itemsize]
        elif kind == 2:
            line = bytearray((x + y) & 255 for x, y in zip(line, before))
        elif kind == 3:
            for i in range(stride):
                line[i] = (line[i] + ((line[i - step] if i >= step else 0) + before[i]) // 2) & 255
        elif kind == 4:
            for i in range(stride):
                a, b, c = (line[i - step], before[i], before[i - step]) if i >= step else (0, before[i], 0)
                p = a + b - c
                pa, pb, pc = abs(p - a), abs(p - b), abs(p - c)
                line[i] = (line[i] + (a if pa <= pb and pa <= pc else b if pb <= pc else c)) & 255
        elif kind != 0:
            raise ValueError(f"filter {kind}")
        rows.append(line)
        before = line
    return rows


def read_png(path):
    """Of 8 bits a colour, RGB or RGBA, not interlaced."""
    with open(path, "rb") as file:
        data = file.read()
    if data[:8] != b"\x89PNG\r\n\x1a\n":
        raise ValueError("no PNG")
    at, packed, head = 8, b"", None
    while at < len(data):
        length, kind = struct.unpack_from(">I4s", data, at)
        body = data[at + 8 : at + 8 + length]
        (crc,) = struct.unpack_from(">I", data, at + 8 + length)
        if crc != zlib.crc32(kind + body):
            raise ValueError(f"chunk {kind}: wrong CRC")
        if kind == b"IHDR":
            head = struct.unpack(">IIBBBBB", body)
        elif kind == b"IDAT":
            packed += body
        elif kind == b"IEND":
            break
        at += 12 + length
    width, height, bits, colour, _, _, interlaced = head
    if bits != 8 or colour not in (2, 6) or interlaced:
        raise ValueError(f"PNG of {bits} bits, colour type {colour}")
    step = 3 if colour == 2 else 4
    rows = _unfiltered(zlib.decompress(packed), height, width * step, step)
    pixels = [pixel for row in rows for pixel in zip(row[0::step], row[1::step], row[2::step])]
    return Picture(width, height, pixels)
