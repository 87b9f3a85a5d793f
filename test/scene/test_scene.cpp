#include <gtest/gtest.h>
#include <yaml-cpp/yaml.h>

#include <cmath>
#include <fstream>
#include <regex>
#include <set>

#include "random_seed.h"
#include "scene/scene_texts.h"
#include "shallow_sand/scene/scene.h"

namespace shallow_sand {
namespace {

Scene sceneFrom(const std::string& text) { return readScene(YAML::Load(text), "test.yaml"); }

/// What the reader says about a scene; empty if it takes it.
std::string errorOf(const std::string& text) {
  try {
    sceneFrom(text);
    return "";
  } catch (const SceneError& error) {
    return error.what();
  }
}

std::string replaced(std::string text, const std::string& old_part, const std::string& new_part) {
  const std::size_t position = text.find(old_part);
  EXPECT_NE(position, std::string::npos) << old_part;
  return text.replace(position, old_part.size(), new_part);
}

/// Depth at the cell that holds (x, y).
float depthAt(const Scene& scene, double x, double y) {
  const Grid grid = scene.parameters.grid.grid();
  const double spacing = scene.parameters.grid.spacing;
  return scene.depth[grid.index(static_cast<int>((x - grid.origin_x) / spacing),
                                static_cast<int>((y - grid.origin_y) / spacing))];
}

TEST(Scene, FullSceneGivesWhatItSays) {
  const Scene scene = sceneFrom(kFullScene);
  EXPECT_EQ(scene.parameters.grid.grid().columns, 200);
  EXPECT_EQ(scene.parameters.grid.grid().rows, 100);
  EXPECT_EQ(scene.parameters.edges.y_min, Edge::open);
  EXPECT_EQ(scene.parameters.edges.y_max, Edge::wall);
  EXPECT_DOUBLE_EQ(scene.parameters.material.friction_angle, 32.0 * M_PI / 180.0);
  EXPECT_EQ(scene.parameters.solver.fixed_step, 0.002);
  EXPECT_EQ(scene.parameters.coupling, Coupling::drag);
  EXPECT_EQ(scene.parameters.backend, Backend::cpu);
  EXPECT_EQ(scene.parameters.threads, 2);
  ASSERT_TRUE(scene.parameters.grains.has_value());
  EXPECT_EQ(scene.parameters.grains->per_cell, 2);
  EXPECT_EQ(scene.parameters.grains->layers, 3);
  EXPECT_EQ(scene.parameters.grains->speed, GrainSpeed::dilute);
  EXPECT_EQ(scene.parameters.grains->color, GrainColor::layer);
  EXPECT_EQ(scene.duration, 10.0);
  ASSERT_EQ(scene.pours.size(), 1u);
  EXPECT_EQ(scene.pours[0].rate, 0.01);
  ASSERT_EQ(scene.bodies.size(), 3u);
  EXPECT_EQ(std::get<Box>(scene.bodies[0].shape).size, Eigen::Vector3d(0.1, 1.0, 0.5));
  EXPECT_EQ(std::get<Cylinder>(scene.bodies[1].shape).length, 0.5);
  EXPECT_EQ(std::get<Sphere>(scene.bodies[2].shape).radius, 0.2);
  const Eigen::Vector3d turned = scene.bodies[0].motion[1].pose.linear() * Eigen::Vector3d::UnitX();
  EXPECT_TRUE(turned.isApprox(Eigen::Vector3d::UnitY(), 1e-12));
}

TEST(Scene, AnEmptyMapGivesTheDefaults) {
  const Scene scene = sceneFrom("{}");
  EXPECT_EQ(scene.depth.size(), 20000u);
  EXPECT_EQ(*std::max_element(scene.depth.begin(), scene.depth.end()), 0.0f);
  EXPECT_EQ(scene.parameters.material.friction_angle, Material().friction_angle);
  EXPECT_TRUE(scene.bodies.empty());
  EXPECT_FALSE(scene.parameters.grains.has_value());
}

TEST(Scene, SandIsAddedInOrder) {
  const Scene scene = sceneFrom(kFullScene);
  EXPECT_FLOAT_EQ(depthAt(scene, 3.9, 0.1), 0.4f);
  EXPECT_FLOAT_EQ(depthAt(scene, 0.1, 1.7), 0.8f);
  EXPECT_FLOAT_EQ(depthAt(scene, 0.91, 1.01),
                  1.8f + std::max(0.0, 1.0 - std::tan(M_PI / 6) * std::hypot(1.09, 0.01)));
  EXPECT_NEAR(depthAt(scene, 2.01, 1.01), 1.4f, 0.01f);
}

TEST(Scene, SurfaceFillsHollowsOfTheBedOnly) {
  const Scene scene = sceneFrom("{bed: {elevation: 0.1, slope: [0.1, 0]}, sand: [{surface: 0.3}]}");
  for (std::size_t k = 0; k < scene.bed.size(); ++k) {
    EXPECT_NEAR(scene.depth[k], std::max(0.0f, 0.3f - scene.bed[k]), 1e-7);
  }
}

TEST(Scene, SandMayBeTakenAwayToTheLastGrain) {
  const Scene scene = sceneFrom("{sand: [{depth: 0.3}, {depth: -0.1}, {depth: -0.2}]}");
  EXPECT_EQ(depthAt(scene, 1.0, 1.0), 0.0f);
}

TEST(Scene, RotationsAreAboutFixedAxesAsInUrdf) {
  const Scene scene = sceneFrom(replaced(kFullScene, "rpy: [0, 0, 90]", "rpy: [90, 0, 90]"));
  // Roll first: z goes to -y; then yaw: -y goes to x.
  const Eigen::Vector3d axis = scene.bodies[0].motion[1].pose.linear() * Eigen::Vector3d::UnitZ();
  EXPECT_TRUE(axis.isApprox(Eigen::Vector3d::UnitX(), 1e-12)) << axis.transpose();
}

TEST(Scene, InfinityIsTakenWhereItHasAMeaning) {
  const Scene layer = sceneFrom("{material: {dilute_layer: {depth: .inf}}}");
  EXPECT_TRUE(std::isinf(layer.parameters.material.layer_depth));
  const Scene pour = sceneFrom("{pours: [{position: [1, 1], rate: 1, stop: .inf}]}");
  EXPECT_TRUE(std::isinf(pour.pours[0].stop));
}

/// A change to the full scene that makes it wrong, and words that the error must hold.
struct Mistake {
  std::string old_part;
  std::string new_part;
  std::string place;  ///< line and key
  std::string expected;
};

class SceneMistakes : public ::testing::TestWithParam<Mistake> {};

TEST_P(SceneMistakes, AreOneClearLine) {
  const std::string error = errorOf(replaced(kFullScene, GetParam().old_part, GetParam().new_part));
  EXPECT_EQ(error.rfind("test.yaml:" + GetParam().place, 0), 0u) << error;
  EXPECT_NE(error.find("; expected "), std::string::npos) << error;
  EXPECT_NE(error.find(GetParam().expected), std::string::npos) << error;
  EXPECT_EQ(error.find('\n'), std::string::npos) << error;
}

INSTANTIATE_TEST_SUITE_P(
    Numbers, SceneMistakes,
    ::testing::Values(
        Mistake{"friction_angle: 32.0", "friction_angle: 95", "3: material.friction_angle: 95;",
                "90 degrees"},
        Mistake{"friction_angle: 32.0", "friction_angle: -1", "3: material.friction_angle: -1;",
                "90 degrees"},
        Mistake{"fraction: 1.0", "fraction: 0", "3: material.dilute_layer.fraction: 0;", "number"},
        Mistake{"depth: 0.1}", "depth: -.inf}", "3: material.dilute_layer.depth: -inf;", "positive"},
        Mistake{"spacing: 0.02", "spacing: -0.02", "1: grid.spacing: -0.02;", "a number from"},
        Mistake{"spacing: 0.02", "spacing: .inf", "1: grid.spacing: .inf;", "a number from"},
        Mistake{"spacing: 0.02", "spacing: 0.3", "1: grid.size[0]: 4;", "whole number of cells"},
        Mistake{"spacing: 0.02", "spacing: 20", "1: grid.size[0]: 4;", "at least one cell"},
        Mistake{"spacing: 0.02", "spacing: 0.0001", "1: grid: ", "2^28 cells"},
        Mistake{"gravity:  [0.0, 0.0, -9.81]", "gravity: [0, 0, 9.81]", "2: gravity: ", "negative"},
        Mistake{"gravity:  [0.0, 0.0, -9.81]", "gravity: [2e4, 0, -9]", "2: gravity: ", "1e4 in size"},
        Mistake{"gravity:  [0.0, 0.0, -9.81]", "gravity: [0, .nan, -9]", "2: gravity[1]: .nan;", "finite"},
        Mistake{"courant: 0.45", "courant: 1", "25: solver.courant: 1;", "between 0 and 1"},
        Mistake{"max_step: 0.01", "max_step: 0", "25: solver.max_step: 0;", "positive"},
        Mistake{"fixed_step: 0.002", "fixed_step: -1", "25: solver.fixed_step: -1;", "positive"},
        Mistake{"coupling: drag", "coupling: push", "25: solver.coupling: push;",
                "displacement, drag or horizontal_drag"},
        Mistake{"[0.6, 1.0, 0.45]", "[.nan, 1.0, 0.45]", "17: bodies[0].motion[0].position[0]: .nan;",
                "finite"},
        Mistake{"[0.6, 1.0, 0.45]", "[1e30, 1.0, 0.45]", "17: bodies[0].motion[0].position[0]: 1e30;", "1e9"},
        Mistake{"rpy: [0, 0, 90]", "rpy: [0, 0, .inf]", "18: bodies[0].motion[1].rpy[2]: .inf;", "finite"},
        Mistake{"time: 8.0", "time: 0", "18: bodies[0].motion[1].time: 0;", "after"},
        Mistake{"box: [0.1, 1.0", "box: [0, 1.0", "15: bodies[0].shape.box[0]: 0;", "a number from"},
        Mistake{"sphere: 0.2", "sphere: -1", "23: bodies[2].shape.sphere: -1;", "a number from"},
        Mistake{"radius: 0.1,", "radius: 0,", "12: pours[0].radius: 0;", "positive"},
        Mistake{"rate: 0.01", "rate: .inf", "12: pours[0].rate: .inf;", "a finite number"},
        Mistake{"stop: 8.0", "stop: -1", "12: pours[0].stop: -1;", "after start"},
        Mistake{"slope_angle: 30.0", "slope_angle: 90", "11: sand[4].cone.slope_angle: 90;", "90 degrees"},
        Mistake{"depth: 0.3", "depth: 1e400", "7: sand[0].depth: 1e400;", "finite"},
        Mistake{"depth: 0.3", "depth: -0.3", "7: sand[0]: takes 0.3 m", "at most the 0 m"},
        Mistake{"depth: 0.4}", "depth: -0.5}", "10: sand[3]: takes 0.5 m", "at most the 0.4 m"},
        Mistake{"duration: 10.0", "duration: -1", "26: duration: -1;", "from 0"},
        Mistake{"threads: 2", "threads: 1.5", "28: threads: 1.5;", "whole number"},
        Mistake{"per_cell: 2", "per_cell: 0", "29: grains.per_cell: 0;", "a whole number from 1"},
        Mistake{"per_cell: 2", "per_cell: 2.5", "29: grains.per_cell: 2.5;", "a whole number from 1"},
        Mistake{"per_cell: 2", "per_cell: 65", "29: grains.per_cell: 65;", "from 1 to 64"},
        Mistake{"layers: 3", "layers: 1025", "29: grains.layers: 1025;", "from 1 to 1024"},
        Mistake{"per_cell: 2, layers: 3", "per_cell: 64, layers: 2", "29: grains: ", "at most 2^26"},
        Mistake{"layers: 3", "layers: .inf", "29: grains.layers: .inf;", "a whole number from 1"}));

INSTANTIATE_TEST_SUITE_P(
    Structure, SceneMistakes,
    ::testing::Values(
        Mistake{"friction_angle", "friction_angel", "3: material.friction_angel: unknown key",
                "did you mean friction_angle?"},
        Mistake{"duration", "xyzzy", "26: xyzzy: unknown key;", "one of: grid, gravity"},
        Mistake{"[4.0, 2.0]", "[4.0]", "1: grid.size: a list of 1;", "a list of 2 numbers"},
        Mistake{"[4.0, 2.0]", "4.0", "1: grid.size: 4.0;", "a list of 2 numbers"},
        Mistake{"spacing: 0.02", "spacing: wide", "1: grid.spacing: wide;", "number"},
        Mistake{"spacing: 0.02", "spacing: \"0.02\"", "1: grid.spacing: 0.02;", "number"},
        Mistake{"spacing: 0.02", "spacing: [1]", "1: grid.spacing: a list of 1;", "number"},
        Mistake{"spacing: 0.02", "spacing: ", "1: grid.spacing: nothing;", "number"},
        Mistake{"frame: sand", "frame: \"\"", "1: grid.frame: an empty text;", "a text"},
        Mistake{"frame: sand", "spacing: 1", "1: grid.spacing: given twice;", "once"},
        Mistake{"{elevation: 0.0, slope: [0.0, 0.0]}", "0", "5: bed: 0;", "a map"},
        Mistake{"y_min: open", "y_min: ajar", "4: edges.y_min: ajar;", "wall or open"},
        Mistake{"{depth: 0.3}", "{depth: 0.3, surface: 1}", "7: sand[0]: a map of 2 keys;", "exactly one of"},
        Mistake{"{depth: 0.3}", "0.3", "7: sand[0]: 0.3;", "a map"},
        Mistake{"max: [1.0, 2.0]", "max: [0.0, 2.0]", "10: sand[3].box.max: ", "above those of min"},
        Mistake{"height: 1.0, ", "", "11: sand[4].cone.height: missing;", "this key"},
        Mistake{"name: roller", "name: blade", "19: bodies[1].name: blade;", "no other body"},
        Mistake{"motion: [{time: 0.0, position: [3.0, 1.0, 2.0]}]", "motion: []",
                "21: bodies[1].motion: ", "at least one pose"},
        Mistake{"{sphere: 0.2}", "{sphere: 0.2, box: [1, 1, 1]}", "23: bodies[2].shape: a map of 2",
                "exactly one"},
        Mistake{"backend: cpu", "backend: tpu", "27: backend: tpu;", "auto, cpu or cuda"},
        Mistake{"speed: dilute", "speed: fast", "29: grains.speed: fast;", "mean or dilute"},
        Mistake{"color: layer", "color: red", "29: grains.color: red;", "origin or layer"},
        Mistake{"{per_cell: 2, layers: 3, speed: dilute, color: layer}", "true", "29: grains: true;",
                "a map"},
        Mistake{"per_cell: 2", "per_sell: 2", "29: grains.per_sell: unknown key", "did you mean per_cell?"}));

INSTANTIATE_TEST_SUITE_P(Meshes, SceneMistakes,
                         ::testing::Values(Mistake{"{sphere: 0.2}", "{mesh: /no_such.stl}",
                                                   "23: bodies[2].shape.mesh: ", "a readable file"},
                                           Mistake{"{sphere: 0.2}", "{mesh: \"http://host/a.stl\"}",
                                                   "23: bodies[2].shape.mesh: ", "package://"},
                                           Mistake{"{sphere: 0.2}", "{mesh: a.stl, scale: [1, 0, 1]}",
                                                   "23: bodies[2].shape.scale[1]: 0;", "which mirrors"},
                                           Mistake{"{sphere: 0.2}", "{mesh: a.stl, size: 2}",
                                                   "23: bodies[2].shape.size: unknown key",
                                                   "mesh, scale, as"}));

TEST(Scene, ErrorsWithoutAFileHaveNoLine) {
  YAML::Node root;
  root["duration"] = -1.0;
  try {
    readScene(root, "parameters");
    FAIL();
  } catch (const SceneError& error) {
    EXPECT_EQ(std::string(error.what()), "parameters: duration: -1; expected a number from 0 to 1e9");
  }
}

TEST(Scene, FilesThatAreNoScenesAreRefused) {
  EXPECT_THROW(loadScene("no_such_scene.yaml"), SceneError);
  EXPECT_THROW(loadScene("."), SceneError);
  std::ofstream("broken.yaml") << "grid: {size: [1, 2\nsand: ]";
  EXPECT_THROW(loadScene("broken.yaml"), SceneError);
  std::ofstream("empty.yaml") << "";
  EXPECT_THROW(loadScene("empty.yaml"), SceneError);
}

TEST(Scene, ExamplesLoad) {
  for (const std::string name : {"blade", "pile", "cone_at_rest", "terrain", "mixing"}) {
    const Scene scene = loadScene(SHALLOW_SAND_SOURCE_DIR "/config/scenes/" + name + ".yaml");
    EXPECT_EQ(scene.name, name);
  }
}

/// Keys of the full scene: where each begins, and its name.
std::vector<std::pair<std::size_t, std::string>> keysOf(const std::string& text) {
  std::vector<std::pair<std::size_t, std::string>> keys;
  const std::regex key("([a-z_]+):");
  for (std::sregex_iterator match(text.begin(), text.end(), key), end; match != end; ++match) {
    keys.emplace_back(match->position(1), match->str(1));
  }
  return keys;
}

std::string misspelt(std::string word, std::mt19937& generator) {
  const auto upTo = [&generator](std::size_t last) {
    return std::uniform_int_distribution<std::size_t>(0, last)(generator);
  };
  const char letter = static_cast<char>('a' + upTo(25));
  const std::size_t position = upTo(word.size() - 1);
  switch (upTo(2)) {
    case 0:
      return word.insert(position, 1, letter);
    case 1:
      return word.replace(position, 1, 1, letter);
    default:
      return word.size() > 1 ? word.erase(position, 1) : word + letter;
  }
}

TEST(Scene, MisspeltKeysAreAlwaysRefused) {
  std::mt19937 generator = seededGenerator();
  const auto keys = keysOf(kFullScene);
  std::set<std::string> known;
  for (const auto& key : keys) {
    known.insert(key.second);
  }
  for (int k = 0; k < 500; ++k) {
    const auto& key = keys[std::uniform_int_distribution<std::size_t>(0, keys.size() - 1)(generator)];
    const std::string wrong = misspelt(key.second, generator);
    if (known.count(wrong) > 0) {
      continue;
    }
    std::string text = kFullScene;
    text.replace(key.first, key.second.size(), wrong);
    const std::string error = errorOf(text);
    EXPECT_NE(error.find(wrong + ": unknown key"), std::string::npos) << wrong << ": " << error;
  }
}

TEST(Scene, ValidScenesAlwaysLoad) {
  std::mt19937 generator = seededGenerator();
  const auto number = [&generator](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(generator);
  };
  for (int k = 0; k < 50; ++k) {
    const int columns = static_cast<int>(number(1.0, 40.0));
    const int rows = static_cast<int>(number(1.0, 40.0));
    const double spacing = number(0.001, 2.0);
    const double added = number(0.0, 1.0);
    YAML::Node root;
    root["grid"]["spacing"] = spacing;
    root["grid"]["size"] = std::vector<double>{columns * spacing, rows * spacing};
    root["grid"]["origin"] = std::vector<double>{number(-1e6, 1e6), number(-1e6, 1e6)};
    root["material"]["friction_angle"] = number(0.0, 89.0);
    root["bed"]["slope"] = std::vector<double>{number(-1.0, 1.0), number(-1.0, 1.0)};
    root["sand"][0]["depth"] = added;
    root["sand"][1]["depth"] = -number(0.0, added);
    root["duration"] = number(0.0, 1e6);
    const Scene scene = readScene(root, "random");
    EXPECT_EQ(scene.depth.size(), static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows));
    EXPECT_GE(*std::min_element(scene.depth.begin(), scene.depth.end()), 0.0f);
  }
}

}  // namespace
}  // namespace shallow_sand
