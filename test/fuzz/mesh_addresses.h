#pragma once

#include <stdlib.h>

#include <fstream>
#include <string>

#include "temporary_folder.h"

namespace shallow_sand {

/// The only folder from which meshes are read, which an input calls FOLDER. No package is found elsewhere.
inline const std::string& meshFolder() {
  static const TemporaryFolder folder;
  static const std::string path = [] {
    const auto write = [](const std::string& name, const std::string& content) {
      std::ofstream(folder.path() / name, std::ios::binary) << content;
    };
    write("empty.stl", "");
    write("text.obj", "no mesh\n");
    write("roof.obj",
          "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0.5 0.5 1\nf 4 3 2 1\nf 1 2 5\nf 2 3 5\nf 3 4 5\nf 4 1 5\n");
    setenv("ROS_PACKAGE_PATH", folder.path().c_str(), 1);
    setenv("ROS_HOME", folder.path().c_str(), 1);
    return folder.path().string();
  }();
  return path;
}

/// The text with the folder's path.
inline std::string withMeshFolder(std::string text) {
  const std::string word = "FOLDER";
  for (std::size_t at = text.find(word); at != std::string::npos; at = text.find(word, at))
    text.replace(at, word.size(), meshFolder());
  return text;
}

/// Whether an address leads to the folder, to a network that must not be reached, or nowhere.
inline bool isHarmless(const std::string& address) {
  const auto begins = [&](const std::string& text) { return address.rfind(text, 0) == 0; };
  if (address.find("..") != std::string::npos || address.find("&#") != std::string::npos ||
      address.find('%') != std::string::npos) {
    return false;
  }
  return address.find('/') == std::string::npos || begins("http://") || begins("package://") ||
         begins(meshFolder() + "/") || begins("file://" + meshFolder() + "/");
}

}  // namespace shallow_sand
