#include <gdal_priv.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <memory>

#include "shallow_sand/scene/picture.h"

namespace shallow_sand {
namespace {

/// A picture as it lies on disk.
class Png {
 public:
  explicit Png(const std::string& path) {
    GDALAllRegister();
    const std::unique_ptr<GDALDataset, decltype(&GDALClose)> file(GDALDataset::Open(path.c_str()),
                                                                  &GDALClose);
    if (file == nullptr) {
      throw std::runtime_error(path + " is not there");
    }
    width_ = file->GetRasterXSize();
    height_ = file->GetRasterYSize();
    for (int channel = 0; channel < 3; ++channel) {
      channels_[channel].resize(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_));
      EXPECT_EQ(file->GetRasterBand(channel + 1)
                    ->RasterIO(GF_Read, 0, 0, width_, height_, channels_[channel].data(), width_, height_,
                               GDT_Byte, 0, 0, nullptr),
                CE_None);
    }
  }

  int width() const { return width_; }
  int height() const { return height_; }
  /// Mean of a square of 21 pixels, which the sand's grain doesn't touch; (u, v) from the relief's top left,
  /// 0 to 1.
  Eigen::Vector3d colourAt(double u, double v) const {
    constexpr int kReach = 10;
    const int x = kPictureBorder + static_cast<int>(u * (width_ - 2 * kPictureBorder));
    const int y = kPictureBorder + static_cast<int>(v * (height_ - 2 * kPictureBorder));
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (int row = y - kReach; row <= y + kReach; ++row) {
      for (int column = x - kReach; column <= x + kReach; ++column) {
        for (int channel = 0; channel < 3; ++channel) {
          sum[channel] += channels_[channel][static_cast<std::size_t>(row) * width_ + column];
        }
      }
    }
    return sum / ((2 * kReach + 1) * (2 * kReach + 1));
  }

 private:
  int width_ = 0;
  int height_ = 0;
  std::array<std::vector<unsigned char>, 3> channels_;
};

Grid gridOf(int columns, int rows) {
  Grid grid;
  grid.columns = columns;
  grid.rows = rows;
  grid.spacing = 0.02f;
  return grid;
}

/// A cone on a bare, level bed.
Fields pileOn(const Grid& grid) {
  Fields fields;
  fields.bed.assign(grid.cells(), 0.0f);
  fields.depth.assign(grid.cells(), 0.0f);
  const double radius = 0.4 * grid.rows * static_cast<double>(grid.spacing);
  for (int j = 0; j < grid.rows; ++j) {
    for (int i = 0; i < grid.columns; ++i) {
      const double distance =
          std::hypot(grid.x(i) - grid.x(grid.columns / 2), grid.y(j) - grid.y(grid.rows / 2));
      fields.depth[grid.index(i, j)] = static_cast<float>(std::max(0.0, 0.6 * (radius - distance)));
    }
  }
  return fields;
}

/// How much redder than blue.
double warmth(const Eigen::Vector3d& colour) { return (colour[0] - colour[2]) / colour.sum(); }

TEST(Picture, HasItsLongSideAndTheGridsShape) {
  const Grid wide = gridOf(60, 30);
  writePicture("wide.png", wide, pileOn(wide));
  EXPECT_EQ(Png("wide.png").width(), kPictureLongSide + 2 * kPictureBorder);
  EXPECT_EQ(Png("wide.png").height(), kPictureLongSide / 2 + 2 * kPictureBorder);
  const Grid tall = gridOf(7, 2001);
  writePicture("tall.png", tall, pileOn(tall));
  EXPECT_EQ(Png("tall.png").height(), kPictureLongSide + 2 * kPictureBorder);
}

TEST(Picture, TheSunStandsInTheNorthWest) {
  const Grid grid = gridOf(80, 80);
  writePicture("pile.png", grid, pileOn(grid));
  const Png picture("pile.png");
  EXPECT_GT(picture.colourAt(0.4, 0.4).sum(), 1.3 * picture.colourAt(0.6, 0.6).sum());
}

TEST(Picture, SandIsWarmAndBareBedIsGrey) {
  const Grid grid = gridOf(80, 80);
  writePicture("hues.png", grid, pileOn(grid));
  const Png picture("hues.png");
  EXPECT_GT(warmth(picture.colourAt(0.4, 0.4)), 0.1);
  EXPECT_LT(std::abs(warmth(picture.colourAt(0.05, 0.05))), 0.05);
}

/// Two grains over each other, each of which covers the whole sand; the bare bed has none.
TEST(Picture, SandHasTheColourOfTheHighestGrain) {
  const Grid grid = gridOf(80, 80);
  GrainCloud grains;
  grains.spacing = 80 * grid.spacing;
  const float middle = 40 * grid.spacing;
  grains.points = {{middle, middle, 0.2f}, {middle, middle, 0.1f}};
  grains.colors = {{0.2f, 0.3f, 0.9f}, {0.9f, 0.3f, 0.2f}};
  writePicture("grains.png", grid, pileOn(grid), {}, grains);
  const Png picture("grains.png");
  EXPECT_LT(warmth(picture.colourAt(0.4, 0.4)), -0.2);
  EXPECT_LT(std::abs(warmth(picture.colourAt(0.05, 0.05))), 0.05);
}

TEST(Picture, LevelSandIsOneTone) {
  const Grid grid = gridOf(50, 40);
  Fields fields;
  fields.bed.assign(grid.cells(), -3.0f);
  fields.depth.assign(grid.cells(), 0.3f);
  writePicture("level.png", grid, fields);
  const Png picture("level.png");
  EXPECT_LT((picture.colourAt(0.2, 0.2) - picture.colourAt(0.8, 0.7)).norm(), 2.0);
  EXPECT_GT(picture.colourAt(0.2, 0.2).sum(), 300.0);
}

TEST(Picture, ASingleCellIsNoTrouble) {
  const Grid grid = gridOf(1, 1);
  Fields fields;
  fields.bed = {0.0f};
  fields.depth = {0.0f};
  EXPECT_NO_THROW(writePicture("cell.png", grid, fields));
}

TEST(Picture, OutlinesAreDrawnWhereTheBodyIs) {
  const Grid grid = gridOf(100, 100);
  const Outline square{{0.5, 1.0}, {1.5, 1.0}, {1.5, 1.5}, {0.5, 1.5}};
  writePicture("plain.png", grid, pileOn(grid));
  writePicture("outlined.png", grid, pileOn(grid), {square, {{-5.0, -5.0}, {9.0, 9.0}}});
  const Png plain("plain.png");
  const Png outlined("outlined.png");
  EXPECT_GT((plain.colourAt(0.3, 0.25) - outlined.colourAt(0.3, 0.25)).norm(), 2.0);
  EXPECT_LT((plain.colourAt(0.2, 0.35) - outlined.colourAt(0.2, 0.35)).norm(), 1e-9);
}

TEST(Picture, FootprintIsTheConvexOutlineFromAbove) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation() = Eigen::Vector3d(1.0, 2.0, 3.0);
  pose.rotate(Eigen::AngleAxisd(M_PI / 2.0, Eigen::Vector3d::UnitZ()));
  const Outline outline = footprint(triangulate(Box{{2.0, 1.0, 4.0}}), pose);
  Eigen::AlignedBox2d box;
  for (const Eigen::Vector2d& corner : outline) {
    box.extend(corner);
  }
  EXPECT_TRUE(box.min().isApprox(Eigen::Vector2d(0.5, 1.0), 1e-9));
  EXPECT_TRUE(box.max().isApprox(Eigen::Vector2d(1.5, 3.0), 1e-9));
}

TEST(Picture, SaysWhichFileCannotBeWritten) {
  const Grid grid = gridOf(10, 10);
  try {
    writePicture("no_such_folder/picture.png", grid, pileOn(grid));
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_EQ(std::string(error.what()).rfind("no_such_folder/picture.png: ", 0), 0u) << error.what();
  }
}

}  // namespace
}  // namespace shallow_sand
