#include <gtest/gtest.h>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "random_fields.h"
#include "random_seed.h"
#include "shallow_sand/bodies/robot_links.h"
#include "shallow_sand/core/parameters.h"
#include "shallow_sand/scene/mesh_file.h"
#include "temporary_folder.h"

namespace shallow_sand {
namespace {

/// Sand, bare bed and loads.
SurfaceMesh randomMesh(std::mt19937& random) {
  const int columns = randomCount(random, 10, 40);
  const RandomSand sand = randomSand(random, columns, randomCount(random, 10, 40));
  const Grid grid = sand.parameters.grid.grid();
  Fields fields;
  fields.bed = sand.bed;
  fields.depth = sand.depth;
  fields.addLoads();
  const std::size_t middle = grid.index(grid.columns / 2, grid.rows / 2);
  for (const std::size_t cell : {middle, middle + 1, middle + static_cast<std::size_t>(grid.columns) + 1}) {
    fields.load[cell] = 0.1f;
    fields.load_elevation[cell] = 2.0f;
  }
  SurfaceMesh mesh = surfaceMesh(grid, fields);
  EXPECT_FALSE(mesh.loads.empty());
  return mesh;
}

std::vector<SurfaceMesh::Triangle> allTriangles(const SurfaceMesh& mesh) {
  std::vector<SurfaceMesh::Triangle> all = mesh.sand;
  all.insert(all.end(), mesh.bed.begin(), mesh.bed.end());
  all.insert(all.end(), mesh.loads.begin(), mesh.loads.end());
  return all;
}

/// Reads numbers off the bytes of a file.
class Bytes {
 public:
  explicit Bytes(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    bytes_.assign(std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>());
  }
  template <class T>
  T next() {
    T value{};
    if (at_ + sizeof value > bytes_.size()) throw std::runtime_error("the file is too short");
    std::memcpy(&value, bytes_.data() + at_, sizeof value);
    at_ += sizeof value;
    return value;
  }
  Eigen::Vector3f nextVector() {
    const float x = next<float>();
    const float y = next<float>();
    return {x, y, next<float>()};
  }
  std::string nextLine() {
    const std::size_t end = bytes_.find('\n', at_);
    if (end == std::string::npos) throw std::runtime_error("the file has no more lines");
    std::string line = bytes_.substr(at_, end - at_);
    at_ = end + 1;
    return line;
  }
  void skip(std::size_t count) { at_ += count; }
  bool atEnd() const { return at_ == bytes_.size(); }

 private:
  std::string bytes_;
  std::size_t at_ = 0;
};

class MeshFile : public ::testing::Test {
 protected:
  std::string path(const std::string& name) const { return (folder_.path() / name).string(); }
  std::size_t filesInFolder() const {
    return static_cast<std::size_t>(std::distance(std::filesystem::directory_iterator(folder_.path()), {}));
  }
  std::mt19937 random_ = seededGenerator();
  SurfaceMesh mesh_ = randomMesh(random_);

 private:
  TemporaryFolder folder_;
};

TEST_F(MeshFile, StlHoldsAllTriangles) {
  writeMesh(path("sand.stl"), mesh_);
  Bytes bytes(path("sand.stl"));
  bytes.skip(80);
  const std::vector<SurfaceMesh::Triangle> triangles = allTriangles(mesh_);
  ASSERT_EQ(bytes.next<std::uint32_t>(), triangles.size());
  for (const auto& triangle : triangles) {
    const Eigen::Vector3f normal = bytes.nextVector();
    EXPECT_NEAR(normal.norm(), 1.0f, 1e-5f);
    EXPECT_GT(normal.z(), 0.0f);
    Eigen::Vector3d along = Eigen::Vector3d::Zero();
    for (const std::uint32_t corner : triangle) {
      EXPECT_EQ(bytes.nextVector(), mesh_.positions[corner].cast<float>());
      along += mesh_.positions[corner] - mesh_.positions[triangle[0]];
    }
    EXPECT_NEAR(normal.cast<double>().dot(along.normalized()), 0.0, 1e-5);
    EXPECT_EQ(bytes.next<std::uint16_t>(), 0);
  }
  EXPECT_TRUE(bytes.atEnd());
}

TEST_F(MeshFile, PlyHoldsVerticesWithNormalsAndColours) {
  writeMesh(path("sand.ply"), mesh_);
  Bytes bytes(path("sand.ply"));
  const std::vector<SurfaceMesh::Triangle> triangles = allTriangles(mesh_);
  std::vector<std::string> header;
  do {
    const std::string line = bytes.nextLine();
    if (line.rfind("comment", 0) != 0) header.push_back(line);
  } while (header.back() != "end_header");
  const std::vector<std::string> expected{"ply",
                                          "format binary_little_endian 1.0",
                                          "element vertex " + std::to_string(mesh_.positions.size()),
                                          "property uchar red",
                                          "property uchar green",
                                          "property uchar blue",
                                          "property float x",
                                          "property float y",
                                          "property float z",
                                          "property float nx",
                                          "property float ny",
                                          "property float nz",
                                          "element face " + std::to_string(triangles.size()),
                                          "property list uchar int vertex_indices",
                                          "end_header"};
  ASSERT_EQ(header, expected);
  for (std::size_t vertex = 0; vertex < mesh_.positions.size(); ++vertex) {
    const Eigen::Vector3f colour = mesh_.colour(vertex);
    for (int channel = 0; channel < 3; ++channel)
      EXPECT_NEAR(bytes.next<std::uint8_t>(), 255.0f * colour[channel], 0.501f);
    EXPECT_EQ(bytes.nextVector(), mesh_.positions[vertex].cast<float>());
    EXPECT_EQ(bytes.nextVector(), mesh_.normals[vertex]);
  }
  for (const auto& triangle : triangles) {
    EXPECT_EQ(bytes.next<std::uint8_t>(), 3);
    for (const std::uint32_t corner : triangle) EXPECT_EQ(bytes.next<std::uint32_t>(), corner);
  }
  EXPECT_TRUE(bytes.atEnd());
}

/// By assimp, as rviz does.
void expectReadBack(const std::string& path, const SurfaceMesh& mesh) {
  const TriangleMesh read = readMesh("file://" + path, Eigen::Vector3d::Ones());
  const std::vector<SurfaceMesh::Triangle> triangles = allTriangles(mesh);
  ASSERT_EQ(read.triangles.size(), triangles.size());
  for (std::size_t k = 0; k < triangles.size(); ++k) {
    for (std::size_t corner = 0; corner < 3; ++corner) {
      const auto vertex = static_cast<std::size_t>(read.triangles[k][corner]);
      EXPECT_EQ(read.vertices[vertex].cast<float>(), mesh.positions[triangles[k][corner]].cast<float>());
    }
  }
}

TEST_F(MeshFile, OthersReadTheSameTriangles) {
  for (const std::string name : {"sand.stl", "sand.ply", "SAND.STL"}) {
    SCOPED_TRACE(name);
    writeMesh(path(name), mesh_);
    expectReadBack(path(name), mesh_);
  }
}

TEST_F(MeshFile, OthersReadAMeshThatBeginsAtACentimetre) {
  const Grid grid{3, 3, 0.02f, 0.0, 0.0};
  Fields fields;
  fields.bed.assign(grid.cells(), 0.0f);
  fields.depth.assign(grid.cells(), 0.3f);
  const SurfaceMesh mesh = surfaceMesh(grid, fields);
  writeMesh(path("centimetre.ply"), mesh);
  expectReadBack(path("centimetre.ply"), mesh);
}

TEST_F(MeshFile, TakesThePlaceOfAnOlderOneWhenItIsComplete) {
  std::ofstream(path("sand.ply")) << "an older one";
  writeMesh(path("sand.ply"), mesh_);
  EXPECT_EQ(Bytes(path("sand.ply")).nextLine(), "ply");
  EXPECT_EQ(filesInFolder(), 1u);
}

TEST_F(MeshFile, SaysWhatIsWrong) {
  for (const std::string name : {"sand.obj", "sand", "stl", ".ply", "sand.ply.gz"}) {
    try {
      requireMeshSuffix("--mesh", name);
      FAIL() << name;
    } catch (const InvalidParameter& error) {
      EXPECT_EQ(error.what(), "--mesh: " + name + "; expected a file that ends in .stl or .ply");
    }
    EXPECT_THROW(writeMesh(path(name), mesh_), InvalidParameter);
  }
  try {
    writeMesh("no_such_folder/sand.stl", mesh_);
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_EQ(std::string(error.what()).rfind("no_such_folder/sand.stl: ", 0), 0u) << error.what();
  }
  std::filesystem::create_directory(path("folder.stl"));
  EXPECT_THROW(writeMesh(path("folder.stl"), mesh_), std::runtime_error);
  EXPECT_EQ(filesInFolder(), 1u);
}

}  // namespace
}  // namespace shallow_sand
