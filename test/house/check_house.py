#!/usr/bin/env python3
"""Checks the rules of the house: which room may include what.

check_house.py ROOT        checks include/ and src/ of the repository at ROOT; exit 1 and one line for each violation
check_house.py --self-check  plants each kind of violation in an empty house and expects that it is found
"""

import re
import sys
import tempfile
from pathlib import Path

# A room includes itself and rooms of a lower level. Rooms of one level do not see each other, but for NEIGHBOURS.
LEVELS = {"core": 0, "device": 1, "solver": 2, "bodies": 3, "coupling": 4, "surface": 5, "particles": 5, "sim": 6,
          "scene": 7, "ros": 7, "client": None, "rviz": None}  # these two know messages only
NEIGHBOURS = {("ros", "scene"), ("rviz", "client")}  # the node reads the keys of a scene file, the display follows the node

ROS = re.compile(r"(ros|rosbag|roscpp|rosgraph_msgs|std_srvs|tf|tf2\w*|urdf|\w+_msgs|rviz|nodelet|pluginlib|class_loader|actionlib|"
                 r"diagnostic_updater|dynamic_reconfigure|interactive_markers|message_filters|image_transport|eigen_conversions|xmlrpcpp)/"
                 r"|XmlRpc\w*\.h$|OGRE/|Ogre\w*\.h$|shallow_sand/[A-Z]\w*\.h$")  # the last: our own messages
ROS_ROOMS = {"ros", "client", "rviz"}

# Libraries that only some rooms know, and there perhaps only in .cpp files.
LIBRARIES = [
    (re.compile(r"(fcl|geometric_shapes|resource_retriever|urdf_model|urdf_parser|urdf_world)/|tinyxml2\.h$"), {"bodies"}, {".cpp"}),
    (re.compile(r"(gdal|ogr_|cpl_)\w*\.h$|nlohmann/|boost/program_options"), {"scene"}, None),
    (re.compile(r"yaml-cpp/"), {"scene", "ros"}, None),
]

CUDA = re.compile(r"(cuda\w*|curand\w*|device_launch_parameters|cooperative_groups|math_constants)(\.h|/)|cub/|thrust/|.*\.cuh$")
CUDA_WORD = re.compile(r"\b(__CUDACC__|__CUDA_ARCH__|__host__|__device__|__global__|__shared__)\b")

INCLUDE = re.compile(r'^[ \t]*#[ \t]*include[ \t]*([<"])([^>"]+)[>"]', re.MULTILINE)
COMMENT = re.compile(r"//[^\n]*|/\*.*?\*/", re.DOTALL)
SUFFIXES = {".h", ".hpp", ".cpp", ".cu", ".cuh"}


def without_comments(text):
    return COMMENT.sub(lambda comment: "\n" * comment.group().count("\n"), text)


def may_include(room, other):
    if room == other or (room, other) in NEIGHBOURS:
        return True
    return LEVELS[room] is not None and LEVELS[other] is not None and LEVELS[other] < LEVELS[room]


def include_problem(room, file, quote, target):
    """What is wrong with one include of a file in `room`; None if nothing is."""
    own = re.match(r"shallow_sand/([a-z]\w*)/", target)
    if own:
        if own.group(1) not in LEVELS:
            return f"there is no room {own.group(1)}"
        if not may_include(room, own.group(1)):
            return f"room {room} must not know room {own.group(1)}"
    elif quote == '"' and ".." in Path(target).parts:
        return "an include that leaves the room by .."
    if ROS.match(target) and room not in ROS_ROOMS:
        return "ROS headers are for ros/, client/ and rviz/"
    for pattern, rooms, suffixes in LIBRARIES:
        if pattern.match(target) and (room not in rooms or (suffixes and file.suffix not in suffixes)):
            where = ", ".join(f"{name}/" for name in sorted(rooms))
            return f"this library is for {where}" + (f" in {', '.join(sorted(suffixes))} files" if suffixes else "")
    if CUDA.match(target) and not knows_cuda(room, file):
        return "CUDA headers are for device/, core/types.h and .cu files"
    return None


def knows_cuda(room, file):
    return room == "device" or file.suffix in (".cu", ".cuh") or (room == "core" and file.name == "types.h")


def problems(root):
    found = []
    files = 0
    for base in (root / "include" / "shallow_sand", root / "src"):
        for file in sorted(base.rglob("*")):
            if file.suffix not in SUFFIXES:
                continue
            files += 1
            name = file.relative_to(root)
            room = file.relative_to(base).parts[0]
            if room not in LEVELS:
                found.append(f"{name}: stands in no room; expected one of {', '.join(LEVELS)}")
                continue
            text = without_comments(file.read_text(encoding="utf-8"))
            for include in INCLUDE.finditer(text):
                problem = include_problem(room, file, *include.groups())
                if problem:
                    line = text.count("\n", 0, include.start()) + 1
                    found.append(f"{name}:{line}: {include.group(2)}: {problem}")
            for word in CUDA_WORD.finditer(text):
                if not knows_cuda(room, file):
                    line = text.count("\n", 0, word.start()) + 1
                    found.append(f"{name}:{line}: {word.group()}: CUDA is for device/, core/types.h and .cu files")
    return files, found


INNOCENT = [
    ("src/ros/node.cpp", '#include <ros/ros.h>\n#include "shallow_sand/scene/scene.h"\n#include "shallow_sand/Status.h"\n'),
    ("src/bodies/shape.cpp", "#include <geometric_shapes/shapes.h>\n#include <urdf_model/model.h>\n"),
    ("include/shallow_sand/core/types.h", "#ifdef __CUDACC__\n#endif\n"),
    ("src/sim/engine.cu", "#include <cuda_runtime.h>\n__global__ void kernel();\n"),
    ("src/sim/engine.cpp", '#include "shallow_sand/coupling/rays.h"\n#include "neighbour.h"\n'),
    ("include/shallow_sand/rviz/visual.h", "#include <rviz/display.h>\n"),
    ("src/rviz/display.cpp", '#include "shallow_sand/client/height_field_map.h"\n'),
    ("include/shallow_sand/solver/step.h", '// #include <ros/ros.h>\n/* __device__\n#include "shallow_sand/sim/x.h" */\n'),
]
GUILTY = [
    ("include/shallow_sand/core/grid.h", '#include "shallow_sand/solver/step.h"\n'),
    ("src/surface/mesh.cpp", '#include "shallow_sand/particles/grains.h"\n'),
    ("src/surface/mesh.cpp", '#include "shallow_sand/sim/simulator.h"\n'),
    ("src/scene/scene.cpp", '#include "shallow_sand/ros/node.h"\n'),
    ("src/sim/sim.cpp", '#include "shallow_sand/cellar/wine.h"\n'),
    ("src/sim/sim.cpp", '#include "../scene/scene_value.h"\n'),
    ("src/attic/box.cpp", "int box;\n"),
    ("src/loose.cpp", "int loose;\n"),
    ("src/sim/sim.cpp", "  #  include <ros/time.h>\n"),
    ("src/scene/scene.cpp", "#include <tf2_ros/buffer.h>\n"),
    ("src/surface/mesh.cpp", "#include <visualization_msgs/Marker.h>\n"),
    ("src/scene/scene.cpp", '#include "shallow_sand/Status.h"\n'),
    ("src/bodies/links.cpp", "#include <urdf/model.h>\n"),
    ("src/rviz/visual.cpp", '#include "shallow_sand/core/grid.h"\n'),
    ("src/client/map.cpp", '#include "shallow_sand/core/fields.h"\n'),
    ("include/shallow_sand/bodies/shape.h", "#include <geometric_shapes/shapes.h>\n"),
    ("src/coupling/rays.cpp", "#include <fcl/geometry/bvh/BVH_model.h>\n"),
    ("src/sim/sim.cpp", "#include <gdal_priv.h>\n"),
    ("src/solver/step.cpp", "#include <cuda_runtime.h>\n"),
    ("src/sim/sim.cpp", '#include "shallow_sand/device/cuda_executor.cuh"\n'),
    ("include/shallow_sand/solver/step.h", "/* why */ __device__ void step();\n"),
    ("include/shallow_sand/core/grid.h", "#ifdef __CUDACC__\n#endif\n"),
]


def problems_of(contents):
    with tempfile.TemporaryDirectory() as folder:
        for name, text in contents:
            file = Path(folder, name)
            file.parent.mkdir(parents=True, exist_ok=True)
            file.write_text(text, encoding="utf-8")
        return problems(Path(folder))[1]


def self_check():
    failures = [f"innocent, but reported: {problem}" for problem in problems_of(INNOCENT)]
    failures += [f"planted, but not found: {name}: {text!r}" for name, text in GUILTY if len(problems_of([(name, text)])) != 1]
    print("\n".join(failures) or f"{len(GUILTY)} planted violations found, {len(INNOCENT)} innocent files left alone")
    return 1 if failures else 0


def main():
    if len(sys.argv) != 2:
        print(__doc__, file=sys.stderr)
        return 2
    if sys.argv[1] == "--self-check":
        return self_check()
    files, found = problems(Path(sys.argv[1]).resolve())
    if files == 0:
        print(f"{sys.argv[1]}: no sources found; expected the root of the repository", file=sys.stderr)
        return 2
    print("\n".join(found) or f"{files} files keep the rules of the house")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
