#include "shallow_sand/rviz/height_field_visual.h"

#include <algorithm>
#include <cmath>

namespace shallow_sand {
namespace {

constexpr std::array<Side, 4> kSides{Side::x_min, Side::x_max, Side::y_min, Side::y_max};

}  // namespace

HeightFieldVisual::HeightFieldVisual(Ogre::SceneManager* scene, Ogre::SceneNode* parent)
    : scene_(scene),
      frame_node_(parent->createChildSceneNode()),
      corner_node_(frame_node_->createChildSceneNode()),
      sides_node_(corner_node_->createChildSceneNode()) {}

HeightFieldVisual::~HeightFieldVisual() {
  clear();
  for (Ogre::SceneNode* node : {sides_node_, corner_node_, frame_node_}) scene_->destroySceneNode(node);
}

void HeightFieldVisual::clear() {
  patches_.clear();
  triangles_.clear();
  touched_.clear();
  for (std::unique_ptr<SandPatch>& side : sides_) side.reset();
}

void HeightFieldVisual::reset(const HeightField& map) {
  clear();
  grid_ = PatchGrid(map);
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

void HeightFieldVisual::touch(const CellRectangle& cells) {
  for (const PatchGrid::Number& patch : grid_.touchedBy(cells)) touched_.insert(patch);
}

void HeightFieldVisual::touchAll(const HeightField& map) { touch({0, 0, map.columns, map.rows}); }

void HeightFieldVisual::write(const HeightField& map, const ShownValue& shown) {
  bool at_side = false;
  for (const PatchGrid::Number& number : touched_) {
    writePatch(map, number, shown);
    at_side = at_side || grid_.isAtSide(number);
  }
  if (at_side) writeSides(map);
  touched_.clear();
}

void HeightFieldVisual::writePatch(const HeightField& map, const PatchGrid::Number& number,
                                   const ShownValue& shown) {
  const CellRectangle cells = grid_.verticesOf(number);
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
  if (buffer.get() == nullptr) buffer = makeTriangleBuffer(gridTriangles(columns, rows, stride_));
  return buffer;
}

void HeightFieldVisual::setPose(const Ogre::Vector3& position, const Ogre::Quaternion& orientation) {
  frame_node_->setPosition(position);
  frame_node_->setOrientation(orientation);
}

void HeightFieldVisual::setMostTriangles(const HeightField& map, std::size_t most) {
  const double drawn_of_all = static_cast<double>(most) / (2.0 * static_cast<double>(map.depth.size()));
  const auto stride = static_cast<std::uint32_t>(
      std::clamp(std::ceil(std::sqrt(1.0 / drawn_of_all)), 1.0, static_cast<double>(PatchGrid::kCells)));
  if (stride == stride_) return;
  stride_ = stride;
  triangles_.clear();
  for (auto& [number, patch] : patches_) {
    const CellRectangle cells = grid_.verticesOf(number);
    patch.ground->setTriangles(trianglesOf(cells.columns, cells.rows));
  }
}

}  // namespace shallow_sand
