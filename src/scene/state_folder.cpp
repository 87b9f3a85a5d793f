#include "shallow_sand/scene/state_folder.h"

#include <algorithm>
#include <cctype>

#include "shallow_sand/core/parameters.h"

namespace shallow_sand {
namespace {

namespace fs = std::filesystem;

bool holds(const fs::path& folder, const fs::path& file) {
  return std::mismatch(folder.begin(), folder.end(), file.begin(), file.end()).first == folder.end();
}

}  // namespace

fs::path fileWithin(const fs::path& folder, const std::string& name) {
  const auto isControl = [](unsigned char letter) { return std::iscntrl(letter) != 0; };
  const auto refuse = [&](const std::string& found) {
    throw InvalidParameter("file", name + found, "the name of a file in the folder " + folder.string());
  };
  const fs::path given = name;
  // Functions of the system would read a name to its first zero only, and the log a line.
  if (std::any_of(name.begin(), name.end(), isControl)) refuse(", which holds control characters");
  if (!given.has_filename() || given.filename() == ".") refuse(name.empty() ? "empty" : ", which is no name");
  if (given.is_absolute()) refuse(", an absolute path");
  if (std::find(given.begin(), given.end(), "..") != given.end()) refuse(", which leads out by ..");
  std::error_code error;
  const fs::path base = fs::weakly_canonical(folder, error);
  const fs::path file = error ? fs::path() : fs::weakly_canonical(base / given, error);
  if (error) refuse(" (" + error.message() + ")");
  if (!holds(base, file)) refuse(", a link to " + file.string());
  if (fs::is_directory(file)) refuse(", a folder");
  return file;
}

}  // namespace shallow_sand
