#include "shallow_sand/rviz/sand_material.h"

#include <OGRE/OgreGpuProgramManager.h>
#include <OGRE/OgreHighLevelGpuProgram.h>
#include <OGRE/OgreHighLevelGpuProgramManager.h>
#include <OGRE/OgreMaterialManager.h>
#include <OGRE/OgrePass.h>
#include <OGRE/OgreResourceGroupManager.h>
#include <OGRE/OgreTechnique.h>

#include <atomic>
#include <stdexcept>
#include <vector>

#include "sand_shaders.h"

namespace shallow_sand {
namespace {

using Palette = std::array<Ogre::ColourValue, 6>;

const Palette kHeight{Ogre::ColourValue(0.27f, 0.00f, 0.33f), Ogre::ColourValue(0.25f, 0.27f, 0.53f),
                      Ogre::ColourValue(0.16f, 0.47f, 0.56f), Ogre::ColourValue(0.13f, 0.66f, 0.52f),
                      Ogre::ColourValue(0.48f, 0.82f, 0.32f), Ogre::ColourValue(0.99f, 0.91f, 0.15f)};
const Palette kHeat{Ogre::ColourValue(0.20f, 0.16f, 0.36f), Ogre::ColourValue(0.47f, 0.17f, 0.45f),
                    Ogre::ColourValue(0.76f, 0.25f, 0.40f), Ogre::ColourValue(0.93f, 0.45f, 0.29f),
                    Ogre::ColourValue(0.98f, 0.70f, 0.32f), Ogre::ColourValue(0.99f, 0.95f, 0.65f)};
const Palette kCutAndFill{Ogre::ColourValue(0.10f, 0.27f, 0.55f), Ogre::ColourValue(0.36f, 0.60f, 0.80f),
                          Ogre::ColourValue(0.90f, 0.88f, 0.83f), Ogre::ColourValue(0.90f, 0.88f, 0.83f),
                          Ogre::ColourValue(0.88f, 0.50f, 0.36f), Ogre::ColourValue(0.63f, 0.11f, 0.17f)};

const Palette& paletteOf(ColorBy what) {
  if (what == ColorBy::change) return kCutAndFill;
  return what == ColorBy::elevation || what == ColorBy::depth ? kHeight : kHeat;
}

/// A program of the graphics card, by a name that no other has.
std::string makeProgram(Ogre::GpuProgramType type, const std::string& source) {
  static std::atomic<int> made{0};
  const std::string name = "shallow_sand/program" + std::to_string(made++);
  Ogre::HighLevelGpuProgramPtr program = Ogre::HighLevelGpuProgramManager::getSingleton().createProgram(
      name, Ogre::ResourceGroupManager::DEFAULT_RESOURCE_GROUP_NAME, "glsl", type);
  program->setSource(source);
  program->load();
  if (program->hasCompileError()) throw std::runtime_error("the graphics driver refuses GLSL 1.20");
  return name;
}

Ogre::Pass* passOf(const Ogre::MaterialPtr& material) { return material->getTechnique(0)->getPass(0); }

}  // namespace

SandMaterial::SandMaterial() {
  if (!Ogre::GpuProgramManager::getSingleton().isSyntaxSupported("glsl"))
    throw std::runtime_error("the graphics driver has no GLSL shaders");
  programs_ = {makeProgram(Ogre::GPT_VERTEX_PROGRAM, kVertexShader),
               makeProgram(Ogre::GPT_FRAGMENT_PROGRAM, kFragmentShader)};
  material_ = Ogre::MaterialManager::getSingleton().create(
      programs_[0] + "/material", Ogre::ResourceGroupManager::DEFAULT_RESOURCE_GROUP_NAME);
  Ogre::Pass* pass = passOf(material_);
  pass->setVertexProgram(programs_[0]);
  pass->setFragmentProgram(programs_[1]);
  // From below one sees the sand's underside, which is better than nothing at all.
  pass->setCullingMode(Ogre::CULL_NONE);
  pass->getVertexProgramParameters()->setNamedAutoConstant(
      "to_screen", Ogre::GpuProgramParameters::ACT_WORLDVIEWPROJ_MATRIX);
  material_->load();
}

SandMaterial::~SandMaterial() {
  Ogre::MaterialManager::getSingleton().remove(material_->getHandle());
  for (const std::string& program : programs_) {
    const auto resource = Ogre::HighLevelGpuProgramManager::getSingleton().getByName(program);
    Ogre::HighLevelGpuProgramManager::getSingleton().remove(resource->getHandle());
  }
}

template <class Value>
void SandMaterial::set(const char* name, const Value& value) {
  passOf(material_)->getFragmentProgramParameters()->setNamedConstant(name, value);
}

void SandMaterial::setColors(const Ogre::ColourValue& sand, const Ogre::ColourValue& bed) {
  set("sand_color", sand);
  set("bed_color", bed);
}

void SandMaterial::setColorBy(ColorBy what, float low, float high) {
  set("color_by", static_cast<Ogre::Real>(what));
  set("range", Ogre::Vector4(low, high, 0.0f, 0.0f));
  const Palette& palette = paletteOf(what);
  for (std::size_t k = 0; k < palette.size(); ++k) set(("palette" + std::to_string(k)).c_str(), palette[k]);
}

void SandMaterial::setShore(float depth) { set("shore", static_cast<Ogre::Real>(depth)); }

void SandMaterial::setContourInterval(float interval) {
  set("contour_interval", static_cast<Ogre::Real>(interval));
}

void SandMaterial::showSand(bool shown) {
  const Ogre::Real value = shown ? 1.0f : 0.0f;
  set("show_sand", value);
  passOf(material_)->getVertexProgramParameters()->setNamedConstant("show_sand", value);
}

void SandMaterial::setAlpha(float alpha) {
  set("alpha", static_cast<Ogre::Real>(alpha));
  Ogre::Pass* pass = passOf(material_);
  const bool opaque = alpha >= 1.0f;
  pass->setSceneBlending(opaque ? Ogre::SBT_REPLACE : Ogre::SBT_TRANSPARENT_ALPHA);
  pass->setDepthWriteEnabled(opaque);
}

}  // namespace shallow_sand
