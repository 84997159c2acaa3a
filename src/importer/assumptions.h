#pragma once

#include <string>
#include <vector>

namespace patrol::importer {

/// Decision of the importer that the imported file does not determine.
struct Assumption {
  std::string subject;        ///< link, joint, mesh or setting
  std::string text;           ///< what is assumed and why
  std::string override_with;  ///< element of the description, option or key that overrides it
};

/// Returns names with commas between them, for the texts of assumptions.
std::string list_of(const std::vector<std::string>& names);

/// Returns the table of assumptions as Markdown, or `none` if there are none.
std::string to_markdown(const std::vector<Assumption>& assumptions, const std::string& none);

}  // namespace patrol::importer
