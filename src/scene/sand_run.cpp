#include <boost/program_options.hpp>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <optional>

#include "shallow_sand/bodies/shape.h"
#include "shallow_sand/scene/geotiff.h"
#include "shallow_sand/scene/mesh_file.h"
#include "shallow_sand/scene/picture.h"
#include "shallow_sand/scene/report.h"
#include "shallow_sand/scene/scene.h"
#include "shallow_sand/scene/simulation.h"

using namespace shallow_sand;

namespace {

enum ExitCode { kSuccess = 0, kFailure = 1, kBadInput = 2 };

struct Options {
  std::string scene;
  std::optional<double> duration;  ///< [s]
  std::optional<std::string> backend;
  std::optional<int> threads;
  std::string load;  ///< paths; empty: not asked for
  std::string save;
  std::string report;
  std::string picture;
  std::string mesh;
};

namespace po = boost::program_options;

/// An option without a default of its own.
template <class Value>
po::typed_value<Value>* valueFor(std::optional<Value>& place) {
  return po::value<Value>()->notifier([&place](const Value& value) { place = value; });
}

po::options_description declareOptions(Options& options) {
  po::options_description declared("Options");
  const auto add = [&](const char* name, const po::value_semantic* value, const char* text) {
    declared.add_options()(name, value, text);
  };
  add("duration", valueFor(options.duration), "Time to simulate [s], instead of the scene's");
  add("backend", valueFor(options.backend), "auto, cpu or cuda, instead of the scene's");
  add("threads", valueFor(options.threads), "Threads of the cpu backend; 0: as many as there are");
  add("load", po::value(&options.load),
      "Go on from this state, which --save wrote; the scene's times count from its start");
  add("save", po::value(&options.save), "Write the state at the end to this GeoTIFF");
  add("report", po::value(&options.report), "Write the figures of the run to this JSON file");
  add("picture", po::value(&options.picture), "Write a shaded relief of the end to this PNG");
  add("mesh", po::value(&options.mesh),
      "Write the surface at the end as triangles to this .stl, or .ply with colours");
  declared.add_options()("help,h", "Tell all this")("version", "Tell the version");
  return declared;
}

/// Returns whether there is a scene to run; help and version are told instead of it.
/// @throws boost::program_options::error, InvalidParameter
bool parseOptions(int argument_count, char** arguments, Options& options) {
  const po::options_description declared = declareOptions(options);
  std::vector<std::string> scenes;
  po::options_description all;
  all.add(declared).add_options()("SCENE", po::value(&scenes));
  po::variables_map given;
  // An abbreviation of an option would mean another one some day.
  po::store(po::command_line_parser(argument_count, arguments)
                .options(all)
                .positional(po::positional_options_description().add("SCENE", -1))
                .style(po::command_line_style::unix_style & ~po::command_line_style::allow_guessing)
                .run(),
            given);
  po::notify(given);
  if (given.count("help") > 0) {
    std::cout << "sand_run SCENE.yaml [OPTIONS]\nRuns a scene of dry sand and the bodies that move in it.\n\n"
              << declared;
    return false;
  }
  if (given.count("version") > 0) {
    std::cout << SHALLOW_SAND_VERSION << '\n';
    return false;
  }
  if (scenes.empty()) throw InvalidParameter("SCENE", "nothing", "a scene file (YAML)");
  if (scenes.size() > 1) throw InvalidParameter("SCENE", scenes[1], "one scene file only");
  options.scene = scenes.front();
  return true;
}

/// Options go before what the scene says.
void applyOptions(const Options& options, Scene& scene) {
  scene.duration = options.duration.value_or(scene.duration);
  if (!(scene.duration >= 0.0 && scene.duration <= 1e9)) {
    throw InvalidParameter("--duration", std::to_string(scene.duration), "a number of seconds from 0 to 1e9");
  }
  if (options.backend) {
    scene.parameters.backend = backendFromString(*options.backend);
  }
  scene.parameters.threads = options.threads.value_or(scene.parameters.threads);
  if (scene.parameters.threads < 0) {
    throw InvalidParameter("--threads", std::to_string(scene.parameters.threads), "a number of at least 0");
  }
}

/// Finds out before a long run, not after it, that a result has nowhere to go.
void requireWritable(const std::string& option, const std::string& path) {
  if (path.empty()) {
    return;
  }
  const bool existed = std::filesystem::exists(path);
  const bool writable = static_cast<bool>(std::ofstream(path, std::ios::app));
  if (writable && !existed) {
    std::filesystem::remove(path);
  }
  if (!writable) {
    throw InvalidParameter(option, path, "a file that can be written, in a folder that exists");
  }
}

/// How far to run between two looks at the clock: with a fixed step a whole number of steps, so none is cut
/// short. [s]
double frameLength(const SolverParameters& solver) {
  constexpr double kFrame = 0.05;
  const double step = solver.fixed_step.value_or(kFrame);
  return std::max(1.0, std::round(kFrame / step)) * step;
}

void printProgress(const Simulator& simulator, double duration, double wall) {
  std::fprintf(stderr, "%8.2f s of %g s (%3.0f %%), %llu steps, %.2f times real time\n", simulator.time(),
               duration, 100.0 * simulator.time() / duration,
               static_cast<unsigned long long>(simulator.progress().steps), simulator.time() / wall);
}

/// Returns the time that the run took on the clock. [s]
double run(Simulator& simulator, double duration) {
  using Clock = std::chrono::steady_clock;
  const auto secondsSince = [](Clock::time_point begin) {
    return std::chrono::duration<double>(Clock::now() - begin).count();
  };
  const Clock::time_point begin = Clock::now();
  const double frame = frameLength(simulator.parameters().solver);
  double next_print = 1.0;
  // Frames end at the same times in every run, and at times that a user can write, so that one that goes on
  // from a saved state takes the same steps.
  const auto nearestNanosecond = [](double time) { return std::round(time * 1e9) / 1e9; };
  for (double number = std::floor(simulator.time() / frame) + 1.0; simulator.time() < duration;
       number += 1.0) {
    const double end = nearestNanosecond(number * frame);
    // No sliver of a frame at the end.
    simulator.advanceTo(end > duration - 0.001 * frame ? duration : std::max(end, simulator.time()));
    if (secondsSince(begin) >= next_print) {
      printProgress(simulator, duration, secondsSince(begin));
      next_print = secondsSince(begin) + 1.0;
    }
  }
  return secondsSince(begin);
}

void printSummary(const Report& report) {
  std::printf("%s: %g s of sand in %.2f s on %s (%d threads), %llu steps, %.3g million cells a second\n",
              report.scene.c_str(), report.simulated, report.wall, report.backend.c_str(), report.threads,
              static_cast<unsigned long long>(report.steps),
              report.wall > 0.0 ? 1e-6 * static_cast<double>(report.cell_updates) / report.wall : 0.0);
  std::printf("volume: %.6g m3 at the start, %.6g poured, %.6g left, %.6g at the end; error %.2g\n",
              report.volume.start, report.volume.poured, report.volume.left, report.volume.now,
              report.volume.error());
  std::printf("at the end: %zu of %zu cells active, fastest sand %.3g m/s, %.3g m3 inside bodies\n",
              report.active_cells_end, report.cells, report.max_speed_end, report.body_overlap);
}

std::vector<Outline> footprints(const Scene& scene, double time) {
  std::vector<Outline> outlines;
  for (const SceneBody& body : scene.bodies) {
    outlines.push_back(footprint(triangulate(body.shape), poseAt(body, time)));
  }
  return outlines;
}

void writeResults(const Options& options, const Scene& scene, const Simulator& simulator,
                  const Report& report) {
  if (!options.save.empty()) {
    saveState(options.save, simulator.parameters(), simulator.snapshot());
  }
  if (!options.report.empty()) {
    writeReport(options.report, report);
  }
  if (!options.picture.empty()) {
    const Grid& grid = simulator.grid();
    const Fields fields = simulator.fields();
    writePicture(options.picture, grid, fields, footprints(scene, simulator.time()),
                 grainCloud(grid, fields, simulator.grains()));
  }
  if (!options.mesh.empty()) {
    writeMesh(options.mesh, surfaceMesh(simulator.grid(), simulator.fields()));
  }
  for (const std::string& path : {options.save, options.report, options.picture, options.mesh}) {
    if (!path.empty()) {
      std::printf("wrote %s\n", path.c_str());
    }
  }
}

void resume(Simulator& simulator, const std::string& path) {
  const Snapshot state = loadState(path, simulator.parameters());
  try {
    simulator.restore(state);
  } catch (const InvalidParameter& error) {
    throw SceneError(path + ": " + error.what());
  }
}

void runScene(const Options& options) {
  Scene scene = loadScene(options.scene);
  applyOptions(options, scene);
  requireWritable("--save", options.save);
  requireWritable("--report", options.report);
  requireWritable("--picture", options.picture);
  if (!options.mesh.empty()) {
    requireMeshSuffix("--mesh", options.mesh);
    requireWritable("--mesh", options.mesh);
  }
  std::vector<std::string> notes;
  Simulator simulator = buildSimulator(scene, &notes);
  for (const std::string& note : notes) {
    std::fprintf(stderr, "%s\n", note.c_str());
  }
  if (!options.load.empty()) {
    resume(simulator, options.load);
  }
  std::printf("%s\n", simulator.backendNotice().c_str());
  const double wall = run(simulator, scene.duration);
  const Report report = makeReport(simulator, scene.name, wall);
  printSummary(report);
  writeResults(options, scene, simulator, report);
}

int failed(const std::string& message, ExitCode code) {
  std::fprintf(stderr, "%s\n", message.c_str());
  return code;
}

}  // namespace

int main(int argument_count, char** arguments) {
  Options options;
  try {
    if (!parseOptions(argument_count, arguments, options)) return kSuccess;
  } catch (const std::exception& error) {
    return failed(std::string("sand_run: ") + error.what() + "; see sand_run --help", kBadInput);
  }
  try {
    runScene(options);
  } catch (const SceneError& error) {
    return failed(error.what(), kBadInput);
  } catch (const InvalidParameter& error) {
    return failed(options.scene + ": " + error.what(), kBadInput);
  } catch (const std::exception& error) {
    return failed(std::string("sand_run: ") + error.what(), kFailure);
  }
  return kSuccess;
}
