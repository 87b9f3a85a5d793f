#!/usr/bin/python3
"""Two cars on the sand table leave ruts as deep as their wheels sink in, about as wide as these, and the rest of the table alone."""
import unittest

import numpy
import rospy
import rostest
from shallow_sand.msg import Status
from wheel_tracks import KeptUp, WheelTracks, dilated, ground, height_field

WHEELS = [f"{car}_wheel_{name}" for car in ("red", "blue") for name in ("front_left", "front_right", "rear_left", "rear_right")]
WIDTH, SINKAGE = 0.05, 0.015  # m, of wheels, as in config/sand_table/make_cars.py
ENDS = 0.12  # m; a wheel is longer than this where it touches the sand


class SandTable(unittest.TestCase):
    def test_ruts(self):
        before = height_field()
        kept_up = KeptUp()
        tracks = WheelTracks(WHEELS)
        after = tracks.sand_after(0.8, 20.0)
        status = rospy.wait_for_message("/sand_node/status", Status, timeout=10.0)
        kept_up.require(self)
        drop = ground(before) - ground(after)
        covered, at_ends = tracks.cells(after, WIDTH, ENDS)
        self.assertGreater(covered.sum(), 500)

        # Walls of a rut slide down to the friction angle: what is left is a groove between two berms.
        lowered = (drop > 1e-3) & ~dilated(at_ends, 4)
        width = WIDTH * lowered.sum() / (covered & ~dilated(at_ends, 4)).sum()
        away = ~dilated(covered | at_ends, 12)
        rospy.loginfo("ruts are %.4f m deep, %.3f m wide; away from them the sand moved by %.1g m", drop[covered].max(), width,
                      numpy.abs(drop[away]).max())
        self.assertAlmostEqual(width, WIDTH, delta=2 * after.spacing)
        self.assertFalse((lowered & ~dilated(covered, 2)).any(), "a rut is wider than its wheel")
        for frame in WHEELS:
            depth = drop[tracks.under(frame, after, WIDTH, ENDS)].max(axis=0)
            self.assertAlmostEqual(numpy.median(depth), SINKAGE, delta=SINKAGE / 3, msg=frame)
        self.assertLess(numpy.abs(drop[away]).max(), 1e-3)
        self.assertLess(status.volume_error, 1e-6)


if __name__ == "__main__":
    rospy.init_node("test_sand_table")
    rostest.rosrun("shallow_sand", "sand_table", SandTable)
