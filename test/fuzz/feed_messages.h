#pragma once

#include <geometry_msgs/PoseStamped.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "fuzz/body_laws.h"
#include "fuzz/mesh_addresses.h"
#include "fuzz/outcome.h"
#include "shallow_sand/MoveBody.h"
#include "shallow_sand/StateFile.h"
#include "shallow_sand/client/height_field_map.h"
#include "shallow_sand/ros/body_look.h"
#include "shallow_sand/ros/bounded_stream.h"
#include "shallow_sand/ros/message_heights.h"
#include "shallow_sand/ros/poses.h"
#include "shallow_sand/ros/query_answers.h"
#include "shallow_sand/ros/requested_edits.h"
#include "shallow_sand/ros/requested_mesh.h"
#include "shallow_sand/scene/state_folder.h"
#include "shallow_sand/sim/simulator.h"
#include "shallow_sand/surface/cell_heights.h"
#include "shallow_sand/surface/polygon_volume.h"

namespace shallow_sand {

/// Sand to which messages come, and what follows it. What a message is, and in which frame, two bytes before
/// it say.
class MessageWorld {
 public:
  MessageWorld() : sand_(parameters(), slope(), std::vector<float>(kCells, 0.3f)), grid_(sand_.grid()) {}

  /// Takes the next message of a stream.
  void take(BoundedStream& stream) {
    const auto kind = stream.take<std::uint8_t>();
    frame_ = frame(stream.take<std::uint8_t>());
    switch (kind % 12) {
      case 0:
        return edit(
            [this, message = stream.take<PourSand>()] { return requestedEdit(message, frame_, grid_); });
      case 1:
        return edit(
            [this, request = stream.take<EditSand::Request>()] { return requestedEdit(request, frame_); });
      case 2:
        return setSand(stream.take<sensor_msgs::PointCloud2>());
      case 3:
        return setSand(stream.take<visualization_msgs::Marker>());
      case 4:
        return addBody(stream.take<AddBody::Request>());
      case 5:
        return moveBody(stream.take<MoveBody::Request>());
      case 6:
        return querySurface(stream.take<QuerySurface::Request>());
      case 7:
        return volumeInPolygon(stream.take<VolumeInPolygon::Request>());
      case 8:
        return follow(stream.take<HeightField>());
      case 9:
        return follow(stream.take<HeightFieldUpdate>());
      case 10:
        return follow(stream.take<geometry_msgs::PoseStamped>());
      default:
        return keep(stream.take<StateFile::Request>());
    }
  }

  /// The sand goes on with what came.
  void finish() {
    sand_.advance(0.01);
    const Fields fields = sand_.fields();
    for (const auto* values :
         {&fields.bed, &fields.depth, &fields.momentum_x, &fields.momentum_y, &fields.load,
          &fields.load_elevation, &fields.load_momentum_x, &fields.load_momentum_y}) {
      require(std::all_of(values->begin(), values->end(), [](float value) { return std::isfinite(value); }),
              "the sand is made of finite numbers");
    }
    for (const auto* depths : {&fields.depth, &fields.load}) {
      require(std::all_of(depths->begin(), depths->end(), [](float depth) { return depth >= 0.0f; }),
              "no depth is negative");
    }
    require(std::isfinite(sand_.ledger().now) && std::isfinite(sand_.bodyOverlap()), "volumes are finite");
    for (const SandContact& contact : sand_.contacts(fields))
      require(std::isfinite(contact.submerged_volume), "contacts are finite");
  }

 private:
  static constexpr int kColumns = 12;
  static constexpr int kRows = 8;
  static constexpr std::size_t kCells = kColumns * kRows;
  static constexpr double kSpacing = 0.25;

  static SimulatorParameters parameters() {
    SimulatorParameters parameters;
    parameters.grid.spacing = kSpacing;
    parameters.grid.size = {kColumns * kSpacing, kRows * kSpacing};
    parameters.grid.origin = {-1.0, 0.5};
    parameters.backend = Backend::cpu;
    parameters.threads = 1;
    return parameters;
  }
  static std::vector<float> slope() {
    std::vector<float> bed(kCells);
    for (std::size_t k = 0; k < kCells; ++k) bed[k] = 0.02f * static_cast<float>(k % kColumns);
    return bed;
  }
  /// The sand's own frame, one near it, or one as far away as tf may tell.
  static Eigen::Isometry3d frame(std::uint8_t number) {
    if (number % 3 == 0) return Eigen::Isometry3d::Identity();
    const Eigen::Vector3d place(0.3, -0.2, 0.1);
    return Eigen::Translation3d(number % 3 == 1 ? place : Eigen::Vector3d(3e9 * place)) *
           Eigen::AngleAxisd(0.4 * number, Eigen::Vector3d(1.0, 2.0, 3.0).normalized());
  }

  template <class Request>
  void edit(const Request& request) {
    outcomeOf<InvalidParameter>([&] { require(std::isfinite(sand_.edit(request())), "volumes are finite"); });
  }

  template <class Message>
  void setSand(const Message& message) {
    outcomeOf<InvalidParameter>([&] {
      const CellValues heights = heightsOf(message, frame_, grid_);
      require(heights.values.size() == kCells && heights.given.size() == kCells,
              "each cell may have a height");
      requireBounded(heights, grid_);
      const auto operation = message.header.seq % 2 == 0 ? EditOperation::level : EditOperation::set;
      require(std::isfinite(sand_.setSand(operation, heights)), "volumes are finite");
    });
  }

  void addBody(const AddBody::Request& request) {
    AddBody::Request harmless = request;
    harmless.mesh = withMeshFolder(request.mesh);
    if (!isHarmless(harmless.mesh) || bodies_.size() >= 2) return;
    outcomeOf<InvalidParameter>([&] {
      const Eigen::Isometry3d pose = frame_ * rigid(harmless.pose.pose);
      BodyGeometryOptions options;
      if (!harmless.mesh_as.empty()) options.shape = linkShapeFromString(harmless.mesh_as, "mesh_as");
      const TriangleMesh mesh = requestedMesh(harmless);
      requireLaws(mesh);
      if (!isQuick(mesh)) return;
      const BodyGeometry body = makeBodyGeometry(mesh, quickSpacing(mesh), options);
      requireLaws(body);
      const auto scale = lookOf(harmless).scale;
      require(std::isfinite(scale.x) && std::isfinite(scale.y) && std::isfinite(scale.z),
              "a look has a size");
      bodies_.push_back(sand_.addBody("body", body.field));
      sand_.placeBody(bodies_.back(), pose);
    });
  }

  void moveBody(const MoveBody::Request& request) {
    outcomeOf<InvalidParameter>([&] {
      const Eigen::Isometry3d pose = frame_ * rigid(request.pose.pose);
      if (!bodies_.empty()) sand_.placeBody(bodies_.back(), pose);
    });
  }

  void querySurface(const QuerySurface::Request& request) {
    outcomeOf<InvalidParameter>([&] {
      requirePoints(request);
      const QuerySurface::Response response = surfaceAt(request, frame_, grid_, sand_.fields());
      const std::size_t count = request.points.size();
      require(response.surface.size() == count && response.depth.size() == count &&
                  response.normal.size() == count && response.inside.size() == count,
              "each point has an answer");
      for (std::size_t k = 0; k < count; ++k) {
        const auto& place = response.surface[k];
        const auto& normal = response.normal[k];
        const double length = std::hypot(normal.x, normal.y, normal.z);
        const bool is_place = std::isfinite(place.x) && std::isfinite(place.y) && std::isfinite(place.z) &&
                              response.depth[k] >= 0.0 && std::abs(length - 1.0) < 1e-9;
        require(is_place == (response.inside[k] != 0), "on the map there is a surface, and none beside it");
      }
    });
  }

  void volumeInPolygon(const VolumeInPolygon::Request& request) {
    outcomeOf<InvalidParameter>([&] {
      const auto corners = requestedPolygon(request, frame_);
      const PolygonVolume volume = shallow_sand::volumeInPolygon(grid_, sand_.fields(), corners);
      const double map = kCells * kSpacing * kSpacing;
      require(std::isfinite(volume.on_ground) && std::isfinite(volume.on_bodies), "volumes are finite");
      require(volume.area >= 0.0 && volume.area <= map * (1.0 + 1e-6), "no polygon is larger than the map");
    });
  }

  template <class Message>
  void follow(const Message& message) {
    const HeightFieldMap::Change change = follower_.take(message);
    if (!change.refused.empty()) requireClearLine(change.refused);
    const HeightField* field = follower_.field();
    if (field == nullptr) return;
    const std::size_t cells = static_cast<std::size_t>(field->columns) * field->rows;
    require(field->bed.size() == cells && field->depth.size() == cells, "each cell has a bed and a depth");
    require(field->load.size() == field->load_elevation.size(), "loads lie on something");
    for (const auto* values :
         {&field->bed, &field->depth, &field->speed, &field->load, &field->load_elevation}) {
      require(values->empty() || values->size() == cells, "each cell has a value, or none");
      require(
          std::all_of(values->begin(), values->end(), [](float value) { return std::abs(value) <= 1e9f; }),
          "values are metres");
    }
    for (const CellRectangle& changed : change.cells) {
      require(std::uint64_t{changed.column} + changed.columns <= field->columns &&
                  std::uint64_t{changed.row} + changed.rows <= field->rows,
              "what has changed is on the map");
    }
  }

  void follow(const geometry_msgs::PoseStamped& message) {
    outcomeOf<InvalidParameter>([&] {
      const Eigen::Isometry3d pose = rigid(message.pose);
      const Eigen::Matrix3d rotation = pose.linear();
      const Eigen::Matrix3d product = rotation * rotation.transpose();
      require(pose.translation().allFinite() && product.isApprox(Eigen::Matrix3d::Identity(), 1e-9),
              "a pose neither stretches nor shears");
    });
  }

  static void keep(const StateFile::Request& request) {
    const std::filesystem::path folder = std::filesystem::canonical(meshFolder()) / "states";
    outcomeOf<InvalidParameter>([&] {
      const std::filesystem::path file = fileWithin(folder, request.file);
      const auto [end, there] = std::mismatch(folder.begin(), folder.end(), file.begin(), file.end());
      require(end == folder.end() && there != file.end(), "states stay in their folder");
    });
  }

  Simulator sand_;
  const Grid grid_;
  std::vector<std::size_t> bodies_;
  HeightFieldMap follower_;
  Eigen::Isometry3d frame_ = Eigen::Isometry3d::Identity();
};

/// Reads bytes as messages, one after the other. @return nothing: each message may be refused or not
inline void feedMessages(const std::uint8_t* data, std::size_t size) {
  constexpr int kMost = 8;
  BoundedStream stream(data, size);
  MessageWorld world;
  try {
    for (int count = 0; count < kMost && stream.left() > 0; ++count) world.take(stream);
  } catch (const std::out_of_range&) {  // the last one is not whole
  }
  world.finish();
}

}  // namespace shallow_sand
