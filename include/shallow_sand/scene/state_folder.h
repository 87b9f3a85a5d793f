#pragma once

#include <filesystem>
#include <string>

namespace shallow_sand {

/// Where a file of this name is, or would be, in a folder: nothing outside of it is reached, whoever chose
/// the name. @throws InvalidParameter with key `file` for absolute paths, "..", links that lead out, folders
/// and no name at all
std::filesystem::path fileWithin(const std::filesystem::path& folder, const std::string& name);

}  // namespace shallow_sand
