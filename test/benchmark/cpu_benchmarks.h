#pragma once

namespace shallow_sand {

/// How fast the CPU's step is, beside what bounds it and what it is compared to; see README.md here.
void registerCpuBenchmarks();

}  // namespace shallow_sand
