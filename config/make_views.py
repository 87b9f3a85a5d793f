#!/usr/bin/env python3
"""Writes the .rviz files of this folder: what they show is the same but for the camera and a few settings in VIEWS."""

from pathlib import Path

import yaml

# File: where the camera looks (x, y, z), from how far, from how far above and from which direction, and what else differs.
VIEWS = {
    "sand": {"focus": (2.0, 1.0, 0.0), "distance": 6.0, "pitch": 0.6, "yaw": 0.85, "robot": "visual", "panels": True},
    "excavator/excavation": {"focus": (1.6, 0.35, 0.4), "distance": 6.7, "pitch": 0.6, "yaw": 0.85, "robot": "visual"},
    "sand_table/sand_table": {"focus": (2.5, 1.2, 0.0), "distance": 5.2, "pitch": 0.75, "yaw": -1.35, "robot": "visual"},
    "rover/rover": {"focus": (11.5, 9.0, -0.3), "distance": 15.0, "pitch": 0.45, "yaw": -2.3, "robot": "visual",
                    "sand_color": "158; 155; 150", "background": "8; 8; 10"},
    "bulldozer/bulldozer": {"focus": (10.4, 5.0, 0.0), "distance": 20.0, "pitch": 0.6, "yaw": -1.1, "robot": "visual"},
    # The bucket's visual mesh is turned against the collision mesh, which is what the sand meets.
    "robots/zx120": {"focus": (2.8, 1.2, 0.8), "distance": 14.0, "pitch": 0.55, "yaw": 0.85, "robot": "collision"},
    "robots/leo": {"focus": (1.2, 0.25, 0.0), "distance": 2.6, "pitch": 0.6, "yaw": -2.2, "robot": "visual"},
    "robots/anymal": {"focus": (0.2, 0.0, 0.15), "distance": 2.6, "pitch": 0.4, "yaw": 0.9, "robot": "visual"},
    "scenes/avalanche": {"focus": (1280.0, 1280.0, 300.0), "distance": 3600.0, "pitch": 0.95, "yaw": 1.57},
    "scenes/blade": {"focus": (1.7, 1.0, 0.1), "distance": 3.6, "pitch": 0.6, "yaw": 0.55},
    "scenes/bucket": {"focus": (0.85, 0.8, 0.15), "distance": 1.7, "pitch": 1.0, "yaw": -2.3},
    "scenes/buried_plate": {"focus": (1.0, 0.6, 0.25), "distance": 2.0, "pitch": 0.6, "yaw": 0.55, "contours": 0.01},
    "scenes/butterfly": {"focus": (1.28, 1.28, 0.2), "distance": 3.6, "pitch": 0.95, "yaw": -1.57},
    "scenes/cone_at_rest": {"focus": (2.0, 2.0, 0.25), "distance": 4.2, "pitch": 0.5, "yaw": 0.8},
    "scenes/fan": {"focus": (1.28, 1.28, 0.1), "distance": 3.3, "pitch": 0.75, "yaw": 0.4},
    "scenes/grains_coarse": {"focus": (1.28, 0.64, 0.2), "distance": 2.7, "pitch": 0.9, "yaw": -1.57, "grains": True},
    "scenes/grains_fine": {"focus": (1.28, 0.64, 0.2), "distance": 2.7, "pitch": 0.9, "yaw": -1.57, "grains": True},
    "scenes/grains_medium": {"focus": (1.28, 0.64, 0.2), "distance": 2.7, "pitch": 0.9, "yaw": -1.57, "grains": True},
    "scenes/layers": {"focus": (2.56, 2.56, 0.3), "distance": 9.0, "pitch": 1.0, "yaw": 0.0},
    # Grains lie in the sand, below its surface.
    "scenes/mixing": {"focus": (1.28, 1.28, 0.1), "distance": 3.3, "pitch": 0.9, "yaw": 0.4, "grains": True},
    "scenes/pile": {"focus": (0.0, 0.0, 0.12), "distance": 2.6, "pitch": 0.5, "yaw": 0.9},
    "scenes/piles": {"focus": (1.28, 1.28, 0.1), "distance": 3.9, "pitch": 0.6, "yaw": -1.2},
    "scenes/pressed_block": {"focus": (0.8, 0.8, 0.3), "distance": 2.8, "pitch": 0.7, "yaw": 0.6},
    "scenes/pressed_block_flat": {"focus": (0.8, 0.8, 0.3), "distance": 2.8, "pitch": 0.7, "yaw": 0.6},
    "scenes/tall_column": {"focus": (0.64, 0.64, 0.1), "distance": 2.0, "pitch": 0.5, "yaw": 0.6},
    "scenes/terrain": {"focus": (3.8, 3.0, 0.2), "distance": 8.0, "pitch": 0.8, "yaw": -1.15},
    "scenes/three_shapes": {"focus": (2.2, 2.56, 0.0), "distance": 5.6, "pitch": 0.8, "yaw": 0.3},
    # From above, so that one can write.
    "scenes/writing": {"focus": (2.56, 1.28, 0.15), "distance": 5.0, "pitch": 1.4, "yaw": -1.5708, "paint": True},
}


def robot(view):
    return {"Class": "rviz/RobotModel", "Name": "Robot", "Enabled": True, "Value": True, "Robot Description": "robot_description",
            "Visual Enabled": view["robot"] == "visual", "Collision Enabled": view["robot"] == "collision", "Alpha": 1,
            "TF Prefix": "", "Update Interval": 0}


def displays(view):
    shown = [robot(view)] if "robot" in view else []
    shown.append({"Class": "shallow_sand/HeightField", "Name": "Sand", "Enabled": True, "Value": True,
                  "Topic": "/sand_node/height_field", "Show Sand": not view.get("grains", False),
                  "Color By": view.get("color_by", "Sand"), **({"Sand Color": view["sand_color"]} if "sand_color" in view else {}),
                  "Contour Interval": view.get("contours", 0)})
    shown.append({"Class": "rviz/MarkerArray", "Name": "Bodies", "Enabled": True, "Value": True, "Marker Topic": "/sand_node/bodies",
                  "Queue Size": 10, "Namespaces": {}})
    shown.append({"Class": "rviz/InteractiveMarkers", "Name": "Handles", "Enabled": True, "Value": True,
                  "Update Topic": "/sand_node/body_handles/update", "Show Axes": False, "Show Descriptions": False,
                  "Show Visual Aids": False, "Enable Transparency": True})
    grains = view.get("grains", False)
    shown.append({"Class": "rviz/PointCloud2", "Name": "Grains", "Enabled": grains, "Value": grains, "Topic": "/sand_node/particles",
                  "Queue Size": 2, "Style": "Points", "Size (Pixels)": 4, "Alpha": 1, "Color Transformer": "RGB8",
                  "Position Transformer": "XYZ", "Use Fixed Frame": True, "Selectable": False})
    shown.append({"Class": "rviz/TF", "Name": "Frames", "Enabled": False, "Value": False, "Marker Scale": 0.5, "Show Names": True,
                  "Show Axes": True, "Show Arrows": False})
    return shown


def tools(view):
    paint = [{"Class": "shallow_sand/PaintSand", "Radius": 0.05, "Depth": 0.02, "Speed": 2}] if view.get("paint", False) else []
    return [{"Class": "rviz/MoveCamera"}, {"Class": "rviz/Interact", "Hide Inactive Objects": True}, {"Class": "rviz/FocusCamera"},
            {"Class": "rviz/Measure"}, {"Class": "shallow_sand/PourSand", "Radius": 0.1, "Rate": 0.02},
            {"Class": "shallow_sand/PlaceBlade", "Width": 0.6, "Height": 0.3, "Thickness": 0.04, "Depth": 0.08}, *paint]


def camera(view):
    x, y, z = view["focus"]
    return {"Class": "rviz/Orbit", "Name": "Current View", "Target Frame": "<Fixed Frame>", "Value": "Orbit (rviz)",
            "Distance": view["distance"], "Focal Point": {"X": x, "Y": y, "Z": z}, "Focal Shape Fixed Size": True,
            "Focal Shape Size": 0.05, "Invert Z Axis": False, "Near Clip Distance": 0.01, "Pitch": view["pitch"], "Yaw": view["yaw"],
            "Field of View": 0.785}


def config(view):
    collapsed = not view.get("panels", False)
    return {
        "Panels": [{"Class": "rviz/Displays", "Name": "Displays"}, {"Class": "rviz/Views", "Name": "Views"},
                   {"Class": "rviz/Tool Properties", "Name": "Tool Properties"}],
        "Visualization Manager": {
            "Class": "", "Displays": displays(view), "Tools": tools(view), "Value": True, "Views": {"Current": camera(view), "Saved": None},
            "Global Options": {"Background Color": view.get("background", "188; 204; 216"), "Default Light": True, "Fixed Frame": "sand",
                               "Frame Rate": 30}},
        "Window Geometry": {
            "Displays": {"collapsed": collapsed}, "Views": {"collapsed": collapsed}, "Tool Properties": {"collapsed": collapsed},
            "Hide Left Dock": collapsed, "Hide Right Dock": True, "Width": 1280, "Height": 800, "X": 0, "Y": 0},
    }


def main():
    folder = Path(__file__).resolve().parent
    for name, view in VIEWS.items():
        (folder / f"{name}.rviz").write_text(yaml.safe_dump(config(view), sort_keys=False), encoding="utf-8")


if __name__ == "__main__":
    main()
