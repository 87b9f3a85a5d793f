#!/usr/bin/python3
"""The node as a nodelet: the same topics and services, in a manager that outlives it."""
import unittest

import rospy
import rostest
from nodelet.srv import NodeletList, NodeletLoad, NodeletUnload
from geometry_msgs.msg import Point, PointStamped
from sand_test import SCENE, wait_until
from sensor_msgs.msg import PointCloud2
from shallow_sand.msg import Status
from shallow_sand.srv import EditSand, EditSandRequest
from std_msgs.msg import Header, UInt64
from std_srvs.srv import SetBool


def load(name, parameters, kind="shallow_sand/SandNodelet", **remapped):
    rospy.set_param(name, parameters)
    rospy.wait_for_service("/manager/load_nodelet", timeout=20.0)
    load_nodelet = rospy.ServiceProxy("/manager/load_nodelet", NodeletLoad)
    return load_nodelet(name, kind, [f"{name}/{topic}" for topic in remapped], list(remapped.values()), [], "").success


def loaded():
    return rospy.ServiceProxy("/manager/list", NodeletList)().nodelets


class Nodelets(unittest.TestCase):
    def test_two_in_one_manager_come_and_go(self):
        for name in ("/one", "/two"):
            self.assertTrue(load(name, dict(SCENE, robot_description="")))
        for name in ("/one", "/two"):
            cloud = rospy.wait_for_message(name + "/points", PointCloud2, timeout=20.0)
            self.assertEqual((cloud.width, cloud.height, cloud.header.frame_id), (20, 20, "sand"))
            start = rospy.wait_for_message(name + "/status", Status, timeout=20.0)
            self.assertGreater(start.volume, 0.0)
        self.assertTrue(rospy.ServiceProxy("/one/pause", SetBool)(True).success)
        self.assertTrue(rospy.wait_for_message("/one/status", Status, timeout=20.0).paused)
        self.assertFalse(rospy.wait_for_message("/two/status", Status, timeout=20.0).paused)
        self.assertTrue(rospy.ServiceProxy("/manager/unload_nodelet", NodeletUnload)("/one").success)
        self.assertIn("/two", loaded())
        self.assertNotIn("/one", loaded())
        self.assertTrue(load("/one", dict(SCENE, robot_description="")))
        rospy.wait_for_message("/one/points", PointCloud2, timeout=20.0)

    def test_clouds_are_shared(self):
        for name in ("/one_listener", "/other_listener"):
            self.assertTrue(load(name, {}, "shallow_sand_listener/Listener", points="/shared/points"))
        self.assertTrue(load("/shared", dict(SCENE, robot_description="")))

        def shared():
            """The first cloud may have been there before they were connected."""
            edited = edit(center=PointStamped(Header(frame_id="sand"), Point(0.5, 0.5, 0.0)), radius=0.2,
                          operation=EditSandRequest.SET, value=0.2)
            self.assertTrue(edited.success, edited.message)
            one, other = (rospy.wait_for_message(f"/{name}_listener/address", UInt64, timeout=20.0).data for name in ("one", "other"))
            return one == other != 0

        rospy.wait_for_service("/shared/edit_sand", timeout=20.0)
        edit = rospy.ServiceProxy("/shared/edit_sand", EditSand)
        wait_until(shared, "the node's own cloud, the same for both")
        # Others get a copy.
        self.assertEqual(rospy.wait_for_message("/shared/points", PointCloud2, timeout=20.0).width, 20)

    def test_a_bad_parameter_leaves_the_manager_running(self):
        load("/bad", {"grid": {"spacing": -1.0}})
        self.assertTrue(load("/good", dict(SCENE, robot_description="")))
        rospy.wait_for_message("/good/points", PointCloud2, timeout=20.0)
        self.assertIn("/good", loaded())


if __name__ == "__main__":
    rospy.init_node("test_nodelet")
    rostest.rosrun("shallow_sand", "nodelet", Nodelets)
