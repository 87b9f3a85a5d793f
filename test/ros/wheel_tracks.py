"""Where wheels have gone, from tf, and what that has done to the sand: for the rostests of vehicles."""
import numpy
import rospy
import tf2_ros
from shallow_sand.msg import HeightField, Status


def height_field(since=0.0, limit=10.0):
    """The map as soon as the sand has come to a time."""
    deadline = rospy.Time.now() + rospy.Duration(limit)
    while rospy.Time.now() < deadline:
        field = rospy.wait_for_message("/sand_node/height_field", HeightField, timeout=limit)
        if field.header.stamp.to_sec() >= since:
            return field
        rospy.sleep(0.1)
    raise AssertionError("the sand is not at %f within %g s" % (since, limit))


def by_rows(field, values):
    return numpy.array(values, float).reshape(field.rows, field.columns)


def ground(field):
    """Elevation of the sand on the ground, without what lies on bodies."""
    return by_rows(field, field.bed) + by_rows(field, field.depth)


def dilated(mask, cells):
    """All cells no farther than so many, along axes and diagonals."""
    for _ in range(cells):
        grown = mask.copy()
        grown[1:] |= mask[:-1]
        grown[:-1] |= mask[1:]
        mask = grown.copy()
        mask[:, 1:] |= grown[:, :-1]
        mask[:, :-1] |= grown[:, 1:]
    return mask


class KeptUp:
    """Whether the sand has left out no time since this was made: else bodies have leapt, and what they left does not tell of the sand."""

    def __init__(self):
        self.given_up = self.now()

    @staticmethod
    def now():
        return rospy.wait_for_message("/sand_node/status", Status, timeout=10.0).time_given_up

    def require(self, test):
        given_up = self.now() - self.given_up
        if given_up > 0.0:
            test.skipTest("the machine was held up: %g s of sand were left out" % given_up)


class WheelTracks:
    """Places of wheels' middles and the directions of their axles, seen from above."""

    def __init__(self, frames):
        self.frames = frames
        self.buffer = tf2_ros.Buffer()
        self.listener = tf2_ros.TransformListener(self.buffer)
        self.places = {frame: [] for frame in frames}  # rows: time, x, y, x and y of the axle

    def follow(self, way, limit):
        """Until each wheel has gone so far, seen from above [m]. @return the time [s]"""
        deadline = rospy.Time.now() + rospy.Duration(limit)
        rate = rospy.Rate(50)
        while min(self.way(frame) for frame in self.frames) < way:
            if rospy.Time.now() > deadline:
                raise AssertionError("wheels have gone %s m within %g s" % ({f: self.way(f) for f in self.frames}, limit))
            for frame in self.frames:
                self.look(frame)
            rate.sleep()
        return max(places[-1][0] for places in self.places.values())

    def sand_after(self, way, limit):
        """The map after each wheel has gone so far, to whose time tracks then reach."""
        field = height_field(self.follow(way, limit))
        for frame in self.frames:
            for time in numpy.arange(self.places[frame][-1][0], field.header.stamp.to_sec(), 0.02):
                self.look(frame, rospy.Time.from_sec(time))
        return field

    def look(self, frame, time=rospy.Time(0)):
        try:
            message = self.buffer.lookup_transform("sand", frame, time)
        except tf2_ros.TransformException:
            return
        q, t = message.transform.rotation, message.transform.translation
        axle = 2 * (q.x * q.y - q.w * q.z), 1 - 2 * (q.x**2 + q.z**2)
        self.places[frame].append((message.header.stamp.to_sec(), t.x, t.y, *(axle / numpy.hypot(*axle))))

    def way(self, frame):
        places = numpy.array(self.places[frame])
        return numpy.hypot(*numpy.diff(places[:, 1:3], axis=0).T).sum() if len(places) > 1 else 0.0

    def between_ends(self, frame, until, ends):
        """Rows of a track up to a time, without what is this near its ends, where the wheel stood or stands."""
        places = numpy.array(self.places[frame])
        places = places[places[:, 0] <= until]
        first, last = (numpy.hypot(*(places[:, 1:3] - places[k, 1:3]).T) for k in (0, -1))
        return places[(first > ends) & (last > ends)]

    def under(self, frame, field, width, ends):
        """Rows and columns of the cells under a wheel: one line for each place across it, one column for each time."""
        track = self.between_ends(frame, field.header.stamp.to_sec(), ends)
        aside = numpy.linspace(-width / 2, width / 2, 2 * round(width / field.spacing) + 1)[:, None]
        y, x = (track[:, 1 + axis] + aside * track[:, 3 + axis] for axis in (1, 0))
        return ((y - field.origin_y) / field.spacing).astype(int), ((x - field.origin_x) / field.spacing).astype(int)

    def cells(self, field, width, ends):
        """Of the map: those that tracks of this width cover, and those at the ends of tracks."""
        covered, at_ends = (numpy.zeros((field.rows, field.columns), bool) for _ in range(2))
        x = field.origin_x + field.spacing * (numpy.arange(field.columns) + 0.5)
        y = (field.origin_y + field.spacing * (numpy.arange(field.rows) + 0.5))[:, None]
        until = field.header.stamp.to_sec()
        for frame in self.frames:
            covered[self.under(frame, field, width, ends)] = True
            for _, end_x, end_y, *_ in (self.places[frame][0], [p for p in self.places[frame] if p[0] <= until][-1]):
                at_ends |= numpy.hypot(x - end_x, y - end_y) <= ends
        return covered & ~at_ends, at_ends
