#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>

#include "shallow_sand/bodies/distance_field.h"

namespace shallow_sand {

/// Sampled meshes on disk, found by what they were made from. Several programs may use one folder at once.
class FieldCache {
 public:
  /// @param most_bytes that all files together may have
  explicit FieldCache(std::filesystem::path folder, std::uintmax_t most_bytes = std::uintmax_t{1} << 30)
      : folder_(std::move(folder)), most_bytes_(most_bytes) {}

  /// Nothing if it is not there or not as it was written.
  std::optional<SampledMesh> load(const std::string& key) const;
  /// Writes a file of its own, then gives it its name; removes the files that were used longest ago when all
  /// together are too large, but not the one just written. @return what went wrong; empty if nothing did
  std::string store(const std::string& key, const SampledMesh& sampled) const;

 private:
  std::filesystem::path fileOf(const std::string& key) const;
  void makeRoom(const std::filesystem::path& kept) const;
  std::filesystem::path folder_;
  std::uintmax_t most_bytes_;
};

/// A name for everything that a sampled mesh depends on: the same for the same bits only.
std::string cacheKey(const TriangleMesh& mesh, const Sampling& sampling);

}  // namespace shallow_sand
