#include "rviz/rviz_window.h"

#include <OGRE/OgreRenderWindow.h>
#include <rviz/display_group.h>
#include <rviz/render_panel.h>
#include <rviz/visualization_frame.h>
#include <rviz/visualization_manager.h>

#include <QTemporaryDir>
#include <chrono>

namespace shallow_sand {
namespace {

template <class Function>
void forEachDisplay(rviz::DisplayGroup& group, const Function& function) {
  for (int k = 0; k < group.numDisplays(); ++k) {
    rviz::Display* display = group.getDisplayAt(k);
    function(*display);
    if (auto* inner = qobject_cast<rviz::DisplayGroup*>(display)) forEachDisplay(*inner, function);
  }
}

}  // namespace

RvizWindow::RvizWindow(int& argc, char** argv, const std::string& view)
    : application_(argc, argv), frame_(std::make_unique<rviz::VisualizationFrame>()) {
  frame_->setApp(&application_);
  frame_->setSplashPath("");
  frame_->initialize(QString::fromStdString(view));
  frame_->show();
}

RvizWindow::~RvizWindow() = default;

void RvizWindow::load(const std::string& view) {
  frame_->setWindowModified(false);  // else it asks whether to save the last view
  frame_->loadDisplayConfig(QString::fromStdString(view));
  frame_->show();
}

rviz::VisualizationManager& RvizWindow::manager() { return *frame_->getManager(); }

HeightFieldDisplay* RvizWindow::sand() {
  HeightFieldDisplay* found = nullptr;
  forEachDisplay(*manager().getRootDisplayGroup(), [&](rviz::Display& display) {
    if (found == nullptr) found = qobject_cast<HeightFieldDisplay*>(&display);
  });
  return found;
}

std::string RvizWindow::errors() {
  std::string errors;
  forEachDisplay(*manager().getRootDisplayGroup(), [&](rviz::Display& display) {
    for (int k = 0; k < display.numChildren(); ++k) {
      const QString name = display.childAt(k)->getName();
      if (display.isEnabled() && name.startsWith("Status: ") && name.contains("Error"))
        errors += display.getNameStd() + " ";
    }
  });
  return errors;
}

bool RvizWindow::runUntil(const std::function<bool()>& holds, double seconds) {
  using Clock = std::chrono::steady_clock;
  const auto end = Clock::now() + std::chrono::duration<double>(seconds);
  while (!holds()) {
    if (Clock::now() > end) return false;
    application_.processEvents(QEventLoop::WaitForMoreEvents, 100);
  }
  return true;
}

bool RvizWindow::runFrames(int frames, double seconds) {
  const std::uint64_t last = manager().getFrameCount() + static_cast<std::uint64_t>(frames);
  return runUntil([&] { return manager().getFrameCount() >= last; }, seconds);
}

QImage RvizWindow::picture() {
  const QTemporaryDir folder;
  const QString file = folder.filePath("picture.png");
  manager().getRenderPanel()->getRenderWindow()->writeContentsToFile(file.toStdString());
  return QImage(file).convertToFormat(QImage::Format_RGB888);
}

}  // namespace shallow_sand
