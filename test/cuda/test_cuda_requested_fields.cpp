#include <gtest/gtest.h>

#include "parity.h"
#include "requested_fields.h"

namespace shallow_sand {
namespace {

using CudaRequestedFields = CudaTest;

TEST_F(CudaRequestedFields, AreThoseThatThereAreAndTheirChangesAreTold) {
  std::mt19937 random = seededGenerator();
  followRandomRuns(random, 3, {70, 20}, Backend::cuda);
}

}  // namespace
}  // namespace shallow_sand
