#include <boost/program_options.hpp>
#include <cstdint>
#include <cstdio>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <string>
#include <thread>

#include "benchmark/timing.h"
#include "shallow_sand/scene/simulation.h"
#include "solver_3d/column_collapse.h"

/// Lets columns of sand collapse on the height field and in three dimensions, by turns, and tells how far,
/// how alike and at what cost; see README.md here.
namespace shallow_sand {
namespace {

struct Options {
  std::string folder = ".";
  int threads = static_cast<int>(std::thread::hardware_concurrency());
  double until = 1.6;                    // [s]
  std::vector<int> heights{10, 20, 40};  // [cells]
};

/// What is spent on frames. Other load on a machine lengthens the time, but not the work.
class Cost {
 public:
  template <class Function>
  void add(const Function& function) {
    const std::clock_t before = std::clock();
    seconds_ += secondsOf(function);
    work_ += static_cast<double>(std::clock() - before) / CLOCKS_PER_SEC;
  }
  double seconds() const { return seconds_; }
  double work() const { return work_; }  ///< of all cores [s]

 private:
  double seconds_ = 0.0;
  double work_ = 0.0;
};

/// The grains of the paper's row, 128 x 128 x 50.
Simulator withGrains(Scene scene) {
  GrainParameters grains;
  grains.per_cell = 2;
  grains.layers = 50;
  scene.parameters.grains = grains;
  return buildSimulator(scene);
}

Column withQuarterOfHeightFlowing(Column column) {
  column.layer = 0.25 * column.height;
  return column;
}

/// A column by both solvers, at the same time; on the height field also with another layer.
class Comparison {
 public:
  Comparison(const Column& column, int threads)
      : height_(column.height),
        points_(column.points(threads)),
        sand_(buildSimulator(column.scene(threads))),
        grains_(withGrains(column.scene(threads))),
        quarter_(buildSimulator(withQuarterOfHeightFlowing(column).scene(threads))) {}

  void runFrame() {
    const auto run_3d = [&] { points_.advance(kFiftieth); };
    const auto run_map = [&] { sand_.advance(kFiftieth); };
    const auto run_grains = [&] { grains_.advance(kFiftieth); };
    if (time() == 0.0 || sand_.activeCells() > 0) {
      in_3d_.add(run_3d);
      on_map_.add(run_map);
      with_grains_.add(run_grains);
      moved_for_ = time();
      steps_3d_ = points_.steps();
      steps_ = sand_.progress().steps;
    } else {
      run_3d();  // sand at rest on the map costs nothing: no comparison
    }
    quarter_.advance(kFiftieth);
    of_3d_ = radialProfile(sand_.grid(), points_.depth());
    of_map_ = radialProfile(sand_);
    of_quarter_ = radialProfile(quarter_);
  }
  double time() const { return points_.time(); }

  static constexpr const char* kFrontHeader = "time,runout_3d,runout,runout_quarter,top_3d,top,top_quarter";
  std::string front() const {
    char line[120];
    std::snprintf(line, sizeof line, "%.2f,%.3f,%.3f,%.3f,%.3f,%.3f,%.3f", time(), runout(of_3d_),
                  runout(of_map_), runout(of_quarter_), of_3d_.depth[0], of_map_.depth[0],
                  of_quarter_.depth[0]);
    return line;
  }

  /// Costs are those of a simulated second while sand on the map moves.
  static constexpr const char* kFiguresHeader =
      "height,deviation,deviation_quarter,points,moved_for,steps_3d,steps,seconds_3d,seconds,seconds_grains,"
      "work_3d,work,"
      "work_grains";
  std::string figures() const {
    char line[240];
    std::snprintf(line, sizeof line, "%.2f,%.3f,%.3f,%zu,%.2f,%.0f,%.0f,%.4g,%.4g,%.4g,%.4g,%.4g,%.4g",
                  height_, relativeDeviation(of_map_, of_3d_), relativeDeviation(of_quarter_, of_3d_),
                  points_.size(), moved_for_, static_cast<double>(steps_3d_) / moved_for_,
                  static_cast<double>(steps_) / moved_for_, in_3d_.seconds() / moved_for_,
                  on_map_.seconds() / moved_for_, (with_grains_.seconds() - on_map_.seconds()) / moved_for_,
                  in_3d_.work() / moved_for_, on_map_.work() / moved_for_,
                  (with_grains_.work() - on_map_.work()) / moved_for_);
    return line;
  }

  void writeProfile(const std::string& path) const {
    std::ofstream file(path);
    file << "radius,depth_3d,depth,depth_quarter\n";
    for (std::size_t k = 0; k < of_3d_.x.size(); ++k) {
      file << of_3d_.x[k] << ',' << of_3d_.depth[k] << ',' << of_map_.depth[k] << ',' << of_quarter_.depth[k]
           << '\n';
    }
  }

 private:
  double runout(const Profile& profile) const { return profile.reach(0.05 * height_); }

  double height_;
  MaterialPoints points_;
  Simulator sand_;
  Simulator grains_;
  Simulator quarter_;
  Profile of_3d_;
  Profile of_map_;
  Profile of_quarter_;
  Cost in_3d_;
  Cost on_map_;
  Cost with_grains_;
  double moved_for_ = 0.0;  // [s]
  std::size_t steps_3d_ = 0;
  std::uint64_t steps_ = 0;
};

/// @returns its figures
std::string compare(const Column& column, const std::string& name, const Options& options) {
  constexpr int kFramesToTell = 5;
  Comparison comparison(column, options.threads);
  std::ofstream fronts(options.folder + "/" + name + "_front.csv");
  fronts << Comparison::kFrontHeader << '\n';
  std::printf("\n%s, %d threads\n%s\n", name.c_str(), options.threads, Comparison::kFrontHeader);
  for (int frame = 1; comparison.time() < options.until - 0.5 * kFiftieth; ++frame) {
    comparison.runFrame();
    fronts << comparison.front() << '\n';
    if (frame % kFramesToTell == 0) std::printf("%s\n", comparison.front().c_str());
    std::fflush(stdout);
  }
  comparison.writeProfile(options.folder + "/" + name + "_profile.csv");
  std::printf("%s\n%s\n", Comparison::kFiguresHeader, comparison.figures().c_str());
  return comparison.figures();
}

void requireValid(const Options& options) {
  const auto requirePositive = [](const char* name, auto value) {
    if (!(value > 0)) throw InvalidParameter(name, std::to_string(value), "a number above 0");
  };
  requirePositive("--threads", options.threads);
  requirePositive("--until", options.until);
  for (const int height : options.heights) requirePositive("--heights", height);
  if (!std::filesystem::is_directory(options.folder))
    throw InvalidParameter("--output", options.folder, "a folder that exists");
}

}  // namespace
}  // namespace shallow_sand

int main(int argc, char** argv) {
  using namespace shallow_sand;
  Options options;
  namespace po = boost::program_options;
  po::options_description declared("Columns of sand collapse on a height field and in three dimensions");
  declared.add_options()("output", po::value(&options.folder), "folder for CSV files")(
      "threads", po::value(&options.threads), "of both solvers")("until", po::value(&options.until), "[s]")(
      "heights", po::value(&options.heights)->multitoken(), "of the columns [cells]")("help",
                                                                                      "tell all this");
  try {
    po::variables_map given;
    po::store(po::command_line_parser(argc, argv)
                  .options(declared)
                  .positional({})
                  .style(po::command_line_style::unix_style & ~po::command_line_style::allow_guessing)
                  .run(),
              given);
    po::notify(given);
    if (given.count("help") > 0) {
      std::cout << declared;
      return 0;
    }
    requireValid(options);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "solver_3d_comparison: %s\n", error.what());
    return 2;
  }
  std::ofstream figures(options.folder + "/figures.csv");
  figures << Comparison::kFiguresHeader << '\n';
  for (const int height : options.heights) {
    Column column;
    column.height = height * column.spacing;
    figures << compare(column, "column_" + std::to_string(height), options) << std::endl;
  }
}
