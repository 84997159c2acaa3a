#include <algorithm>
#include <cctype>
#include <cmath>

#include <fmt/format.h>

#include "io/files/markup_text.h"
#include "report/block_html.h"
#include "report/html.h"
#include "report/round_step.h"

/// Tables, and charts made of tables with a bar or box per row, without a script.
namespace patrol::report {
namespace {

/// Escaped text with line break opportunities after '_' and '/' and between the parts of a path.
std::string breakable_html(const std::string& text) {
  std::string html;
  for (std::size_t i = 0; i < text.size(); ++i) {
    html += io::escaped_markup(std::string_view(text).substr(i, 1));
    const bool is_part =
        text[i] == '.' && i + 1 < text.size() && std::isalpha(static_cast<unsigned char>(text[i + 1])) != 0;
    if (text[i] == '_' || text[i] == '/' || is_part) html += "<wbr>";
  }
  return html;
}

std::string cell_html(const TableCell& cell, const Column& column) {
  const std::string classes = fmt::format("{}{}", column.is_number ? "number " : "", css_class(cell.tone));
  return fmt::format("<td class=\"{}\">{}</td>", classes,
                     column.is_number ? io::escaped_markup(cell.text) : breakable_html(cell.text));
}

std::string head_html(const std::vector<Column>& columns) {
  if (std::all_of(columns.begin(), columns.end(), [](const Column& column) { return column.title.empty(); })) return "";
  std::string html = "<thead><tr>";
  for (const Column& column : columns) {
    html += fmt::format("<th{}>{}</th>", column.is_number ? " class=\"number\"" : "", io::escaped_markup(column.title));
  }
  return html + "</tr></thead>";
}

/// Axis with round ticks from at most `min` to at least `max`, including zero.
struct Scale {
  double step = 0.2;
  double begin = 0.0;
  double end = 1.0;

  Scale(double min, double max) {
    min = std::min(min, 0.0);
    max = std::max(max, 0.0);
    if (!(max - min > 0.0)) return;
    step = round_step(max - min, 5);
    begin = step * std::floor(min / step * (1.0 - 1e-9));
    end = step * std::ceil(max / step * (1.0 - 1e-9));
  }
  double percent(double value) const { return 100.0 * (value - begin) / (end - begin); }
  double width(double from, double to) const { return 100.0 * (to - from) / (end - begin); }
};

std::string ticks_html(const Scale& scale, const std::string& unit) {
  std::string html;
  const long first = std::lround(scale.begin / scale.step), last = std::lround(scale.end / scale.step);
  for (long i = first; i <= last; ++i) {
    const double value = static_cast<double>(i) * scale.step;
    const std::string text = fmt::format("{:.6g}{}", value, i == last ? " " + unit : "");
    html += fmt::format("<i style=\"left:{:.3f}%\">{}</i>", scale.percent(value), io::escaped_markup(text));
  }
  return fmt::format("<tr class=\"ticks\"><th></th><td><div class=\"track\">{}</div></td><td></td></tr>\n", html);
}

std::string box_html(const Box& box, const Scale& scale) {
  const auto [min, max] = std::minmax_element(box.values.begin(), box.values.end());
  const auto span = [&](const char* name, double from, double to) {
    return fmt::format(R"(<i class="{}" style="left:{:.3f}%;width:{:.3f}%"></i>)", name, scale.percent(from),
                       scale.width(from, to));
  };
  std::string html = span("whisker", *min, *max) + span("box", box.lower_quartile, box.upper_quartile);
  for (const double value : box.values)
    html += fmt::format(R"(<i class="dot" style="left:{:.3f}%"></i>)", scale.percent(value));
  return html + fmt::format(R"(<i class="median" style="left:{:.3f}%"></i>)", scale.percent(box.median));
}

std::string span_html(const Span& span, const Scale& scale) {
  const double low = std::min(span.from, span.to), high = std::max(span.from, span.to);
  std::string html = fmt::format(
      R"(<i class="zero" style="left:{:.3f}%"></i><i class="span {}" style="left:{:.3f}%;width:{:.3f}%"></i>)",
      scale.percent(0.0), css_class(span.tone), scale.percent(low), scale.width(low, high));
  if (!span.interval) return html;
  return html + fmt::format(R"(<i class="whisker" style="left:{:.3f}%;width:{:.3f}%"></i>)",
                            scale.percent(span.interval->first),
                            scale.width(span.interval->first, span.interval->second));
}

}  // namespace

std::string to_html(const TableBlock& block) {
  std::string html = "<div class=\"table\" tabindex=\"0\"><table>";  // scrolls: reachable by keyboard
  if (!block.caption.empty()) html += fmt::format("<caption>{}</caption>", io::escaped_markup(block.caption));
  html += head_html(block.columns) + "<tbody>\n";
  for (const std::vector<TableCell>& row : block.rows) {
    html += "<tr>";
    for (std::size_t i = 0; i < row.size() && i < block.columns.size(); ++i)
      html += cell_html(row[i], block.columns[i]);
    html += "</tr>\n";
  }
  return html + "</tbody></table></div>\n";
}

std::string to_html(const CollapsibleTables& block) {
  std::string html = fmt::format("<details><summary>{}</summary>\n<div class=\"{}\">\n",
                                 io::escaped_markup(block.summary), block.tables.size() > 1 ? "columns" : "single");
  for (const TableBlock& table : block.tables) html += to_html(table);
  return html + "</div></details>\n";
}

std::string to_html(const BarBlock& block) {
  double max = 0.0;
  for (const Bar& bar : block.bars) max = std::max(max, bar.value);
  std::string html =
      fmt::format("<table class=\"chart bars\"><caption>{}</caption><tbody>\n", io::escaped_markup(block.caption));
  for (const Bar& bar : block.bars) {
    const double percent = max > 0.0 ? 100.0 * std::max(bar.value, 0.0) / max : 0.0;
    html += fmt::format(
        "<tr><th>{}</th><td><i class=\"bar\" style=\"width:{:.3f}%\"></i></td><td class=\"number\">{}</td></tr>\n",
        io::escaped_markup(bar.label), percent, io::escaped_markup(bar.text));
  }
  return html + "</tbody></table>\n";
}

std::string to_html(const WaterfallChart& block) {
  double min = 0.0, max = 0.0;
  for (const Span& span : block.spans) {
    const auto [low, high] = span.interval.value_or(std::pair(span.to, span.to));
    min = std::min({min, span.from, span.to, low});
    max = std::max({max, span.from, span.to, high});
  }
  const Scale scale(min, max);
  std::string html =
      fmt::format("<table class=\"chart spans\"><caption>{}</caption><tbody>\n", io::escaped_markup(block.caption));
  for (const Span& span : block.spans) {
    html += fmt::format("<tr><th>{}</th><td><div class=\"track\">{}</div></td><td class=\"number\">{}</td></tr>\n",
                        io::escaped_markup(span.label), span_html(span, scale), io::escaped_markup(span.text));
  }
  return html + ticks_html(scale, block.unit) + "</tbody></table>\n";
}

std::string to_html(const BoxPlot& block) {
  double min = 0.0, max = 0.0;
  for (const Box& box : block.boxes) {
    for (const double value : box.values) min = std::min(min, value), max = std::max(max, value);
  }
  const Scale scale(min, max);
  std::string html =
      fmt::format("<table class=\"chart boxes\"><caption>{}</caption><tbody>\n", io::escaped_markup(block.caption));
  for (const Box& box : block.boxes) {
    if (box.values.empty()) continue;
    html += fmt::format("<tr><th>{}</th><td><div class=\"track\">{}</div></td><td class=\"number\">{}</td></tr>\n",
                        io::escaped_markup(box.label), box_html(box, scale), io::escaped_markup(box.text));
  }
  return html + ticks_html(scale, block.unit) + "</tbody></table>\n";
}

}  // namespace patrol::report
