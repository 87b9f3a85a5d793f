#pragma once

#include <Eigen/Core>
#include <string>

namespace shallow_sand {

/// What a body does to the sand at one instant. Rays up the middles of cells tell where the body is; the sand
/// is what the cells hold: figures of a body's shape converge with the spacing.
///
/// Sand around the body: the ground's, in columns that this body does not cover and that no body closes (one
/// that touches the ground's sand). In a column that the body covers, the surface around it is that of the
/// next such columns to the west, east, south and north, each weighted by one over its distance: what is
/// plane around a body goes on plane under it. A direction without such a column counts for nothing. There is
/// no surface where all of these have bare bed (see bareDepth).
struct SandContact {
  std::string name;
  /// Of the body, above the bed and below the surface around it. What lies on the body does not count as
  /// surface, so a bucket that carries sand through the air is not in it. [m³]
  double submerged_volume = 0.0;
  /// Seen from above, of the columns in which sand touches the body: it fills the room under its lowest
  /// point, stands beside the column higher than that, or lies on it. Less than Fields::kDust is none. [m²]
  double touching_area = 0.0;
  /// Mean place of these columns; of each, the middle of what the sand touches of the body. In the grid's
  /// frame; zero where nothing touches. [m]
  Eigen::Vector3d contact_center{0.0, 0.0, 0.0};
  /// Of the sand that lies on the body; on two of them, as on the higher. Of all bodies, all loads. [m³]
  double carried_volume = 0.0;
  /// Volume times velocity, in the grid's frame, of the sand that touches the body: of what lies on it, and
  /// of the columns beside it that are higher than its lowest point there. This is the momentum that this
  /// sand has now, whoever gave it, not what the body has given. [m⁴/s]
  Eigen::Vector2d contact_momentum{0.0, 0.0};
  /// Volume times velocity, in the grid's frame, that the body has given to sand since the start, or since a
  /// snapshot was restored: it counts on from when bodies are placed the next time. Negative where it took
  /// some. It is what sand gets by making way: what is displaced moves with the body (Eq. 20), sand that a
  /// body closes in stops, and a body that moves up or down pushes what is beside it (Eq. 24). Where several
  /// bodies fill a column, all of it counts as given by the one whose velocity the sand takes. Pressure at
  /// the body's sides, and friction of what lies on it, are not in it: it is not the force on the body, and a
  /// slow body that sand runs after may take more than it gives. Times the bulk density it is an impulse
  /// [N·s]. [m⁴/s]
  Eigen::Vector2d given_momentum{0.0, 0.0};
};

}  // namespace shallow_sand
