#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <list>
#include <map>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "field_cache.h"
#include "random_fields.h"
#include "random_seed.h"
#include "temporary_folder.h"

namespace shallow_sand {
namespace {

namespace fs = std::filesystem;

constexpr int kMostSamples = 9;
/// Samples, key, seal and a few numbers.
constexpr std::uintmax_t largestFile(int samples) {
  return static_cast<std::uintmax_t>(samples * samples * samples) * sizeof(float) + 200;
}
constexpr std::uintmax_t kLargestFile = largestFile(kMostSamples);

/// `most` samples along each axis, or down to half of that.
SampledMesh randomSampled(std::mt19937& random, int most = kMostSamples) {
  SampledMesh sampled;
  std::size_t count = 1;
  for (int& samples : sampled.field.samples) {
    samples = randomCount(random, (most + 1) / 2, most);
    count *= static_cast<std::size_t>(samples);
  }
  sampled.field.spacing = uniform(random, 0.001, 1.0);
  sampled.field.origin = {uniform(random, -1.0, 1.0), uniform(random, -1.0, 1.0), uniform(random, -1.0, 1.0)};
  for (std::size_t i = 0; i < count; ++i)
    sampled.field.distance.push_back(static_cast<float>(uniform(random, -1.0, 1.0)));
  sampled.thickened = uniform(random, 0.0, 1.0);
  sampled.doubtful = uniform(random, 0.0, 1.0);
  sampled.open_edges = uniform(random, 0.0, 10.0);
  return sampled;
}

bool same(const SampledMesh& a, const SampledMesh& b) {
  return a.field.samples == b.field.samples && a.field.spacing == b.field.spacing &&
         a.field.origin == b.field.origin && a.field.distance == b.field.distance &&
         a.thickened == b.thickened && a.doubtful == b.doubtful && a.open_edges == b.open_edges;
}

std::string contentOf(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

void overwrite(const fs::path& path, const std::string& content) {
  std::ofstream(path, std::ios::binary) << content;
}

/// Every file of the cache becomes older, so that what is used next is newer than all others for certain: a
/// file system counts time in ticks.
void letTimePass(const fs::path& folder) {
  for (const auto& entry : fs::directory_iterator(folder))
    fs::last_write_time(entry.path(), entry.last_write_time() - std::chrono::hours(1));
}

/// Names of the cache's files; the rest are others'.
std::set<std::string> keysIn(const fs::path& folder) {
  std::set<std::string> keys;
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (entry.path().extension() == ".field") keys.insert(entry.path().stem().string());
  }
  return keys;
}

std::uintmax_t bytesIn(const fs::path& folder) {
  std::uintmax_t sum = 0;
  for (const std::string& key : keysIn(folder)) sum += fs::file_size(folder / (key + ".field"));
  return sum;
}

/// Random loads and stores beside a list in the order of use, which is what the policy says.
TEST(FieldCache, removesWhatWasUsedLongestAgo) {
  std::mt19937 random = seededGenerator();
  int removals = 0;
  for (int repeat = 0; repeat < 5; ++repeat) {
    const TemporaryFolder folder;
    const std::uintmax_t most = kLargestFile * static_cast<unsigned>(randomCount(random, 1, 3));
    const FieldCache cache(folder.path(), most);
    const std::string others(most + 1, 'x');
    overwrite(folder.path() / "others.txt", others);
    std::list<std::string> by_use;  // the latest first
    std::map<std::string, SampledMesh> stored;
    for (int i = 0; i < 100; ++i) {
      const std::string key = "key" + std::to_string(random() % 12);
      const bool known = std::find(by_use.begin(), by_use.end(), key) != by_use.end();
      if (random() % 2 == 0) {
        const std::optional<SampledMesh> loaded = cache.load(key);
        ASSERT_EQ(loaded.has_value(), known);
        if (!known) continue;
        EXPECT_TRUE(same(*loaded, stored[key]));
        by_use.remove(key);
        by_use.push_front(key);
      } else {
        stored[key] = randomSampled(random);
        const std::uintmax_t before = fs::exists(folder.path() / (key + ".field"))
                                          ? fs::file_size(folder.path() / (key + ".field"))
                                          : 0;
        std::map<std::string, std::uintmax_t> sizes;
        std::uintmax_t total = bytesIn(folder.path()) - before;
        for (const std::string& other : by_use)
          sizes[other] = fs::file_size(folder.path() / (other + ".field"));
        ASSERT_EQ(cache.store(key, stored[key]), "");
        total += fs::file_size(folder.path() / (key + ".field"));
        by_use.remove(key);
        by_use.push_front(key);
        while (total > most) {
          total -= sizes[by_use.back()];
          by_use.pop_back();
          ++removals;
        }
      }
      ASSERT_EQ(keysIn(folder.path()), std::set<std::string>(by_use.begin(), by_use.end()));
      EXPECT_LE(bytesIn(folder.path()), most);
      letTimePass(folder.path());
    }
    EXPECT_EQ(contentOf(folder.path() / "others.txt"), others);
  }
  EXPECT_GT(removals, 0);
}

/// Also where all others seem newer: another machine's clock, or one that was put back.
TEST(FieldCache, neverRemovesWhatItHasJustWritten) {
  std::mt19937 random = seededGenerator();
  const TemporaryFolder folder;
  const FieldCache cache(folder.path(), 2 * kLargestFile);
  for (int i = 0; i < 30; ++i) {
    const std::string key = "key" + std::to_string(i);
    const SampledMesh sampled = randomSampled(random);
    ASSERT_EQ(cache.store(key, sampled), "");
    const std::optional<SampledMesh> loaded = cache.load(key);
    ASSERT_TRUE(loaded.has_value());
    EXPECT_TRUE(same(*loaded, sampled));
    EXPECT_LE(bytesIn(folder.path()), 2 * kLargestFile);
    for (const auto& entry : fs::directory_iterator(folder.path()))
      fs::last_write_time(entry.path(), fs::file_time_type::clock::now() +
                                            std::chrono::minutes(randomCount(random, 1, 1000)));
  }
  EXPECT_LT(keysIn(folder.path()).size(), 30u);
}

TEST(FieldCache, doesNotUseASpoiltFile) {
  std::mt19937 random = seededGenerator();
  const TemporaryFolder folder;
  const FieldCache cache(folder.path());
  const fs::path file = folder.path() / "key.field";
  for (int repeat = 0; repeat < 100; ++repeat) {
    const SampledMesh sampled = randomSampled(random);
    ASSERT_EQ(cache.store("key", sampled), "");
    const std::string whole = contentOf(file);
    ASSERT_LE(whole.size(), kLargestFile);
    std::string spoilt = whole;
    switch (repeat % 5) {
      case 0:
        spoilt.resize(random() % whole.size());
        break;
      case 1: {
        char& byte = spoilt[random() % whole.size()];
        byte = static_cast<char>(byte ^ (1 << random() % 8));
        break;
      }
      case 2:
        spoilt += spoilt.substr(0, 1 + random() % whole.size());
        break;
      case 3:  // a file system that has lost a page
        std::fill(spoilt.begin() + static_cast<std::ptrdiff_t>(random() % whole.size()), spoilt.end(), '\0');
        break;
      default:  // whole, but of another mesh
        ASSERT_EQ(cache.store("kez", randomSampled(random)), "");
        spoilt = contentOf(folder.path() / "kez.field");
    }
    overwrite(file, spoilt);
    letTimePass(folder.path());
    const fs::file_time_type time = fs::last_write_time(file);
    EXPECT_FALSE(cache.load("key").has_value()) << "case " << repeat % 5;
    EXPECT_EQ(fs::last_write_time(file), time) << "counts as used";
    ASSERT_EQ(cache.store("key", sampled), "");
    const std::optional<SampledMesh> loaded = cache.load("key");
    ASSERT_TRUE(loaded.has_value());
    EXPECT_TRUE(same(*loaded, sampled));
  }
}

/// What several write and remove at once is there whole or not at all.
TEST(FieldCache, isSharedByManyAtOnce) {
  std::mt19937 random = seededGenerator();
  const TemporaryFolder folder;
  constexpr int samples = 30;  // so large that it is neither written nor read in one go
  constexpr std::uintmax_t most = 3 * largestFile(samples);
  std::vector<SampledMesh> fields;
  for (int i = 0; i < 8; ++i) fields.push_back(randomSampled(random, samples));
  std::vector<std::thread> threads;
  for (int i = 0; i < 4; ++i) {
    threads.emplace_back([&, own = std::mt19937(random())]() mutable {
      const FieldCache cache(folder.path(), most);
      for (int step = 0; step < 50; ++step) {
        const std::size_t which = own() % fields.size();
        const std::string key = "key" + std::to_string(which);
        // Others may need the room before the file has its name: then it tells so.
        if (own() % 2 == 0) cache.store(key, fields[which]);
        const std::optional<SampledMesh> loaded = cache.load(key);
        EXPECT_TRUE(!loaded || same(*loaded, fields[which]));
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  // Whoever looked last saw all files.
  EXPECT_LE(bytesIn(folder.path()), most);
  for (const std::string& key : keysIn(folder.path())) EXPECT_EQ(key.find('.'), std::string::npos) << key;
}

}  // namespace
}  // namespace shallow_sand
