#include "shallow_sand/core/replace_file.h"

#include <fcntl.h>
#include <signal.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdlib>
#include <stdexcept>
#include <system_error>

namespace shallow_sand {
namespace {

namespace fs = std::filesystem;

/// "FOLDER/STEM.": what names of all parts begin with, then come ".PROCESS.NUMBER.part" and the extension.
fs::path beginOfParts(const fs::path& path) { return path.parent_path() / (path.stem().string() + "."); }

fs::path partOf(const fs::path& path) {
  static std::atomic<unsigned> count{0};
  return beginOfParts(path).string() + std::to_string(::getpid()) + "." + std::to_string(count++) + ".part" +
         path.extension().string();
}

/// Until the disk has it. @throws std::system_error
void synchronise(const fs::path& path, int flags) {
  const int file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | flags);
  const bool done = file >= 0 && ::fsync(file) == 0;
  const int error = errno;
  if (file >= 0) ::close(file);
  // A file system that cannot do so for folders says EINVAL.
  if (!done && !(flags != 0 && error == EINVAL))
    throw std::system_error(error, std::generic_category(), "cannot be brought to the disk");
}

/// The number of the process that writes a part; 0 for other files.
pid_t writerOf(const fs::path& file, const fs::path& path) {
  const std::string name = file.filename().string();
  const std::string begin = beginOfParts(path).filename().string();
  const std::string end = ".part" + path.extension().string();
  if (name.size() < begin.size() + end.size() || name.compare(0, begin.size(), begin) != 0 ||
      name.compare(name.size() - end.size(), end.size(), end) != 0) {
    return 0;
  }
  return static_cast<pid_t>(std::strtol(name.c_str() + begin.size(), nullptr, 10));
}

}  // namespace

void replaceFile(const fs::path& path, const std::function<void(const fs::path& part)>& write) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (fs::exists(status) && !fs::is_regular_file(status)) return write(path);
  const fs::path target = fs::exists(status) ? fs::canonical(path) : path;
  const fs::path part = partOf(target);
  try {
    write(part);
    synchronise(part, 0);
    fs::rename(part, target);
    synchronise(target.has_parent_path() ? target.parent_path() : ".", O_DIRECTORY);
  } catch (const std::system_error& problem) {
    fs::remove(part, error);
    throw std::runtime_error(path.string() + ": cannot be written (" + problem.code().message() + ")");
  } catch (...) {
    fs::remove(part, error);
    throw;
  }
}

void removeLeftParts(const fs::path& path) {
  std::error_code error;
  const fs::path folder = path.has_parent_path() ? path.parent_path() : ".";
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
    const pid_t writer = writerOf(entry->path(), path);
    std::error_code gone;
    if (writer > 0 && ::kill(writer, 0) != 0 && errno == ESRCH) fs::remove(entry->path(), gone);
  }
}

}  // namespace shallow_sand
