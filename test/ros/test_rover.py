#!/usr/bin/python3
"""The rover's wheels leave tracks in the regolith about as deep as they sink in, over the crater's rim, and nothing moves far from them."""
import unittest

import numpy
import rospy
import rostest
from shallow_sand.msg import Status
from wheel_tracks import KeptUp, WheelTracks, dilated, ground, height_field

WHEELS = [f"wheel_{row}_{side}" for row in ("front", "middle", "rear") for side in ("left", "right")]
WIDTH, SINKAGE = 0.30, 0.06  # m, of wheels, as in config/rover/make_rover.py
ENDS = 0.45  # m; a wheel is longer than this where it touches the ground


class Rover(unittest.TestCase):
    def test_tracks(self):
        before = height_field()
        kept_up = KeptUp()
        tracks = WheelTracks(WHEELS)
        after = tracks.sand_after(4.5, 20.0)
        status = rospy.wait_for_message("/sand_node/status", Status, timeout=10.0)
        kept_up.require(self)
        drop = ground(before) - ground(after)
        covered, at_ends = tracks.cells(after, WIDTH, ENDS)
        away = ~dilated(covered | at_ends, 8)
        self.assertGreater(covered.sum(), 100)
        rospy.loginfo("tracks are %.3f m deep (median); away from them the ground moved by %.1g m", numpy.median(drop[covered]),
                      numpy.abs(drop[away]).max())
        for frame in WHEELS:
            depth = drop[tracks.under(frame, after, WIDTH, ENDS)].max(axis=0)
            self.assertAlmostEqual(numpy.median(depth), SINKAGE, delta=SINKAGE / 3, msg=frame)
        self.assertLess(numpy.abs(drop[away]).max(), 0.01)
        self.assertLess(status.volume_error, 1e-6)
        # Over the rim: the way goes up to its crest and down again.
        way = ground(before)[tracks.under("wheel_front_left", after, 0.0, 0.0)][0]
        self.assertGreater(way.max(), max(way[0], way[-1]) + 0.1)


if __name__ == "__main__":
    rospy.init_node("test_rover")
    rostest.rosrun("shallow_sand", "rover", Rover)
