#pragma once

#include <string>
#include <variant>
#include <vector>

#include "shallow_sand/ros/node_parameters.h"

namespace shallow_sand {

/// Where dynamic_reconfigure keeps its own parameters, below the node's private ones.
constexpr const char* kReconfigureNamespace = "reconfigure";

/// A private parameter of sand_node that is no key of a scene file.
struct ParameterRow {
  /// Where its value goes, and its default comes from; none where a reader of its own takes it.
  using Target = std::variant<std::monostate, double NodeParameters::*, bool NodeParameters::*,
                              std::string NodeParameters::*>;
  std::string name;
  std::string type;      ///< number, true or false, text, list, map
  std::string expected;  ///< what an error says was expected
  std::string unit;
  std::string default_text;
  std::string bounds;
  std::string meaning;  ///< one line
  Target target;
  double low = 0.0;  ///< bounds of a number, both allowed
  double high = 0.0;
  bool at_run_time = false;  ///< dynamic_reconfigure changes it, see cfg/Sand.cfg

  /// @throws InvalidParameter if a number is not within the bounds
  void require(double value) const;
};

/// The one place where names, bounds and meanings of private parameters stand; defaults are those of
/// NodeParameters.
const std::vector<ParameterRow>& parameterTable();
const ParameterRow& parameterRow(const std::string& name);  ///< @throws std::out_of_range
/// The table as the README has it.
std::string parameterMarkdown();

}  // namespace shallow_sand
