#!/usr/bin/python3
"""Writes dig_cycle.yaml: the joint positions of the excavator while it digs a trench and heaps what it dug beside it.

    /usr/bin/python3 make_dig_cycle.py

The cycle is given below as waypoints of the bucket: where its cutting edge is, in the machine's frame (x forward, z up, z = 0 on the
ground), how far it is tilted, and how far the house is swung. Between waypoints each of these runs along a monotone cubic, so that a
height that two waypoints share is kept exactly. Inverse kinematics in the plane of the arm then gives the joints, and the hydraulics'
joints follow. All lengths come from excavator.urdf.
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


# Waypoints: time, edge x, y and z, tilt. Tilt is the elevation of the bucket's x axis in degrees: at -90 it points straight down and the
# mouth faces the machine; less is curled in. The house is swung so that the arm's plane goes through (x, y).


def bucket_turned(pin_x, pin_z, tilt):
    """The cutting edge of a bucket whose pin is at a place of the arm's plane."""
    edge = pin_x + 1j * pin_z + pin("bucket_edge") * turn(np.radians(tilt))
    return edge.real, edge.imag


def load(start, x, depth, heap_swing):
    """Enters the sand at x, drags level until the bucket is full, curls, lifts, swings, and tips it out over the heap."""
    def at_heap(pin_z, tilt):
        radius, z = bucket_turned(HEAP_RADIUS, pin_z, tilt)
        return radius * np.cos(heap_swing), radius * np.sin(heap_swing), z, tilt

    def in_line(pin_x, pin_z, tilt):
        edge_x, edge_z = bucket_turned(pin_x, pin_z, tilt)
        return edge_x, 0.0, edge_z, tilt

    waypoints = [
        (0.0, x + 0.10, 0.0, 0.30, -76.0),
        (1.4, x, 0.0, depth, -86.0),
        (1.8, x - 0.10, 0.0, depth, -87.0),
        (5.2, x - 1.15, 0.0, depth, -95.0),
        (6.6, x - 1.50, 0.0, depth + 0.12, -135.0),
        (7.9, *in_line(x - 1.05, 0.60, CURLED)),
        (9.2, *in_line(x - 1.00, 1.10, CURLED)),
        (12.6, *at_heap(1.25, CURLED)),
        (14.6, *at_heap(1.25, -75.0)),
        (15.0, *at_heap(1.25, -62.0)),
    ]
    return [(start + waypoint[0], *waypoint[1:]) for waypoint in waypoints]


CURLED = -178.0  # degrees of tilt at which the mouth is level
HEAP_RADIUS = 2.15  # m from the axis of the house to the bucket's pin while it is tipped out
HEAP_SWING = np.radians(72.0)
TRAVEL = (2.05, 0.0, 1.35, -165.0)
STARTS = (2.2, 19.4, 36.6)

WAYPOINTS = [
    (0.0, *TRAVEL),
    *load(STARTS[0], 3.60, -0.12, HEAP_SWING),
    *load(STARTS[1], 3.65, -0.22, HEAP_SWING),
    *load(STARTS[2], 3.70, -0.30, HEAP_SWING),
    (STARTS[2] + 18.0, *TRAVEL),
]

STEPS = (("enter", 0.0, 1.4), ("dig", 1.4, 5.2), ("curl", 5.2, 7.9), ("lift", 7.9, 9.2), ("swing", 9.2, 12.6), ("tip", 12.6, 15.0))
PHASES = [("reach", 0.0, STARTS[0])]
for number, (begin, following) in enumerate(zip(STARTS, (*STARTS[1:], STARTS[-1] + 18.0)), 1):
    PHASES += [(f"{step}_{number}", begin + start, begin + end) for step, start, end in STEPS]
    PHASES += [(f"return_{number}", begin + STEPS[-1][2], following)]


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
        "# The excavator digs a trench and tips three buckets of sand into a heap on its left: keyframes for scripts/joint_player.",
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
