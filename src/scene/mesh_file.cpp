#include "shallow_sand/scene/mesh_file.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cctype>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>

#include "shallow_sand/core/parameters.h"
#include "shallow_sand/core/replace_file.h"

/// By hand: the PLY exporter of assimp 5 announces bytes for colours and writes floats.
namespace shallow_sand {
namespace {

namespace fs = std::filesystem;

std::string suffixOf(const std::string& path) {
  std::string suffix = fs::path(path).extension().string();
  std::transform(suffix.begin(), suffix.end(), suffix.begin(),
                 [](unsigned char letter) { return static_cast<char>(std::tolower(letter)); });
  return suffix;
}

/// Numbers in little-endian order, as both formats have them.
class BinaryFile {
 public:
  explicit BinaryFile(const fs::path& path) : file_(path, std::ios::binary) {}

  void text(const std::string& value) {
    file_.write(value.data(), static_cast<std::streamsize>(value.size()));
  }
  void byte(std::uint32_t value) { file_.put(static_cast<char>(value)); }
  void integer(std::uint32_t value) {
    const char bytes[]{static_cast<char>(value), static_cast<char>(value >> 8),
                       static_cast<char>(value >> 16), static_cast<char>(value >> 24)};
    file_.write(bytes, sizeof bytes);
  }
  void vector(const Eigen::Vector3f& value) {
    for (const float coordinate : {value.x(), value.y(), value.z()}) {
      std::uint32_t bits;
      std::memcpy(&bits, &coordinate, sizeof bits);
      integer(bits);
    }
  }
  /// Whether all of it has been written.
  bool close() {
    file_.close();
    return static_cast<bool>(file_);
  }

 private:
  std::ofstream file_;
};

void writeStl(const SurfaceMesh& mesh, BinaryFile& file) {
  std::string header = "shallow_sand";
  header.resize(80, ' ');
  file.text(header);
  file.integer(static_cast<std::uint32_t>(mesh.triangles()));
  mesh.forEachTriangle([&](const SurfaceMesh::Triangle& triangle) {
    const Eigen::Vector3d& a = mesh.positions[triangle[0]];
    const Eigen::Vector3d& b = mesh.positions[triangle[1]];
    const Eigen::Vector3d& c = mesh.positions[triangle[2]];
    file.vector((b - a).cross(c - a).normalized().cast<float>());
    for (const Eigen::Vector3d* corner : {&a, &b, &c}) file.vector(corner->cast<float>());
    file.byte(0);
    file.byte(0);
  });
}

void writePly(const SurfaceMesh& mesh, BinaryFile& file) {
  std::ostringstream header;
  header << "ply\nformat binary_little_endian 1.0\ncomment shallow_sand, metres\nelement vertex "
         << mesh.positions.size();
  // Colours go first: assimp, so rviz, too, cannot read a file whose numbers begin with a byte 10, as those
  // of x = 0.01 do. No colour is that dark.
  for (const char* name : {"red", "green", "blue"}) header << "\nproperty uchar " << name;
  for (const char* name : {"x", "y", "z", "nx", "ny", "nz"}) header << "\nproperty float " << name;
  header << "\nelement face " << mesh.triangles() << "\nproperty list uchar int vertex_indices\nend_header\n";
  file.text(header.str());
  for (std::size_t vertex = 0; vertex < mesh.positions.size(); ++vertex) {
    const Eigen::Vector3f colour = mesh.colour(vertex);
    for (const float channel : {colour.x(), colour.y(), colour.z()})
      file.byte(static_cast<std::uint32_t>(255.0f * channel + 0.5f));
    file.vector(mesh.positions[vertex].cast<float>());
    file.vector(mesh.normals[vertex]);
  }
  mesh.forEachTriangle([&](const SurfaceMesh::Triangle& triangle) {
    file.byte(3);
    for (const std::uint32_t corner : triangle) file.integer(corner);
  });
}

}  // namespace

void requireMeshSuffix(const std::string& key, const std::string& path) {
  const std::string suffix = suffixOf(path);
  if (suffix != ".stl" && suffix != ".ply")
    throw InvalidParameter(key, path, "a file that ends in .stl or .ply");
}

void writeMesh(const std::string& path, const SurfaceMesh& mesh) {
  requireMeshSuffix("mesh", path);
  replaceFile(path, [&](const fs::path& part) {
    BinaryFile file(part);
    suffixOf(path) == ".stl" ? writeStl(mesh, file) : writePly(mesh, file);
    if (!file.close()) throw std::runtime_error(path + ": cannot be written");
  });
}

}  // namespace shallow_sand
