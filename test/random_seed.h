#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <iostream>
#include <random>
#include <string>

namespace shallow_sand {

/// A generator with a new seed in every run, told in the test's output and record. To repeat a run, set the
/// environment variable SHALLOW_SAND_SEED to that number.
inline std::mt19937 seededGenerator() {
  const char* chosen = std::getenv("SHALLOW_SAND_SEED");
  const auto seed = chosen == nullptr ? static_cast<std::mt19937::result_type>(std::random_device{}())
                                      : static_cast<std::mt19937::result_type>(std::stoul(chosen));
  std::cout << "SHALLOW_SAND_SEED=" << seed << std::endl;
  ::testing::Test::RecordProperty("SHALLOW_SAND_SEED", std::to_string(seed));
  return std::mt19937(seed);
}

}  // namespace shallow_sand
