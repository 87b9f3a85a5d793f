#pragma once

#include <OGRE/OgreHardwareIndexBuffer.h>
#include <OGRE/OgreMaterial.h>
#include <OGRE/OgreMovableObject.h>
#include <OGRE/OgreRenderable.h>
#include <OGRE/OgreSceneNode.h>
#include <OGRE/OgreVertexIndexData.h>

#include <memory>
#include <vector>

#include "shallow_sand/rviz/sand_vertices.h"

namespace shallow_sand {

/// Corners of triangles in the memory of the graphics card; patches that are alike share one.
using TriangleBuffer = Ogre::HardwareIndexBufferSharedPtr;
TriangleBuffer makeTriangleBuffer(const std::vector<std::uint32_t>& corners);

/// A part of the sand that is drawn at once and left out when it is not in view. Its vertices are written in
/// place.
class SandPatch : public Ogre::MovableObject, public Ogre::Renderable {
 public:
  SandPatch(Ogre::SceneNode* node, const Ogre::MaterialPtr& material);
  ~SandPatch() override;
  SandPatch(const SandPatch&) = delete;
  SandPatch& operator=(const SandPatch&) = delete;

  void setVertices(const std::vector<SandVertex>& vertices);
  void setTriangles(const TriangleBuffer& triangles);

  const Ogre::String& getMovableType() const override;
  const Ogre::AxisAlignedBox& getBoundingBox() const override { return box_; }
  Ogre::Real getBoundingRadius() const override;
  void _updateRenderQueue(Ogre::RenderQueue* queue) override;
  void visitRenderables(Ogre::Renderable::Visitor* visitor, bool debug_renderables) override;

  const Ogre::MaterialPtr& getMaterial() const override { return material_; }
  void getRenderOperation(Ogre::RenderOperation& operation) override;
  void getWorldTransforms(Ogre::Matrix4* transform) const override;
  Ogre::Real getSquaredViewDepth(const Ogre::Camera* camera) const override;
  const Ogre::LightList& getLights() const override { return queryLights(); }

 private:
  Ogre::SceneNode* node_;
  Ogre::MaterialPtr material_;
  std::unique_ptr<Ogre::VertexData> vertices_;
  std::unique_ptr<Ogre::IndexData> triangles_;
  Ogre::AxisAlignedBox box_;
};

}  // namespace shallow_sand
