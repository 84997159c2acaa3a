#pragma once

#include <string>
#include <utility>
#include <vector>

#include "app/realism/realism_result.h"
#include "report/blocks.h"

namespace patrol::app {

/// Content of a realism page besides the beams.
struct RealismContents {
  std::string kind, title;
  std::vector<std::pair<std::string, std::string>> facts;
  std::vector<std::string> notes;           ///< assumptions and limits of the comparison
  std::vector<report::Section> first = {};  ///< sections before the comparison
};

/// Page with key figures, map, scans, histograms and tables of a comparison.
report::Page realism_page(const RealismContents& contents, const RealismResult& result);

}  // namespace patrol::app
