"""Forward kinematics of a URDF in plain Python, written from the format's description and from nothing of cellmirror."""

import math
import random
import xml.etree.ElementTree as ElementTree

IDENTITY = ((1.0, 0.0, 0.0, 0.0), (0.0, 1.0, 0.0, 0.0), (0.0, 0.0, 1.0, 0.0), (0.0, 0.0, 0.0, 1.0))


def multiply(a, b):
    return tuple(tuple(sum(a[i][k] * b[k][j] for k in range(4)) for j in range(4)) for i in range(4))


def about(axis, angle):
    """Rodrigues' formula."""
    length = math.sqrt(sum(component * component for component in axis))
    x, y, z = (component / length for component in axis)
    c, s = math.cos(angle), math.sin(angle)
    t = 1.0 - c
    return ((c + x * x * t, x * y * t - z * s, x * z * t + y * s, 0.0),
            (y * x * t + z * s, c + y * y * t, y * z * t - x * s, 0.0),
            (z * x * t - y * s, z * y * t + x * s, c + z * z * t, 0.0),
            (0.0, 0.0, 0.0, 1.0))


def shift(x, y, z):
    return ((1.0, 0.0, 0.0, x), (0.0, 1.0, 0.0, y), (0.0, 0.0, 1.0, z), (0.0, 0.0, 0.0, 1.0))


def numbers(element, attribute, default):
    text = default if element is None else element.get(attribute, default)
    return [float(word) for word in text.split()]


def origin_of(joint):
    origin = joint.find("origin")
    roll, pitch, yaw = numbers(origin, "rpy", "0 0 0")
    rotation = multiply(about((0, 0, 1), yaw), multiply(about((0, 1, 0), pitch), about((1, 0, 0), roll)))
    return multiply(shift(*numbers(origin, "xyz", "0 0 0")), rotation)


class Arm:
    """The joints on the way from base to tip; the base stands above the tip."""

    def __init__(self, path, base, tip):
        root = ElementTree.parse(path).getroot()
        above = {joint.find("child").get("link"): joint for joint in root.findall("joint")}
        self.path, self.base, self.tip = path, base, tip
        self.joints = []
        link = tip
        while link != base:
            self.joints.insert(0, above[link])
            link = above[link].find("parent").get("link")
        self.moving = [joint for joint in self.joints if joint.get("type") != "fixed"]

    def limits(self, joint):
        if joint.get("type") == "continuous":
            return -math.inf, math.inf
        limit = joint.find("limit")
        return float(limit.get("lower", 0)), float(limit.get("upper", 0))

    def pose(self, q):
        pose = IDENTITY
        values = iter(q)
        for joint in self.joints:
            pose = multiply(pose, origin_of(joint))
            if joint.get("type") == "fixed":
                continue
            axis = numbers(joint.find("axis"), "xyz", "1 0 0")
            value = next(values)
            pose = multiply(pose, shift(*(value * c for c in axis)) if joint.get("type") == "prismatic" else about(axis, value))
        return pose

    def random_posture(self, random_numbers):
        out = []
        for joint in self.moving:
            lower, upper = self.limits(joint)
            bounded = math.isfinite(lower)
            out.append(random_numbers.uniform(lower if bounded else -math.pi, upper if bounded else math.pi))
        return out

    def within_limits(self, q):
        return all(self.limits(joint)[0] <= value <= self.limits(joint)[1] for joint, value in zip(self.moving, q))

    def arguments(self):
        return ["--urdf", str(self.path), "--base", self.base, "--tip", self.tip]


def quaternion(pose):
    """x, y, z, w, by the largest of the four (Shepperd's method)."""
    r = [row[:3] for row in pose[:3]]
    trace = r[0][0] + r[1][1] + r[2][2]
    candidates = [r[0][0], r[1][1], r[2][2], trace]
    largest = candidates.index(max(candidates))
    if largest == 3:
        q = [r[2][1] - r[1][2], r[0][2] - r[2][0], r[1][0] - r[0][1], 1.0 + trace]
    else:
        i, j, k = largest, (largest + 1) % 3, (largest + 2) % 3
        q = [0.0] * 4
        q[i] = 1.0 + r[i][i] - r[j][j] - r[k][k]
        q[j] = r[j][i] + r[i][j]
        q[k] = r[k][i] + r[i][k]
        q[3] = r[k][j] - r[j][k]
    length = math.sqrt(sum(c * c for c in q))
    return [c / length for c in q]


def error(pose, target):
    """Position vector (m) and rotation vector (rad) from pose to target."""
    position = [target[i][3] - pose[i][3] for i in range(3)]
    # R_target R_pose^T
    r = [[sum(target[i][k] * pose[j][k] for k in range(3)) for j in range(3)] for i in range(3)]
    axis = [r[2][1] - r[1][2], r[0][2] - r[2][0], r[1][0] - r[0][1]]
    sine = 0.5 * math.sqrt(sum(c * c for c in axis))
    cosine = 0.5 * (r[0][0] + r[1][1] + r[2][2] - 1.0)
    angle = math.atan2(sine, cosine)
    factor = 0.5 if sine < 1e-12 else 0.5 * angle / sine
    return position, [factor * c for c in axis]


def write_targets(path, poses):
    with open(path, "w") as out:
        out.write("px,py,pz,qx,qy,qz,qw\n")
        for pose in poses:
            values = [pose[0][3], pose[1][3], pose[2][3], *quaternion(pose)]
            out.write(",".join(repr(value) for value in values) + "\n")


def seeded(seed):
    return random.Random(seed)
