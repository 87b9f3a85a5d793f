#pragma once

#include <OGRE/OgreColourValue.h>
#include <OGRE/OgreMaterial.h>

#include <array>
#include <string>

namespace shallow_sand {

/// What the colour of sand tells.
enum class ColorBy { sand, elevation, depth, slope, speed, change };

/// How sand and bed are painted: shaders that run on the graphics card, and what they are told.
class SandMaterial {
 public:
  /// @throws std::runtime_error if the graphics driver has no such shaders
  SandMaterial();
  ~SandMaterial();
  SandMaterial(const SandMaterial&) = delete;
  SandMaterial& operator=(const SandMaterial&) = delete;

  const Ogre::MaterialPtr& material() const { return material_; }

  void setColors(const Ogre::ColourValue& sand, const Ogre::ColourValue& bed);
  /// @param low, high what the first and the last colour of the scale stand for: [m], [m/s], or the tangent
  /// of a slope
  void setColorBy(ColorBy what, float low, float high);
  /// Sand thinner than this is bare bed. [m]
  void setShore(float depth);
  /// Distance of contour lines in elevation [m]; 0: none.
  void setContourInterval(float interval);
  void setAlpha(float alpha);
  /// Whether the sand is drawn, or only the bed below it.
  void showSand(bool shown);

 private:
  template <class Value>
  void set(const char* name, const Value& value);

  Ogre::MaterialPtr material_;
  std::array<std::string, 2> programs_;
};

}  // namespace shallow_sand
