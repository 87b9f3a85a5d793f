#!/usr/bin/python3
"""What goes wrong is said in one clear line, and the node lives on, or ends with exit code 2 if it cannot start."""
import os
import socket
import struct
import tempfile
import unittest

import rospy
import rostest
from sand_test import SCENE, RunningNode, link, robot
from shallow_sand.msg import BodyStatus

URDF = robot("ghost_robot", link("ghost"))


class Faults(unittest.TestCase):
    def setUp(self):
        if rospy.has_param("/robot_description"):
            rospy.delete_param("/robot_description")

    def test_missing_robot_description_then_missing_tf(self):
        with RunningNode("no_robot", SCENE) as node:
            lines = node.wait_for_error("/robot_description", "URDF")
            self.assertEqual(len(lines), 1)
            node.assert_well(self)
            # It comes later; its link never gets a pose.
            rospy.set_param("/robot_description", URDF)
            node.wait_for_error("link ghost", "tf frame ghost", "frame sand")
            waiting = node.status(lambda status: any(body.problem for body in status.bodies))
            self.assertEqual([body.state for body in waiting.bodies], [BodyStatus.WAITING])
            node.assert_well(self)
            self.assertEqual(len(node.wait_for_error("link ghost")), 1, "said more than once")

    def test_broken_robot_description(self):
        rospy.set_param("/robot_description", "<robot name='broken'>")
        with RunningNode("broken_robot", SCENE) as node:
            self.assertEqual(len(node.wait_for_error("/robot_description")), 1)
            node.assert_well(self)
            self.assertEqual(len(node.wait_for_error("/robot_description")), 1, "said more than once")

    def test_bad_meshes(self):
        with tempfile.TemporaryDirectory() as folder:
            contents = {
                "empty": b"",
                "text": b"This is no mesh.\n" * 100,
                # A binary STL that promises four thousand million triangles and holds one.
                "promise": bytes(80) + struct.pack("<I", 4000000000) + bytes(50),
            }
            for name, content in contents.items():
                with open(os.path.join(folder, name + ".stl"), "wb") as file:
                    file.write(content)
            names = ["missing"] + list(contents)
            caller = socket.create_server(("127.0.0.1", 0))
            caller.setblocking(False)
            links = [link(name, f'<mesh filename="file://{folder}/{name}.stl"/>') for name in names]
            links += [link("fetched", f'<mesh filename="http://127.0.0.1:{caller.getsockname()[1]}/a.stl"/>')]
            links += [link("huge", '<box size="1e6 1e6 1e6"/>'), link("good")]
            rospy.set_param("/robot_description", robot("patchwork", *links))
            with RunningNode("meshes", SCENE) as node:
                # One that is so large is sampled coarsely, and comes when that is done.
                status = node.status(lambda status: len(status.bodies) >= 2)
                self.assertEqual([body.name for body in status.bodies], ["good", "huge"])
                for name in names:
                    self.assertEqual(len(node.wait_for_error(f"'{name}'", name + ".stl", "left out")), 1, name)
                self.assertEqual(len(node.wait_for_error("'fetched'", "http://", "expected package://", "left out")), 1)
                with self.assertRaises(BlockingIOError, msg="somebody called"):
                    caller.accept()
                caller.close()
                self.assertEqual(len(node.wait_for_error("link huge", "so large", "sampled every")), 1)
                node.assert_well(self)
                self.assertEqual(len(node.error_lines("left out")), len(names) + 1, node.error_lines())

    def expect_refusal(self, name, changes, *words):
        with RunningNode(name, dict(SCENE, **changes)) as node:
            self.assertEqual(node.process.wait(timeout=20), 2)
            lines = node.error_lines()
            self.assertEqual(len(lines), 1, lines)
            for word in words:
                self.assertIn(word, lines[0])

    def test_bad_parameters_end_the_node(self):
        self.expect_refusal("angle", {"material": {"friction_angle": 95.0}}, "material.friction_angle", "95")
        self.expect_refusal("typo", {"sands": []}, "sands", "sand")
        self.expect_refusal("nearest", {"publish_rates": 5.0}, "publish_rates", "unknown", "such as publish_rate")
        self.expect_refusal("rate", {"frame_rate": -1.0}, "frame_rate", "hertz")
        self.expect_refusal("delay", {"tf_delay": 60.0}, "tf_delay", "seconds", "60")
        self.expect_refusal("mesh_cells", {"mesh_cells": 1e9}, "mesh_cells", "cells", "1e6")
        self.expect_refusal("mesh_file", {"mesh_file": "sand.obj"}, "mesh_file", "sand.obj", ".stl or .ply")
        self.expect_refusal("pattern", {"include": "bucket"}, "include", "bucket", "list of patterns")
        self.expect_refusal("no_list", {"robots": "r2d2"}, "robots", "r2d2", "list of maps")
        self.expect_refusal("no_map", {"robots": ["r2d2"]}, "robots[0]", "r2d2", "map")
        self.expect_refusal("no_description", {"robots": [{"name": "a"}]}, "robots[0]", "description", "missing")
        self.expect_refusal("key", {"robots": [{"description": "a", "prefix": "b"}]}, "robots[0]", "prefix", "tf_prefix")
        twice = {"description": "a", "name": "b"}
        self.expect_refusal("twice", {"robots": [twice, twice]}, "robots[1]", "name", "no other robot")
        self.expect_refusal("both", {"robots": [twice], "tf_prefix": "c"}, "robots", "tf_prefix")


if __name__ == "__main__":
    rospy.init_node("test_faults")
    rostest.rosrun("shallow_sand", "faults", Faults)
