#include <gtest/gtest.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "random_seed.h"
#include "shallow_sand/bodies/robot_links.h"
#include "shallow_sand/core/parameters.h"

namespace shallow_sand {
namespace {

/// A file that is gone when the test ends.
class TemporaryFile {
 public:
  TemporaryFile(const std::string& ending, const std::string& content) {
    std::string path = "/tmp/shallow_sand_XXXXXX" + ending;
    const int descriptor = mkstemps(&path[0], static_cast<int>(ending.size()));
    if (descriptor < 0) throw std::runtime_error("no temporary file at " + path);
    close(descriptor);
    path_ = path;
    std::ofstream(path_, std::ios::binary) << content;
  }
  ~TemporaryFile() { std::remove(path_.c_str()); }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;

  std::string uri() const { return "file://" + path_; }

 private:
  std::string path_;
};

/// A box of 1 × 2 × 4 with one corner at the origin, so that no two axes can be mistaken for each other.
std::string boxAsStl() {
  const TriangleMesh box = triangulate(Box{{1.0, 2.0, 4.0}});
  std::ostringstream stl;
  stl << "solid box\n";
  for (const auto& triangle : box.triangles) {
    stl << "facet normal 0 0 0\nouter loop\n";
    for (const int vertex : triangle) {
      const Eigen::Vector3d moved =
          box.vertices[static_cast<std::size_t>(vertex)] + Eigen::Vector3d(0.5, 1.0, 2.0);
      stl << "vertex " << moved.transpose() << "\n";
    }
    stl << "endloop\nendfacet\n";
  }
  stl << "endsolid box\n";
  return stl.str();
}

/// A triangle in COLLADA with corners at 0, 1 and 2 along no axis, x and z, in a node moved by (0, 0, 3).
std::string triangleAsCollada(const std::string& asset) {
  return R"(<?xml version="1.0" encoding="utf-8"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
 <asset>)" +
         asset + R"(</asset>
 <library_geometries><geometry id="g" name="g"><mesh>
  <source id="p"><float_array id="pa" count="9">0 0 0 1 0 0 0 0 2</float_array><technique_common>
   <accessor source="#pa" count="3" stride="3"><param name="X" type="float"/><param name="Y" type="float"/>
   <param name="Z" type="float"/></accessor></technique_common></source>
  <vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
  <triangles count="1"><input semantic="VERTEX" source="#v" offset="0"/><p>0 1 2</p></triangles>
 </mesh></geometry></library_geometries>
 <library_visual_scenes><visual_scene id="s" name="s"><node id="n" name="n">
  <matrix>1 0 0 0 0 1 0 0 0 0 1 3 0 0 0 1</matrix><instance_geometry url="#g"/></node></visual_scene>
 </library_visual_scenes>
 <scene><instance_visual_scene url="#s"/></scene>
</COLLADA>)";
}

Eigen::AlignedBox3d bounds(const TriangleMesh& mesh) {
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& vertex : mesh.vertices) box.extend(vertex);
  return box;
}

/// Positive only when triangles face outwards.
double volume(const TriangleMesh& mesh) {
  double sum = 0.0;
  for (const auto& triangle : mesh.triangles) {
    const auto vertex = [&](std::size_t i) { return mesh.vertices[static_cast<std::size_t>(triangle[i])]; };
    sum += vertex(0).dot(vertex(1).cross(vertex(2))) / 6.0;
  }
  return sum;
}

void expectNear(const Eigen::Vector3d& found, const Eigen::Vector3d& expected, double tolerance) {
  EXPECT_LE((found - expected).cwiseAbs().maxCoeff(), tolerance)
      << found.transpose() << " instead of " << expected.transpose();
}

std::string robot(const std::string& links) { return "<robot name=\"digger\">" + links + "</robot>"; }

std::string collision(const std::string& geometry, const std::string& origin = "") {
  return "<collision>" + origin + "<geometry>" + geometry + "</geometry></collision>";
}

std::string messageOf(const std::string& urdf) {
  try {
    collisionGeometry(urdf);
  } catch (const InvalidParameter& error) {
    return error.what();
  }
  return "no error";
}

/// STL and COLLADA come through assimp, in single precision: 2⁻²⁴ of lengths up to 5.
constexpr double kSingle = 1e-6;
/// URDFs here are short decimals; what follows is double precision.
constexpr double kDouble = 1e-12;

TEST(RobotLinks, listsOnlyLinksThatCanTouchSand) {
  const RobotGeometry found = collisionGeometry(
      robot("<link name=\"wheel\">" + collision("<cylinder radius=\"0.1\" length=\"0.05\"/>") + "</link>" +
            "<link name=\"tip\"/>" +
            "<link name=\"eye\"><visual><geometry><sphere radius=\"1\"/></geometry></visual>" + "</link>" +
            "<joint name=\"a\" type=\"fixed\"><parent link=\"wheel\"/><child link=\"tip\"/></joint>" +
            "<joint name=\"b\" type=\"fixed\"><parent link=\"wheel\"/><child link=\"eye\"/></joint>"));
  EXPECT_EQ(found.robot, "digger");
  EXPECT_TRUE(found.problems.empty());
  ASSERT_EQ(found.links.size(), 1u);
  EXPECT_EQ(found.links[0].link, "wheel");
}

TEST(RobotLinks, mergesAllElementsOfALinkEachAtItsOrigin) {
  const RobotGeometry found = collisionGeometry(
      robot("<link name=\"scoop\">" +
            collision("<box size=\"1 2 3\"/>", "<origin xyz=\"10 0 0\" rpy=\"0 0 1.5707963267948966\"/>") +
            collision("<sphere radius=\"0.5\"/>", "<origin xyz=\"-10 0 0\"/>") +
            collision("<cylinder radius=\"0.5\" length=\"4\"/>", "<origin rpy=\"1.5707963267948966 0 0\"/>") +
            "</link>"));
  ASSERT_EQ(found.links.size(), 1u);
  const TriangleMesh& mesh = found.links[0].mesh;
  TriangleMesh box = mesh;
  TriangleMesh sphere = mesh;
  TriangleMesh cylinder = mesh;
  const auto keep = [](TriangleMesh& part, double low, double high) {
    const auto elsewhere = [&](const Eigen::Vector3d& vertex) {
      return vertex.x() < low || vertex.x() > high;
    };
    part.vertices.erase(std::remove_if(part.vertices.begin(), part.vertices.end(), elsewhere),
                        part.vertices.end());
  };
  keep(box, 5.0, 15.0);
  keep(sphere, -15.0, -5.0);
  keep(cylinder, -5.0, 5.0);
  expectNear(bounds(box).sizes(), {2.0, 1.0, 3.0}, kDouble);
  expectNear(bounds(box).center(), {10.0, 0.0, 0.0}, kDouble);
  const double round = 0.002 * 0.5;  // triangulate's 0.1 % of the radius, on both sides
  expectNear(bounds(sphere).sizes(), {1.0, 1.0, 1.0}, round);
  expectNear(bounds(cylinder).sizes(), {1.0, 4.0, 1.0}, round);
  const double pi = 3.14159265358979323846;
  const double exact = 6.0 + 4.0 / 3.0 * pi * 0.125 + pi * 0.25 * 4.0;
  EXPECT_NEAR(volume(mesh), exact, 0.003 * exact);  // radii enter up to cubed
}

TEST(RobotLinks, readsAMeshWithItsScale) {
  const TemporaryFile file(".stl", boxAsStl());
  const RobotGeometry found = collisionGeometry(robot(
      "<link name=\"bucket\">" +
      collision("<mesh filename=\"" + file.uri() + "\" scale=\"0.5 1 0.25\"/>", "<origin xyz=\"0 0 1\"/>") +
      "</link>"));
  EXPECT_TRUE(found.problems.empty());
  ASSERT_EQ(found.links.size(), 1u);
  const TriangleMesh& mesh = found.links[0].mesh;
  expectNear(bounds(mesh).min(), {0.0, 0.0, 1.0}, kSingle);
  expectNear(bounds(mesh).max(), {0.5, 2.0, 2.0}, kSingle);
  EXPECT_NEAR(volume(mesh), 1.0, 10.0 * kSingle);
}

TEST(RobotLinks, scaleMultipliesWhateverItsSigns) {
  std::mt19937 generator = seededGenerator();
  const TemporaryFile file(".stl", boxAsStl());
  std::uniform_real_distribution<double> length(0.1, 1.0);
  for (int signs = 0; signs < 8; ++signs) {
    const Eigen::Vector3d scale(length(generator) * (signs & 1 ? -1 : 1),
                                length(generator) * (signs & 2 ? -1 : 1),
                                length(generator) * (signs & 4 ? -1 : 1));
    const TriangleMesh mesh = readMesh(file.uri(), scale);
    const Eigen::Vector3d corner = scale.cwiseProduct(Eigen::Vector3d(1.0, 2.0, 4.0));
    expectNear(bounds(mesh).min(), corner.cwiseMin(0.0), kSingle);
    expectNear(bounds(mesh).max(), corner.cwiseMax(0.0), kSingle);
    EXPECT_NEAR(volume(mesh), std::abs(corner.prod()), 50.0 * kSingle) << "scale " << scale.transpose();
  }
}

/// As rviz does it: the unit counts, the nodes' transforms count, the up axis does not.
TEST(RobotLinks, readsColladaAsRvizShowsIt) {
  struct Case {
    std::string asset;
    double unit;
  };
  for (const Case& tried :
       std::vector<Case>{{"<unit name=\"inch\" meter=\"0.0254\"/><up_axis>Z_UP</up_axis>", 0.0254},
                         {"<unit name=\"inch\" meter=\"0.0254\"/><up_axis>Y_UP</up_axis>", 0.0254},
                         {"<unit name=\"meter\" meter=\"1\"/><up_axis>X_UP</up_axis>", 1.0},
                         {"<up_axis>Z_UP</up_axis>", 1.0}}) {
    const TemporaryFile file(".dae", triangleAsCollada(tried.asset));
    const TriangleMesh mesh = readMesh(file.uri(), {2.0, 2.0, 2.0});
    expectNear(bounds(mesh).min(), 2.0 * tried.unit * Eigen::Vector3d(0.0, 0.0, 3.0), 2.0 * kSingle);
    expectNear(bounds(mesh).max(), 2.0 * tried.unit * Eigen::Vector3d(1.0, 0.0, 5.0), 2.0 * kSingle);
  }
}

TEST(RobotLinks, oneBadElementIsOneProblemAndTheRestGoesOn) {
  const TemporaryFile garbage(".stl", "no mesh at all");
  const TemporaryFile empty(".stl", "");
  const TemporaryFile good(".stl", boxAsStl());
  const std::vector<std::string> uris{"file:///nowhere/blade.stl", "package://no_such_package/blade.stl",
                                      "blade.stl", garbage.uri(), empty.uri()};
  for (const std::string& uri : uris) {
    const RobotGeometry found = collisionGeometry(
        robot("<link name=\"arm\">" + collision("<box size=\"1 1 1\"/>") +
              collision("<mesh filename=\"" + uri + "\"/>") + "</link><link name=\"blade\">" +
              collision("<mesh filename=\"" + uri + "\"/>") + "</link>" + "<link name=\"bucket\">" +
              collision("<mesh filename=\"" + good.uri() + "\"/>") + "</link>" +
              "<joint name=\"a\" type=\"fixed\"><parent link=\"arm\"/><child link=\"blade\"/></joint>" +
              "<joint name=\"b\" type=\"fixed\"><parent link=\"arm\"/><child link=\"bucket\"/></joint>"));
    ASSERT_EQ(found.links.size(), 2u) << uri;
    EXPECT_EQ(found.links[0].link, "arm");
    EXPECT_EQ(found.links[0].mesh.triangles.size(), 12u);
    EXPECT_EQ(found.links[1].link, "bucket");
    ASSERT_EQ(found.problems.size(), 2u) << uri;
    for (const std::string& word :
         {std::string("digger"), std::string("blade"), uri, std::string("expected")}) {
      EXPECT_NE(found.problems[1].find(word), std::string::npos) << found.problems[1];
    }
    EXPECT_EQ(found.problems[1].find('\n'), std::string::npos) << found.problems[1];
  }
}

TEST(RobotLinks, aSizeOfZeroIsAProblemOfItsElement) {
  const TemporaryFile file(".stl", boxAsStl());
  const RobotGeometry found =
      collisionGeometry(robot("<link name=\"plate\">" + collision("<box size=\"1 0 1\"/>") +
                              collision("<mesh filename=\"" + file.uri() + "\" scale=\"1 1 0\"/>") +
                              collision("<sphere radius=\"1\"/>") + "</link>"));
  EXPECT_EQ(found.problems.size(), 2u);
  ASSERT_EQ(found.links.size(), 1u);
}

/// urdfdom drops it, and all that follow in its link, without telling its caller.
TEST(RobotLinks, anElementUnknownToUrdfIsAProblem) {
  const std::string box = collision("<box size=\"1 1 1\"/>");
  const RobotGeometry found = collisionGeometry(robot(
      "<link name=\"arm\">" + box + collision("<capsule radius=\"1\" length=\"2\"/>") + box + "</link>"));
  ASSERT_EQ(found.problems.size(), 1u);
  for (const std::string word : {"digger", "arm", "from 2 on", "expected"}) {
    EXPECT_NE(found.problems[0].find(word), std::string::npos) << found.problems[0];
  }
  ASSERT_EQ(found.links.size(), 1u);
  EXPECT_EQ(found.links[0].mesh.triangles.size(), 12u);
}

TEST(RobotLinks, whatIsNoUrdfIsRefused) {
  for (const std::string& text : {std::string(), std::string("no XML"), std::string("<robot"),
                                  std::string("<house/>"), std::string("<robot name=\"empty\"/>")}) {
    EXPECT_EQ(messageOf(text).rfind("robot_description: ", 0), 0u) << text << " gave " << messageOf(text);
  }
}

TEST(RobotLinks, elementsTooDeepForTheParsersStackAreRefused) {
  std::string deep;
  for (int depth = 0; depth < 200000; ++depth) deep += "<a>";
  EXPECT_NE(messageOf(robot(deep)).find("robot_description: elements within more than"), std::string::npos)
      << messageOf(robot(deep));
}

TEST(RobotLinks, namesOfAnyLengthAndLettersMakeProblemsOfALine) {
  const std::string name = "a&#10;" + std::string(1000000, 'x');
  const RobotGeometry found = collisionGeometry(
      robot("<link name=\"" + name + "\">" + collision("<sphere radius=\"0\"/>") + "</link>"));
  ASSERT_EQ(found.problems.size(), 1u);
  EXPECT_LT(found.problems[0].size(), 3000u);
  EXPECT_EQ(found.problems[0].find('\n'), std::string::npos);
}

TEST(RobotLinks, devicesAreNoMeshes) {
  // Of these, one never ends, and one waits for ever.
  const std::string pipe = "/tmp/shallow_sand_pipe_" + std::to_string(getpid());
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  for (const std::string& uri :
       {std::string("/dev/zero"), std::string("file:///dev/zero"), std::string("file:///dev%2Fzero"), pipe,
        "file://" + pipe, std::string("file://") + std::string(10000, 'x'),
        std::string("file:///") + std::string(10000, 'x')}) {
    EXPECT_THROW(readMesh(uri, Eigen::Vector3d::Ones()), InvalidParameter) << uri;
  }
  std::remove(pipe.c_str());
}

TEST(RobotLinks, addressesOfFilesMayBeWrittenInCode) {
  const TemporaryFile file(" %41.stl", boxAsStl());
  std::string coded = file.uri();
  EXPECT_EQ(readMesh(coded, Eigen::Vector3d::Ones()).triangles.size(), 12u);
  coded.replace(coded.find(' '), 1, "%20");
  coded.replace(coded.find("%41"), 3, "%2541");
  EXPECT_EQ(readMesh(coded, Eigen::Vector3d::Ones()).triangles.size(), 12u);
}

}  // namespace
}  // namespace shallow_sand
