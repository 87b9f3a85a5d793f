#include "shallow_sand/rviz/height_field_visual.h"

#include <algorithm>

namespace shallow_sand {
namespace {

/// Cells along a side of a patch: few enough that little is written for a small change, enough that the
/// graphics card has something to do.
constexpr std::uint32_t kPatch = 64;
constexpr std::array<Side, 4> kSides{Side::x_min, Side::x_max, Side::y_min, Side::y_max};

/// Vertices of a patch: it shares its last with the next one.
CellRectangle verticesOf(const HeightField& map, std::uint32_t column, std::uint32_t row) {
  const std::uint32_t i = column * kPatch;
  const std::uint32_t j = row * kPatch;
  return {i, j, std::min(kPatch + 1, map.columns - i), std::min(kPatch + 1, map.rows - j)};
}

/// Patches along a side. The last cell of a map begins none, for it has no neighbour to span to.
std::uint32_t patchesAlong(std::uint32_t cells) { return cells <= 1 ? cells : (cells - 2) / kPatch + 1; }

}  // namespace

HeightFieldVisual::HeightFieldVisual(Ogre::SceneManager* scene, Ogre::SceneNode* parent)
    : scene_(scene),
      frame_node_(parent->createChildSceneNode()),
      corner_node_(frame_node_->createChildSceneNode()),
      sides_node_(corner_node_->createChildSceneNode()) {}

HeightFieldVisual::~HeightFieldVisual() {
  patches_.clear();
  for (std::unique_ptr<SandPatch>& side : sides_) side.reset();
  for (Ogre::SceneNode* node : {sides_node_, corner_node_, frame_node_}) scene_->destroySceneNode(node);
}

void HeightFieldVisual::reset(const HeightField& map) {
  patches_.clear();
  triangles_.clear();
  touched_.clear();
  corner_node_->setPosition(static_cast<Ogre::Real>(map.origin_x), static_cast<Ogre::Real>(map.origin_y),
                            0.0f);
  material_.setShore(0.1f * map.spacing);
  for (std::size_t k = 0; k < sides_.size(); ++k) {
    sides_[k] = std::make_unique<SandPatch>(sides_node_, material_.material());
    const std::vector<std::uint32_t> corners = sideTriangles(map, kSides[k]);
    if (!corners.empty()) sides_[k]->setTriangles(makeTriangleBuffer(corners));
  }
  touchAll(map);
}

void HeightFieldVisual::touch(const HeightField& map, const CellRectangle& cells) {
  const auto first = [](std::uint32_t cell) {
    // Its first vertex belongs to the patch before, too.
    return cell > kReachOfVertices ? (cell - kReachOfVertices - 1) / kPatch : 0;
  };
  const auto last = [](std::uint32_t end, std::uint32_t of) {
    return std::min((end - 1 + kReachOfVertices) / kPatch, patchesAlong(of) - 1);
  };
  for (std::uint32_t row = first(cells.row); row <= last(cells.row + cells.rows, map.rows); ++row) {
    for (std::uint32_t column = first(cells.column);
         column <= last(cells.column + cells.columns, map.columns); ++column)
      touched_.insert({column, row});
  }
}

void HeightFieldVisual::touchAll(const HeightField& map) { touch(map, {0, 0, map.columns, map.rows}); }

std::size_t HeightFieldVisual::write(const HeightField& map, const ShownValue& shown) {
  const std::size_t written = touched_.size();
  bool at_side = false;
  for (const PatchNumber& number : touched_) {
    writePatch(map, number, shown);
    at_side = at_side || number.first == 0 || number.second == 0 ||
              number.first + 1 == patchesAlong(map.columns) || number.second + 1 == patchesAlong(map.rows);
  }
  if (at_side) writeSides(map);
  touched_.clear();
  return written;
}

void HeightFieldVisual::writePatch(const HeightField& map, const PatchNumber& number,
                                   const ShownValue& shown) {
  const CellRectangle cells = verticesOf(map, number.first, number.second);
  if (cells.columns < 2 || cells.rows < 2) return;
  Patch& patch = patches_[number];
  if (!patch.ground) {
    patch.ground = std::make_unique<SandPatch>(corner_node_, material_.material());
    patch.ground->setTriangles(trianglesOf(cells.columns, cells.rows));
  }
  patch.ground->setVertices(groundVertices(map, cells, shown));

  const LoadSheet sheet = loadSheet(map, cells);
  if (sheet.triangles.empty()) {
    patch.load.reset();
    return;
  }
  if (!patch.load) patch.load = std::make_unique<SandPatch>(corner_node_, material_.material());
  patch.load->setVertices(sheet.vertices);
  patch.load->setTriangles(makeTriangleBuffer(sheet.triangles));
}

void HeightFieldVisual::writeSides(const HeightField& map) {
  for (std::size_t k = 0; k < sides_.size(); ++k) sides_[k]->setVertices(sideVertices(map, kSides[k]));
}

const TriangleBuffer& HeightFieldVisual::trianglesOf(std::uint32_t columns, std::uint32_t rows) {
  TriangleBuffer& buffer = triangles_[{columns, rows}];
  if (!buffer) buffer = makeTriangleBuffer(gridTriangles(columns, rows, stride_));
  return buffer;
}

void HeightFieldVisual::setPose(const Ogre::Vector3& position, const Ogre::Quaternion& orientation) {
  frame_node_->setPosition(position);
  frame_node_->setOrientation(orientation);
}

void HeightFieldVisual::setMostTriangles(const HeightField& map, std::size_t most) {
  std::uint32_t stride = 1;
  while (stride < kPatch && 2 * map.depth.size() / stride / stride > most) stride *= 2;
  if (stride == stride_) return;
  stride_ = stride;
  triangles_.clear();
  for (auto& [number, patch] : patches_) {
    const CellRectangle cells = verticesOf(map, number.first, number.second);
    patch.ground->setTriangles(trianglesOf(cells.columns, cells.rows));
  }
}

}  // namespace shallow_sand
