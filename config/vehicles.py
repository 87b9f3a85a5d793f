"""What the scripts share that write the vehicles of config/sand_table, config/rover and config/bulldozer: descriptions, the ground that they
drive on, and motions for scripts/joint_player.

A vehicle hangs on the link `sand` by virtual joints, so that joint_player moves all of it and tf needs no other source.
"""

import pathlib
import sys

import numpy as np

CONFIG = pathlib.Path(__file__).resolve().parent
sys.path += [str(CONFIG / "terrain"), str(CONFIG / "robots")]
import terrain_file  # noqa: E402
from make_motions import solve  # noqa: E402

MOTIONS = {"x": ("prismatic", (1, 0, 0)), "y": ("prismatic", (0, 1, 0)), "z": ("prismatic", (0, 0, 1)),
           "yaw": ("continuous", (0, 0, 1)), "pitch": ("continuous", (0, 1, 0)), "roll": ("continuous", (1, 0, 0))}


def numbers(values):
    return " ".join(f"{value:.5g}" for value in values)


def box(size, xyz=(0, 0, 0), rpy=(0, 0, 0), color="metal", solid=False):
    return f'<box size="{numbers(size)}"/>', xyz, rpy, color, solid


def cylinder(radius, length, xyz=(0, 0, 0), rpy=(np.pi / 2, 0, 0), color="metal", solid=False):
    """Lies along y unless told otherwise."""
    return f'<cylinder radius="{radius:.5g}" length="{length:.5g}"/>', xyz, rpy, color, solid


class Description:
    """A URDF in the making. Solid shapes meet the sand, the others are only seen."""

    def __init__(self, name, comment, colors):
        self.lines = ['<?xml version="1.0"?>', f"<!-- {comment} -->", f'<robot name="{name}">']
        self.lines += [f'  <material name="{color}"><color rgba="{numbers(rgb)} 1"/></material>' for color, rgb in colors.items()]
        self.lines.append('  <link name="sand"/>')

    def link(self, name, *shapes):
        self.lines.append(f'  <link name="{name}">')
        for geometry, xyz, rpy, color, solid in shapes:
            place = f'<origin xyz="{numbers(xyz)}" rpy="{numbers(rpy)}"/><geometry>{geometry}</geometry>'
            self.lines.append(f'    <visual>{place}<material name="{color}"/></visual>')
            self.lines += [f"    <collision>{place}</collision>"] if solid else []
        self.lines.append("  </link>")

    def joint(self, name, kind, parent, child, axis=(0, 0, 1), xyz=(0, 0, 0)):
        limit = "" if kind == "continuous" else '<limit lower="-100" upper="100" effort="1" velocity="100"/>'
        self.lines.append(f'  <joint name="{name}" type="{kind}"><parent link="{parent}"/><child link="{child}"/>'
                          f'<origin xyz="{numbers(xyz)}"/><axis xyz="{numbers(axis)}"/>{limit}</joint>')

    def hang(self, child, prefix="", motions=tuple(MOTIONS)):
        """Virtual joints between the sand and a vehicle, named by the prefix and the motion."""
        parent = "sand"
        for motion in motions:
            kind, axis = MOTIONS[motion]
            link = child if motion == motions[-1] else f"{prefix}to_{motion}"
            if link != child:
                self.lines.append(f'  <link name="{link}"/>')
            self.joint(prefix + motion, kind, parent, link, axis)
            parent = link

    def write(self, file):
        file.write_text("\n".join([*self.lines, "</robot>"]) + "\n")


def wheel(radius, width, color, lugs):
    """Shapes of a wheel about y: what meets the sand, and lugs and spokes by which one sees it turn."""
    shapes = [cylinder(radius, width, color="rubber", solid=True), cylinder(0.62 * radius, 1.04 * width, color=color)]
    for angle in np.arange(lugs) * 2 * np.pi / lugs:
        place = 0.95 * radius * np.sin(angle), 0, 0.95 * radius * np.cos(angle)
        shapes.append(box((0.10 * radius, 1.01 * width, 0.16 * radius), place, (0, angle, 0), "tread"))
    for angle in np.arange(3) * np.pi / 3:
        shapes.append(box((0.12 * radius, 1.08 * width, 1.1 * radius), rpy=(0, angle, 0), color="tread"))
    return shapes


class Ground:
    """A surface, linear between the middles of a file's pixels."""

    def __init__(self, file, band, pixel):
        self.elevation, self.pixel = terrain_file.read(file, band), pixel

    def height(self, x, y):
        rows, columns = self.elevation.shape
        u, v = np.clip(x / self.pixel - 0.5, 0, columns - 1.001), np.clip(y / self.pixel - 0.5, 0, rows - 1.001)
        i, j = int(u), int(v)
        s, t = u - i, v - j
        low, high = self.elevation[j, i : i + 2], self.elevation[j + 1, i : i + 2]
        return (1 - t) * ((1 - s) * low[0] + s * low[1]) + t * ((1 - s) * high[0] + s * high[1])

    def centre(self, x, y, radius, sinkage):
        """Height of the middle of a wheel that goes so deep into the ground, along its normal."""
        slopes = [(self.height(x + dx, y + dy) - self.height(x - dx, y - dy)) / (2 * radius) for dx, dy in ((radius, 0), (0, radius))]
        return self.height(x, y) + (radius - sinkage) * np.sqrt(1 + slopes[0] ** 2 + slopes[1] ** 2)

    def settled(self, robot, wheels, joints, free, radius, sinkage):
        """Free joints near `free` with which all wheels (links) go so deep into the ground. @param joints all of them, from free ones"""

        def residual(trial):
            """the wheels' depth"""
            middles = [robot.frame(wheel, joints(trial))[:3, 3] for wheel in wheels]
            return [middle[2] - self.centre(*middle[:2], radius, sinkage) for middle in middles]

        return solve(free, residual)


def ease(share):
    """From 0 to 1, at rest at both ends, even in between."""
    ramp = 0.1
    share = np.clip(share, 0.0, 1.0)
    late = np.where(share > 1 - ramp, 1 - ramp - (1 - share) ** 2 / 2 / ramp, share - ramp / 2)
    return np.where(share < ramp, share**2 / 2 / ramp, late) / (1 - ramp)


def along(path, share):
    """Rows x, y, yaw, curvature, way from the start at these shares of a path's length."""
    fine = np.linspace(0.0, 1.0, 4001)
    x, y = path(fine)
    way = np.concatenate([[0.0], np.cumsum(np.hypot(np.diff(x), np.diff(y)))])
    yaw = np.unwrap(np.arctan2(np.gradient(y), np.gradient(x)))
    curvature = np.gradient(yaw, way)
    return np.column_stack([np.interp(share * way[-1], way, values) for values in (x, y, yaw, curvature, way)])


def write_motion(file, comment, times, joints, phases=()):
    """@param joints names → positions at the times"""
    lines = [f"# {comment}", "# Keyframes for scripts/joint_player, in metres and radians; linear in between.", f"joints: [{', '.join(joints)}]"]
    if phases:
        lines += ["phases:", *(f"  - {{name: {name}, start: {start:.2f}, end: {end:.2f}}}" for name, start, end in phases)]
    lines.append("keyframes:")
    for time, row in zip(times, np.column_stack(list(joints.values()))):
        lines.append(f"  - {{time: {time:.2f}, positions: [{', '.join(f'{value:.4f}' for value in row)}]}}")
    file.write_text("\n".join(lines) + "\n")
    print(f"{file.name}: {len(times)} keyframes over {times[-1]:.1f} s")
