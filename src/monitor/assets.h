#pragma once

#include <string_view>

/// Files of the page, compiled into the program (embed.cmake).
namespace patrol::monitor {

extern const std::string_view kPage;          ///< index.html
extern const std::string_view kPageStyle;     ///< page.css
extern const std::string_view kPageScript;    ///< page.js
extern const std::string_view kSiteScript;    ///< site.js
extern const std::string_view kFormatScript;  ///< format.js
extern const std::string_view kMapScript;     ///< map.js
extern const std::string_view kPlotsScript;   ///< plots.js
extern const std::string_view kPlotLibrary;   ///< uPlot
extern const std::string_view kPlotStyle;
extern const std::string_view kSchema;  ///< result.schema.json

}  // namespace patrol::monitor
