#pragma once

#include <cctype>
#include <string>

#include <tinyxml2.h>

namespace patrol::io {

/// Returns why a document could not be read, in words: "mismatched element" for XML_ERROR_MISMATCHED_ELEMENT.
inline std::string xml_problem(const tinyxml2::XMLDocument& document) {
  const tinyxml2::XMLError error = document.ErrorID();
  if (error == tinyxml2::XML_ERROR_PARSING) return "incomplete or not well-formed";
  if (error == tinyxml2::XML_ERROR_MISMATCHED_ELEMENT) return "mismatched element: a tag is not closed";
  std::string name = document.ErrorName();
  const std::string prefix = "XML_ERROR_";
  if (name.starts_with(prefix)) name.erase(0, prefix.size());
  for (char& c : name) c = c == '_' ? ' ' : static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return name;
}

}  // namespace patrol::io
