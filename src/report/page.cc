#include "report/page.h"

#include <algorithm>
#include <cctype>

#include <fmt/format.h>

#include "io/files/markup_text.h"
#include "report/assets.h"
#include "report/block_html.h"
#include "report/html.h"

namespace patrol::report {
namespace {

constexpr const char* kGridEnd = "</div>\n<p class=\"note hint\">Drag to zoom all plots; double-click to reset.</p>\n";
constexpr const char* kPolicy =
    "default-src 'none'; style-src 'unsafe-inline'; script-src 'unsafe-inline'; img-src data:; media-src data: 'self' "
    "file:";

/// Anchor of a section: "Error over time" -> "error-over-time".
std::string anchor_of(const std::string& title) {
  std::string anchor;
  for (const char c : title)
    anchor += std::isalnum(static_cast<unsigned char>(c))
                  ? static_cast<char>(std::tolower(static_cast<unsigned char>(c)))
                  : '-';
  return anchor;
}

std::string header_html(const Page& page) {
  std::string html = fmt::format("<header><p class=\"kind\">Patrol: {}</p><h1>{}</h1>\n<dl class=\"facts\">",
                                 io::escaped_markup(page.kind), io::escaped_markup(page.title));
  for (const auto& [label, value] : page.facts) {
    html += fmt::format("<div><dt>{}</dt><dd>{}</dd></div>", io::escaped_markup(label), io::escaped_markup(value));
  }
  return html + "</dl></header>\n";
}

std::string navigation_html(const Page& page) {
  std::string html = "<nav>";
  for (const Section& section : page.sections) {
    if (!section.title.empty())
      html += fmt::format("<a href=\"#{}\">{}</a>", anchor_of(section.title), io::escaped_markup(section.title));
  }
  return html + "</nav>\n";
}

/// Converts the blocks; consecutive line plots form a grid.
std::string blocks_html(const std::vector<Block>& blocks) {
  std::string html;
  bool is_in_grid = false;
  for (const Block& block : blocks) {
    const bool is_line_plot = std::holds_alternative<LinePlot>(block);
    if (is_line_plot != is_in_grid) html += is_line_plot ? "<div class=\"grid\">\n" : kGridEnd;
    is_in_grid = is_line_plot;
    html += block_html(block);
  }
  return html + (is_in_grid ? kGridEnd : "");
}

std::string section_html(const Section& section) {
  if (section.title.empty()) return fmt::format("<section>\n{}</section>\n", blocks_html(section.blocks));
  return fmt::format("<section id=\"{}\">\n<h2>{}</h2>\n{}</section>\n", anchor_of(section.title),
                     io::escaped_markup(section.title), blocks_html(section.blocks));
}

/// uPlot reads the pixel ratio from a name that is shadowed here. A ratio of at least three gives sharp plots in print.
std::string scripts_html() {
  return fmt::format(
      "<script>(function(devicePixelRatio){{\n{}\nwindow.uPlot=uPlot;}})(Math.max(3,window.devicePixelRatio));</"
      "script>\n<script>\n{}</script>\n",
      kPlotLibrary, kReportScript);
}

}  // namespace

std::string to_html(const Page& page) {
  std::string html = fmt::format(
      "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
      "<meta http-equiv=\"Content-Security-Policy\" content=\"{}\">\n<link rel=\"icon\" href=\"data:,\">\n"
      "<title>{}</title>\n<style>\n{}\n{}</style></head>\n<body>\n",
      kPolicy, io::escaped_markup(page.title), kPlotStyle, kReportStyle);
  html += header_html(page) + navigation_html(page) + "<main>\n";
  for (const Section& section : page.sections) html += section_html(section);
  html += fmt::format(
      "</main>\n<footer>{}</footer>\n<noscript><p class=\"note\">Plots require JavaScript.</p></noscript>\n",
      io::escaped_markup(page.footer));
  return html + scripts_html() + "</body></html>\n";
}

}  // namespace patrol::report
