#pragma once

namespace shallow_sand {

/// Threads of a block on the GPU, in a rectangle of cells: a warp is a row.
constexpr int kBlockColumns = 32;
constexpr int kBlockRows = 4;
constexpr int kBlockThreads = kBlockColumns * kBlockRows;

}  // namespace shallow_sand
