#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <functional>
#include <optional>

#include "random_grains.h"
#include "random_seed.h"
#include "shallow_sand/particles/grain_memory.h"
#include "shallow_sand/particles/grains_on_host.h"
#include "shallow_sand/solver/sand_constants.h"

/// Grains in flows that are given.
namespace shallow_sand {
namespace {

using Velocity = std::function<Eigen::Vector2d(double x, double y)>;

/// Sand a metre deep on cells a tenth of a metre long, with grains.
class GivenFlow {
 public:
  GivenFlow(int columns, int rows, const GrainParameters& grains, const Material& material = {})
      : parameters_(grains), start_(grainGrid(columns, rows, grains)) {
    const std::vector<float> none(start_.grid.cells(), 0.0f);
    fields_ = {none, std::vector<float>(start_.grid.cells(), 1.0f), none, none};
    sand_.sand = sandConstants(start_.grid, {0.0, 0.0, -9.81}, material);
    sand_.columns = columns;
    sand_.rows = rows;
    memory_.emplace(grains, start_.grid, startingGrains(start_.grains, start_.grid, fields_));
  }

  /// Relative to the corner of cell (0, 0). [m], [m/s]
  void set(const Velocity& velocity) {
    for (int j = 0; j < sand_.rows; ++j) {
      for (int i = 0; i < sand_.columns; ++i) {
        const Eigen::Vector2d here = velocity(grid().x(i), grid().y(j));
        fields_.momentum_x[grid().index(i, j)] = static_cast<float>(here.x());
        fields_.momentum_y[grid().index(i, j)] = static_cast<float>(here.y());
      }
    }
  }
  void open(bool is_open) { sand_.open = {is_open, is_open, is_open, is_open}; }

  GrainMove move(double duration) {
    sand_.in = {fields_.depth.data(),
                fields_.momentum_x.data(),
                fields_.momentum_y.data(),
                fields_.bed.data(),
                nullptr,
                nullptr,
                nullptr,
                nullptr};
    return memory_->move({{sand_}, {}, false}, static_cast<float>(duration), ++moves_);
  }
  void advance(double duration, int threads = 1) {
    moveGrains(HostExecutor(threads), move(duration), {Window::all(grid())});
  }

  Grains grains() const {
    Grains grains(parameters_, start_.grid);
    grains.moves = moves_;
    grains.cells = memory_->get();
    return grains;
  }
  const Grid& grid() const { return start_.grid; }
  double spacing() const { return static_cast<double>(start_.grains.spacing); }

 private:
  struct Start {
    Grid grid;
    GrainGrid grains;
  };
  static Start grainGrid(int columns, int rows, const GrainParameters& grains) {
    Grid grid;
    grid.columns = columns;
    grid.rows = rows;
    grid.spacing = 0.1f;
    return {grid, GrainGrid(grains, grid)};
  }

  GrainParameters parameters_;
  Start start_;
  Fields fields_;
  StepArguments sand_{};
  std::optional<GrainMemory<HostExecutor::Memory>> memory_;
  std::uint32_t moves_ = 0;
};

GrainParameters grainsOf(int per_cell, int layers) {
  GrainParameters grains;
  grains.per_cell = per_cell;
  grains.layers = layers;
  return grains;
}

/// A grain that was there at the start: where it was then, and where it is. [m]
struct Survivor {
  Eigen::Vector2d from;
  Eigen::Vector2d to;
};

std::vector<Survivor> survivorsOf(const Grains& grains) {
  std::vector<Survivor> survivors;
  const double spacing = static_cast<double>(grains.grid.spacing);
  const auto place = [&](std::size_t cell, const Grain& grain) {
    const std::size_t line = cell / grains.grid.columns;
    return Eigen::Vector2d(
        spacing * (static_cast<double>(cell % grains.grid.columns) + static_cast<double>(grain.x)),
        spacing * (static_cast<double>(line % grains.grid.rows) + static_cast<double>(grain.y)));
  };
  for (std::size_t k = 0; k < grains.cells.size(); ++k) {
    const Grain& grain = grains.cells[k];
    if (grain.born == 0)
      survivors.push_back({place(grain.origin, generatedGrain(grain.origin, 0, 0)), place(k, grain)});
  }
  return survivors;
}

TEST(GrainFlow, ByWholeCellsLosesNoGrainThatStaysInside) {
  std::mt19937 random = seededGenerator();
  for (int number = 0; number < 20; ++number) {
    const GrainParameters grains = randomGrains(random, 20);
    GivenFlow flow(randomCount(random, 10, 40), randomCount(random, 10, 20), grains);
    const int cells_x = randomCount(random, -4, 4);
    const int cells_y = randomCount(random, -4, 4);
    flow.set([&](double, double) { return Eigen::Vector2d(cells_x, cells_y); });
    // As long as rounding of the velocity turns no whole cell into less.
    const Grains start = flow.grains();
    if (grains.speed == GrainSpeed::dilute) continue;
    flow.advance(flow.spacing());
    const Grains end = flow.grains();
    expectValid(end);
    std::size_t stayed = 0;
    const GrainGrid& grid = start.grid;
    for (int d = 0; d < grid.layers; ++d) {
      for (int t = 1; t < grid.rows - 1; ++t) {
        for (int s = 1; s < grid.columns - 1; ++s) {
          const int s_after = s + cells_x;
          const int t_after = t + cells_y;
          if (s_after < 1 || t_after < 1 || s_after >= grid.columns - 1 || t_after >= grid.rows - 1) continue;
          const Grain& before = start.cells[grid.index(s, t, d)];
          // Offsets at the very end of a cell may be rounded out of it.
          if (std::min(before.x, before.y) < 1e-5f || std::max(before.x, before.y) > 1.0f - 1e-5f) continue;
          const Grain& after = end.cells[grid.index(s_after, t_after, d)];
          ASSERT_EQ(after.origin, before.origin) << cells_x << ", " << cells_y;
          ASSERT_EQ(after.born, 0u);
          ASSERT_NEAR(after.x, before.x, 1e-5);
          ASSERT_NEAR(after.y, before.y, 1e-5);
          ++stayed;
        }
      }
    }
    EXPECT_GT(stayed, 0u);
  }
}

/// However little it is, and from the very ends of a cell.
TEST(GrainFlow, BringsGrainsToPlacesInACell) {
  std::mt19937 random = seededGenerator();
  GivenFlow flow(20, 20, grainsOf(3, 1));
  for (int number = 0; number < 200; ++number) {
    const double size = std::pow(10.0, uniform(random, -12.0, 0.0));
    const double heading = uniform(random, 0.0, 2.0 * M_PI);
    flow.set([&](double, double) -> Eigen::Vector2d {
      return size * Eigen::Vector2d(std::cos(heading), std::sin(heading));
    });
    const GrainMove move = flow.move(flow.spacing());
    for (int j = 0; j < 20; ++j) {
      for (int i = 0; i < 20; ++i) move.findFlow(i, j);
    }
    for (const float x : {0.0f, 1e-9f, static_cast<float>(uniform(random, 0.1, 0.9)), kBelowOne}) {
      const GrainPlace place =
          move.flow.placeOf({x, 1.0f - x > kBelowOne ? kBelowOne : 1.0f - x, 0, 0}, 30, 30, 0);
      ASSERT_TRUE(place.x >= 0.0f && place.x < 1.0f && place.y >= 0.0f && place.y < 1.0f) << place.x;
      ASSERT_NEAR(place.s + static_cast<double>(place.x),
                  30.0 + static_cast<double>(x) + size * std::cos(heading), 1e-5);
    }
  }
}

/// Here and there a cell of the map moves; every grain to which Eq. 27 gives a velocity goes on, however far
/// it is from a tile in which something moves.
TEST(GrainFlow, MovesAllGrainsAroundACellThatMoves) {
  std::mt19937 random = seededGenerator();
  for (int number = 0; number < 20; ++number) {
    GivenFlow flow(80, 20, grainsOf(4, 1));
    std::vector<Eigen::Vector2d> velocities(80 * 20, Eigen::Vector2d::Zero());
    for (int k = 0; k < 8; ++k) {
      // Often in the corner of a tile.
      const int i = random() % 2 == 0 ? 32 * randomCount(random, 0, 2) : 32 * randomCount(random, 1, 2) - 1;
      const int j = random() % 2 == 0 ? 4 * randomCount(random, 0, 4) : randomCount(random, 0, 19);
      velocities[j * 80 + i] = {uniform(random, -1.0, 1.0), uniform(random, -1.0, 1.0)};
    }
    const auto cell = [](double place) { return static_cast<int>(place / 0.1); };
    flow.set([&](double x, double y) { return velocities[cell(y) * 80 + cell(x)]; });
    const Grains start = flow.grains();
    const double duration = 0.01 * flow.spacing();
    flow.advance(duration);
    const Grains end = flow.grains();
    const GrainMove move = flow.move(duration);
    for (int j = 0; j < 20; ++j) {
      for (int i = 0; i < 80; ++i) move.findFlow(i, j);
    }
    std::size_t went = 0;
    for (int t = 0; t < start.grid.rows; ++t) {
      for (int s = 0; s < start.grid.columns; ++s) {
        const Grain& before = start.cells[start.grid.index(s, t, 0)];
        const Grain& after = end.cells[start.grid.index(s, t, 0)];
        const GrainPlace place = move.flow.placeOf(before, s, t, 0);
        // Few leave their cells.
        if (after.origin != before.origin || after.born != 0 || place.s != s || place.t != t) continue;
        ASSERT_EQ(after.x, place.x) << s << ", " << t;
        ASSERT_EQ(after.y, place.y) << s << ", " << t;
        went += after.x != before.x ? 1 : 0;
      }
    }
    EXPECT_GT(went, 16u);
  }
}

TEST(GrainFlow, GivesNewGrainsTheOriginOfWhatWasUpstream) {
  std::mt19937 random = seededGenerator();
  std::size_t generated = 0;
  for (int number = 0; number < 10; ++number) {
    GivenFlow flow(20, 20, grainsOf(2, 2));
    const Eigen::Vector2d cells(uniform(random, -3.0, 3.0), uniform(random, -3.0, 3.0));
    flow.set([&](double, double) -> Eigen::Vector2d { return cells * flow.spacing(); });
    flow.advance(1.0);
    const Grains grains = flow.grains();
    for (int d = 0; d < 2; ++d) {
      for (int t = 4; t < grains.grid.rows - 4; ++t) {
        for (int s = 4; s < grains.grid.columns - 4; ++s) {
          const Grain& grain = grains.cells[grains.grid.index(s, t, d)];
          if (grain.born == 0) continue;
          const double x = s + static_cast<double>(grain.x) - cells.x();
          const double y = t + static_cast<double>(grain.y) - cells.y();
          // Too near to another cell to say.
          if (std::abs(x - std::round(x)) < 1e-4 || std::abs(y - std::round(y)) < 1e-4) continue;
          ASSERT_EQ(grain.origin, grains.grid.index(static_cast<int>(x), static_cast<int>(y), d));
          ++generated;
        }
      }
    }
  }
  EXPECT_GT(generated, 500u);
}

/// Of two grains that come close one is lost, but not ever more: who is left keeps its distance.
TEST(GrainFlow, KeepsManyGrainsOnALongWayAndTheirPathsAreStraight) {
  std::mt19937 random = seededGenerator();
  GivenFlow flow(100, 30, grainsOf(4, 1));
  const double heading = uniform(random, -0.1, 0.1);
  const double cells = uniform(random, 0.1, 2.5);
  const Eigen::Vector2d velocity =
      cells * flow.spacing() * Eigen::Vector2d(std::cos(heading), std::sin(heading));
  flow.set([&](double, double) { return velocity; });
  const int moves = static_cast<int>(200 / cells);
  for (int k = 0; k < moves; ++k) flow.advance(1.0);
  const Grains grains = flow.grains();
  expectValid(grains);
  const Eigen::Vector2d way = moves * velocity;
  std::size_t inside = 0;
  for (const Survivor& grain : survivorsOf(grains)) {
    // Walls stop grains.
    if (grain.to.x() > 9.99 || grain.to.y() < 0.01 || grain.to.y() > 2.99) continue;
    ++inside;
    ASSERT_NEAR(grain.to.x() - grain.from.x(), way.x(),
                1e-5 * moves * flow.spacing() + 1e-4 * flow.spacing());
    ASSERT_NEAR(grain.to.y() - grain.from.y(), way.y(),
                1e-5 * moves * flow.spacing() + 1e-4 * flow.spacing());
  }
  const double could = (10.0 - way.x()) * (3.0 - std::abs(way.y())) / (flow.spacing() * flow.spacing());
  std::printf("%.0f %% of the grains are left after 200 cells, %.2f a move\n", 100.0 * inside / could, cells);
  EXPECT_GT(inside, 0.25 * could);
}

/// What grains show lags by no more than about a cell, however far it goes.
TEST(GrainFlow, CarriesOriginsAlong) {
  std::mt19937 random = seededGenerator();
  GivenFlow flow(100, 30, grainsOf(4, 1));
  const double cells = uniform(random, 0.1, 2.5);
  flow.set([&](double, double) { return Eigen::Vector2d(cells * flow.spacing(), 0.0); });
  const int moves = static_cast<int>(200 / cells);
  for (int k = 0; k < moves; ++k) flow.advance(1.0);
  const Grains grains = flow.grains();
  const double way = moves * cells;
  double squares = 0.0;
  int count = 0;
  for (int t = 20; t < grains.grid.rows - 20; ++t) {
    for (int s = static_cast<int>(way) + 20; s < grains.grid.columns - 20; ++s) {
      const int origin = static_cast<int>(grains.cells[grains.grid.index(s, t, 0)].origin);
      const double lag = s - way - origin % grains.grid.columns;
      const double aside = t - origin / grains.grid.columns;
      squares += lag * lag + aside * aside;
      ++count;
    }
  }
  const double error = std::sqrt(squares / count);
  std::printf("origins are %.2f cells off after 200, %.2f a move\n", error, cells);
  EXPECT_LT(error, 1.5);
}

/// Mean distance of grains from where the exact flow takes them. [m]
double errorAfter(GivenFlow& flow, double duration, int moves,
                  const std::function<std::optional<Eigen::Vector2d>(const Eigen::Vector2d&)>& exact) {
  for (int k = 0; k < moves; ++k) flow.advance(duration / moves);
  double error = 0.0;
  int count = 0;
  for (const Survivor& grain : survivorsOf(flow.grains())) {
    const std::optional<Eigen::Vector2d> place = exact(grain.from);
    if (!place) continue;
    error += (grain.to - *place).norm();
    ++count;
  }
  EXPECT_GT(count, 100);
  return error / count;
}

TEST(GrainFlow, TurnsRigidlyWithAnErrorOfFirstOrder) {
  std::mt19937 random = seededGenerator();
  const double turned = uniform(random, 0.5, 1.0);  // [rad]
  const double spin = random() % 2 == 0 ? 1.0 : -1.0;
  const Eigen::Vector2d middle(uniform(random, 1.9, 2.1), uniform(random, 1.9, 2.1));
  std::vector<double> errors;
  for (const int moves : {10, 20, 40}) {
    GivenFlow flow(40, 40, grainsOf(4, 1));
    flow.set([&](double x, double y) -> Eigen::Vector2d {
      return spin * Eigen::Vector2d(middle.y() - y, x - middle.x());
    });
    errors.push_back(errorAfter(flow, turned, moves, [&](const Eigen::Vector2d& from) {
      const Eigen::Vector2d arm = from - middle;
      std::optional<Eigen::Vector2d> to;
      if (arm.norm() < 1.6) to = middle + Eigen::Rotation2Dd(spin * turned) * arm;
      return to;
    }));
  }
  std::printf("errors %.3g, %.3g, %.3g m\n", errors[0], errors[1], errors[2]);
  EXPECT_NEAR(errors[0] / errors[1], 2.0, 0.1);
  EXPECT_NEAR(errors[1] / errors[2], 2.0, 0.1);
}

TEST(GrainFlow, ShearsExactly) {
  std::mt19937 random = seededGenerator();
  const double rate = uniform(random, 0.3, 0.6);  // [1/s]
  GivenFlow flow(60, 20, grainsOf(3, 2));
  flow.set([&](double, double y) { return Eigen::Vector2d(rate * y, 0.0); });
  const double error = errorAfter(flow, 1.5, 15, [&](const Eigen::Vector2d& from) {
    std::optional<Eigen::Vector2d> to(Eigen::Vector2d(from.x() + 1.5 * rate * from.y(), from.y()));
    // Beyond the last centres velocities are those at the edge.
    if (to->x() > 5.9 || from.y() < 0.05 || from.y() > 1.95) to.reset();
    return to;
  });
  EXPECT_LT(error, 1e-5);
}

TEST(GrainFlow, StopsAtWallsAndLeavesOverOpenEdges) {
  std::mt19937 random = seededGenerator();
  for (int number = 0; number < 20; ++number) {
    const bool is_open = number % 2 == 0;
    GivenFlow flow(randomCount(random, 3, 20), randomCount(random, 3, 20),
                   grainsOf(randomCount(random, 1, 4), 1));
    flow.open(is_open);
    const double angle = uniform(random, 0.0, 2.0 * M_PI);
    flow.set([&](double, double) { return Eigen::Vector2d(std::cos(angle), std::sin(angle)); });
    // Farther than any grain may go in a move.
    flow.advance(1e6);
    const Grains grains = flow.grains();
    expectValid(grains);
    const std::vector<Survivor> survivors = survivorsOf(grains);
    if (is_open) {
      EXPECT_TRUE(survivors.empty());
    } else {
      const Eigen::Vector2d corner(std::cos(angle) > 0.0 ? grains.grid.columns * flow.spacing() : 0.0,
                                   std::sin(angle) > 0.0 ? grains.grid.rows * flow.spacing() : 0.0);
      ASSERT_EQ(survivors.size(), 1u);
      EXPECT_LT((survivors[0].to - corner).norm(), 1e-4);
    }
  }
}

/// As much sand goes with the grains as flows: each stands for Δl³.
TEST(GrainFlow, OfTheDiluteLayerIsThatOfTheSand) {
  std::mt19937 random = seededGenerator();
  for (int number = 0; number < 20; ++number) {
    GrainParameters parameters = grainsOf(randomCount(random, 1, 4), 0);
    parameters.layers = 10 * parameters.per_cell;  // down to the bed
    const int moving = randomCount(random, 1, parameters.layers);
    Material material;
    // Between two layers of grains, of which roundings may let one beside it go, or rest.
    material.layer_depth = 0.1 / parameters.per_cell * moving;
    parameters.speed = GrainSpeed::dilute;
    GivenFlow flow(6, 5, parameters, material);
    const Eigen::Vector2d velocity(uniform(random, -1.0, 1.0), uniform(random, -1.0, 1.0));
    flow.set([&](double, double) { return velocity; });
    const Grains grains = flow.grains();
    const double duration = 1e-3;
    const GrainMove move = flow.move(duration);
    for (int j = 0; j < 5; ++j) {
      for (int i = 0; i < 6; ++i) move.findFlow(i, j);
    }
    Eigen::Vector2d ways = Eigen::Vector2d::Zero();
    int in_doubt = 0;
    for (int d = 0; d < grains.grid.layers; ++d) {
      for (int t = 0; t < grains.grid.rows; ++t) {
        for (int s = 0; s < grains.grid.columns; ++s) {
          const Grain& grain = grains.cells[grains.grid.index(s, t, d)];
          const Momentum way = move.flow.wayOf(grain, s, t, d);
          const double depth = static_cast<double>(depthOf(grain, d, grains.grid.spacing));
          const bool doubtful = std::abs(depth - material.layer_depth) < 1e-6 * material.layer_depth;
          in_doubt += doubtful ? 1 : 0;
          EXPECT_TRUE(doubtful || (way.x != 0.0f) == (d < moving));
          ways += Eigen::Vector2d(way.x, way.y);
        }
      }
    }
    const double moving_grains = moving * 30.0 * parameters.per_cell * parameters.per_cell;
    // Depth 1 m: hu is u.
    const Eigen::Vector2d flux = std::pow(flow.spacing(), 4) * ways / (duration * 6 * 5 * 0.01);
    EXPECT_LT((flux - velocity).norm(), (1e-4 + in_doubt / moving_grains) * velocity.norm())
        << parameters.per_cell << ", " << moving;
  }
}

TEST(GrainGrid, FindsTheCellOfSandByMultiplication) {
  std::mt19937 random = seededGenerator();
  Grid grid;
  grid.columns = grid.rows = 1;
  for (int per_cell = 1; per_cell <= 64; ++per_cell) {
    const GrainGrid grains(grainsOf(per_cell, 1), grid);
    for (int k = 0; k < 10000; ++k) {
      const int multiple = randomCount(random, 1, (1 << 26) / per_cell - 1) * per_cell;
      for (const int cell : {multiple - 1, multiple, randomCount(random, 0, (1 << 26) - 1)})
        ASSERT_EQ(grains.cellOfSand(cell), cell / per_cell) << per_cell;
    }
  }
}

TEST(GrainClaims, OfSandGoBeforeThoseOfBareGroundAndOldOnesBeforeYoung) {
  std::mt19937 random = seededGenerator();
  for (int k = 0; k < 100000; ++k) {
    const std::uint32_t cell = static_cast<std::uint32_t>(random()) & kClaimant;
    const std::uint32_t other = static_cast<std::uint32_t>(random()) & kClaimant;
    const std::uint32_t born = static_cast<std::uint32_t>(random()) >> 1;
    const Grain old{0.5f, 0.5f, cell, born};
    const Grain young{0.5f, 0.5f, other, born + 1 + static_cast<std::uint32_t>(random() % 3)};
    const Grain bare{0.5f, 0.5f, cell | Grain::kBare, 0};
    ASSERT_EQ(claimantOf(claimOf(old, cell)), cell);
    ASSERT_EQ(claimantOf(claimOf(bare, other)), other);
    ASSERT_GT(claimOf(old, cell), claimOf(young, other));
    ASSERT_GT(claimOf(young, cell), claimOf(bare, other));
    ASSERT_GT(claimOf(bare, other), 0u);
  }
}

/// Chi-square of equal bins is below this with a probability of 1 − 1e-9 (Wilson and Hilferty).
double chiSquareBound(int degrees) {
  const double z = 5.998;
  const double k = 2.0 / (9.0 * degrees);
  return degrees * std::pow(1.0 - k + z * std::sqrt(k), 3);
}

/// Numbers between 0 and 1 in equal bins; pairs of them in squares of 16.
void expectUniform(const std::vector<float>& x, const std::vector<float>& y) {
  constexpr int kBins = 16;
  std::array<std::array<double, kBins>, kBins> counts{};
  double sum = 0.0;
  double squares = 0.0;
  double products = 0.0;
  for (std::size_t k = 0; k < x.size(); ++k) {
    counts[static_cast<int>(x[k] * kBins)][static_cast<int>(y[k] * kBins)] += 1.0;
    const double dx = static_cast<double>(x[k]) - 0.5;
    const double dy = static_cast<double>(y[k]) - 0.5;
    sum += dx;
    squares += dx * dx;
    products += dx * dy;
  }
  const double n = static_cast<double>(x.size());
  const double expected = n / (kBins * kBins);
  double chi_square = 0.0;
  for (const auto& column : counts) {
    for (const double count : column) chi_square += (count - expected) * (count - expected) / expected;
  }
  EXPECT_LT(chi_square, chiSquareBound(kBins * kBins - 1));
  // Six standard deviations: more with a probability of 2e-9.
  EXPECT_LT(std::abs(sum / n), 6.0 * std::sqrt(1.0 / 12.0 / n));
  EXPECT_LT(std::abs(squares / n - 1.0 / 12.0), 6.0 * std::sqrt(1.0 / 180.0 / n));
  EXPECT_LT(std::abs(products / n), 6.0 / 12.0 / std::sqrt(n));
}

TEST(GrainGeneration, IsUniformAndWithoutPattern) {
  std::mt19937 random = seededGenerator();
  const std::uint32_t move = static_cast<std::uint32_t>(random());
  const std::uint32_t first = static_cast<std::uint32_t>(random() % (1u << 25));
  std::vector<float> x, y, z, x_beside, x_later;
  for (std::uint32_t cell = first; cell < first + 200000; ++cell) {
    const Grain grain = generatedGrain(cell, move, cell);
    x.push_back(grain.x);
    y.push_back(grain.y);
    z.push_back(depthOf(grain, 0, 1.0f));
    x_beside.push_back(generatedGrain(cell + 1, move, 0).x);
    x_later.push_back(generatedGrain(cell, move + 1, 0).x);
  }
  for (const auto* other : {&y, &z, &x_beside, &x_later}) {
    expectUniform(x, *other);
    expectUniform(*other, x);
  }
  expectUniform(y, z);
}

}  // namespace
}  // namespace shallow_sand
