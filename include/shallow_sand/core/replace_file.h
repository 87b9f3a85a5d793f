#pragma once

#include <filesystem>
#include <functional>
#include <string>

namespace shallow_sand {

/// Writes a file such that whoever reads it, at any time and after any crash, finds all of the old one or all
/// of the new one: it is written beside the old one, brought to the disk and renamed. A link stays and leads
/// to the new file; what is no file, as /dev/stdout, is written to as it is.
/// @param write gets the path to write to, with the extension of `path`; when it throws, nothing has changed
/// @throws what `write` throws; std::runtime_error naming `path`
void replaceFile(const std::filesystem::path& path,
                 const std::function<void(const std::filesystem::path& part)>& write);

/// Removes what processes that were killed on this machine have left of files that should have become `path`.
void removeLeftParts(const std::filesystem::path& path);

}  // namespace shallow_sand
