#pragma once

#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include <tinyxml2.h>

namespace patrol::importer {

/// Element of SDF that is left out before libsdformat reads the file.
struct LeftOutElement {
  std::string element;
  int line = 0;
  std::string text;           ///< why, for its row
  std::string override_with;  ///< what replaces it, for its row
};

/// Returns the row of an element that a site does not have and that is left out; none: it is another one, or it has no
/// row.
std::optional<LeftOutElement> left_out_element(std::string_view element, int line);

/// Removes lights, actors, roads and inertias below an element: their errors do not concern a site, and lights of
/// included models often have the same name. Plugins, sensors and states keep theirs. Returns those with a row.
std::vector<LeftOutElement> leave_out_elements(tinyxml2::XMLElement& root);

/// Removes models and includes of the world of a file by their names; an include without a name has the last part of
/// its URI. Returns the names of all models that the world had.
std::set<std::string> leave_out_models(tinyxml2::XMLElement& root, const std::set<std::string>& names);

}  // namespace patrol::importer
