#!/usr/bin/python3
"""The surface as others get it: a cloud and a mesh with colours, the mesh coarser where it would be large, and a file at the end."""
import os
import signal
import tempfile
import unittest

import numpy
import rospy
import rostest
from sand_test import SCENE, RunningNode, World
from sensor_msgs.msg import PointCloud2
from visualization_msgs.msg import Marker

# Sand on the western half; the other half is bare.
HALF = dict(SCENE, sand=[{"box": {"min": [0.0, 0.0], "max": [0.5, 1.0], "depth": 0.1}}], material={"friction_angle": 89.0})
CELLS = 20 * 20
LEVEL_SAND = numpy.array([0.93, 0.78, 0.54])


def is_sand(colors):
    """Sand is warm, and bare bed grey."""
    return colors[:, 0] > colors[:, 2] + 0.1


class Surface(unittest.TestCase):
    def mesh(self, node):
        marker = rospy.wait_for_message(node.name + "/mesh", Marker, timeout=20.0)
        self.assertEqual((marker.header.frame_id, marker.type), ("sand", Marker.TRIANGLE_LIST))
        points = numpy.array([(p.x, p.y, p.z) for p in marker.points])
        colors = numpy.array([(c.r, c.g, c.b) for c in marker.colors])
        self.assertEqual(len(points), len(colors))
        return points.reshape(-1, 3, 3), is_sand(colors).reshape(-1, 3)

    def test_the_cloud_has_fields_and_colours(self):
        with World({}), RunningNode("cloud", HALF) as node:
            cloud = rospy.wait_for_message(node.name + "/points", PointCloud2, timeout=20.0)
        self.assertEqual([field.name for field in cloud.fields], ["x", "y", "z", "intensity", "rgb"])
        self.assertEqual((cloud.width, cloud.height), (20, 20))
        values = numpy.frombuffer(cloud.data, dtype=numpy.float32).reshape(CELLS, 5)
        packed = numpy.ascontiguousarray(values[:, 4]).view(numpy.uint32)
        colors = numpy.stack([(packed >> shift & 0xFF) / 255.0 for shift in (16, 8, 0)], axis=1)
        numpy.testing.assert_array_equal(is_sand(colors), values[:, 3] >= 0.005)
        inside = values[:, 0] < 0.3
        numpy.testing.assert_allclose(colors[inside], numpy.tile(LEVEL_SAND, (inside.sum(), 1)), atol=0.003)

    def test_each_triangle_of_the_mesh_is_sand_or_bed(self):
        with World({}), RunningNode("fine", HALF) as node:
            triangles, sand = self.mesh(node)
        self.assertGreater(len(triangles), 2 * 19 * 19)
        numpy.testing.assert_array_equal(sand.all(axis=1), sand.any(axis=1))
        seam = triangles[sand.all(axis=1)][:, :, 0].max()
        self.assertTrue(0.475 < seam < 0.525, seam)

    def test_a_large_map_is_shown_by_blocks(self):
        with World({}), RunningNode("coarse", dict(SCENE, mesh_cells=100)) as node:
            triangles, _ = self.mesh(node)
        self.assertEqual(len(triangles), 2 * 9 * 9)

    def test_a_file_at_the_end(self):
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "sand.ply")
            with World({}), RunningNode("file", dict(SCENE, mesh_file=path)) as node:
                node.status()
                node.process.send_signal(signal.SIGINT)
                self.assertEqual(node.process.wait(timeout=20), 0)
            with open(path, "rb") as file:
                header = file.read().split(b"end_header")[0]
            self.assertIn(b"element face %d\n" % (2 * 19 * 19), header)


if __name__ == "__main__":
    rospy.init_node("test_surface")
    rostest.rosrun("shallow_sand", "surface", Surface)
