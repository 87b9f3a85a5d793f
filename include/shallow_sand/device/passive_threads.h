#pragma once

namespace shallow_sand {

/// Starts the program anew with OMP_WAIT_POLICY=passive unless the user has set that variable: OpenMP reads
/// it before main. Threads that spin while they wait take the cores from the rest of a robot's stack, and
/// from each other: two such threads beside other busy processes ran 25 times slower than one. Call it first
/// in main.
void waitPassively(char** arguments);

}  // namespace shallow_sand
