#pragma once

#include <string>
#include <vector>

namespace shallow_sand {

/// Vector instructions of a CPU for which the step is compiled. All give the same bits.
enum class InstructionSet { baseline, avx2, avx512 };

/// "baseline", "avx2", "avx512".
std::string toString(InstructionSet set);

/// Those that this machine has, the fastest last; never empty.
std::vector<InstructionSet> instructionSets();

}  // namespace shallow_sand
