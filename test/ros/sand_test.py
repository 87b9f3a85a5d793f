"""What the rostests of sand_node share: the node as a child process, and a world of clock and tf that does what it is told."""
import subprocess
import tempfile
import threading
import time

import numpy
import rospy
from geometry_msgs.msg import TransformStamped
from roslib.packages import find_node
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import PointCloud2
from shallow_sand.msg import Status
from tf2_msgs.msg import TFMessage

SCENE = {
    "grid": {"size": [1.0, 1.0], "spacing": 0.05, "frame": "sand"},
    "sand": [{"depth": 0.1}],
    "backend": "cpu",
    "threads": 1,
    "tf_timeout": 0.5,
}


def link(name, geometry='<box size="0.2 0.2 0.2"/>'):
    return f'<link name="{name}"><collision><geometry>{geometry}</geometry></collision></link>'


def robot(name, *links):
    """A URDF. Its links hang on a root without geometry, for urdfdom wants a tree."""
    joints = "".join(f'<joint name="to_{k}" type="fixed"><parent link="{name}_root"/><child link="{child}"/></joint>'
                     for k, child in enumerate(part.split('"')[1] for part in links))
    return f'<robot name="{name}"><link name="{name}_root"/>{"".join(links)}{joints}</robot>'


class RunningNode:
    """sand_node as a child process; what it writes to its standard error is kept in a file. Waits are of wall time."""

    def __init__(self, name, parameters):
        self.name = "/" + name
        if rospy.has_param(self.name):
            rospy.delete_param(self.name)
        rospy.set_param(self.name, parameters)
        self.errors = tempfile.NamedTemporaryFile("w+", suffix=".log")
        self.process = subprocess.Popen(
            [find_node("shallow_sand", "sand_node")[0], "__name:=" + name],
            stdout=subprocess.DEVNULL,
            stderr=self.errors,
        )

    def __enter__(self):
        return self

    def __exit__(self, problem=None, *_):
        if self.process.poll() is None:
            self.process.terminate()
        elif problem:
            print("%s ended with %d:" % (self.name, self.process.returncode), *self.error_lines()[-60:], sep="\n")
        self.process.wait(timeout=20)
        self.errors.close()

    def error_lines(self, *words):
        """Lines that hold all words."""
        with open(self.errors.name) as log:
            lines = [line for line in log.read().splitlines() if line.strip()]
        return [line for line in lines if all(word in line for word in words)]

    def wait_for_error(self, *words, limit=20.0):
        deadline = time.monotonic() + limit
        while time.monotonic() < deadline:
            lines = self.error_lines(*words)
            if lines:
                return lines
            rospy.rostime.wallsleep(0.05)
        raise AssertionError("no line with %s within %g s, only %s" % (words, limit, self.error_lines()))

    def status(self, condition=lambda status: True, limit=20.0):
        deadline = time.monotonic() + limit
        status = None
        while time.monotonic() < deadline:
            status = rospy.wait_for_message(self.name + "/status", Status, timeout=limit)
            if condition(status):
                return status
        raise AssertionError("no such status within %g s; the last was %s" % (limit, status))

    def body(self, name, condition=lambda body: True, limit=20.0):
        """The status of a body once it is there and as wanted."""
        found = []

        def check(status):
            found[:] = [body for body in status.bodies if body.name == name]
            return bool(found) and condition(found[0])

        self.status(check, limit)
        return found[0]

    def assert_well(self, test):
        """It lives on, and no sand was lost."""
        before = self.status().simulated_time
        after = self.status(lambda status: status.simulated_time > before)
        test.assertLess(after.volume_error, 1e-6)
        test.assertGreater(after.volume, 0.0)


def wait_until(condition, what, limit=20.0):
    deadline = time.monotonic() + limit
    while time.monotonic() < deadline:
        if condition():
            return
        rospy.rostime.wallsleep(0.002)
    raise AssertionError(f"not within {limit} s: {what}")


def service(node, name, kind):
    rospy.wait_for_service(f"{node.name}/{name}", timeout=20.0)
    return rospy.ServiceProxy(f"{node.name}/{name}", kind)


def wait_for_depth(node, x, y, condition, limit=20.0):
    """Until the depth of the sand in the cell at a place is as wanted."""
    deadline = time.monotonic() + limit
    while time.monotonic() < deadline:
        cloud = rospy.wait_for_message(node.name + "/points", PointCloud2, timeout=10.0)
        values = numpy.frombuffer(cloud.data, dtype=numpy.float32).reshape(cloud.height, cloud.width, -1)
        spacing = SCENE["grid"]["spacing"]
        depth = values[int(y / spacing), int(x / spacing), 3]
        if condition(depth):
            return
    raise AssertionError(f"the depth at ({x}, {y}) is not as wanted within {limit} s but {depth}")


class Place:
    """A transform as it is published."""

    def __init__(self, x=0.0, y=0.0, z=0.0, rotation=(0.0, 0.0, 0.0, 1.0), parent="sand"):
        self.position, self.rotation, self.parent = (x, y, z), rotation, parent


class World:
    """Publishes /clock, which runs at twice the speed of the wall's, and the transforms that `frames` gives: a map from frames to
    functions of time [s], which return a Place or, to keep silent, None. A test may change all of it while it runs."""

    WALL_STEP, STEP = 0.01, 0.02  # s

    def __init__(self, frames, start=100.0):
        self.frames = dict(frames)
        self.latency = 0.0  # s that transforms lie behind the clock
        self.now = start
        self.lock = threading.Lock()
        self.stopped = threading.Event()
        self.clock = rospy.Publisher("/clock", Clock, queue_size=10)
        self.tf = rospy.Publisher("/tf", TFMessage, queue_size=10)
        self.thread = threading.Thread(target=self.run)

    def __enter__(self):
        self.thread.start()
        return self

    def __exit__(self, *_):
        self.stopped.set()
        self.thread.join()
        self.clock.unregister()
        self.tf.unregister()

    def set_time(self, now):
        with self.lock:
            self.now = now

    def run(self):
        while not self.stopped.wait(self.WALL_STEP):
            with self.lock:
                self.now += self.STEP
                now = self.now
            stamp = now - self.latency
            places = {frame: place(stamp) for frame, place in list(self.frames.items())}
            # The clock last: whoever knows the time has been sent the transforms up to it.
            self.tf.publish(TFMessage([transform(f, p, stamp) for f, p in places.items() if p is not None]))
            self.clock.publish(Clock(rospy.Time.from_sec(now)))


def transform(frame, place, stamp):
    message = TransformStamped()
    message.header.stamp = rospy.Time.from_sec(stamp)
    message.header.frame_id = place.parent
    message.child_frame_id = frame
    t, q = message.transform.translation, message.transform.rotation
    t.x, t.y, t.z = place.position
    q.x, q.y, q.z, q.w = place.rotation
    return message
