#pragma once

#include <string_view>

/// Files that every page carries, put into the program when it is built (embed.cmake).
namespace patrol::render {

extern const std::string_view kReportStyle;   ///< report.css
extern const std::string_view kReportScript;  ///< report.js
extern const std::string_view kPlotLibrary;   ///< uPlot, which declares itself as `uPlot`
extern const std::string_view kPlotStyle;

}  // namespace patrol::render
