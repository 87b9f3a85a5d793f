#pragma once

#include <console_bridge/console.h>

#include <cstddef>
#include <cstdint>
#include <string>

#include "fuzz/body_laws.h"
#include "fuzz/mesh_addresses.h"
#include "fuzz/outcome.h"
#include "shallow_sand/bodies/link_selection.h"
#include "shallow_sand/bodies/robot_links.h"
#include "shallow_sand/core/parameters.h"

namespace shallow_sand {

/// Whether all addresses of meshes in a description are.
inline bool namesHarmlessMeshes(const std::string& urdf) {
  const std::string key = "filename";
  for (std::size_t at = urdf.find(key); at != std::string::npos; at = urdf.find(key, at + 1)) {
    const std::size_t quote = urdf.find_first_of("'\"", at);
    if (quote == std::string::npos) return true;
    const std::size_t end = urdf.find(urdf[quote], quote + 1);
    if (!isHarmless(urdf.substr(quote + 1, end - quote - 1))) return false;
  }
  return true;
}

/// Reads bytes as a robot's description, and samples its links.
inline std::string feedUrdf(const std::uint8_t* data, std::size_t size) {
  console_bridge::setLogLevel(console_bridge::CONSOLE_BRIDGE_LOG_NONE);
  const std::string urdf = withMeshFolder(std::string(reinterpret_cast<const char*>(data), size));
  if (!namesHarmlessMeshes(urdf)) return "";
  return outcomeOf<InvalidParameter>([&] {
    const LinkSelection selection = selectLinks(urdf, {{}, {"left_*"}});
    const RobotGeometry robot = collisionGeometry(selection.urdf);
    for (const std::string& problem : robot.problems) requireClearLine(problem);
    for (const LinkGeometry& link : robot.links) {
      require(!link.mesh.triangles.empty(), "links without a surface are left out");
      requireLaws(link.mesh);
      if (!isQuick(link.mesh)) continue;
      BodyGeometryOptions options;
      options.shape = static_cast<LinkShape>(link.link.size() % 3);
      outcomeOf<InvalidParameter>(
          [&] { requireLaws(makeBodyGeometry(link.mesh, quickSpacing(link.mesh), options)); });
    }
  });
}

}  // namespace shallow_sand
