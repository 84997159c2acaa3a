#pragma once

#include <string>

#include "report/blocks.h"

/// Conversion of blocks to HTML. Blocks drawn by a script embed their data; report.js draws them.
namespace patrol::report {

std::string block_html(const Block& block);

std::string to_html(const TextBlock& block);
std::string to_html(const VerdictBlock& block);
std::string to_html(const KeyMetrics& block);
std::string to_html(const TableBlock& block);
std::string to_html(const CollapsibleTables& block);
std::string to_html(const BarBlock& block);
std::string to_html(const BoxPlot& block);
std::string to_html(const WaterfallChart& block);
std::string to_html(const LinePlot& block);
std::string to_html(const EventTimeline& block);
std::string to_html(const MapBlock& block);
std::string to_html(const HeatMap& block);
std::string to_html(const PlanView& block);
std::string to_html(const VideoBlock& block);
std::string to_html(const PictureBlock& block);

/// CSS class of report.css.
const char* css_class(Tone tone);
const char* css_class(SeriesColor color);

}  // namespace patrol::report
