#pragma once

#include <QApplication>
#include <QImage>
#include <functional>
#include <memory>
#include <string>

#include "shallow_sand/rviz/height_field_display.h"

namespace rviz {
class VisualizationFrame;
class VisualizationManager;
}  // namespace rviz

namespace shallow_sand {

/// The whole of rviz, in this process and under its control.
class RvizWindow {
 public:
  /// ROS must have been initialised. @param view a .rviz file
  RvizWindow(int& argc, char** argv, const std::string& view);
  ~RvizWindow();

  /// Leaves what is shown now for another .rviz file.
  void load(const std::string& view);
  rviz::VisualizationManager& manager();
  /// The display of that class that comes first; null if there is none.
  HeightFieldDisplay* sand();
  /// Displays whose status is an error, by name.
  std::string errors();

  /// Lets rviz run until something holds, looked at after each frame; false if it does not within so many
  /// seconds.
  bool runUntil(const std::function<bool()>& holds, double seconds);
  /// Lets rviz show so many more frames.
  bool runFrames(int frames, double seconds);
  /// What rviz draws.
  QImage picture();

 private:
  QApplication application_;
  std::unique_ptr<rviz::VisualizationFrame> frame_;
};

}  // namespace shallow_sand
