#!/usr/bin/python3
"""A robot with what real descriptions hold in store: it loads, says what is amiss once, and leaves its track."""
import os
import pathlib
import struct
import tempfile
import unittest

import numpy
import rospy
import rostest
from sand_test import SCENE, Place, RunningNode, World, wait_for_depth

DEPTH = SCENE["sand"][0]["depth"]

CORNERS = numpy.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)], float)
FACES = [(0, 2, 6, 4), (1, 5, 7, 3), (0, 4, 5, 1), (2, 3, 7, 6), (0, 1, 3, 2), (4, 6, 7, 5)]  # below, above, then the sides


def triangles(faces):
    return [triangle for a, b, c, d in faces for triangle in ((a, b, c), (a, c, d))]


def write_stl(path, corners, faces):
    data = b"".join(struct.pack("<12fH", 0, 0, 0, *corners[list(triangle)].ravel(), 0) for triangle in triangles(faces))
    path.write_bytes(bytes(80) + struct.pack("<I", len(data) // 50) + data)


def write_collada(path, corners, faces):
    """In inches and Z up, which assimp puts into the root's matrix; its texture is missing."""
    numbers = " ".join(f"{value:g}" for value in corners.ravel())
    indices = " ".join(str(corner) for triangle in triangles(faces) for corner in triangle)
    path.write_text(f"""<?xml version="1.0"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
  <asset><unit name="inch" meter="0.0254"/><up_axis>Z_UP</up_axis></asset>
  <library_images><image id="paint"><init_from>missing.png</init_from></image></library_images>
  <library_geometries><geometry id="part"><mesh>
    <source id="places"><float_array id="numbers" count="{corners.size}">{numbers}</float_array>
      <technique_common><accessor source="#numbers" count="{len(corners)}" stride="3">
        <param name="X" type="float"/><param name="Y" type="float"/><param name="Z" type="float"/></accessor></technique_common></source>
    <vertices id="corners"><input semantic="POSITION" source="#places"/></vertices>
    <triangles count="{len(triangles(faces))}"><input semantic="VERTEX" source="#corners" offset="0"/><p>{indices}</p></triangles>
  </mesh></geometry></library_geometries>
  <library_visual_scenes><visual_scene id="scene"><node id="node"><instance_geometry url="#part"/></node></visual_scene></library_visual_scenes>
  <scene><instance_visual_scene url="#scene"/></scene>
</COLLADA>
""")


def link(name, mesh, scale="1 1 1"):
    return f'<link name="{name}"><collision><geometry><mesh filename="{mesh.as_uri()}" scale="{scale}"/></geometry></collision></link>'


def description(folder):
    write_collada(folder / "post.dae", (CORNERS - [0.5, 0.5, 0]) * [8, 8, 20], FACES)
    # An open shell without thickness: a box without its lid, in millimetres.
    write_stl(folder / "shell.stl", (CORNERS - [0.5, 0.5, 0]) * [400, 300, 250], FACES[:1] + FACES[2:])
    write_stl(folder / "wedge.stl", (CORNERS - [0.0, 0.5, 0]) * [0.2, 0.2, 0.4], FACES)
    joint = '<joint name="{0}_joint" type="{2}"><parent link="{1}"/><child link="{0}"/><axis xyz="0 0 2"/>{3}</joint>'.format
    return f"""<robot name="traps"><link name="base"/><link name="tool_tip"/>
{link("post", folder / "post.dae")}{link("shell", folder / "shell.stl", "0.001 0.001 0.001")}
{link("mirrored", folder / "wedge.stl", "-1 1 1")}{link("lost", folder / "lost.stl")}
{joint("post", "base", "continuous", "")}{joint("shell", "base", "fixed", '<mimic joint="post_joint"/>')}
{joint("mirrored", "base", "fixed", "")}{joint("lost", "base", "fixed", "")}{joint("tool_tip", "post", "fixed", "")}</robot>"""


class Traps(unittest.TestCase):
    def test_loads_and_leaves_its_track(self):
        with tempfile.TemporaryDirectory() as folder:
            os.environ["XDG_CACHE_HOME"] = folder
            rospy.set_param("/robot_description", description(pathlib.Path(folder)))
            scene = dict(SCENE, grid={"size": [2.0, 2.0], "spacing": 0.05, "frame": "sand"})
            frames = {"post": lambda _: Place(0.5, 0.5, -0.1), "shell": lambda _: Place(1.4, 0.5, 0.3),
                      "mirrored": lambda _: Place(0.8, 1.5, -0.1), "lost": lambda _: Place(1.5, 1.5)}
            with World(frames) as world, RunningNode("trapped", scene) as node:
                self.assertEqual(sorted(body.name for body in node.status(lambda status: len(status.bodies) == 3).bodies),
                                 ["mirrored", "post", "shell"])
                # 8 inches wide, 0.2 m, and upright.
                wait_for_depth(node, 0.55, 0.45, lambda depth: depth < 0.1 * DEPTH)
                wait_for_depth(node, 0.70, 0.45, lambda depth: depth > 0.3 * DEPTH)
                for y in (0.25, 0.75):
                    wait_for_depth(node, 0.5, y, lambda depth: depth > 0.3 * DEPTH)
                # The mirrored one reaches from x = 0.6 to 0.8.
                wait_for_depth(node, 0.7, 1.5, lambda depth: depth < 0.1 * DEPTH)
                wait_for_depth(node, 0.95, 1.5, lambda depth: depth > 0.3 * DEPTH)
                # The shell hangs over the sand and goes into it: its floor comes to rest on the bed.
                wait_for_depth(node, 1.4, 0.5, lambda depth: depth > 0.9 * DEPTH)
                world.frames["shell"] = lambda _: Place(1.4, 0.5, 0.01)
                wait_for_depth(node, 1.4, 0.5, lambda depth: depth < 0.2 * DEPTH)
                world.frames["shell"] = lambda _: Place(1.4, 0.5, 0.6)
                wait_for_depth(node, 1.25, 0.4, lambda depth: depth > 0.1 * DEPTH)
                self.assertEqual(len(node.wait_for_error("'lost'", "lost.stl", "left out")), 1)
                node.assert_well(self)
                self.assertEqual([line for line in node.error_lines() if "lost" not in line and "jumped" not in line], [])


if __name__ == "__main__":
    rospy.init_node("test_traps")
    rostest.rosrun("shallow_sand", "traps", Traps)
