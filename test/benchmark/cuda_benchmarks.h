#pragma once

namespace shallow_sand {

/// How fast the GPU's step is, beside what bounds it: memory, launches and synchronisations of the grid; see
/// README.md here. @throws std::runtime_error with CUDA's own words
void registerCudaBenchmarks();

}  // namespace shallow_sand
