#include <gtest/gtest.h>
#include <stdlib.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <variant>

#include "shallow_sand/scene/simulation.h"
#include "temporary_folder.h"

namespace shallow_sand {
namespace {

/// A folder with a scene and what it names; the caches of programs go there, too.
class SceneMeshes : public ::testing::Test {
 protected:
  SceneMeshes() {
    setenv("XDG_CACHE_HOME", (folder_ / "cache").c_str(), 1);
    // A tetrahedron that faces outwards.
    write("corner.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n");
  }

  void write(const std::string& name, const std::string& content) const {
    std::ofstream(folder_ / name) << content;
  }
  Scene load(const std::string& shape) const {
    write("scene.yaml",
          "grid: {size: [2, 2], spacing: 0.1}\nsand: [{depth: 0.3}]\nbodies:\n  - name: tool\n    shape: " +
              shape + "\n    motion: [{time: 0, position: [0.8, 0.8, 0.1]}]\n");
    return loadScene((folder_ / "scene.yaml").string());
  }
  std::string messageOf(const std::string& shape) const {
    try {
      load(shape);
    } catch (const SceneError& error) {
      return error.what();
    }
    return "no error";
  }
  const TemporaryFolder temporary_;
  const std::filesystem::path folder_ = temporary_.path();
};

/// Positive only when triangles face outwards.
double volume(const Shape& shape) {
  const TriangleMesh& mesh = std::get<TriangleMesh>(shape);
  double sum = 0.0;
  for (const auto& triangle : mesh.triangles) {
    const auto vertex = [&](std::size_t i) { return mesh.vertices[static_cast<std::size_t>(triangle[i])]; };
    sum += vertex(0).dot(vertex(1).cross(vertex(2))) / 6.0;
  }
  return sum;
}

TEST_F(SceneMeshes, areReadFromTheScenesFolder) {
  EXPECT_NEAR(volume(load("{mesh: corner.obj}").bodies[0].shape), 1.0 / 6.0, 1e-6);
  EXPECT_NEAR(volume(load("{mesh: \"file://" + (folder_ / "corner.obj").string() + "\"}").bodies[0].shape),
              1.0 / 6.0, 1e-6);
}

/// An STL and a COLLADA file of the same corner, which has its unit in the file.
TEST_F(SceneMeshes, areReadFromStlAndCollada) {
  write("corner.stl",
        "solid corner\n"
        "facet normal 0 0 -1\nouter loop\nvertex 0 0 0\nvertex 0 1 0\nvertex 1 0 0\nendloop\nendfacet\n"
        "facet normal 0 -1 0\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 0 1\nendloop\nendfacet\n"
        "facet normal -1 0 0\nouter loop\nvertex 0 0 0\nvertex 0 0 1\nvertex 0 1 0\nendloop\nendfacet\n"
        "facet normal 1 1 1\nouter loop\nvertex 1 0 0\nvertex 0 1 0\nvertex 0 0 1\nendloop\nendfacet\n"
        "endsolid corner\n");
  write("corner.dae", R"(<?xml version="1.0" encoding="utf-8"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
  <asset><unit name="centimeter" meter="0.01"/><up_axis>Z_UP</up_axis></asset>
  <library_geometries><geometry id="corner"><mesh>
    <source id="places"><float_array id="numbers" count="12">0 0 0 100 0 0 0 100 0 0 0 100</float_array>
      <technique_common><accessor source="#numbers" count="4" stride="3"><param name="X" type="float"/>
        <param name="Y" type="float"/><param name="Z" type="float"/></accessor></technique_common></source>
    <vertices id="vertices"><input semantic="POSITION" source="#places"/></vertices>
    <triangles count="4"><input semantic="VERTEX" source="#vertices" offset="0"/>
      <p>0 2 1 0 1 3 0 3 2 1 2 3</p></triangles>
  </mesh></geometry></library_geometries>
  <library_visual_scenes><visual_scene id="scene"><node><instance_geometry url="#corner"/></node>
  </visual_scene></library_visual_scenes>
  <scene><instance_visual_scene url="#scene"/></scene>
</COLLADA>)");
  for (const std::string file : {"corner.stl", "corner.dae"}) {
    EXPECT_NEAR(volume(load("{mesh: " + file + "}").bodies[0].shape), 1.0 / 6.0, 1e-6) << file;
  }
}

TEST_F(SceneMeshes, areReadFromPackages) {
  setenv("ROS_PACKAGE_PATH", SHALLOW_SAND_SOURCE_DIR, 1);
  for (const auto& entry :
       std::filesystem::directory_iterator(SHALLOW_SAND_SOURCE_DIR "/config/excavator/meshes")) {
    const std::string uri =
        "package://shallow_sand/config/excavator/meshes/" + entry.path().filename().string();
    EXPECT_GT(volume(load("{mesh: \"" + uri + "\"}").bodies[0].shape), 0.0) << uri;
  }
}

TEST_F(SceneMeshes, areScaledAndMirrored) {
  const Scene scene = load("{mesh: corner.obj, scale: [-2, 1, 1], as: convex_hull}");
  EXPECT_NEAR(volume(scene.bodies[0].shape), 2.0 / 6.0, 1e-6);
  EXPECT_EQ(scene.bodies[0].stands_for, LinkShape::convex_hull);
  for (const Eigen::Vector3d& vertex : std::get<TriangleMesh>(scene.bodies[0].shape).vertices) {
    EXPECT_LE(vertex.x(), 0.0);
  }
}

TEST_F(SceneMeshes, displaceSandAndAreKeptForTheNextRun) {
  Simulator simulator = buildSimulator(load("{mesh: corner.obj}"));
  EXPECT_GT(simulator.bodyOverlap(), 0.0);
  EXPECT_TRUE(std::filesystem::exists(folder_ / "cache" / "shallow_sand"));
}

TEST_F(SceneMeshes, faultyFilesAreOneClearLine) {
  write("empty.stl", "");
  write("text.stl", "this is no mesh");
  for (const std::string file : {"empty.stl", "text.stl", "no_such.stl", "."}) {
    const std::string message = messageOf("{mesh: " + file + "}");
    EXPECT_NE(message.find("scene.yaml:5: bodies[0].shape.mesh: "), std::string::npos) << message;
    EXPECT_NE(message.find("; expected "), std::string::npos) << message;
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
  }
}

TEST_F(SceneMeshes, hugeFilesAreRefusedUnread) {
  write("huge.stl", "x");
  std::filesystem::resize_file(folder_ / "huge.stl", std::uintmax_t{3} << 30);  // takes no room on the disk
  EXPECT_NE(messageOf("{mesh: huge.stl}").find("a file of 3072 MiB; expected at most 256 MiB"),
            std::string::npos);
}

}  // namespace
}  // namespace shallow_sand
