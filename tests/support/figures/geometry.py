"""Diagrams with axes and units: velocity profiles, fly points, cones of sensors, cameras, values that cannot be true."""

import math

from svg import FAINT, INK, STROKES, Drawing, Plot

VELOCITY, ACCELERATION = 1.2, 4.8  # m/s, m/s2: rob_cart_lin_vel 1200 and rob_cart_lin_acc 4800
RAMP = VELOCITY / ACCELERATION     # s


def velocity_at(time, cruise, sine):
    """Of a move that accelerates, cruises for `cruise` seconds and brakes."""
    end = 2 * RAMP + cruise
    edge = min(max(min(time, end - time), 0), RAMP)
    return VELOCITY * ((1 - math.cos(math.pi * edge / RAMP)) / 2 if sine else edge / RAMP)


def acceleration_at(time, cruise, sine):
    end = 2 * RAMP + cruise
    if time < RAMP:
        return math.pi / 2 * ACCELERATION * math.sin(math.pi * time / RAMP) if sine else ACCELERATION
    if time < RAMP + cruise:
        return 0.0
    return -(math.pi / 2 * ACCELERATION * math.sin(math.pi * (end - time) / RAMP) if sine else ACCELERATION)


def velocity_profiles():
    d = Drawing(880, 300, "Velocity and acceleration of the profiles ramp and sine")
    cruise, steps = 0.25, 300
    times = [i * (2 * RAMP + cruise) / steps for i in range(steps + 1)]
    speed = Plot(d, (0, 0.8), (0, 1.4), 70, 50, 330, 180, "time [s]", "velocity [m/s]", (0, 0.25, 0.5, 0.75), (0, 0.4, 0.8, 1.2))
    pull = Plot(d, (0, 0.8), (-8, 8), 520, 50, 330, 180, "time [s]", "acceleration [m/s\u00b2]", (0, 0.25, 0.5, 0.75), (-7.5, -4.8, 0, 4.8, 7.5))
    for sine, colour in ((False, STROKES["amber"]), (True, STROKES["blue"])):
        speed.line([(t, velocity_at(t, cruise, sine)) for t in times], colour)
        pull.line([(t, acceleration_at(t, cruise, sine)) for t in times], colour)
    pull.line([(0, 0), (0.8, 0)], "#b5bcc2", 1, dash=True)
    d.path([(300, 70), (326, 70)], STROKES["amber"], 2)
    d.text(332, 74, "ramp", 12, "start")
    d.path([(300, 90), (326, 90)], STROKES["blue"], 2)
    d.text(332, 94, "sine", 12, "start")
    return d


def fly_point():
    """Two lines with fly type 1: the second begins where the first is nearer to the corner than the radius."""
    d = Drawing(880, 320, "A fly point between two lines")
    length, radius, step = 0.4, 0.12, 0.002
    cruise = length / VELOCITY - RAMP
    duration = 2 * RAMP + cruise
    first = second = time = 0.0
    begun = None
    path = [(0.0, 0.0)]
    while second < length - 1e-6 and time < 3:
        first = min(first + velocity_at(time, cruise, False) * step, length)
        if begun is None and length - first < radius:
            begun = time
            joined = (first, 0.0)
        if begun is not None and time - begun < duration:
            second = min(second + velocity_at(time - begun, cruise, False) * step, length)
        elif begun is not None:
            second = length
        time += step
        path.append((first, second))
    plot = Plot(d, (0, 0.46), (0, 0.4), 80, 30, 322, 240, "x [m]", "y [m]", (0, 0.1, 0.2, 0.3, 0.4), (0, 0.1, 0.2, 0.3, 0.4))
    plot.line([(0, 0), (length, 0), (length, length)], "#a7b0b8", 1.5, dash=True)
    x, y = plot.at(length, 0)
    d.add(f'<path d="M{x - radius * 700:.1f},{y} A{radius * 700:.1f},{radius * 600:.1f} 0 0 1 {x},{y - radius * 600:.1f}" fill="none" stroke="{STROKES["amber"]}" stroke-dasharray="4 3"/>')
    plot.line(path, STROKES["blue"], 2.5)
    d.circle(*plot.at(*joined), 4, STROKES["red"])
    end_of_first = next(point for point in path if point[0] >= length)
    d.circle(*plot.at(*end_of_first), 4, STROKES["green"])
    rows = (("red", "the first move is nearer to the corner than the radius:", "the second begins, and both run, one added to the other"),
            ("green", "the first move has ended: from here on", "the TCP is exactly on the second line"), ("amber", "rob_cart_fly_radius 1 120: within 120 mm of the corner", ""))
    for i, (colour, one, two) in enumerate(rows):
        d.circle(470, 66 + i * 62, 5, STROKES[colour])
        d.text(486, 70 + i * 62, one + ("\n" + two if two else ""), 12, "start")
    d.text(486, 262, "dashed: the two lines as programmed", 12, "start", colour=FAINT)
    return d


def sensor_cone():
    d = Drawing(880, 330, "What an ultrasonic sensor reads")
    apex, axis, half, blind = (70, 170), 640, math.radians(14), 110

    def at(distance, angle):
        return apex[0] + distance * math.cos(angle), apex[1] + distance * math.sin(angle)

    arc = [at(axis, -half + i * 2 * half / 40) for i in range(41)]
    d.path([apex, *arc, apex], STROKES["blue"], 1.3, fill="#eef5fb")
    near = [at(blind, -half + i * 2 * half / 20) for i in range(21)]
    d.path([apex, *near, apex], STROKES["amber"], 1.3, fill="#fbedd0")
    d.box(20, 150, 44, 40, "", "grey", radius=3)
    d.text(42, 212, "sensor", 12)
    d.arrow(apex, (apex[0] + axis + 60, apex[1]), label="z of the node", at=(810, 160), anchor="middle")
    d.box(470, 196, 90, 74, "", "red", radius=3)
    d.text(515, 238, "body", 12)
    corner = (470, 196)
    d.path([apex, corner], STROKES["red"], 2)
    d.circle(*corner, 5, STROKES["red"])
    d.text(250, 258, "reading: to the nearest point\nof any surface in the cone", 12)
    d.box(430, 24, 80, 28, "", "grey", radius=3)
    d.text(422, 43, "beside the cone: not seen", 12, "end")
    d.text(135, 116, "blind zone", 12, colour=STROKES["amber"])
    d.arrow((70, 310), (70 + axis, 310), both=True, label="range_m")
    d.path([at(300, 0), at(300, -half / 3), at(300, -2 * half / 3), at(300, -half)], INK, 1, arrow=True)
    d.text(378, 144, "half_angle_rad", 12, "start")
    return d


def camera_axes():
    d = Drawing(880, 320, "The axes of a camera, and of a pan-tilt head")
    d.text(200, 28, "camera: a workframe", 13, bold=True)
    d.text(650, 28, "pan-tilt head that carries it", 13, bold=True)
    lens = (90, 170)
    corners = [(300, 90), (340, 120), (340, 270), (300, 240)]
    for corner in corners:
        d.path([lens, corner], "#8e979e", 1)
    d.path([*corners, corners[0]], STROKES["blue"], 1.5, fill="#eef5fb")
    d.arrow(lens, (385, 182), label="z, optical axis", at=(398, 186), anchor="start")
    d.arrow(lens, (150, 215), label="x, right in\nthe image", at=(158, 226), anchor="start")
    d.arrow(lens, (90, 262), label="y, down in the image", at=(90, 282))
    d.circle(*lens, 5)
    d.text(320, 84, "viewing distance", 12, colour=FAINT)
    d.text(330, 292, "opening angle: of the height", 12, colour=FAINT)
    d.box(600, 250, 100, 26, "mount", "grey", 12)
    d.path([(650, 250), (650, 200)], FAINT, 6)
    d.box(600, 140, 100, 60, "", "blue")
    d.path([(700, 170), (744, 170)], INK, 2, arrow=True)
    d.text(752, 174, "z", 12, "start", colour=FAINT)
    d.path([(650, 120), (650, 60)], INK, 1, dash=True)
    d.add(f'<path d="M622,92 A28,9 0 1 0 678,92" fill="none" stroke="{INK}" stroke-width="1.5" marker-end="url(#arrow)"/>')
    d.text(694, 92, "pan: positive to the right", 12, "start")
    d.path([(560, 170), (740, 170)], "#8e979e", 1, dash=True)
    d.add(f'<path d="M570,196 A9,26 0 1 1 570,144" fill="none" stroke="{INK}" stroke-width="1.5" marker-end="url(#arrow)"/>')
    d.text(552, 134, "tilt: positive upwards", 12, "end")
    d.circle(650, 170, 4, STROKES["red"])
    d.text(712, 222, "both axes meet in the\ncamera's workframe", 12, "start", colour=FAINT)
    return d


def plausibility():
    d = Drawing(880, 330, "A value that cannot be true, and what is shown")
    plot = Plot(d, (0, 3), (-1.5, 2.6), 80, 44, 560, 220, "time [s]", "position [rad]", (0, 0.5, 1, 1.5, 2, 2.5, 3), (-1, 0, 1, 2))
    x0, top = plot.at(0, 2.0)
    x1, bottom = plot.at(3, -1.0)
    d.add(f'<rect x="{x0}" y="{top:.1f}" width="{x1 - x0}" height="{bottom - top:.1f}" fill="#eaf5ee"/>')
    for bound in (2.0, -1.0):
        plot.line([(0, bound), (3, bound)], STROKES["green"], 1)
    for margin in (2.3, -1.3):
        plot.line([(0, margin), (3, margin)], STROKES["amber"], 1, dash=True)

    def joint(time):
        return 0.5 + 0.8 * math.sin(1.6 * time)

    times = [i * 0.05 for i in range(61)]
    wrong = [0.9 + 0.05 * i for i in range(5)]
    held_until = 1.15 + 10 * 0.05
    shown = [(t, joint(t) if t < 0.9 or t > held_until else joint(0.85)) for t in times]
    plot.line(shown, STROKES["blue"], 2.5)
    for t in times:
        value = 2.5 if any(abs(t - w) < 0.01 for w in wrong) else joint(t)
        d.circle(*plot.at(t, value), 2.6, STROKES["red"] if value > 2.3 else INK)
    d.text(660, 66, "margin", 12, "start", colour=STROKES["amber"])
    d.text(660, 82, "range of the joint", 12, "start", colour=STROKES["green"])
    d.circle(666, 122, 3, INK)
    d.text(678, 126, "value of the controller", 12, "start")
    d.circle(666, 146, 3, STROKES["red"])
    d.text(678, 150, "value that cannot be true", 12, "start")
    d.path([(658, 170), (674, 170)], STROKES["blue"], 2.5)
    d.text(680, 174, "what is shown: held until", 12, "start")
    d.text(680, 191, "plausible_after (10) values", 12, "start")
    d.text(680, 208, "were plausible", 12, "start")
    return d


DIAGRAMS = {"velocity_profiles": velocity_profiles, "fly_point": fly_point, "sensor_cone": sensor_cone, "camera_axes": camera_axes,
            "plausibility": plausibility}
