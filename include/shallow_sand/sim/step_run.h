#pragma once

#include <cstdint>

#include "shallow_sand/core/types.h"

namespace shallow_sand {

/// When a pour runs and how much it pours, or takes if the rate is negative.
struct PourTimes {
  double start;  ///< [s]
  double stop;   ///< [s]
  double rate;   ///< [m³/s]
};

struct Progress {
  std::uint64_t steps = 0;
  std::uint64_t cell_updates = 0;    ///< cells that were computed; those that sleep are not
  std::uint64_t repeated_steps = 0;  ///< attempts that proved too long for the speeds they met
  double last_step = 0.0;            ///< [s]
};

/// Bounds of a step's length.
struct StepBounds {
  double courant_way;  ///< that the fastest wave or body may go in a step: Courant number · ΔL [m]
  double longest;      ///< [s]
  double fixed;        ///< [s]; 0: steps are as long as the bounds let them be
};

/// Where a run of steps is, and how far it may go.
struct StepRun {
  /// Speeds are known only once a step has read them. A step is tried that is a little shorter than the bound
  /// at the step before, and is repeated in the rare case that speeds have grown by more.
  static constexpr double kHeadroom = 0.97;
  /// Columns by which sand gives way to a body in the time of a step: most of what waits under a body that
  /// comes down fast is inside of it.
  static constexpr int kHopsPerStep = 4;
  static constexpr int kMostStepsUnsorted = 4;  ///< in as many, waves travel a cell

  StepBounds bounds;
  double end;                ///< the run takes steps until then [s]
  const double* placed_at;   ///< when bodies are in each of their placements, ascending [s]
  int placements;            ///< 0: there are no bodies
  bool displacement;         ///< false: bodies drag the sand in every step
  std::uint64_t most_steps;  ///< the run stops after as many, however far it is

  double time;             ///< [s]
  double trial;            ///< length of the next step unless something forbids it [s]
  int placement;           ///< for which sand made way the last time; -1: for one before these
  int steps_since_placed;  ///< steps since then
  bool moved;              ///< sand has moved since it met bodies
  Progress progress;
  double too_long_for;  ///< bound that the fixed step breaks [s]; 0 if it breaks none

  /// Bodies are known no longer: the run stops after the step that goes beyond.
  SHALLOW_SAND_HOST_DEVICE bool placementsAreUsedUp() const {
    return placements > 0 && placement == placements - 1 && placed_at[placements - 1] < end;
  }
  SHALLOW_SAND_HOST_DEVICE bool goesOn() const {
    return time < end && too_long_for == 0.0 && progress.steps < most_steps && !placementsAreUsedUp();
  }
  /// Length of the next step; none is a sliver at the end, which roundings of the time would leave. [s]
  SHALLOW_SAND_HOST_DEVICE double nextStep() const {
    const double tried = trial < bounds.longest ? trial : bounds.longest;
    const double longest = bounds.fixed > 0.0 ? bounds.fixed : tried;
    return end - time <= longest * (1.0 + 1e-9) ? end - time : longest;
  }
  /// How long a step may be (Eq. 14, 34). [s]
  SHALLOW_SAND_HOST_DEVICE double boundFor(float speed) const {
    const double least = 1e-9;
    const double fastest = static_cast<double>(speed);
    return bounds.courant_way / (fastest > least ? fastest : least);
  }
  /// The last placement whose time has come. Bodies that drag the sand in every step are in the first whose
  /// time has not passed: there is none before it at the start.
  SHALLOW_SAND_HOST_DEVICE int placementNow() const {
    int now = placement;
    if (displacement) {
      while (now + 1 < placements && placed_at[now + 1] <= time) ++now;
      return now;
    }
    now = now < 0 ? 0 : now;
    while (now + 1 < placements && placed_at[now] < time) ++now;
    return now;
  }
  SHALLOW_SAND_HOST_DEVICE double timeAfterStep() const {
    const double step = nextStep();
    return step < end - time ? time + step : end;
  }
  /// What a pour brings in the next step. [m³]
  SHALLOW_SAND_HOST_DEVICE double volumeOf(const PourTimes& pour) const {
    const double after = timeAfterStep();
    const double from = time > pour.start ? time : pour.start;
    const double to = after < pour.stop ? after : pour.stop;
    return to > from ? (to - from) * pour.rate : 0.0;
  }
  /// Whether bodies are placed anew now. Those that drag the sand are after every step.
  SHALLOW_SAND_HOST_DEVICE bool placesBodies() const {
    return moved && placements > 0 && (!displacement || placementNow() > placement);
  }
  SHALLOW_SAND_HOST_DEVICE bool sortsSand() const {
    return moved && placements > 0 && !placesBodies() && steps_since_placed % kMostStepsUnsorted == 0;
  }

  /// The next step was tried, and had to follow a speed that does not allow for it.
  SHALLOW_SAND_HOST_DEVICE void shorten(float speed) {
    if (bounds.fixed > 0.0) {
      too_long_for = boundFor(speed);
      return;
    }
    trial = kHeadroom * boundFor(speed);
    progress.repeated_steps += 1;
  }
  /// The next step was taken.
  SHALLOW_SAND_HOST_DEVICE void stepTaken(float speed, long long cells) {
    progress.last_step = nextStep();
    progress.steps += 1;
    progress.cell_updates += static_cast<std::uint64_t>(cells);
    time = timeAfterStep();
    trial = kHeadroom * boundFor(speed);
    steps_since_placed += placements > 0 ? 1 : 0;
    moved = true;
  }
  SHALLOW_SAND_HOST_DEVICE void bodiesMet() {
    if (placesBodies()) {
      placement = placementNow();
      steps_since_placed = 0;
    }
    moved = false;
  }
};

/// Takes a step. `sand` is that of a backend; see takeSteps.
template <class Sand>
SHALLOW_SAND_HOST_DEVICE void takeStep(Sand& sand, StepRun& run) {
  float speed = 0.0f;
  for (int tries = 1;; ++tries) {
    speed = sand.attempt(static_cast<float>(run.nextStep()));
    if (tries == 2 || run.nextStep() <= run.boundFor(speed)) break;
    sand.once([&] { run.shorten(speed); });
    if (run.too_long_for > 0.0) return;
  }
  const long long cells = sand.accept();
  for (int k = 0; k < sand.pours(); ++k) {
    const double volume = run.volumeOf(sand.pourTimes(k));
    if (volume != 0.0) sand.pour(k, volume);
  }
  sand.once([&] { run.stepTaken(speed, cells); });
}

/// Sand makes way for bodies that have moved on, or is told apart anew.
template <class Sand>
SHALLOW_SAND_HOST_DEVICE void meetBodies(Sand& sand, StepRun& run) {
  const bool places = run.placesBodies();
  if (places || run.sortsSand()) {
    const int steps = places ? run.steps_since_placed : StepRun::kMostStepsUnsorted;
    sand.meetBodies(places, run.placementNow(), run.placement, StepRun::kHopsPerStep * steps);
  }
  if (run.moved) sand.once([&] { run.bodiesMet(); });
}

/// Takes the steps of a run; the same on every backend. What `sand` has to offer, in the order of a step:
/// - attempt(dt) computes it, any number of times; returns the largest speed that it has to follow [m/s]
/// - accept() makes the last attempt the state; returns how many cells that computed
/// - pours(), pourTimes(k), pour(k, volume)
/// - meetBodies(places, placement, before, hops) lets sand make way for bodies in a placement, those of
///   `before` being in its place until now, or only tells apart the sand under and on bodies
/// and once(function), which calls a function that changes the run: on a GPU, all threads are here.
template <class Sand>
SHALLOW_SAND_HOST_DEVICE void takeSteps(Sand& sand, StepRun& run) {
  for (;;) {
    meetBodies(sand, run);
    if (!run.goesOn()) return;
    takeStep(sand, run);
  }
}

}  // namespace shallow_sand
