#pragma once

#include <string_view>

/// Files contained in every report page, compiled into the program (embed.cmake).
namespace patrol::report {

extern const std::string_view kReportStyle;   ///< report.css
extern const std::string_view kReportScript;  ///< report.js
extern const std::string_view kPlotLibrary;   ///< uPlot, which defines the global `uPlot`
extern const std::string_view kPlotStyle;

}  // namespace patrol::report
