#!/usr/bin/python3
"""The blade pushes a trench into the sand: as deep as it reaches, with a heap before it, and no sand is lost."""
import unittest

import rospy
import rostest
from geometry_msgs.msg import Point
from sensor_msgs.msg import JointState
from shallow_sand.msg import BodyStatus, Status
from shallow_sand.srv import QuerySurface, QuerySurfaceRequest


class Dig(unittest.TestCase):
    def setUp(self):
        self.joints = rospy.Publisher("joint_states", JointState, queue_size=10)
        rospy.wait_for_service("/sand_node/query_surface", timeout=30.0)
        self.query_surface = rospy.ServiceProxy("/sand_node/query_surface", QuerySurface)

    def push(self, position):
        message = JointState(name=["push"], position=[position])
        message.header.stamp = rospy.Time.now()
        self.joints.publish(message)
        rospy.sleep(0.02)

    def heights(self, *places):
        request = QuerySurfaceRequest(points=[Point(x, y, 0.0) for x, y in places])
        request.header.frame_id = "sand"
        answer = self.query_surface(request)
        self.assertTrue(answer.success, answer.message)
        return [place.z for place in answer.surface]

    def wait_until_blade_is_in_sand(self):
        for _ in range(1500):
            self.push(0.0)
            status = rospy.wait_for_message("/sand_node/status", Status, timeout=10.0)
            if any(body.name == "blade" and body.state == BodyStatus.MOVING for body in status.bodies):
                return
        self.fail("the blade never got into the sand")

    def test_a_trench(self):
        self.wait_until_blade_is_in_sand()
        for k in range(200):  # 0.8 m in 4 s
            self.push(0.8 * k / 200)
        for _ in range(50):
            self.push(0.8)
        behind, beside, before = self.heights((0.9, 0.0), (0.9, 0.5), (1.3, 0.0))
        self.assertLess(behind, -0.03, "no trench")  # the blade reaches 0.05 m deep
        self.assertGreater(before, 0.02, "no heap")
        self.assertAlmostEqual(beside, 0.0, delta=0.005)
        status = rospy.wait_for_message("/sand_node/status", Status, timeout=10.0)
        self.assertLess(status.volume_error, 1e-6)


if __name__ == "__main__":
    rospy.init_node("test_dig")
    rostest.rosrun("my_digger", "dig", Dig)
