#include "shallow_sand/bodies/link_selection.h"

#include <fnmatch.h>
#include <tinyxml2.h>

#include <algorithm>

namespace shallow_sand {
namespace {

bool anyMatches(const std::vector<std::string>& patterns, const std::string& name) {
  return std::any_of(patterns.begin(), patterns.end(),
                     [&](const std::string& pattern) { return matchesPattern(pattern, name); });
}

bool isChosen(const LinkPatterns& patterns, const std::string& name) {
  return (patterns.include.empty() || anyMatches(patterns.include, name)) &&
         !anyMatches(patterns.exclude, name);
}

void takeCollisionsOut(tinyxml2::XMLElement& link) {
  while (auto* collision = link.FirstChildElement("collision")) link.DeleteChild(collision);
}

}  // namespace

bool matchesPattern(const std::string& pattern, const std::string& name) {
  return fnmatch(pattern.c_str(), name.c_str(), 0) == 0;
}

std::vector<std::string> unmatchedPatterns(const std::vector<std::string>& patterns,
                                           const std::vector<std::string>& names) {
  std::vector<std::string> unmatched;
  for (const std::string& pattern : patterns) {
    const bool used = std::any_of(names.begin(), names.end(),
                                  [&](const std::string& name) { return matchesPattern(pattern, name); });
    if (!used) unmatched.push_back(pattern);
  }
  return unmatched;
}

LinkSelection selectLinks(const std::string& urdf_xml, const LinkPatterns& patterns) {
  LinkSelection selection;
  selection.urdf = urdf_xml;
  tinyxml2::XMLDocument document;
  if (document.Parse(urdf_xml.data(), urdf_xml.size()) != tinyxml2::XML_SUCCESS) return selection;
  auto* robot = document.FirstChildElement("robot");
  if (robot == nullptr) return selection;
  for (auto* link = robot->FirstChildElement("link"); link; link = link->NextSiblingElement("link")) {
    const char* name = link->Attribute("name");
    if (name == nullptr || link->FirstChildElement("collision") == nullptr) continue;
    selection.available.emplace_back(name);
    if (!isChosen(patterns, name)) takeCollisionsOut(*link);
  }
  for (const auto* list : {&patterns.include, &patterns.exclude}) {
    const std::vector<std::string> unmatched = unmatchedPatterns(*list, selection.available);
    selection.unmatched.insert(selection.unmatched.end(), unmatched.begin(), unmatched.end());
  }
  tinyxml2::XMLPrinter printer;
  document.Print(&printer);
  selection.urdf = printer.CStr();
  return selection;
}

}  // namespace shallow_sand
