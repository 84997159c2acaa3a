#include <algorithm>
#include <cmath>
#include <cstdlib>

#include <fmt/format.h>

#include "io/files/markup_text.h"
#include "report/block_html.h"
#include "report/decimation.h"
#include "report/html.h"

/// Plot data that report.js draws with uPlot.
namespace patrol::report {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kNumSegments = 600;  // segments of a decimated curve, more than a screen shows
constexpr double kLogFrom = 50.0;          // ratio of peak to median above which the axis is logarithmic

/// Rounds to four digits, the resolution of a plot.
double shortened(double value) { return std::strtod(fmt::format("{:.4g}", value).c_str(), nullptr); }
double shortened_x(double x) { return std::round(1e3 * x) / 1e3; }

Json curve_json(const Curve& curve) {
  Json json = {{"name", curve.name},
               {"ink", css_class(curve.color)},
               {"dashed", curve.is_dashed},
               {"x", Json::array()},
               {"y", Json::array()}};
  for (const Eigen::Vector2d& point : decimate(curve.points, kNumSegments)) {
    json["x"].push_back(shortened_x(point.x()));
    json["y"].push_back(shortened(point.y()));
  }
  return json;
}

Json marks_json(const std::vector<PlotMark>& marks) {
  Json json = Json::array();
  for (const PlotMark& mark : marks)
    json.push_back({{"x", shortened_x(mark.x)}, {"text", mark.text}, {"ink", css_class(mark.color)}});
  return json;
}

Json spans_json(const std::vector<PlotSpan>& spans) {
  Json json = Json::array();
  for (const PlotSpan& span : spans) json.push_back({{"from", span.from}, {"to", span.to}, {"text", span.text}});
  return json;
}

/// True for curves with negative values; these have no logarithmic axis.
bool has_sign(const Curve& curve) {
  return std::any_of(curve.points.begin(), curve.points.end(),
                     [](const Eigen::Vector2d& point) { return point.y() < 0.0; });
}

bool has_far_peak(const Curve& curve) {
  std::vector<double> values;
  for (const Eigen::Vector2d& point : curve.points) values.push_back(point.y());
  if (values.empty()) return false;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle > 0.0 && *std::max_element(middle, values.end()) > kLogFrom * *middle;
}

std::string legend_html(const std::vector<Curve>& curves) {
  std::string html;
  for (const Curve& curve : curves) {
    html += fmt::format("<span class=\"key {} {}\">{}</span>", css_class(curve.color), curve.is_dashed ? "dashed" : "",
                        io::escaped_markup(curve.name));
  }
  return html;
}

/// Note about decimated curves, empty if all points are drawn.
std::string decimation_note(const std::vector<Curve>& curves) {
  std::size_t max_samples = 0;
  for (const Curve& curve : curves) max_samples = std::max(max_samples, curve.points.size());
  if (max_samples <= 2 * kNumSegments) return "";
  return fmt::format(
      R"(<span class="thinned" title="Minimum and maximum of each of {} segments">min/max of {} samples</span>)",
      kNumSegments, max_samples);
}

std::string plot_html(const char* kind, const std::string& title, const std::string& legend, const Json& data) {
  return fmt::format(
      "<figure class=\"plot {}\"><figcaption><b>{}</b>{}</figcaption><div class=\"drawing\"></div>"
      "<script type=\"application/json\">{}</script></figure>\n",
      kind, io::escaped_markup(title), legend, script_json(data));
}

}  // namespace

std::string to_html(const LinePlot& block) {
  const bool is_signed = std::any_of(block.curves.begin(), block.curves.end(), has_sign);
  const bool is_log = !block.max && !is_signed && std::any_of(block.curves.begin(), block.curves.end(), has_far_peak);
  Json data = {{"label", block.axis.label}, {"end", block.axis.max}, {"log", is_log}, {"curves", Json::array()}};
  if (block.axis.min != 0.0) data["begin"] = block.axis.min;
  if (block.max) data["max"] = *block.max;
  for (const Curve& curve : block.curves) data["curves"].push_back(curve_json(curve));
  data["marks"] = marks_json(block.marks);
  data["spans"] = spans_json(block.spans);
  const std::string title = block.title + (block.unit.empty() ? "" : ", " + block.unit) + (is_log ? " (log)" : "");
  return plot_html("lines", title, legend_html(block.curves) + decimation_note(block.curves), data);
}

std::string to_html(const EventTimeline& block) {
  Json data = {{"label", block.axis.label}, {"end", block.axis.max}, {"lanes", Json::array()}};
  for (const EventTimeline::Lane& lane : block.lanes)
    data["lanes"].push_back({{"name", lane.name}, {"marks", marks_json(lane.marks)}});
  data["spans"] = spans_json(block.spans);
  return plot_html("lanes", block.title, "<output></output>", data);
}

}  // namespace patrol::report
