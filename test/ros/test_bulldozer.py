#!/usr/bin/python3
"""The bulldozer's blade leaves the plan's level behind it, and what cut_and_fill tells before and after is even."""
import unittest

import numpy
import rospy
import rostest
from shallow_sand.msg import Status
from std_msgs.msg import Float64
from wheel_tracks import KeptUp, by_rows, ground, height_field

LANE = 8.0  # m, y of the middle of the pass
BEGIN, END = 5.5, 8.2  # m, x that the blade comes from and leaves its heap before, as in one_pass.yaml
WITHIN = 1.2  # m from the middle of the lane; the blade is 3.0 m wide, and sand slides back over its ends
LIMIT = 30.0  # s


class Bulldozer(unittest.TestCase):
    def setUp(self):
        self.told = {"cut": [], "fill": []}
        for name, values in self.told.items():
            rospy.Subscriber("/cut_and_fill/" + name, Float64, lambda message, values=values: values.append(message.data))

    def wait_for(self, count):
        deadline = rospy.Time.now() + rospy.Duration(LIMIT)
        while min(map(len, self.told.values())) < count:
            self.assertLess(rospy.Time.now(), deadline, f"cut_and_fill has told only {self.told}")
            rospy.sleep(0.05)

    def test_level_and_volumes(self):
        self.wait_for(1)
        before = height_field()
        kept_up = KeptUp()
        self.wait_for(2)
        after = height_field()
        kept_up.require(self)
        x = before.origin_x + before.spacing * (numpy.arange(before.columns) + 0.5)
        y = (before.origin_y + before.spacing * (numpy.arange(before.rows) + 0.5))[:, None]
        worked = (x > BEGIN) & (x < END) & (numpy.abs(y - LANE) < WITHIN)
        off = numpy.abs(ground(before)[worked]).max(), numpy.abs(ground(after)[worked]).max()
        rospy.loginfo("the lane was off the plan by %.3f m and is by %.3f m", *off)
        self.assertGreater(off[0], 2 * after.spacing)
        self.assertLess(off[1], after.spacing)
        self.check_volumes(before, after)

    def check_volumes(self, before, after):
        status = rospy.wait_for_message("/sand_node/status", Status, timeout=10.0)
        self.assertLess(status.volume_error, 1e-6)
        surface = [ground(field) + (by_rows(field, field.load) if field.load else 0.0) for field in (before, after)]
        for name, sign in (("cut", 1), ("fill", -1)):
            for told, elevation in zip(self.told[name], surface):
                self.assertAlmostEqual(told, numpy.maximum(sign * elevation, 0.0).sum() * before.spacing**2, delta=1e-3)
        cut, filled = (values[0] - values[1] for values in self.told.values())
        rospy.loginfo("%.4f m3 were cut, %.4f m3 filled", cut, filled)
        self.assertGreater(filled, 0.0)
        self.assertAlmostEqual(cut, filled, delta=1e-6 * status.volume)


if __name__ == "__main__":
    rospy.init_node("test_bulldozer")
    rostest.rosrun("shallow_sand", "bulldozer", Bulldozer)
