#include "shallow_sand/rviz/sand_patch.h"

#include <OGRE/OgreCamera.h>
#include <OGRE/OgreHardwareBufferManager.h>
#include <OGRE/OgreRenderQueue.h>

#include <algorithm>
#include <atomic>
#include <string>

namespace shallow_sand {
namespace {

/// A node tells its objects apart by their names.
std::string uniqueName() {
  static std::atomic<unsigned> made{0};
  return "shallow_sand/patch" + std::to_string(made++);
}

}  // namespace

TriangleBuffer makeTriangleBuffer(const std::vector<std::uint32_t>& corners) {
  TriangleBuffer buffer = Ogre::HardwareBufferManager::getSingleton().createIndexBuffer(
      Ogre::HardwareIndexBuffer::IT_32BIT, corners.size(), Ogre::HardwareBuffer::HBU_STATIC_WRITE_ONLY);
  buffer->writeData(0, corners.size() * sizeof(std::uint32_t), corners.data(), true);
  return buffer;
}

SandPatch::SandPatch(Ogre::SceneNode* node, const Ogre::MaterialPtr& material)
    : MovableObject(uniqueName()),
      node_(node),
      material_(material),
      vertices_(std::make_unique<Ogre::VertexData>()),
      triangles_(std::make_unique<Ogre::IndexData>()) {
  Ogre::VertexDeclaration* layout = vertices_->vertexDeclaration;
  layout->addElement(0, offsetof(SandVertex, position), Ogre::VET_FLOAT3, Ogre::VES_POSITION);
  layout->addElement(0, offsetof(SandVertex, normal), Ogre::VET_FLOAT3, Ogre::VES_NORMAL);
  // Depth, value and openness.
  layout->addElement(0, offsetof(SandVertex, depth), Ogre::VET_FLOAT3, Ogre::VES_TEXTURE_COORDINATES, 0);
  node_->attachObject(this);
}

SandPatch::~SandPatch() { node_->detachObject(this); }

void SandPatch::setVertices(const std::vector<SandVertex>& vertices) {
  if (vertices_->vertexCount != vertices.size()) {
    vertices_->vertexCount = vertices.size();
    vertices_->vertexBufferBinding->setBinding(
        0,
        Ogre::HardwareBufferManager::getSingleton().createVertexBuffer(
            sizeof(SandVertex), vertices.size(), Ogre::HardwareBuffer::HBU_DYNAMIC_WRITE_ONLY_DISCARDABLE));
  }
  vertices_->vertexBufferBinding->getBuffer(0)->writeData(0, vertices.size() * sizeof(SandVertex),
                                                          vertices.data(), true);
  box_.setNull();
  for (const SandVertex& vertex : vertices)
    box_.merge(Ogre::Vector3(vertex.position[0], vertex.position[1], vertex.position[2]));
  // Culling goes by what the node remembers of its objects.
  node_->needUpdate();
}

void SandPatch::setTriangles(const TriangleBuffer& triangles) {
  triangles_->indexBuffer = triangles;
  triangles_->indexCount = triangles->getNumIndexes();
}

const Ogre::String& SandPatch::getMovableType() const {
  static const Ogre::String type = "ShallowSandPatch";
  return type;
}

Ogre::Real SandPatch::getBoundingRadius() const {
  return box_.isNull() ? 0.0f : std::max(box_.getMinimum().length(), box_.getMaximum().length());
}

void SandPatch::_updateRenderQueue(Ogre::RenderQueue* queue) {
  if (vertices_->vertexCount > 0 && triangles_->indexCount > 0) queue->addRenderable(this);
}

void SandPatch::visitRenderables(Ogre::Renderable::Visitor* visitor, bool /*debug_renderables*/) {
  visitor->visit(this, 0, false);
}

void SandPatch::getRenderOperation(Ogre::RenderOperation& operation) {
  operation.operationType = Ogre::RenderOperation::OT_TRIANGLE_LIST;
  operation.useIndexes = true;
  operation.vertexData = vertices_.get();
  operation.indexData = triangles_.get();
  operation.srcRenderable = this;
}

void SandPatch::getWorldTransforms(Ogre::Matrix4* transform) const {
  *transform = _getParentNodeFullTransform();
}

Ogre::Real SandPatch::getSquaredViewDepth(const Ogre::Camera* camera) const {
  return node_->getSquaredViewDepth(camera);
}

}  // namespace shallow_sand
