#include "shallow_sand/ros/parameter_table.h"

#include <algorithm>
#include <sstream>
#include <stdexcept>

#include "shallow_sand/ros/conversions.h"

namespace shallow_sand {
namespace {

struct Unit {
  const char* word;
  const char* symbol;
};
constexpr Unit kHertz{"hertz", "Hz"};
constexpr Unit kSeconds{"seconds", "s"};
constexpr Unit kMetresASecond{"metres a second", "m/s"};
constexpr Unit kMetres{"metres", "m"};
constexpr Unit kCubicMetresASecond{"cubic metres a second", "m³/s"};
constexpr Unit kCells{"cells", ""};

const char* const kPatterns = "a list of patterns of link names, such as ['wheel_*']";

/// 1e6 for a million, not 1e+06.
std::string text(double value) {
  std::ostringstream stream;
  stream << value;
  std::string digits = stream.str();
  const std::size_t exponent = digits.find("e+0");
  return exponent == std::string::npos ? digits : digits.replace(exponent, 3, "e");
}

ParameterRow number(const std::string& name, double NodeParameters::*target, const Unit& unit, double low,
                    double high, const std::string& meaning) {
  ParameterRow row;
  row.name = name;
  row.type = "number";
  row.bounds = text(low) + " to " + text(high);
  row.expected = std::string("a number of ") + unit.word + " from " + row.bounds;
  row.unit = unit.symbol;
  row.default_text = text(NodeParameters().*target);
  row.meaning = meaning;
  row.target = target;
  row.low = low;
  row.high = high;
  return row;
}

ParameterRow atRunTime(ParameterRow row) {
  row.at_run_time = true;
  return row;
}

ParameterRow choice(const std::string& name, bool NodeParameters::*target, const std::string& meaning) {
  return {name, "true or false", "true or false", "", NodeParameters().*target ? "true" : "false",
          "",   meaning,         target};
}

ParameterRow words(const std::string& name, std::string NodeParameters::*target, const std::string& expected,
                   const std::string& meaning) {
  return {name, "text", expected, "", NodeParameters().*target, "", meaning, target};
}

/// A parameter that a reader of its own takes.
ParameterRow special(const std::string& name, const std::string& type, const std::string& expected,
                     const std::string& default_text, const std::string& meaning) {
  return {name, type, expected, "", default_text, "", meaning, {}};
}

std::vector<ParameterRow> makeTable() {
  using N = NodeParameters;
  const RobotParameters robot;
  return {
      special("robot_description", "text", "the name of a parameter", robot.description,
              "name of the parameter that holds the URDF; empty: no robot"),
      special("tf_prefix", "text", "a text", robot.tf_prefix,
              "put before link names to get their tf frames, such as robot_1/"),
      special("include", "list", kPatterns, "[]",
              "only links that match one of these shell patterns dig; empty: all"),
      special("exclude", "list", kPatterns, "[]", "links that match one of these do not dig"),
      special("shapes", "map", "a map from patterns of link names to exact, convex_hull or bounding_box",
              "{}", "what stands for links; the longest pattern that matches decides"),
      special("robots", "list", "a list of maps", "[]",
              "several robots instead of one; then robot_description is not read, and tf_prefix, include, "
              "exclude and shapes must be empty"),
      words("sand_frame", &N::sand_frame, "the name of a tf frame",
            "tf frame of the sand instead of grid.frame"),
      words("scene_folder", &N::scene_folder, "the path of a folder",
            "that paths of terrain files and meshes start from (sand.launch sets it); empty: they must be "
            "absolute"),
      words("report", &N::report, "the path of a file",
            "file for the figures of the run, written at the end"),
      words("picture", &N::picture, "the path of a file", "file for a shaded relief, written at the end"),
      words("mesh_file", &N::mesh_file, "the path of a file",
            "file for the surface, .stl or .ply, written at the end"),
      words("state_folder", &N::state_folder, "the path of a folder",
            "absolute; ~save and ~load stay within it; empty: ~/.ros/shallow_sand ($ROS_HOME is heeded)"),
      number("snapshot_period", &N::snapshot_period, kSeconds, 0.0, 1e9,
             "of simulated time after which the state is saved, again and again; 0: never"),
      words("snapshot_file", &N::snapshot_file, "the name of a file",
            "of those snapshots, within state_folder"),
      choice("restore", &N::restore, "go on from snapshot_file at the start, if it is there"),
      // The bounds keep periods within what ros::Duration can hold.
      atRunTime(number("frame_rate", &N::frame_rate, kHertz, 0.01, 1e4,
                       "how often poses are taken and the sand runs on")),
      choice("paused", &N::paused,
             "whether the sand rests at the start, until ~pause or ~step tell otherwise"),
      atRunTime(
          number("publish_rate", &N::publish_rate, kHertz, 0.01, 1e4,
                 "most messages a second, of the wall clock, on ~points, ~mesh, ~particles and ~bodies each; "
                 "mesh and particles are made anew only while somebody listens")),
      atRunTime(number("height_field_rate", &N::height_field_rate, kHertz, 0.01, 1e4,
                       "most rounds of ~height_field_updates a second, of the wall clock")),
      choice("publish_speed", &N::publish_speed, "the speed of the sand in ~height_field and its updates"),
      number("mesh_cells", &N::mesh_cells, kCells, 100.0, kMostMarkerCells,
             "most cells that ~mesh shows; a larger map is shown by blocks of cells"),
      words("replay_calls", &N::replay_calls, "the name of a topic",
            "topic on which a bag plays what a node has published on ~calls, to be done again at the same "
            "frames; empty: none"),
      // tf keeps ten seconds.
      number("tf_delay", &N::tf_delay, kSeconds, 0.0, 5.0,
             "by how much the sand runs behind ROS time, so that tf has come"),
      number("tf_timeout", &N::tf_timeout, kSeconds, 0.001, 1e6,
             "a link whose newest pose is older is reported as stale"),
      atRunTime(number("max_body_speed", &N::max_body_speed, kMetresASecond, 1e-3, 1e6,
                       "of the farthest point of a body; a pose that moves faster has jumped")),
      atRunTime(number("pour_rate", &N::pour_rate, kCubicMetresASecond, -1e6, 1e6,
                       "of sand that is poured on a disc as long as the sand runs; below 0: taken away")),
      atRunTime(number("pour_x", &N::pour_x, kMetres, -1e8, 1e8, "middle of that disc in the sand's frame")),
      atRunTime(number("pour_y", &N::pour_y, kMetres, -1e8, 1e8, "middle of that disc in the sand's frame")),
      atRunTime(number("pour_radius", &N::pour_radius, kMetres, 1e-3, 1e6,
                       "of that disc, at most the grid's longer side")),
  };
}

}  // namespace

void ParameterRow::require(double value) const {
  if (value >= low && value <= high) return;
  throw InvalidParameter(name, std::to_string(value), expected);
}

const std::vector<ParameterRow>& parameterTable() {
  static const std::vector<ParameterRow> table = makeTable();
  return table;
}

const ParameterRow& parameterRow(const std::string& name) {
  const std::vector<ParameterRow>& table = parameterTable();
  const auto row =
      std::find_if(table.begin(), table.end(), [&](const ParameterRow& other) { return other.name == name; });
  if (row == table.end()) throw std::out_of_range("there is no parameter " + name);
  return *row;
}

std::string parameterMarkdown() {
  std::ostringstream table;
  table << "| parameter | type | default | bounds | meaning |\n|---|---|---|---|---|\n";
  for (const ParameterRow& row : parameterTable()) {
    const std::string unit = row.unit.empty() ? "" : " " + row.unit;
    table << "| `~" << row.name << "`" << (row.at_run_time ? " *" : "") << " | " << row.type << " | "
          << row.default_text << (row.default_text.empty() ? "" : unit) << " | " << row.bounds << " | "
          << row.meaning << " |\n";
  }
  table << "\nThose with a * change while the node runs, through dynamic_reconfigure.\n";
  return table.str();
}

}  // namespace shallow_sand
