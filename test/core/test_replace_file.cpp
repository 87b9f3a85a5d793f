#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fstream>
#include <iterator>
#include <random>
#include <stdexcept>

#include "random_seed.h"
#include "shallow_sand/core/replace_file.h"
#include "temporary_folder.h"

namespace shallow_sand {
namespace {

namespace fs = std::filesystem;

void put(const fs::path& path, const std::string& text) {
  std::ofstream file(path);
  file << text;
}

std::string textOf(const fs::path& path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

std::ptrdiff_t filesIn(const fs::path& folder) {
  return std::distance(fs::directory_iterator(folder), fs::directory_iterator());
}

TEST(ReplaceFile, WritesWhatIsNewAndReplacesWhatIsOld) {
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "a.tif";
  for (const std::string text : {"first", "second, longer", "3"}) {
    replaceFile(path, [&](const fs::path& part) {
      EXPECT_NE(part, path);
      EXPECT_EQ(part.extension(), path.extension());
      put(part, text);
    });
    EXPECT_EQ(textOf(path), text);
    EXPECT_EQ(filesIn(folder.path()), 1);
  }
}

TEST(ReplaceFile, LeavesAllAsItWasIfWritingFails) {
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "a.tif";
  put(path, "old");
  const auto fail = [](const fs::path& part) {
    put(part, "half of the n");
    throw std::domain_error("disk full");
  };
  EXPECT_THROW(replaceFile(path, fail), std::domain_error);
  EXPECT_EQ(textOf(path), "old");
  EXPECT_EQ(filesIn(folder.path()), 1);
}

TEST(ReplaceFile, NamesTheFileThatCannotBeWritten) {
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "missing" / "a.tif";
  try {
    replaceFile(path, [](const fs::path& part) { put(part, "new"); });
    FAIL() << "written into a folder that is not there";
  } catch (const std::runtime_error& problem) {
    EXPECT_NE(std::string(problem.what()).find(path.string()), std::string::npos) << problem.what();
  }
}

TEST(ReplaceFile, FollowsLinksAndWritesToWhatIsNoFile) {
  const TemporaryFolder folder;
  put(folder.path() / "target.txt", "old");
  fs::create_symlink("target.txt", folder.path() / "link.txt");
  replaceFile(folder.path() / "link.txt", [](const fs::path& part) { put(part, "new"); });
  EXPECT_TRUE(fs::is_symlink(folder.path() / "link.txt"));
  EXPECT_EQ(textOf(folder.path() / "target.txt"), "new");
  replaceFile("/dev/null", [](const fs::path& part) { EXPECT_EQ(part, "/dev/null"); });
  EXPECT_TRUE(fs::is_character_file("/dev/null"));
}

/// A process writes the same letter many times, and another one next time, until it is killed.
TEST(ReplaceFile, IsWholeWhereverTheWriterIsKilled) {
  std::mt19937 random = seededGenerator();
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "a.txt";
  constexpr std::size_t kLength = 300000;
  put(path, std::string(kLength, 'a'));
  const auto writeForever = [&] {
    for (char letter = 'a';; letter = letter == 'z' ? 'a' : static_cast<char>(letter + 1))
      replaceFile(path, [&](const fs::path& part) { put(part, std::string(kLength, letter)); });
  };
  for (int round = 0; round < 20; ++round) {
    const pid_t writer = ::fork();
    if (writer == 0) writeForever();
    ASSERT_GT(writer, 0);
    ::usleep(static_cast<useconds_t>(random() % 20000));
    ::kill(writer, SIGKILL);
    ::waitpid(writer, nullptr, 0);
    const std::string text = textOf(path);
    ASSERT_EQ(text, std::string(kLength, text.at(0)));
    removeLeftParts(path);
    ASSERT_EQ(filesIn(folder.path()), 1) << "what a killed writer left is still there";
  }
}

TEST(ReplaceFile, KeepsPartsOfThoseWhoLiveAndOtherFiles) {
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "a.tif";
  const std::string own = "a." + std::to_string(::getpid()) + ".0.part.tif";
  for (const std::string& name : {own, std::string("a.tif"), std::string("a.1.part.png"),
                                  std::string("b.999999999.0.part.tif"), std::string("a.old.part.tif")})
    put(folder.path() / name, "x");
  put(folder.path() / "a.999999999.0.part.tif", "x");  // Linux numbers no process so high
  removeLeftParts(path);
  EXPECT_EQ(filesIn(folder.path()), 5);
  EXPECT_FALSE(fs::exists(folder.path() / "a.999999999.0.part.tif"));
}

}  // namespace
}  // namespace shallow_sand
