#!/usr/bin/python3
"""Writes dig_cycle.yaml: the joint positions of the excavator while it digs a trench in two passes.

    /usr/bin/python3 make_dig_cycle.py

The cycle is given below as waypoints of the bucket: where its cutting edge is, in the machine's frame (x forward, z up, z = 0 on the
ground), how far it is tilted, and how far the house is swung. Between waypoints each of these runs along a monotone cubic, so that a
height that two waypoints share is kept exactly. Inverse kinematics in the plane of the arm then gives the joints, and the hydraulics'
joints follow. All lengths come from excavator.urdf, and the bucket's lower side from its mesh.
"""

import pathlib
import xml.etree.ElementTree as ElementTree

import numpy as np

HERE = pathlib.Path(__file__).resolve().parent
ROBOT = ElementTree.parse(HERE / "excavator.urdf").getroot()
JOINTS = {joint.get("name"): joint for joint in ROBOT.iter("joint")}

KEYFRAME_INTERVAL = 0.2  # s; the arm's joints, interpolated linearly over it, keep the edge level to a fraction of a millimetre


def pin(joint):
    """Where a joint sits in its parent link, as x + iz: a turn in the plane of the arm is then a product."""
    x, _, z = map(float, JOINTS[joint].find("origin").get("xyz").split())
    return complex(x, z)


def turn(angle):
    return np.exp(1j * np.asarray(angle))


def bucket_points():
    """The corners of the bucket's collision mesh in the plane of the arm."""
    uri = ROBOT.find("link[@name='bucket']/collision/geometry/mesh").get("filename")
    data = (HERE / "meshes" / uri.rsplit("/", 1)[1]).read_bytes()
    triangles = np.frombuffer(data, np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")]), offset=84)
    corners = triangles["corners"].reshape(-1, 3).astype(float)
    return corners[:, 0] + 1j * corners[:, 2]


def edge_height(lower_side, tilt):
    """The height of the cutting edge at which the lowest point of the bucket is at `lower_side`."""
    attitude = turn(np.radians(tilt))
    return lower_side + (pin("bucket_edge") * attitude).imag - (bucket_points() * attitude).imag.min()


# Waypoints: time, edge x, y and z, tilt. Tilt is the elevation of the bucket's x axis in degrees: at -90 it points straight down and the
# mouth faces the machine; less is curled in. The house is swung so that the arm's plane goes through (x, y).


def dig(start, x, depth):
    """Enters the sand at x, drags level, then rises while it still pulls. The floor behind the edge stays above the edge."""
    return [
        (start, x + 0.10, 0.0, 0.30, -76.0),
        (start + 1.6, x, 0.0, depth, -86.0),
        (start + 2.2, x - 0.12, 0.0, depth, -87.0),
        (start + 6.2, x - 1.30, 0.0, depth, -90.0),
        (start + 7.8, x - 1.70, 0.0, -0.02, -94.0),
    ]


def sweep(start, far_y):
    """Sets the curled bucket down beside the pile and pushes that to the left with its side, straight across and a little outwards."""
    tilt, lower_side = -130.0, 0.015
    low = edge_height(lower_side, tilt)
    return [(start + share * 4.2, 1.42 + 0.30 * share, -1.05 + (far_y + 1.05) * share, low, tilt) for share in np.linspace(0, 1, 8)]


TRAVEL = (2.05, 0.0, 1.35, -165.0)
FIRST_DIG, FIRST_SWEEP, SECOND_DIG, SECOND_SWEEP = 2.8, 13.6, 21.6, 32.2

WAYPOINTS = [
    (0.0, *TRAVEL),
    *dig(FIRST_DIG, 3.60, -0.12),
    (FIRST_DIG + 9.2, 1.95, -0.55, 0.75, -115.0),
    *sweep(FIRST_SWEEP, 1.30),
    (FIRST_SWEEP + 5.6, 1.80, 1.22, 1.10, -125.0),
    (FIRST_SWEEP + 6.8, 2.90, 0.20, 1.00, -80.0),
    *dig(SECOND_DIG, 3.70, -0.22),
    (SECOND_DIG + 9.2, 1.95, -0.55, 0.75, -115.0),
    *sweep(SECOND_SWEEP, 1.10),
    (SECOND_SWEEP + 5.6, 1.80, 1.02, 1.10, -135.0),
    (SECOND_SWEEP + 7.6, *TRAVEL),
]

PHASES = [
    ("reach", 0.0, FIRST_DIG),
    ("enter", FIRST_DIG, FIRST_DIG + 1.6),
    ("dig", FIRST_DIG + 1.6, FIRST_DIG + 6.2),
    ("rise", FIRST_DIG + 6.2, FIRST_DIG + 7.8),
    ("lift", FIRST_DIG + 7.8, FIRST_SWEEP),
    ("sweep", FIRST_SWEEP, FIRST_SWEEP + 4.2),
    ("return", FIRST_SWEEP + 4.2, SECOND_DIG),
    ("enter_again", SECOND_DIG, SECOND_DIG + 1.6),
    ("dig_again", SECOND_DIG + 1.6, SECOND_DIG + 6.2),
    ("rise_again", SECOND_DIG + 6.2, SECOND_DIG + 7.8),
    ("lift_again", SECOND_DIG + 7.8, SECOND_SWEEP),
    ("sweep_again", SECOND_SWEEP, SECOND_SWEEP + 4.2),
    ("travel", SECOND_SWEEP + 4.2, SECOND_SWEEP + 7.6),
]


def monotone_cubic(knots, values, at):
    """Fritsch and Carlson's interpolant: smooth, at rest at both ends, and never beyond the values of its two neighbours."""
    steps = np.diff(knots)
    slopes = np.diff(values) / steps
    before, after = slopes[:-1], slopes[1:]
    weight_before, weight_after = 2 * steps[1:] + steps[:-1], steps[1:] + 2 * steps[:-1]
    monotone = before * after > 0
    tangents = np.zeros(len(knots))
    tangents[1:-1][monotone] = ((weight_before + weight_after)[monotone]
                                / (weight_before[monotone] / before[monotone] + weight_after[monotone] / after[monotone]))
    k = np.clip(np.searchsorted(knots, at, side="right") - 1, 0, len(steps) - 1)
    s = (at - knots[k]) / steps[k]
    return (values[k] * (1 + 2 * s) * (1 - s) ** 2 + values[k + 1] * s**2 * (3 - 2 * s)
            + steps[k] * s * (1 - s) * (tangents[k] * (1 - s) - tangents[k + 1] * s))


def arm(radius, height, tilt):
    """Boom, stick and bucket for a cutting edge at (radius, height) in the plane of the arm: the elbow is above."""
    bucket_pin = radius + 1j * height - pin("bucket_edge") * turn(tilt)
    reach = bucket_pin - pin("swing") - pin("boom")
    boom_length, stick_length = abs(pin("stick")), abs(pin("bucket"))
    rise = np.arccos((boom_length**2 + abs(reach) ** 2 - stick_length**2) / (2 * boom_length * abs(reach)))
    boom = np.angle(reach) + rise
    stick = np.angle(reach - pin("stick") * turn(boom))
    return {"boom": boom, "stick": wrap(stick - boom), "bucket": wrap(tilt - stick)}


def wrap(angle):
    return (angle + np.pi) % (2 * np.pi) - np.pi


def hydraulics(joints):
    """The joints of the three cylinders and of the bucket's levers, from those of the arm."""
    boom, stick, bucket = (turn(joints[name]) for name in ("boom", "stick", "bucket"))

    # The far end of the rocker lies a rocker's length from its pin on the stick, a link's length from the link's pin on the bucket,
    # and above both.
    link_pin = pin("bucket") + pin("bucket_link_pin") * bucket
    span = link_pin - pin("rocker")
    rocker_length, link_length = abs(pin("bucket_link")), abs(pin("bucket_link_end"))
    rocker = np.angle(span) + np.arccos((rocker_length**2 + abs(span) ** 2 - link_length**2) / (2 * rocker_length * abs(span)))
    rocker_end = pin("rocker") + rocker_length * turn(rocker)

    following = {"rocker": rocker, "bucket_link": wrap(np.angle(link_pin - rocker_end) - rocker)}
    for name, rod_pin in (("boom", pin("boom") + pin("boom_cylinder_pin") * boom),
                          ("stick", pin("stick") + pin("stick_cylinder_pin") * stick), ("bucket", rocker_end)):
        rod = rod_pin - pin(f"{name}_cylinder")
        following[f"{name}_cylinder"], following[f"{name}_rod"] = np.angle(rod), abs(rod)
    return following


def cycle():
    """Keyframe times and the positions of every joint at them."""
    knots, x, y, z, tilt = np.array(WAYPOINTS, float).T
    times = np.arange(round(knots[-1] / KEYFRAME_INTERVAL) + 1) * KEYFRAME_INTERVAL
    radius, swing, height, attitude = (
        monotone_cubic(knots, values, times) for values in (np.hypot(x, y), np.arctan2(y, x), z, np.radians(tilt)))
    joints = {"swing": swing, **arm(radius, height, attitude)}
    joints.update(hydraulics(joints))
    for name, positions in joints.items():
        limit = JOINTS[name].find("limit")
        low, high = (float(limit.get(key)) for key in ("lower", "upper")) if limit is not None else (-np.pi, np.pi)
        outside = ~((positions >= low) & (positions <= high))
        if outside.any():
            raise SystemExit(f"{name} would be at {positions[outside][0]:.3f} at {times[outside][0]:.1f} s, outside [{low}, {high}]")
    return times, joints


def main():
    times, joints = cycle()
    positions = [", ".join(f"{value:.5f}" for value in row) for row in np.column_stack(list(joints.values()))]
    lines = [
        "# The excavator digs a trench in two passes and sweeps what it dug into a heap on its left: keyframes for scripts/joint_player.",
        "# Made by make_dig_cycle.py from waypoints of the cutting edge; change those there and run it again.",
        "# Radians and metres, in the order of `joints`; linear in between. Times in seconds from the start of the motion.",
        "",
        f"joints: [{', '.join(joints)}]",
        "",
        "# What the machine is doing; a phase ends where the next one starts.",
        "phases:",
        *(f"  - {{name: {name}, start: {start:.1f}, end: {end:.1f}}}" for name, start, end in PHASES),
        "",
        "keyframes:",
        *(f"  - {{time: {time:.1f}, positions: [{row}]}}" for time, row in zip(times, positions)),
    ]
    (HERE / "dig_cycle.yaml").write_text("\n".join(lines) + "\n")
    print(f"{len(times)} keyframes over {times[-1]:.1f} s")
    for name, values in joints.items():
        print(f"{name:16s} {values.min():7.3f} to {values.max():7.3f}")


if __name__ == "__main__":
    main()
