#!/usr/bin/python3
"""The demo digs: a trench where tf says the bucket's edge went, and beside it a heap of what the bucket carried there."""
import unittest

import numpy
import rospy
import rostest
import tf2_ros
from sensor_msgs.msg import PointCloud2
from shallow_sand.msg import BodyStatus, Status
from std_msgs.msg import Bool, String

GRID = "/sand_node/grid"
BED = "/sand_node/bed"
CYCLE_LIMIT = 120.0  # s; the cycle takes 55
TIPPED = numpy.array([0.7, 2.2])  # m; where the bucket is tipped out


def edge_path(buffer, phases, limit):
    """Positions of the bucket's edge in the sand's frame while `phases` are played, until the player has finished."""
    state = {"phase": "", "finished": False}
    rospy.Subscriber("/joint_player/phase", String, lambda m: state.update(phase=m.data))
    rospy.Subscriber("/joint_player/finished", Bool, lambda m: state.update(finished=m.data))
    path = []
    deadline = rospy.Time.now() + rospy.Duration(limit)
    rate = rospy.Rate(50)
    while not state["finished"]:
        if rospy.Time.now() > deadline:
            raise AssertionError("the dig cycle did not finish within %g s; last phase: %r" % (limit, state["phase"]))
        if state["phase"] in phases:
            try:
                t = buffer.lookup_transform("sand", "bucket_edge", rospy.Time(0)).transform.translation
                path.append((t.x, t.y, t.z))
            except tf2_ros.TransformException:
                pass
        rate.sleep()
    return numpy.array(path)


def wait_for_rest(limit):
    """The first status in which the sand has come to rest."""
    deadline = rospy.Time.now() + rospy.Duration(limit)
    while rospy.Time.now() < deadline:
        status = rospy.wait_for_message("/sand_node/status", Status, timeout=5.0)
        if status.max_speed < 1e-3:
            return status
    raise AssertionError("the sand did not come to rest within %g s" % limit)


def surface():
    """Columns x, y, z of the cloud and the depth of all sand, as rows × columns × 4."""
    cloud = rospy.wait_for_message("/sand_node/points", PointCloud2, timeout=10.0)
    values = numpy.frombuffer(cloud.data, dtype=numpy.float32)
    return values.reshape(cloud.height, cloud.width, cloud.point_step // 4)[:, :, :4].astype(float)


class Excavation(unittest.TestCase):
    def test_trench_heap_and_ledger(self):
        buffer = tf2_ros.Buffer()
        listener = tf2_ros.TransformListener(buffer)
        path = edge_path(buffer, ("dig_1", "dig_2", "dig_3"), CYCLE_LIMIT)
        listener.unregister()
        self.assertGreater(len(path), 100, "tf told of the bucket's edge too rarely")
        status = wait_for_rest(10.0)
        points = surface()
        spacing = rospy.get_param(GRID)["spacing"]
        self.check_trench(path, points, spacing)
        self.check_heap(points, spacing)
        self.assertLess(status.volume_error, 1e-6)
        self.assertGreater(status.volume_start, 0.0)
        self.assertTrue(all(b.state == BodyStatus.MOVING for b in status.bodies), status.bodies)
        self.assertIn("bucket", [b.name for b in status.bodies])

    def check_trench(self, path, points, spacing):
        # Sand slides back from the ends of the cut, and the bucket leaves a sill where it curls.
        deepest = path[:, 2].min()
        middle = points[numpy.argmin(numpy.abs(points[:, 0, 1]))]
        within = (middle[:, 0] > path[:, 0].min()) & (middle[:, 0] < path[:, 0].max())
        # From the depth of the sand: where the bucket stands, the cloud shows what is left in it.
        ground = middle[:, 3] + rospy.get_param(BED)["elevation"]
        length = numpy.count_nonzero(within & (ground < 0.25 * deepest)) * spacing
        rospy.loginfo("trench: %.2f m deep over %.2f m; the edge went to %.2f m", -ground[within].min(), length, deepest)
        self.assertLess(deepest, -0.25)
        self.assertLess(ground[within].min(), 0.6 * deepest)
        self.assertGreater(length, 0.5)

    def check_heap(self, points, spacing):
        # The original surface is z = 0: what stands above it is as much as what is missing below.
        z = points[:, :, 2]
        below = -z[z < 0].sum() * spacing**2
        distance = numpy.hypot(*(points[:, :, axis] - TIPPED[axis] for axis in (0, 1)))
        heap = z[(distance < 0.9) & (z > 0)].sum() * spacing**2
        top = numpy.unravel_index(numpy.where(distance < 0.9, z, -1.0).argmax(), z.shape)
        rospy.loginfo("%.3f m3 dug out, %.3f m3 of it in the heap, %.3f m high at %s", below, heap, z[top], points[top][:2])
        self.assertGreater(heap, 0.5 * below)
        self.assertGreater(z[top], 0.3)
        self.assertLess(distance[top], 0.3, "the heap is not where the bucket was tipped out")


if __name__ == "__main__":
    rospy.init_node("test_excavation")
    rostest.rosrun("shallow_sand", "excavation", Excavation)
