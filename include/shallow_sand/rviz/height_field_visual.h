#pragma once

#include <OGRE/OgreSceneManager.h>
#include <OGRE/OgreSceneNode.h>

#include <array>
#include <map>
#include <memory>
#include <set>
#include <utility>
#include <vector>

#include "shallow_sand/HeightField.h"
#include "shallow_sand/client/height_field_map.h"
#include "shallow_sand/rviz/patch_grid.h"
#include "shallow_sand/rviz/sand_material.h"
#include "shallow_sand/rviz/sand_patch.h"

namespace shallow_sand {

/// What is drawn of a map of sand: patches of the ground, sand on bodies above them, and the cut along the
/// map's sides. Only patches in which something changed are written again.
class HeightFieldVisual {
 public:
  /// @throws std::runtime_error if the graphics driver cannot draw it
  HeightFieldVisual(Ogre::SceneManager* scene, Ogre::SceneNode* parent);
  ~HeightFieldVisual();
  HeightFieldVisual(const HeightFieldVisual&) = delete;
  HeightFieldVisual& operator=(const HeightFieldVisual&) = delete;

  /// Draws nothing until there is a map again.
  void clear();
  /// Starts anew with a map, of any size.
  void reset(const HeightField& map);
  /// These cells have changed.
  void touch(const CellRectangle& cells);
  void touchAll(const HeightField& map);
  /// Writes what was touched since the last time.
  void write(const HeightField& map, const ShownValue& shown);

  /// Of the map's frame, in the scene's.
  void setPose(const Ogre::Vector3& position, const Ogre::Quaternion& orientation);
  /// Not many more triangles are drawn than so many: only every second, third ... cell then.
  void setMostTriangles(const HeightField& map, std::size_t most);
  void showSides(bool shown) { sides_node_->setVisible(shown); }
  SandMaterial& material() { return material_; }

 private:
  struct Patch {
    std::unique_ptr<SandPatch> ground;
    std::unique_ptr<SandPatch> load;
  };

  void writePatch(const HeightField& map, const PatchGrid::Number& number, const ShownValue& shown);
  void writeSides(const HeightField& map);
  const TriangleBuffer& trianglesOf(std::uint32_t columns, std::uint32_t rows);

  Ogre::SceneManager* scene_;
  Ogre::SceneNode* frame_node_;   // the map's frame
  Ogre::SceneNode* corner_node_;  // its corner
  Ogre::SceneNode* sides_node_;
  SandMaterial material_;
  PatchGrid grid_;
  std::uint32_t stride_ = 1;
  std::map<std::pair<std::uint32_t, std::uint32_t>, TriangleBuffer> triangles_;  // of patches of a size
  std::map<PatchGrid::Number, Patch> patches_;
  std::array<std::unique_ptr<SandPatch>, 4> sides_;
  std::set<PatchGrid::Number> touched_;
};

}  // namespace shallow_sand
