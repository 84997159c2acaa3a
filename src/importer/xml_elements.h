#pragma once

#include <functional>
#include <string>

#include <tinyxml2.h>

namespace patrol::importer {

/// Returns the text of an attribute; empty without it.
inline std::string attribute_text(const tinyxml2::XMLElement& element, const char* name) {
  const char* text = element.Attribute(name);
  return text == nullptr ? "" : text;
}

/// Calls `visit` with every element below `root`.
inline void for_each_below(const tinyxml2::XMLElement& root,
                           const std::function<void(const tinyxml2::XMLElement&)>& visit) {
  for (const tinyxml2::XMLElement* child = root.FirstChildElement(); child != nullptr;
       child = child->NextSiblingElement()) {
    visit(*child);
    for_each_below(*child, visit);
  }
}

/// Returns a text without blanks at its ends; empty for null.
inline std::string trimmed(const char* text) {
  std::string word = text == nullptr ? "" : text;
  word.erase(0, word.find_first_not_of(" \t\r\n"));
  word.erase(word.find_last_not_of(" \t\r\n") + 1);
  return word;
}

}  // namespace patrol::importer
