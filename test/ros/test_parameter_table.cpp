#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <set>

#include "random_seed.h"
#include "shallow_sand/SandConfig.h"
#include "shallow_sand/core/nearest_name.h"
#include "shallow_sand/ros/parameter_table.h"
#include "shallow_sand/scene/scene.h"

namespace shallow_sand {
namespace {

TEST(ParameterTable, NamesAreTakenOnceAndByNoKeyOfAScene) {
  std::set<std::string> names(sceneKeys().begin(), sceneKeys().end());
  names.insert(kReconfigureNamespace);
  for (const ParameterRow& row : parameterTable()) EXPECT_TRUE(names.insert(row.name).second) << row.name;
}

TEST(ParameterTable, EveryRowIsComplete) {
  for (const ParameterRow& row : parameterTable()) {
    SCOPED_TRACE(row.name);
    for (const std::string& text : {row.type, row.expected, row.meaning}) {
      EXPECT_FALSE(text.empty());
      EXPECT_EQ(text.find_first_of("|\n"), std::string::npos) << text;
    }
    EXPECT_NE(parameterMarkdown().find("`~" + row.name + "`"), std::string::npos);
  }
}

TEST(ParameterTable, DefaultsLieWithinBoundsAndWhatLiesBeyondIsRefusedByName) {
  for (const ParameterRow& row : parameterTable()) {
    const auto target = std::get_if<double NodeParameters::*>(&row.target);
    if (target == nullptr) continue;
    SCOPED_TRACE(row.name);
    EXPECT_LT(row.low, row.high);
    for (const double good : {NodeParameters().**target, row.low, row.high})
      EXPECT_NO_THROW(row.require(good));
    const double infinity = std::numeric_limits<double>::infinity();
    for (const double bad :
         {std::nextafter(row.low, -infinity), std::nextafter(row.high, infinity), infinity, std::nan("")}) {
      try {
        row.require(bad);
        ADD_FAILURE() << bad << " was not refused";
      } catch (const InvalidParameter& problem) {
        EXPECT_EQ(std::string(problem.what()).rfind(row.name + ": ", 0), 0u) << problem.what();
      }
    }
  }
}

const SandConfig::AbstractParamDescription& described(const std::string& name) {
  for (const auto& parameter : SandConfig::__getParamDescriptions__()) {
    if (parameter->name == name) return *parameter;
  }
  throw std::out_of_range(name);
}

double valueOf(const std::string& name, const SandConfig& config) {
  boost::any value;
  described(name).getValue(config, value);
  return boost::any_cast<double>(value);
}

/// cfg/Sand.cfg is written by hand, for the generator cannot ask the table.
TEST(SandConfigFile, SaysOfTheNodesParametersWhatTheTableSays) {
  int compared = 0;
  for (const ParameterRow& row : parameterTable()) {
    if (!row.at_run_time) {
      EXPECT_THROW(described(row.name), std::out_of_range) << row.name;
      continue;
    }
    SCOPED_TRACE(row.name);
    EXPECT_EQ(described(row.name).description, row.meaning);
    EXPECT_EQ(valueOf(row.name, SandConfig::__getMin__()), row.low);
    EXPECT_EQ(valueOf(row.name, SandConfig::__getMax__()), row.high);
    const auto target = std::get<double NodeParameters::*>(row.target);
    EXPECT_EQ(valueOf(row.name, SandConfig::__getDefault__()), NodeParameters().*target);
    ++compared;
  }
  EXPECT_EQ(compared, 8);
}

/// Whether Material takes a value.
bool takes(double Material::*member, double value) {
  Material material;
  material.*member = value;
  try {
    material.validate();
  } catch (const InvalidParameter&) {
    return false;
  }
  return true;
}

/// What lies beyond the bounds of the file is refused by the simulator, and what lies between is taken.
TEST(SandConfigFile, BoundsMaterialAsItIsBounded) {
  std::mt19937 random = seededGenerator();
  struct Bounded {
    const char* name;
    double Material::*member;
    double unit;
  };
  for (const Bounded& bounded : {Bounded{"friction_angle", &Material::friction_angle, M_PI / 180.0},
                                 Bounded{"layer_fraction", &Material::layer_fraction, 1.0},
                                 Bounded{"layer_depth", &Material::layer_depth, 1.0}}) {
    SCOPED_TRACE(bounded.name);
    const double low = valueOf(bounded.name, SandConfig::__getMin__());
    const double high = valueOf(bounded.name, SandConfig::__getMax__());
    const double widest = std::isinf(high) ? 1e9 : high;
    for (int k = 0; k < 100; ++k) {
      const double between = std::uniform_real_distribution<double>(low + 1e-9, widest - 1e-9)(random);
      EXPECT_TRUE(takes(bounded.member, between * bounded.unit)) << between;
    }
    EXPECT_FALSE(takes(bounded.member, (low - 1e-9) * bounded.unit));
    // Beyond infinity there is nothing.
    EXPECT_EQ(takes(bounded.member, (high + 1e-9) * bounded.unit), std::isinf(high));
    EXPECT_NEAR(valueOf(bounded.name, SandConfig::__getDefault__()) * bounded.unit,
                Material().*bounded.member, 1e-12);
  }
}

TEST(SandConfigFile, StartsWithTheGravityOfAScene) {
  const SandConfig start = SandConfig::__getDefault__();
  EXPECT_EQ(Eigen::Vector3d(start.gravity_x, start.gravity_y, start.gravity_z),
            SimulatorParameters().gravity);
}

TEST(NearestName, IsTheNameItselfOrTheOneThatATypingErrorMeant) {
  std::vector<std::string> known = sceneKeys();
  for (const ParameterRow& row : parameterTable()) known.push_back(row.name);
  for (const std::string& name : known) EXPECT_EQ(nearestName(name, known), name);
  EXPECT_EQ(nearestName("publish_rates", known), "publish_rate");
  EXPECT_EQ(nearestName("pubish_rate", known), "publish_rate");
  EXPECT_EQ(nearestName("heigth_field_rate", known), "height_field_rate");
  EXPECT_EQ(nearestName("gravitiy", known), "gravity");
  EXPECT_EQ(nearestName("", {"abc", "ab"}), "ab");
}

}  // namespace
}  // namespace shallow_sand
