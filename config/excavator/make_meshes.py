#!/usr/bin/python3
"""Makes the excavator's meshes: binary STL files in `meshes/`, beside this script.

    /usr/bin/python3 make_meshes.py

Every part is a closed surface with its triangles facing outwards, given in metres in the frame of the link that shows it
(see excavator.urdf). Where the pins of the machine are is read from the URDF, so that shapes and joints agree; colours are
the URDF's too, which is why a link with several colours has several files. `bucket.stl`, `boom.stl` and `stick.stl` are
also what the sand collides with.

A part is drawn as an outline in a plane (u, v) and extruded along w. Side views are drawn in (x, z), plan views in (x, y).
"""

import pathlib
import re
import struct
import xml.etree.ElementTree as ElementTree
from collections import Counter

import numpy as np

HERE = pathlib.Path(__file__).resolve().parent
JOINTS = {joint.get("name"): joint for joint in ElementTree.parse(HERE / "excavator.urdf").getroot().iter("joint")}

# The bucket's size across, in metres.
BUCKET_WIDTH = 0.90
BUCKET_PLATE = 0.05  # at least a cell of the sand's grid, so that no plate falls between two columns


def pin(joint):
    """Where a joint sits in its parent link, seen from the side."""
    x, _, z = map(float, JOINTS[joint].find("origin").get("xyz").split())
    return np.array([x, z])


# Outlines: arrays of points (u, v), counterclockwise.


def circle(center, radius, count=24, start=0.0, sweep=2 * np.pi):
    angles = start + sweep * np.arange(count + (sweep < 2 * np.pi)) / count
    return np.array(center) + radius * np.column_stack([np.cos(angles), np.sin(angles)])


def rectangle(low, high):
    return np.array([(low[0], low[1]), (high[0], low[1]), (high[0], high[1]), (low[0], high[1])], float)


def bezier(points, count):
    a, b, c, d = map(np.array, points)
    t = np.linspace(0, 1, count + 1)[:, None]
    return (1 - t) ** 3 * a + 3 * t * (1 - t) ** 2 * b + 3 * t**2 * (1 - t) * c + t**3 * d


def rounded(corners, radius, count=5):
    """The polygon with an arc of about `radius` in place of each corner."""
    corners = np.array(corners, float)
    outline = []
    for before, corner, after in zip(np.roll(corners, 1, 0), corners, np.roll(corners, -1, 0)):
        first = corner + (before - corner) * min(radius / np.linalg.norm(before - corner), 0.45)
        last = corner + (after - corner) * min(radius / np.linalg.norm(after - corner), 0.45)
        outline.extend(bezier([first, (first + 2 * corner) / 3, (last + 2 * corner) / 3, last], count))
    return np.array(outline)


def hull(*circles):
    """A belt around circles (center, radius): levers, bosses, tracks."""
    points = np.concatenate([circle(center, radius, 32) for center, radius in circles])
    points = points[np.lexsort((points[:, 1], points[:, 0]))]

    def chain(ordered):
        kept = []
        for point in ordered:
            while len(kept) > 1 and cross(kept[-1] - kept[-2], point - kept[-1]) <= 1e-12:
                kept.pop()
            kept.append(point)
        return kept[:-1]

    return np.array(chain(points) + chain(points[::-1]))


def cross(a, b):
    return a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0]


def offset(points, distance, closed=True):
    """The outline moved to its left (into a counterclockwise one) by `distance`."""
    along = np.roll(points, -1, 0) - points
    along /= np.linalg.norm(along, axis=1)[:, None]
    normal = np.column_stack([-along[:, 1], along[:, 0]])
    before = np.roll(normal, 1, 0)
    if not closed:
        before[0], normal[-1] = normal[0], before[-1]
    return points + distance * (before + normal) / (1 + np.sum(before * normal, axis=1))[:, None]


def triangulate(outline):
    """Ears cut off a simple polygon, as index triples."""
    left = list(range(len(outline)))
    ears = []
    while len(left) > 3:
        best = None
        for k in range(len(left)):
            i, j, m = left[k - 1], left[k], left[(k + 1) % len(left)]
            a, b, c = outline[[i, j, m]]
            area = cross(b - a, c - a)
            rest = outline[[n for n in left if n not in (i, j, m)]]
            inside = (cross(b - a, rest - a) >= 0) & (cross(c - b, rest - b) >= 0) & (cross(a - c, rest - c) >= 0)
            if area > 0 and not inside.any():
                # The best shaped ear first: slivers would catch the light badly.
                sides = np.sum((b - a) ** 2) + np.sum((c - b) ** 2) + np.sum((a - c) ** 2)
                if best is None or area / sides > best[0]:
                    best = (area / sides, k, (i, j, m))
        ears.append(best[2])
        left.pop(best[1])
    return ears + [tuple(left)]


# Meshes: arrays of triangles, (count, 3 corners, 3 coordinates).


def wall(lower, upper, closed=True):
    """Two rows of points in space joined by triangles; they face right of the direction of the rows, seen from `upper`."""
    following = [np.roll(row, -1, 0) if closed else row[1:] for row in (lower, upper)]
    if not closed:
        lower, upper = lower[:-1], upper[:-1]
    return np.concatenate([np.stack([lower, following[0], following[1]], 1), np.stack([lower, following[1], upper], 1)])


def at(outline, w):
    return np.column_stack([outline, np.full(len(outline), w)])


def cap(outline, w, up):
    points = at(outline, w)
    return np.array([points[list(ear if up else ear[::-1])] for ear in triangulate(outline)])


def extrude(outline, low, high, bevel=0.0):
    """The outline from w = low to w = high, its rims cut back by `bevel` so that they catch the light."""
    if not bevel:
        return np.concatenate([cap(outline, low, False), wall(at(outline, low), at(outline, high)), cap(outline, high, True)])
    inner = offset(outline, bevel)
    levels = [at(inner, low), at(outline, low + bevel), at(outline, high - bevel), at(inner, high)]
    walls = [wall(a, b) for a, b in zip(levels, levels[1:])]
    return np.concatenate([cap(inner, low, False), *walls, cap(inner, high, True)])


def extrude_frame(outline, inner, low, high):
    """What lies between two outlines of as many points."""
    return np.concatenate([
        wall(at(outline, low), at(outline, high)), wall(at(inner, high), at(inner, low)),
        wall(at(outline, high), at(inner, high)), wall(at(inner, low), at(outline, low)),
    ])


def side_view(mesh):
    """(u, v, w) to (x, -y, z): drawn from the machine's right side."""
    return np.stack([mesh[..., 0], -mesh[..., 2], mesh[..., 1]], -1)


def side(outline, y_low, y_high, bevel=0.0):
    return side_view(extrude(np.array(outline, float), -y_high, -y_low, bevel))


def plan(outline, z_low, z_high, bevel=0.0):
    return extrude(np.array(outline, float), z_low, z_high, bevel)


def box(low, high, bevel=0.0):
    return plan(rectangle(low[:2], high[:2]), low[2], high[2], bevel)


def both_sides(outline, y_low, y_high, bevel=0.0):
    return np.concatenate([side(outline, y_low, y_high, bevel), side(outline, -y_high, -y_low, bevel)])


# Bucket. Its frame sits in the pin that joins it to the stick, x points at the cutting edge and z to the back of the bowl, so
# that the mouth opens towards -z: to the machine when x points down.


def bucket_outline():
    """From the cutting edge along the floor, up the back, to the lip under the ears: the bowl's outer side."""
    edge = pin("bucket_edge")
    clearance = np.radians(10.0)  # the floor rises behind the edge: it must not rub on the ground that was just cut
    floor = np.array([-np.sin(clearance), np.cos(clearance)])
    floor_end = edge + 0.30 * floor
    lip, top_end = np.array([0.09, 0.02]), np.array([0.16, 0.36])
    top = (top_end - lip) / np.linalg.norm(top_end - lip)
    back = bezier([floor_end, floor_end + 0.30 * floor, top_end + 0.30 * top, top_end], 14)
    return np.concatenate([[edge], back, [lip]])


def bucket_shell(plate, edge_thickness):
    """Floor, back and two side plates of one thickness, as one closed surface."""
    outer = bucket_outline()
    edge, lip = outer[0], outer[-1]
    floor, top = (direction / np.linalg.norm(direction) for direction in (outer[1] - edge, outer[-2] - lip))
    mouth = (lip - edge) / np.linalg.norm(lip - edge)
    inner = offset(outer, plate, closed=False)
    # The lip ends in the plane of the mouth, and the floor is ground down to its edge from above: what touches sand keeps the
    # whole plate there, for an edge much thinner than a cell is lost between samples of its distance field.
    inner[-1] = lip + mouth * cross(inner[-1] - lip, top) / cross(mouth, top)
    inner = np.concatenate([[edge + edge_thickness * mouth, inner[0] + 0.12 * floor], inner[1:]])

    half, inside = BUCKET_WIDTH / 2, BUCKET_WIDTH / 2 - plate
    cavity = [inner[[-1, k, k + 1]] for k in range(len(inner) - 2)]

    def rim(outline, w):
        return np.concatenate([at(outline[[0, -1]], -w), at(outline[[-1, 0]], w)])

    return side_view(np.concatenate([
        cap(outer, -half, False), wall(at(outer, -half), at(outer, half), closed=False), cap(outer, half, True),
        [at(triangle, -inside) for triangle in cavity], [at(triangle[::-1], inside) for triangle in cavity],
        wall(at(inner, inside), at(inner, -inside), closed=False), wall(rim(inner, inside), rim(outer, half)),
    ]))


def bucket_looks():
    """The bucket as it is seen: thinner plates, teeth, wear strips and the ears that carry the pins."""
    edge, link = pin("bucket_edge"), pin("bucket_link_pin")
    outer = bucket_outline()
    forward = edge - outer[1]
    forward /= np.linalg.norm(forward)
    up = np.array([forward[1], -forward[0]])
    tooth = [edge - 0.11 * forward, edge - 0.11 * forward + 0.034 * up, edge - 0.07 * forward + 0.034 * up, edge + 0.055 * forward]
    teeth = [side(tooth, y - 0.03, y + 0.03) for y in np.linspace(-BUCKET_WIDTH / 2 + 0.04, BUCKET_WIDTH / 2 - 0.04, 7)]
    ear = hull(((0.0, 0.0), 0.065), (link, 0.06), ((0.16, 0.20), 0.08), ((0.12, 0.10), 0.06))
    strip = np.concatenate([outer[2:-2], offset(outer, -0.012, closed=False)[2:-2][::-1]])
    strips = [side(strip[::-1], y - 0.02, y + 0.02) for y in (-0.2, 0.0, 0.2)]
    return np.concatenate([bucket_shell(0.022, 0.012), *teeth, both_sides(ear, 0.085, 0.12, 0.006), *strips])


# Boom, stick and the levers of the bucket, each in its own frame with x towards the next pin.


def boom():
    tip = pin("stick")
    crest = np.array([0.48 * tip[0], 0.40])
    spine = bezier([(0, 0), 0.75 * crest + (0, 0.04), (crest[0] + 0.18, crest[1] + 0.02), tip], 18)
    share = np.linspace(0, 1, len(spine))
    half = np.interp(share, [0, 0.12, 0.5, 0.9, 1], [0.10, 0.115, 0.165, 0.10, 0.09])[:, None]
    along = np.gradient(spine, axis=0)
    normal = np.column_stack([-along[:, 1], along[:, 0]]) / np.linalg.norm(along, axis=1)[:, None]
    lower, upper = spine - half * normal, spine + half * normal
    foot = np.arctan2(*normal[0][::-1])
    head = np.arctan2(*-normal[-1][::-1])
    foot_end = circle(spine[0], half[0], 10, foot, np.pi)[1:-1]
    head_end = circle(tip, half[-1], 10, head, np.pi)[1:-1]
    outline = np.concatenate([lower, head_end, upper[::-1], foot_end])
    ram = pin("stick_cylinder")
    lug = hull((ram, 0.05), (ram + (-0.06, -0.17), 0.08), (ram + (0.12, -0.17), 0.08))
    return side(outline, -0.085, 0.085, 0.014), both_sides(lug, 0.045, 0.075, 0.005)


def stick():
    tip, tail = pin("bucket"), pin("stick_cylinder_pin")
    below = [tail + (-0.06, -0.05), (-0.12, -0.11), (0.10, -0.125), (0.45, -0.115), tip + (0.04, -0.07), tip + (0.075, 0.0)]
    above = [tip + (0.03, 0.065), (0.50, 0.125), (0.15, 0.17), (0.0, 0.19), tail + (0.05, 0.06), tail + (-0.05, 0.05)]
    outline = rounded(below + above, 0.06)
    ram = pin("bucket_cylinder")
    lug = hull((ram, 0.045), (ram + (-0.05, -0.13), 0.06), (ram + (0.12, -0.13), 0.06))
    return side(outline, -0.065, 0.065, 0.012), both_sides(lug, 0.04, 0.065, 0.005)


def lever(end, radius, y_low, y_high):
    return both_sides(hull(((0.0, 0.0), radius), (end, radius)), y_low, y_high, 0.005)


# Undercarriage: base_link, with z = 0 on the ground.

TRACK_LENGTH, TRACK_RADIUS, TRACK_WIDTH = 1.90, 0.225, 0.29


def track_belt():
    """The rubber belt in the frame of its track, with the lugs that it stands on."""
    reach = TRACK_LENGTH / 2 - TRACK_RADIUS
    turn = np.pi * TRACK_RADIUS
    length = 4 * reach + 2 * turn
    lugs = 46
    # Four points for each lug: two on its top, two on the belt.
    way = (np.arange(4 * lugs) + np.tile([0.0, 0.25, 0.0, 0.25], lugs)) * length / (4 * lugs)

    def outline(radius):
        """Forward below, up around the front, back above, down around the rear."""
        half_way = way % (length / 2)
        straight, angle = np.minimum(half_way, 2 * reach), np.maximum(half_way - 2 * reach, 0) / TRACK_RADIUS
        points = np.column_stack([straight - reach + radius * np.sin(angle), -radius * np.cos(angle)])
        return np.where(way[:, None] < length / 2, points, -points)

    tops, roots = outline(TRACK_RADIUS), outline(TRACK_RADIUS - 0.028)
    is_top = np.tile([True, True, False, False], lugs)[:, None]
    return side_view(extrude_frame(np.where(is_top, tops, roots), outline(TRACK_RADIUS - 0.055), -TRACK_WIDTH / 2, TRACK_WIDTH / 2))


def track_frame():
    """Sprocket, idler, rollers and the beam that holds them."""
    reach = TRACK_LENGTH / 2 - TRACK_RADIUS
    half = TRACK_WIDTH / 2 - 0.02
    teeth = np.arange(48)
    sprocket = circle((0, 0), 1.0, 48) * np.where(teeth % 4 < 2, 0.172, 0.150)[:, None] + (-reach, 0)
    parts = [side(sprocket, -half + 0.03, half - 0.03, 0.006), side(circle((-reach, 0), 0.085), -half, half, 0.015),
             side(circle((reach, 0), 0.168, 32), -half + 0.03, half - 0.03, 0.012), side(circle((reach, 0), 0.06), -half, half, 0.015)]
    parts += [side(circle((x, -0.10), 0.068), -half, half, 0.012) for x in np.linspace(-0.40, 0.40, 4)]
    parts += [side(circle((0.0, 0.125), 0.045), -half, half, 0.01)]
    beam = rounded([(-0.52, -0.07), (0.55, -0.07), (0.50, 0.05), (0.12, 0.09), (-0.12, 0.09), (-0.46, 0.06)], 0.04)
    return np.concatenate([*parts, side(beam, -0.10, 0.10, 0.012)])


def undercarriage():
    """The cross of the frame between the tracks, and the ring that the house turns on."""
    return np.concatenate([
        plan(rounded([(-0.50, -0.32), (0.50, -0.32), (0.50, 0.32), (-0.50, 0.32)], 0.12), 0.17, 0.36, 0.02),
        box((-0.38, -0.48, 0.20), (-0.16, 0.48, 0.34), 0.015), box((0.16, -0.48, 0.20), (0.38, 0.48, 0.34), 0.015),
        plan(circle((0, 0), 0.36, 40), 0.34, 0.45, 0.01),
    ])


def dozer_blade():
    back = bezier([(1.10, 0.13), (1.02, 0.22), (1.02, 0.34), (1.07, 0.46)], 10)
    front = back + np.array([0.03, 0.0])
    blade = side(np.concatenate([front, back[::-1]]), -0.72, 0.72)
    ribs = [side([(0.98, 0.20), (1.09, 0.15), (1.06, 0.42), (1.02, 0.42)], y - 0.015, y + 0.015) for y in (-0.69, -0.24, 0.24, 0.69)]
    arm = rounded([(0.42, 0.22), (1.05, 0.20), (1.05, 0.30), (0.42, 0.33)], 0.03)
    return np.concatenate([blade, *ribs, both_sides(arm, 0.20, 0.28, 0.01)])


# House: its frame turns about z, at the height of the swing joint.


def tail(radius, x_front, half_width):
    """A plan outline with a round tail, as of a machine that turns within its tracks."""
    angle = np.arcsin(half_width / radius)
    return np.concatenate([circle((0, 0), radius, 20, np.pi - angle, 2 * angle), [(x_front, -half_width), (x_front, half_width)]])


def platform():
    foot, ram = pin("boom"), pin("boom_cylinder")
    bracket = hull((foot, 0.12), (ram, 0.08), ((0.44, -0.02), 0.10), ((0.44, 0.20), 0.08))
    return plan(tail(0.78, 0.50, 0.68), -0.04, 0.08, 0.02), both_sides(bracket, 0.095, 0.135, 0.012)


def hood():
    """Engine cover behind, tank and hydraulics on the right."""
    cover = tail(0.75, -0.26, 0.665)
    flank = rounded([(-0.31, -0.665), (0.36, -0.665), (0.46, -0.56), (0.46, -0.17), (-0.31, -0.17)], 0.06)
    return np.concatenate([plan(cover, 0.28, 0.80, 0.04), plan(flank, 0.08, 0.52, 0.04)])


def counterweight():
    return plan(tail(0.79, -0.36, 0.675), 0.08, 0.34, 0.035)


CAB_LEFT, CAB_RIGHT = 0.67, -0.12
CAB_OUTLINE = [(-0.25, 0.08), (0.44, 0.08), (0.49, 0.55), (0.36, 1.66), (-0.22, 1.66), (-0.26, 0.60)]


def cab_frame():
    """Pillars and rails around the panes, left and right, and what joins them at the front and the back."""
    outline = rounded(CAB_OUTLINE, 0.10)
    inner = offset(outline, 0.055)
    frame = extrude_frame(outline, inner, -0.025, 0.025)
    sides = [side_view(frame) + np.array([0.0, y, 0.0]) for y in (CAB_LEFT - 0.025, CAB_RIGHT + 0.025)]
    rails = [side(rounded(corners, 0.01), CAB_RIGHT + 0.04, CAB_LEFT - 0.04) for corners in (
        [(0.405, 0.08), (0.448, 0.08), (0.495, 0.52), (0.445, 0.52)],
        [(0.345, 1.56), (0.375, 1.56), (0.36, 1.655), (0.33, 1.655)],
        [(-0.235, 1.56), (-0.195, 1.56), (-0.19, 1.65), (-0.225, 1.65)],
        [(-0.255, 0.08), (-0.21, 0.08), (-0.21, 0.70), (-0.255, 0.70)],
    )]
    door = [side(rounded([(-0.055, 0.12), (0.0, 0.12), (0.03, 1.62), (-0.025, 1.62)], 0.01), y - 0.022, y + 0.022)
            for y in (CAB_LEFT - 0.025, CAB_RIGHT + 0.025)]
    handle = [box((0.05, CAB_LEFT, 0.62), (0.16, CAB_LEFT + 0.025, 0.65), 0.008)]
    return np.concatenate([*sides, *rails, *door, *handle])


def cab_panels():
    """The sheet metal of the cab: sills under the panes, and the roof."""
    sill = rounded([(-0.25, 0.12), (0.41, 0.12), (0.44, 0.50), (-0.25, 0.50)], 0.03)
    sills = [side(sill, y - 0.012, y + 0.012, 0.004) for y in (CAB_LEFT - 0.02, CAB_RIGHT + 0.02)]
    roof = plan(rounded(rectangle((-0.29, CAB_RIGHT - 0.02), (0.43, CAB_LEFT + 0.02)), 0.09), 1.65, 1.74, 0.03)
    return np.concatenate([*sills, roof])


def cab_glass():
    return side(offset(rounded(CAB_OUTLINE, 0.10), 0.02), CAB_RIGHT + 0.02, CAB_LEFT - 0.02)


def cab_interior():
    middle = (CAB_LEFT + CAB_RIGHT) / 2
    seat = rounded([(-0.20, 0.42), (0.14, 0.40), (0.18, 0.50), (-0.08, 0.52), (-0.14, 1.02), (-0.24, 1.02)], 0.05)
    headrest = rounded([(-0.20, 1.05), (-0.14, 1.05), (-0.15, 1.22), (-0.21, 1.22)], 0.02)
    lever_stick = rounded([(0.10, 0.60), (0.13, 0.60), (0.16, 0.80), (0.12, 0.80)], 0.01)
    parts = [side(seat, middle - 0.22, middle + 0.22, 0.03), side(headrest, middle - 0.12, middle + 0.12, 0.008),
             box((-0.20, middle - 0.18, 0.08), (0.10, middle + 0.18, 0.42), 0.02)]
    for y in (middle - 0.27, middle + 0.27):
        parts += [box((-0.10, y - 0.05, 0.10), (0.16, y + 0.05, 0.62), 0.02), side(lever_stick, y - 0.018, y + 0.018)]
    return np.concatenate(parts)


def grille():
    """Slots around the engine cover, and the exhaust."""
    slots = []
    for z in np.arange(0.44, 0.72, 0.05):
        for start, sweep in ((2.25, 0.35), (2.85, 0.58), (3.68, 0.35)):
            arcs = [circle((0, 0), radius, 8, start, sweep) for radius in (0.753, 0.70)]
            slots.append(plan(np.concatenate([arcs[0], arcs[1][::-1]]), z, z + 0.022))
    pipe = [plan(circle((-0.50, -0.42), 0.035), 0.79, 1.02, 0.006), plan(circle((-0.50, -0.42), 0.052), 0.78, 0.90, 0.01)]
    return np.concatenate([*slots, *pipe])


# Letters for the stick, five squares by seven.

GLYPHS = {
    " ": "",
    "S": "01111 10000 10000 01110 00001 00001 11110", "H": "10001 10001 10001 11111 10001 10001 10001",
    "A": "01110 10001 10001 11111 10001 10001 10001", "L": "10000 10000 10000 10000 10000 10000 11111",
    "O": "01110 10001 10001 10001 10001 10001 01110", "W": "10001 10001 10001 10101 10101 11011 10001",
    "N": "10001 11001 10101 10011 10001 10001 10001", "D": "11110 10001 10001 10001 10001 10001 11110",
}


def lettering(text, height, y):
    """Text that starts at the origin and runs along x, to be read from the right of the machine (y < 0) or the left (y > 0)."""
    square = height / 7
    boxes = []
    for place, letter in enumerate(text):
        for row, line in enumerate(GLYPHS[letter].split()):
            for stroke in re.finditer("1+", line):
                low, high = ((6 * place + column) * square for column in stroke.span())
                boxes.append(box((low, y - 0.002, (6 - row) * square), (high, y + 0.002, (7 - row) * square)))
    mesh = np.concatenate(boxes)
    if y > 0:
        # Seen from the left, x runs to the left: turned about z, the text keeps its reading direction.
        mesh = mesh * (-1, -1, 1) + ((6 * len(text) - 1) * square, 2 * y, 0)
    return mesh


def write(name, mesh):
    """Binary STL. Refuses a surface that is not closed and facing outwards: a sand column could not tell inside from outside."""
    corners = mesh.astype("<f4")
    keys = [tuple(corner) for corner in corners.reshape(-1, 3).tolist()]
    edges = Counter((keys[3 * t + i], keys[3 * t + (i + 1) % 3]) for t in range(len(corners)) for i in range(3))
    closed = all(edges[(b, a)] == count for (a, b), count in edges.items())
    exact = corners.astype(float)
    volume = np.sum(exact[:, 0] * np.cross(exact[:, 1], exact[:, 2])) / 6
    assert closed and volume > 0, f"{name}: not a closed surface that faces outwards (volume {volume})"
    normals = np.cross(exact[:, 1] - exact[:, 0], exact[:, 2] - exact[:, 0])
    normals /= np.maximum(np.linalg.norm(normals, axis=1), 1e-12)[:, None]
    records = np.zeros(len(corners), dtype=[("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])
    records["normal"], records["corners"] = normals, corners
    header = f"shallow_sand excavator: {name}".encode().ljust(80, b" ")
    (HERE / "meshes" / f"{name}.stl").write_bytes(header + struct.pack("<I", len(corners)) + records.tobytes())
    print(f"{name:20s} {len(corners):5d} triangles {volume:9.5f} m3")


def main():
    boom_body, boom_lugs = boom()
    stick_body, stick_lugs = stick()
    floor, bracket = platform()
    meshes = {
        "bucket": bucket_shell(BUCKET_PLATE, BUCKET_PLATE), "bucket_looks": bucket_looks(),
        "boom": boom_body, "boom_lugs": boom_lugs, "stick": stick_body, "stick_lugs": stick_lugs,
        "rocker": lever(pin("bucket_link"), 0.045, 0.07, 0.10), "bucket_link": lever(pin("bucket_link_end"), 0.05, 0.03, 0.065),
        "track_belt": track_belt(), "track_frame": track_frame(), "undercarriage": undercarriage(), "dozer_blade": dozer_blade(),
        "platform": floor, "boom_bracket": bracket, "hood": hood(), "counterweight": counterweight(), "grille": grille(),
        "cab_frame": cab_frame(), "cab_panels": cab_panels(), "cab_glass": cab_glass(), "cab_interior": cab_interior(),
    }
    for y, name in ((0.065, "lettering_left"), (-0.065, "lettering_right")):
        meshes[name] = lettering("SHALLOW SAND", 0.068, y)
    for name, mesh in meshes.items():
        write(name, mesh)


if __name__ == "__main__":
    main()
