#include <gtest/gtest.h>

#include <fstream>

#include "shallow_sand/core/parameters.h"
#include "shallow_sand/scene/state_folder.h"
#include "temporary_folder.h"

namespace shallow_sand {
namespace {

namespace fs = std::filesystem;

class StateFolder : public ::testing::Test {
 protected:
  void refuse(const std::string& name) const { refuse(name, name); }
  /// @param told what the error says that the name is
  void refuse(const std::string& name, const std::string& told) const {
    try {
      FAIL() << name << " is taken for " << fileWithin(folder_, name);
    } catch (const InvalidParameter& problem) {
      const std::string text = problem.what();
      EXPECT_NE(text.find(told), std::string::npos) << text;
      EXPECT_NE(text.find(folder_.string()), std::string::npos) << text;
      EXPECT_EQ(text.find('\n'), std::string::npos) << text;
    }
  }

  TemporaryFolder temporary_;
  fs::path folder_ = fs::canonical(temporary_.path()) / "states";
};

TEST_F(StateFolder, HoldsItsFilesAndThoseInFoldersWithin) {
  for (const char* name : {"latest.tif", "a/b/c.tif", ".hidden", "..tif", "a b.tif", "./x.tif"}) {
    const fs::path file = fileWithin(folder_, name);
    EXPECT_EQ(file, (folder_ / name).lexically_normal());
  }
}

TEST_F(StateFolder, HoldsNothingElse) {
  for (const char* name : {"", ".", "..", "../x.tif", "a/../../x.tif", "a/..", "/etc/passwd", "/x", "a/"})
    refuse(name);
  refuse((folder_ / "x.tif").string());
  refuse(std::string("x.tif\0.txt", 10), "x.tif .txt");
  refuse("a\nb.tif", "a b.tif");
  fs::create_directories(folder_ / "inner");
  refuse("inner");
}

TEST_F(StateFolder, IsNotLeftByLinks) {
  fs::create_directories(folder_ / "inner");
  const fs::path outside = temporary_.path() / "outside";
  fs::create_directories(outside);
  std::ofstream(outside / "x.tif") << "x";
  fs::create_symlink(outside, folder_ / "way_out");
  fs::create_symlink(outside / "x.tif", folder_ / "x.tif");
  fs::create_symlink("inner", folder_ / "way_in");
  refuse("way_out/x.tif");
  refuse("way_out/new.tif");
  refuse("x.tif");
  EXPECT_EQ(fileWithin(folder_, "way_in/x.tif"), folder_ / "inner" / "x.tif");
  // A folder that is itself a link is as good as another, and one that begins alike is another.
  fs::create_symlink(folder_, temporary_.path() / "linked");
  EXPECT_EQ(fileWithin(temporary_.path() / "linked", "y.tif"), folder_ / "y.tif");
  fs::create_directories(temporary_.path() / "states2");
  fs::create_symlink("../states2", folder_ / "alike");
  refuse("alike/x.tif");
}

}  // namespace
}  // namespace shallow_sand
