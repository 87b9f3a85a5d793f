#include "shallow_sand/scene/report.h"

#include <fstream>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "shallow_sand/core/replace_file.h"

namespace shallow_sand {

Report makeReport(const Simulator& simulator, const std::string& scene, double wall) {
  Report report;
  report.scene = scene;
  report.backend = toString(simulator.backend());
  report.threads = simulator.threads();
  report.cells = simulator.grid().cells();
  report.steps = simulator.progress().steps;
  report.simulated = simulator.time();
  report.wall = wall;
  report.cell_updates = simulator.progress().cell_updates;
  const SandFigures figures = simulator.figures();
  report.active_cells_end = figures.active_cells;
  report.max_speed_end = figures.max_speed;
  report.volume = figures.ledger;
  report.body_overlap = simulator.bodyOverlap();
  const auto& grains = simulator.parameters().grains;
  if (grains) report.grains = static_cast<std::size_t>(GrainGrid(*grains, simulator.grid()).cells());
  return report;
}

void writeReport(const std::string& path, const Report& report) {
  const double per_second = report.wall > 0.0 ? static_cast<double>(report.cell_updates) / report.wall : 0.0;
  nlohmann::json json = {{"scene", report.scene},
                         {"backend", report.backend},
                         {"threads", report.threads},
                         {"cells", report.cells},
                         {"steps", report.steps},
                         {"simulated_s", report.simulated},
                         {"wall_s", report.wall},
                         {"cell_updates", report.cell_updates},
                         {"cell_updates_per_s", per_second},
                         {"active_cells_end", report.active_cells_end},
                         {"max_speed_end", report.max_speed_end},
                         {"volume_start_m3", report.volume.start},
                         {"volume_poured_m3", report.volume.poured},
                         {"volume_left_m3", report.volume.left},
                         {"volume_end_m3", report.volume.now},
                         {"volume_error", report.volume.error()},
                         {"body_overlap_m3", report.body_overlap}};
  if (report.grains > 0) json["grains"] = report.grains;
  replaceFile(path, [&](const std::filesystem::path& part) {
    std::ofstream file(part);
    // A name need not be UTF-8, and a report with a replaced letter is better than none.
    file << json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) << '\n';
    file.close();
    if (!file) throw std::runtime_error(path + ": cannot be written");
  });
}

}  // namespace shallow_sand
