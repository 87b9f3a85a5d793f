#include <benchmark/benchmark.h>

#include <algorithm>
#include <memory>
#include <random>

#include "benchmark/maps.h"
#include "benchmark/run_benchmarks.h"
#include "benchmark/timing.h"
#include "shallow_sand/bodies/distance_field.h"
#include "shallow_sand/core/moved_volume.h"

/// What bodies add to the cost of a step, and what it costs to ask what they do; see README.md here. The same
/// sand runs by turns with and without bodies, so that what else a machine does falls on both.
namespace shallow_sand {
namespace {

constexpr double kStep = 0.001;  ///< short enough for the waves of a sloshing map [s]
constexpr double kFrame = 10.0 * kStep;
constexpr double kSurface = 1.0;  ///< mean elevation of a sloshing map's surface [m]

/// Sand without friction in which every cell moves, or sand that only the links move; every cell is computed.
/// In steps of one length.
Map computedMap(int side, bool moving) {
  Map map = moving ? sloshingSand(side, 1) : restingSand(side, 1, Edge::wall);
  if (!moving) map.depth.assign(map.depth.size(), static_cast<float>(kSurface));
  map.parameters.solver.fixed_step = kStep;
  map.parameters.sleeping = moving;
  return map;
}

/// Boxes as large as the links of a robot, at random places of a square in the middle of the map, that swing
/// to and fro and turn: half of each in the sand, or all just above it.
class Links {
 public:
  Links(Simulator& simulator, int count, double square, bool in_sand) : simulator_(simulator) {
    std::mt19937 random(1);
    const auto uniform = [&](double low, double high) {
      return std::uniform_real_distribution<double>(low, high)(random);
    };
    const Grid& grid = simulator.grid();
    const double middle = 0.5 * grid.columns * static_cast<double>(grid.spacing);
    for (int k = 0; k < count; ++k) {
      const double length = uniform(0.1, 0.4);
      const double height = uniform(0.1, 0.2);
      const TriangleMesh mesh = triangulate(Box{{length, uniform(0.1, 0.2), height}});
      simulator.addBody("link", std::make_shared<const DistanceField>(computeDistanceField(mesh, 0.01)));
      const double x = middle + uniform(-0.5, 0.5) * square;
      const double y = middle + uniform(-0.5, 0.5) * square;
      const double above = in_sand ? uniform(-0.05, 0.05) : 0.5 * height + grid.spacing;
      places_.emplace_back(x, y, kSurface + above);
      headings_.push_back(uniform(-M_PI, M_PI));
    }
    tell(0.0);
  }

  /// Where the links will be at the end of the next frame.
  void tellNextFrame() { tell(simulator_.time() + kFrame); }

 private:
  void tell(double time) {
    constexpr double kSwing = 0.1;  // [m]
    for (std::size_t k = 0; k < places_.size(); ++k) {
      const double phase = 2.0 * time + headings_[k];
      const Eigen::Vector3d place = places_[k] + kSwing * Eigen::Vector3d(std::sin(phase), 0.0, 0.0);
      simulator_.appendPose(
          k, time,
          Eigen::Translation3d(place) * Eigen::AngleAxisd(std::sin(phase), Eigen::Vector3d::UnitZ()));
    }
  }

  Simulator& simulator_;
  std::vector<Eigen::Vector3d> places_;
  std::vector<double> headings_;
};

/// `square`: side of the square that holds all links, of the map's. [%]
void coupling(benchmark::State& state) {
  const Map map = computedMap(static_cast<int>(state.range(0)), state.range(3) != 0);
  Simulator with = map.simulator();
  Simulator without = map.simulator();
  const double size = map.parameters.grid.size.x();
  Links links(with, static_cast<int>(state.range(1)), 0.01 * static_cast<double>(state.range(2)) * size,
              state.range(4) != 0);
  Timing coupled;
  Timing alone;
  const double steps = kFrame / kStep;
  for (auto _ : state) {
    links.tellNextFrame();
    const double seconds = secondsOf([&] { with.advance(kFrame); });
    state.SetIterationTime(seconds);
    coupled.add(seconds, steps);
    alone.add(secondsOf([&] { without.advance(kFrame); }), steps);
  }
  state.counters["coupling_over_step"] = coupled.best() / alone.best() - 1.0;
  state.counters["typical_coupling_over_step"] = coupled.typical() / alone.typical() - 1.0;
  state.counters["step_ms"] = 1e3 * alone.best();
  state.counters["coupled_step_ms"] = 1e3 * coupled.best();
  state.counters["moving"] = static_cast<double>(with.activeCells());
}

/// Of what the links do to the sand, on the host: figures of all of them, and the volume that was moved.
void contacts(benchmark::State& state) {
  const Map map = computedMap(static_cast<int>(state.range(0)), false);
  Simulator simulator = map.simulator();
  const double size = map.parameters.grid.size.x();
  Links links(simulator, static_cast<int>(state.range(1)), 0.01 * static_cast<double>(state.range(2)) * size,
              true);
  links.tellNextFrame();
  simulator.advance(kFrame);
  const Fields fields = simulator.fields();
  for (auto _ : state) {
    benchmark::DoNotOptimize(simulator.contacts(fields));
    benchmark::DoNotOptimize(movedVolume(simulator.grid(), map.depth, fields));
  }
  state.counters["fields_ms"] = 1e3 * secondsOf([&] { benchmark::DoNotOptimize(simulator.fields()); });
}

void registerAll() {
  benchmark::internal::Benchmark* coupled = benchmark::RegisterBenchmark("coupling", coupling)
                                                ->ArgNames({"side", "bodies", "square", "moving", "in_sand"});
  withProduct(coupled, {{512}, {50}, {25, 90}, {0}, {0, 1}});
  withProduct(coupled, {{512}, {50}, {25, 90}, {1}, {1}});
  withProduct(coupled, {{1024}, {200}, {90}, {0, 1}, {1}});
  coupled->Args({64, 2, 50, 1, 1})->UseManualTime()->Unit(benchmark::kMillisecond);
  withProduct(benchmark::RegisterBenchmark("contacts", contacts)->ArgNames({"side", "bodies", "square"}),
              {{512}, {0, 50}, {25, 90}})
      ->Args({1024, 200, 90})
      ->Args({64, 2, 50})
      ->Unit(benchmark::kMillisecond);
}

}  // namespace
}  // namespace shallow_sand

int main(int argc, char** argv) {
  return shallow_sand::runBenchmarks({argv, argv + argc}, shallow_sand::registerAll);
}
