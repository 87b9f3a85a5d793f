#include "shallow_sand/coupling/rays_together.h"

#include <limits>

namespace shallow_sand {

namespace {

constexpr int kSide = BodyBins::kSize;
constexpr int kLanes = 16;  ///< rays that march together

/// The rays that meet one body in a bin, on their way up as castRay has them.
class MarchingRays {
 public:
  MarchingRays(const BodyView& body, int number)
      : body_(body), rise_(RayInField::at(body, 0.0f, 0.0f).rise), of_body_{number, body.position.z} {}

  /// Adds the rays of a row of the bin.
  /// @param begin,j the row's first cell
  /// @param first number of the column above it
  void enter(const BodiesOverBed& bodies, int begin, int j, int first) {
    const float y = bodies.centre(j);
    if (y < body_.low.y || y > body_.high.y || bodies.centre(begin) > body_.high.x ||
        bodies.centre(begin + kSide - 1) < body_.low.x)
      return;
    // Also read beyond a window that ends within the bin, for which memory on the host has room.
    const float* bed = bodies.bed + bodies.cellAt(begin, j);
    int meets[kSide];
#pragma GCC ivdep
    for (int k = 0; k < kSide; ++k) {
      const float x = bodies.centre(begin + k);
      const float from = maximum(bed[k], body_.low.z);
      const RayInField ray = RayInField::at(body_, x, y);
      float z = from - body_.position.z;
      float to = body_.high.z - body_.position.z;
      ray.clip(body_.field, z, to);
      meets[k] = (x >= body_.low.x) & (x <= body_.high.x) & (from < body_.high.z) & (z < to);
      base_x_[count_ + k] = ray.base.x;
      base_y_[count_ + k] = ray.base.y;
      base_z_[count_ + k] = ray.base.z;
      next_z_[count_ + k] = z;
      to_[count_ + k] = to;
    }
    keep(meets, first);
  }

  void march(SolidIntervals* columns) {
    padWithRaysThatMiss();
    for (int first = 0; first < count_; first += kLanes) march(first, columns);
  }

 private:
  /// Moves those of the last rays that meet the body together.
  void keep(const int* meets, int first) {
    const int begin = count_;
    for (int k = 0; k < kSide; ++k) {
      base_x_[count_] = base_x_[begin + k];
      base_y_[count_] = base_y_[begin + k];
      base_z_[count_] = base_z_[begin + k];
      next_z_[count_] = next_z_[begin + k];
      to_[count_] = to_[begin + k];
      column_[count_] = first + k;
      count_ += meets[k];
    }
  }

  /// Such that have no way to go, and are nowhere in the body's field.
  void padWithRaysThatMiss() {
    for (int k = count_; k < count_ + kLanes; ++k) {
      base_x_[k] = -std::numeric_limits<float>::infinity();
      base_y_[k] = base_z_[k] = next_z_[k] = to_[k] = 0.0f;
    }
  }

  void march(int first, SolidIntervals* columns) {
    for (int k = first; k < first + kLanes; ++k) {
      z_[k] = bottom_[k] = next_z_[k];
      distance_[k] = body_.field.spacing;  // rays come from outside
    }
    do {
      if (sampleNext(first)) cross(first, columns);
    } while (climb(first));
    for (int k = first; k < first + kLanes; ++k) {
      if (sample(k).inside()) of_body_.add(bottom_[k], to_[k], columns[column_[k]]);
    }
  }

  /// Finds the next distances. Returns whether any ray crosses the body's surface. In two loops: of one, GCC
  /// makes a branch that it does not vectorise.
  bool sampleNext(int first) {
#pragma GCC ivdep
    for (int k = first; k < first + kLanes; ++k) {
      const Vector3 place = ray(k).placeAt(next_z_[k]);
      next_distance_[k] = body_.field.interpolateAt(place.x, place.y, place.z);
    }
    int any = 0;
#pragma GCC ivdep
    for (int k = first; k < first + kLanes; ++k) {
      const Vector3 place = ray(k).placeAt(next_z_[k]);
      const bool covered = body_.field.covers(place.x, place.y, place.z);
      next_distance_[k] = covered ? next_distance_[k] : body_.field.spacing;
      any |= sample(k).inside() != next(k).inside() ? 1 : 0;
    }
    return any != 0;
  }

  void cross(int first, SolidIntervals* columns) {
    for (int k = first; k < first + kLanes; ++k) {
      if (sample(k).inside() != next(k).inside())
        of_body_.cross(sample(k), next(k), bottom_[k], columns[column_[k]]);
    }
  }

  /// Goes on to the next heights; rays that are through stay. Returns whether any is not yet through.
  bool climb(int first) {
    int any = 0;
#pragma GCC ivdep
    for (int k = first; k < first + kLanes; ++k) {
      z_[k] = next_z_[k];
      distance_[k] = next_distance_[k];
      next_z_[k] = sample(k).nextZ(body_.field.spacing, to_[k]);
      any |= z_[k] < to_[k] ? 1 : 0;
    }
    return any != 0;
  }

  RayInField ray(int k) const { return {{base_x_[k], base_y_[k], base_z_[k]}, rise_}; }
  RaySample sample(int k) const { return {z_[k], distance_[k]}; }
  RaySample next(int k) const { return {next_z_[k], next_distance_[k]}; }

  static constexpr int kMost = kSide * kSide + kLanes;

  const BodyView& body_;
  Vector3 rise_;
  SolidsOfBody of_body_;
  int count_ = 0;
  int column_[kMost];  ///< where each stands in the bin, by rows
  alignas(64) float base_x_[kMost];
  alignas(64) float base_y_[kMost];
  alignas(64) float base_z_[kMost];
  alignas(64) float to_[kMost];
  alignas(64) float z_[kMost];
  alignas(64) float distance_[kMost];
  alignas(64) float bottom_[kMost];
  alignas(64) float next_z_[kMost];
  alignas(64) float next_distance_[kMost];
};

void castThrough(const BodyView& body, int number, const BodiesOverBed& bodies, const Window& cells,
                 SolidIntervals* columns) {
  MarchingRays rays(body, number);
  for (int j = cells.row_begin; j < cells.row_end; ++j)
    rays.enter(bodies, cells.column_begin, j, (j - cells.row_begin) * kSide);
  rays.march(columns);
}

// One source, compiled for each instruction set, as the step is (see tiled_stepper.cpp).
__attribute__((flatten)) void castBaseline(const BodyView& body, int number, const BodiesOverBed& bodies,
                                           const Window& cells, SolidIntervals* columns) {
  castThrough(body, number, bodies, cells, columns);
}
#ifdef __x86_64__
__attribute__((target("avx2"), flatten)) void castAvx2(const BodyView& body, int number,
                                                       const BodiesOverBed& bodies, const Window& cells,
                                                       SolidIntervals* columns) {
  castThrough(body, number, bodies, cells, columns);
}
__attribute__((target("avx512f,avx512vl,avx512dq,avx512bw"), flatten)) void castAvx512(
    const BodyView& body, int number, const BodiesOverBed& bodies, const Window& cells,
    SolidIntervals* columns) {
  castThrough(body, number, bodies, cells, columns);
}
#endif

auto castFor(InstructionSet instructions) {
#ifdef __x86_64__
  if (instructions == InstructionSet::avx2) return castAvx2;
  if (instructions == InstructionSet::avx512) return castAvx512;
#endif
  (void)instructions;
  return castBaseline;
}

}  // namespace

void RaysTogether::cast(const BodiesOverBed& bodies, int bin, SolidsOfBin& solids) const {
  const BodyBins& bins = bodies.bins;
  const auto castThroughBody = castFor(instructions_);
  for (int k = bins.first[bin]; k < bins.first[bin + 1]; ++k) {
    const int number = bins.members[k];
    castThroughBody(bins.bodies[number], number, bodies, bins.cellsOf(bin), solids.columns[0]);
  }
}

}  // namespace shallow_sand
