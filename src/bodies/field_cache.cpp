#include "field_cache.h"

#include <algorithm>
#include <boost/uuid/name_generator_sha1.hpp>
#include <boost/uuid/uuid_io.hpp>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <iterator>
#include <system_error>
#include <type_traits>
#include <vector>

#include "shallow_sand/core/replace_file.h"

namespace shallow_sand {
namespace {

namespace fs = std::filesystem;

/// Of the file's layout and of how fields are computed: raise it when one of them changes.
constexpr std::uint32_t kVersion = 4;
const char kEnding[] = ".field";
constexpr std::size_t kNameLength = 36;  ///< of a UUID as text

std::string nameOf(const std::string& bytes) {
  return boost::uuids::to_string(boost::uuids::name_generator_sha1(boost::uuids::ns::oid())(bytes));
}

template <typename Value>
void put(std::string& bytes, const Value* values, std::size_t count) {
  static_assert(std::is_trivially_copyable<Value>::value, "written as it lies in memory");
  bytes.append(reinterpret_cast<const char*>(values), count * sizeof(Value));
}

/// Takes values from the front of a text; everything is zero once it is too short.
class Taker {
 public:
  explicit Taker(const std::string& bytes) : bytes_(bytes) {}

  template <typename Value>
  void take(Value* values, std::size_t count) {
    static_assert(std::is_trivially_copyable<Value>::value, "read as it lies in memory");
    const std::size_t size = count * sizeof(Value);
    if (size > left()) {
      short_ = true;
      return;
    }
    std::memcpy(values, bytes_.data() + at_, size);
    at_ += size;
  }
  std::size_t left() const { return bytes_.size() - at_; }
  bool tookAll() const { return !short_ && left() == 0; }

 private:
  const std::string& bytes_;
  std::size_t at_ = 0;
  bool short_ = false;
};

std::string written(const std::string& key, const SampledMesh& sampled) {
  std::string bytes;
  put(bytes, &kVersion, 1);
  bytes += key;
  put(bytes, sampled.field.samples.data(), 3);
  put(bytes, &sampled.field.spacing, 1);
  put(bytes, sampled.field.origin.data(), 3);
  put(bytes, &sampled.thickened, 1);
  put(bytes, &sampled.doubtful, 1);
  put(bytes, &sampled.open_edges, 1);
  put(bytes, sampled.field.distance.data(), sampled.field.distance.size());
  return bytes + nameOf(bytes);
}

std::optional<SampledMesh> readBack(std::string bytes, const std::string& key) {
  if (bytes.size() < kNameLength) return std::nullopt;
  const std::string seal = bytes.substr(bytes.size() - kNameLength);
  bytes.resize(bytes.size() - kNameLength);
  if (nameOf(bytes) != seal) return std::nullopt;
  Taker taker(bytes);
  std::uint32_t version = 0;
  std::string found_key(key.size(), ' ');
  SampledMesh sampled;
  taker.take(&version, 1);
  taker.take(&found_key[0], found_key.size());
  taker.take(sampled.field.samples.data(), 3);
  taker.take(&sampled.field.spacing, 1);
  taker.take(sampled.field.origin.data(), 3);
  taker.take(&sampled.thickened, 1);
  taker.take(&sampled.doubtful, 1);
  taker.take(&sampled.open_edges, 1);
  sampled.field.distance.resize(taker.left() / sizeof(float));
  taker.take(sampled.field.distance.data(), sampled.field.distance.size());
  if (version != kVersion || found_key != key || !taker.tookAll()) return std::nullopt;
  return sampled;
}

}  // namespace

std::string cacheKey(const TriangleMesh& mesh, const Sampling& sampling) {
  std::string bytes;
  put(bytes, &kVersion, 1);
  put(bytes, &sampling.spacing, 1);
  put(bytes, &sampling.least_thickness, 1);
  const std::uint64_t vertices = mesh.vertices.size();
  put(bytes, &vertices, 1);
  for (const Eigen::Vector3d& vertex : mesh.vertices) put(bytes, vertex.data(), 3);
  put(bytes, mesh.triangles.data(), mesh.triangles.size());
  return nameOf(bytes);
}

fs::path FieldCache::fileOf(const std::string& key) const { return folder_ / (key + kEnding); }

std::optional<SampledMesh> FieldCache::load(const std::string& key) const {
  const fs::path path = fileOf(key);
  std::error_code error;
  if (!fs::is_regular_file(path, error) || fs::file_size(path, error) > most_bytes_) return std::nullopt;
  std::ifstream file(path, std::ios::binary);
  std::string bytes((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
  std::optional<SampledMesh> sampled = readBack(std::move(bytes), key);
  // The time tells makeRoom what is in use; a folder that is read only needs no room.
  if (sampled) fs::last_write_time(path, fs::file_time_type::clock::now(), error);
  return sampled;
}

std::string FieldCache::store(const std::string& key, const SampledMesh& sampled) const {
  std::error_code error;
  fs::create_directories(folder_, error);
  if (error) return folder_.string() + ": " + error.message();
  try {
    // What is left of a part that was not finished ends as files of the cache do, and is removed with them.
    replaceFile(fileOf(key), [&](const fs::path& part) {
      std::ofstream file(part, std::ios::binary);
      const std::string bytes = written(key, sampled);
      file.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
      file.close();
      if (!file) throw std::runtime_error("cannot be written");
    });
  } catch (const std::exception&) {
    return folder_.string() + " cannot be written";
  }
  makeRoom(fileOf(key));
  return "";
}

void FieldCache::makeRoom(const fs::path& kept) const {
  struct File {
    fs::file_time_type time;
    std::uintmax_t size;
    fs::path path;
  };
  std::vector<File> files;
  std::uintmax_t total = 0;
  std::error_code error;
  for (fs::directory_iterator entry(folder_, error), end; !error && entry != end; entry.increment(error)) {
    if (entry->path().extension() != kEnding) continue;
    // Another program may remove it meanwhile.
    std::error_code gone;
    const File file{entry->last_write_time(gone), entry->file_size(gone), entry->path()};
    if (gone) continue;
    total += file.size;
    // Its time may be older than that of others: clocks tick, differ between machines and are put back.
    if (file.path != kept) files.push_back(file);
  }
  std::sort(files.begin(), files.end(), [](const File& a, const File& b) { return a.time < b.time; });
  for (const File& file : files) {
    if (total <= most_bytes_) return;
    if (fs::remove(file.path, error)) total -= file.size;
  }
}

}  // namespace shallow_sand
