#!/usr/bin/python3
"""What stands for a link in the sand: its own shape, or what `shapes` puts around it; and the cache, which two nodes share."""
import os
import pathlib
import tempfile
import unittest

import rospy
import rostest
from geometry_msgs.msg import Point, Pose, PoseStamped
from sand_test import SCENE, Place, RunningNode, World, link, robot, wait_for_depth
from shallow_sand.srv import AddBody

DEPTH = SCENE["sand"][0]["depth"]
POSTS = "".join(f'<collision><origin xyz="{x} 0 0"/><geometry><box size="0.1 0.2 0.4"/></geometry></collision>' for x in (-0.3, 0.3))


def posts(name):
    """Two posts, with sand between them unless something else stands for the link."""
    return f'<link name="{name}">{POSTS}</link>'


class Shapes(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        os.environ["XDG_CACHE_HOME"] = self.folder.name
        rospy.set_param("/robot_description", robot("crane", posts("fork"), posts("gate")))
        self.frames = {"fork": lambda _: Place(0.5, 0.25, 0.1), "gate": lambda _: Place(0.5, 0.75, 0.1)}

    def tearDown(self):
        self.folder.cleanup()

    def cached(self):
        return sorted(path.name for path in pathlib.Path(self.folder.name).glob("shallow_sand/*"))

    def test_one_link_by_its_hull(self):
        shapes = {"fo*": "convex_hull", "knife_*": "bounding_box"}
        with World(self.frames), RunningNode("hull", dict(SCENE, shapes=shapes)) as node:
            wait_for_depth(node, 0.5, 0.25, lambda depth: depth < 0.1 * DEPTH)
            wait_for_depth(node, 0.2, 0.75, lambda depth: depth < 0.1 * DEPTH)
            wait_for_depth(node, 0.5, 0.75, lambda depth: depth > 0.9 * DEPTH)
            self.assertEqual(len(node.wait_for_error("robot crane", "shapes", "'knife_*'", "fork, gate")), 1)
            node.assert_well(self)
            self.assertEqual(len(node.error_lines()), 1, node.error_lines())

    def test_two_nodes_share_the_cache(self):
        with World(self.frames), RunningNode("first", SCENE) as first, RunningNode("second", SCENE) as second:
            for node in (first, second):
                node.status(lambda status: len(status.bodies) == 2)
                node.assert_well(self)
                self.assertEqual(node.error_lines(), [])
            # Both links have the same shape.
            self.assertEqual(len(self.cached()), 1, self.cached())

    def test_a_mesh_comes_from_the_cache_the_second_time(self):
        mesh = pathlib.Path(self.folder.name) / "tetrahedron.obj"
        mesh.write_text("v 0 0 0\nv 0.3 0 0\nv 0 0.3 0\nv 0 0 0.3\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n")
        with World(self.frames), RunningNode("mesh", SCENE) as node:
            rospy.wait_for_service(node.name + "/add_body", timeout=20.0)
            add = rospy.ServiceProxy(node.name + "/add_body", AddBody)
            pose = PoseStamped(pose=Pose(position=Point(0.5, 0.5, 2.0)))
            for name, mesh_as, words in (("a", "", "sampled"), ("b", "exact", "from the cache"),
                                         ("c", "bounding_box", "sampled"), ("d", "ball", "mesh_as")):
                answer = add(name=name, mesh=mesh.as_uri(), mesh_as=mesh_as, pose=pose)
                self.assertIn(words, answer.message)
                self.assertEqual(answer.success, name != "d")

    def test_bad_shapes(self):
        for shapes, words in (({"fork": "ball"}, ("shapes.fork", "ball", "convex_hull")), (["fork"], ("shapes", "map"))):
            with RunningNode("bad_shapes", dict(SCENE, shapes=shapes)) as node:
                self.assertEqual(node.process.wait(timeout=20), 2)
                self.assertEqual(len(node.error_lines()), 1, node.error_lines())
                self.assertTrue(all(word in node.error_lines()[0] for word in words), node.error_lines())


if __name__ == "__main__":
    rospy.init_node("test_shapes")
    rostest.rosrun("shallow_sand", "shapes", Shapes)
