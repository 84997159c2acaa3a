#include <algorithm>
#include <cmath>
#include <map>
#include <vector>

#include <fmt/format.h>

#include "io/files/markup_text.h"
#include "report/block_html.h"
#include "report/html.h"
#include "report/round_step.h"

/// Figures as SVG in pixels, without a script.
namespace patrol::report {
namespace {

constexpr int kCellWidth = 18, kCellHeight = 9;
constexpr int kLeft = 100, kLine = 16;  // margins for labels
constexpr int kNumLevels = 10;          // steps of a color from zero to the maximum
constexpr double kPlanWidth = 420.0;
constexpr int kMaxTicks = 8;

std::string text_html(double x, double y, const char* anchor, const std::string& text, const char* css = "") {
  return fmt::format("<text class=\"{}\" x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\">{}</text>\n", css, x, y, anchor,
                     io::escaped_markup(text));
}

std::string figure_html(const char* kind, const std::string& caption, double width, double height,
                        const std::string& drawing, const std::string& legend) {
  return fmt::format(
      "<figure class=\"svg {0}\"><figcaption><b>{1}</b></figcaption><svg viewBox=\"0 0 {2:.0f} {3:.0f}\" "
      "style=\"width:{2:.0f}px\" role=\"img\" aria-label=\"{1}\">\n{4}</svg><figcaption>{5}</figcaption></figure>\n",
      kind, io::escaped_markup(caption), width, height, drawing, legend);
}

double column_x(int column) { return kLeft + column * kCellWidth; }
double row_y(int row) { return row * kCellHeight; }

/// One path for all cells of a level and sign, because a page has thousands of cells.
std::string cells_html(const HeatMap& block) {
  std::map<int, std::string> paths;
  std::string all;
  for (const HeatMap::Cell& cell : block.cells) {
    const double ratio = std::clamp(cell.value / block.max, -1.0, 1.0);
    const std::string outline = fmt::format("M{:.0f} {:.0f}h{}v{}h-{}z", column_x(cell.column), row_y(cell.row),
                                            kCellWidth, kCellHeight, kCellWidth);
    paths[static_cast<int>(std::lround(kNumLevels * ratio))] += outline;
    all += outline;
  }
  std::string html = fmt::format("<path class=\"cell\" d=\"{}\"/>\n", all);
  for (const auto& [level, outline] : paths) {
    if (level == 0) continue;
    html += fmt::format("<path class=\"{}\" fill-opacity=\"{:.1f}\" d=\"{}\"/>\n", level < 0 ? "negative" : "positive",
                        static_cast<double>(std::abs(level)) / kNumLevels, outline);
  }
  return html;
}

std::string marks_html(const HeatMap& block) {
  std::string html;
  for (const HeatMap::Mark& mark : block.marks) {
    const bool is_left = 2 * mark.column < static_cast<int>(block.columns.size());
    const double x = column_x(mark.column), y = row_y(mark.row);
    html += fmt::format("<rect class=\"mark\" x=\"{:.0f}\" y=\"{:.0f}\" width=\"{}\" height=\"{}\"/>\n", x, y,
                        kCellWidth, kCellHeight);
    html +=
        text_html(is_left ? x + kCellWidth + 5 : x - 5, y + kCellHeight, is_left ? "start" : "end", mark.text, "label");
  }
  return html;
}

/// Labels of every column up to 12 columns, else of every second, third and so on.
std::string labels_html(const HeatMap& block) {
  std::string html;
  for (std::size_t row = 0; row < block.rows.size(); ++row) {
    if (!block.rows[row].empty())
      html += text_html(kLeft - 6, row_y(static_cast<int>(row)) + kCellHeight, "end", block.rows[row]);
  }
  const double below = row_y(static_cast<int>(block.rows.size())) + kLine;
  const std::size_t step = std::max<std::size_t>(1, (block.columns.size() + 11) / 12);
  for (std::size_t i = 0; i < block.columns.size(); i += step)
    html += text_html(column_x(static_cast<int>(i)) + kCellWidth / 2.0, below, "middle", block.columns[i]);
  html += text_html(kLeft - 6, below, "end", block.column_title);
  if (block.notes.empty()) return html;
  html += text_html(kLeft - 6, below + kLine, "end", block.notes_title);
  for (const HeatMap::ColumnNote& note : block.notes)
    html +=
        text_html(column_x(note.column) + kCellWidth / 2.0, below + kLine, "middle", note.text, css_class(note.tone));
  return html;
}

/// Multiples of the step from `low_m` to `high_m`; 0 is exactly 0.
std::vector<double> ticks_m(double low_m, double high_m, double step_m) {
  std::vector<double> ticks;
  for (double index = std::ceil(low_m / step_m); index * step_m <= high_m; index += 1.0)
    ticks.push_back(step_m * index + 0.0);
  return ticks;
}

}  // namespace

std::string to_html(const HeatMap& block) {
  const double width = column_x(static_cast<int>(block.columns.size())) + 12;
  const double height = row_y(static_cast<int>(block.rows.size())) + kLine * (block.notes.empty() ? 1.5 : 2.5);
  const std::string legend = fmt::format("<span class=\"diverging\">{} {:.3g} {}<i></i>{:.3g} {} {}</span>",
                                         io::escaped_markup(block.negative), block.max, io::escaped_markup(block.unit),
                                         block.max, io::escaped_markup(block.unit), io::escaped_markup(block.positive));
  return figure_html("heat", block.caption, width, height, cells_html(block) + marks_html(block) + labels_html(block),
                     legend);
}

std::string to_html(const PlanView& block) {
  const Eigen::Vector2d size_m = block.high_m - block.low_m;
  const double px_per_m = kPlanWidth / std::max(size_m.x(), size_m.y());
  const Eigen::Vector2d size = px_per_m * size_m;
  constexpr double kMargin = 44.0, kTop = 6.0;
  const auto to_x = [&](double x_m) { return kMargin + px_per_m * (x_m - block.low_m.x()); };
  const auto to_y = [&](double y_m) { return kTop + px_per_m * (block.high_m.y() - y_m); };
  std::string html =
      fmt::format("<rect class=\"frame\" x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\"/>\n", kMargin,
                  kTop, size.x(), size.y());
  const double step_m = round_step(size_m.maxCoeff(), kMaxTicks);
  for (const double x_m : ticks_m(block.low_m.x(), block.high_m.x(), step_m)) {
    html += fmt::format("<path class=\"tick\" d=\"M{:.1f} {:.1f}v{:.1f}\"/>\n", to_x(x_m), kTop, size.y());
    html += text_html(to_x(x_m), kTop + size.y() + kLine, "middle", fmt::format("{:g}", x_m));
  }
  for (const double y_m : ticks_m(block.low_m.y(), block.high_m.y(), step_m)) {
    html += fmt::format("<path class=\"tick\" d=\"M{:.1f} {:.1f}h{:.1f}\"/>\n", kMargin, to_y(y_m), size.x());
    html += text_html(kMargin - 6, to_y(y_m) + 4, "end", fmt::format("{:g}", y_m));
  }
  std::string legend;
  for (const MapPath& path : block.paths) {
    legend += fmt::format("<span class=\"key {}\">{}</span>", css_class(path.color), io::escaped_markup(path.name));
    for (const std::vector<Eigen::Vector2d>& piece : path.pieces_m) {
      std::string points;
      for (const Eigen::Vector2d& p_m : piece) points += fmt::format("{:.1f},{:.1f} ", to_x(p_m.x()), to_y(p_m.y()));
      html += fmt::format("<polyline class=\"{}\" points=\"{}\"/>\n", css_class(path.color), points);
    }
  }
  for (const MapMark& mark : block.marks) {
    const double x = to_x(mark.p_m.x()), y = to_y(mark.p_m.y());
    html += fmt::format("<circle class=\"{}\" cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"4\"/>\n", css_class(mark.color), x, y);
    html += text_html(x + 8, y - 6, "start", mark.label, "label");
  }
  html += text_html(kMargin + size.x() / 2, kTop + size.y() + 2 * kLine, "middle", block.x_title);
  html += fmt::format("<text transform=\"translate(12 {:.1f}) rotate(-90)\" text-anchor=\"middle\">{}</text>\n",
                      kTop + size.y() / 2, io::escaped_markup(block.y_title));
  return figure_html("plan", block.caption, kMargin + size.x() + 12, kTop + size.y() + 2.4 * kLine, html, legend);
}

}  // namespace patrol::report
