#include <fmt/format.h>

#include "io/files/markup_text.h"
#include "report/block_html.h"
#include "report/decimation.h"
#include "report/html.h"

/// Map figure as SVG: unit meter, y down from the picture's upper edge; report.js zooms it.
namespace patrol::report {
namespace {

constexpr double kPathTolerance_m = 0.01;
constexpr int kNumRampColors = 9;

std::string points_of(const std::vector<Eigen::Vector2d>& piece_m, const MapPicture& picture) {
  std::string text;
  for (const Eigen::Vector2d& p : simplify_path(piece_m, kPathTolerance_m)) {
    text +=
        fmt::format("{}{:.2f},{:.2f}", text.empty() ? "" : " ", p.x() - picture.low_m.x(), picture.high_m.y() - p.y());
  }
  return text;
}

std::string path_html(const MapPath& path, const MapPicture& picture) {
  std::string html;
  for (const std::vector<Eigen::Vector2d>& piece : path.pieces_m) {
    html += fmt::format("<polyline class=\"{}\" points=\"{}\"/>\n", css_class(path.color), points_of(piece, picture));
  }
  return html;
}

/// A line of zero length with a round cap is a dot of constant size at every zoom.
std::string mark_html(const MapMark& mark, const MapPicture& picture) {
  const double x = mark.p_m.x() - picture.low_m.x(), y = picture.high_m.y() - mark.p_m.y();
  return fmt::format(
      "<g class=\"{0}\"><path d=\"M{1:.2f} {2:.2f}h0\"/><text x=\"{1:.2f}\" y=\"{2:.2f}\">{3}</text></g>\n",
      css_class(mark.color), x, y, io::escaped_markup(mark.label));
}

std::string sheet_html(const char* name, const MapPicture::Sheet& sheet) {
  return fmt::format(
      "<image class=\"{}\" width=\"{:.3f}\" height=\"{:.3f}\" preserveAspectRatio=\"none\" href=\"{}\"/>\n", name,
      sheet.size_m.x(), sheet.size_m.y(), data_uri("image/png", sheet.png));
}

std::string css_color(Color color) { return fmt::format("#{:02x}{:02x}{:02x}", color.r, color.g, color.b); }

std::string error_key(const std::string& name) {
  std::string colors;
  for (int i = 0; i < kNumRampColors; ++i) {
    colors +=
        fmt::format("{}{}", i == 0 ? "" : ",", css_color(map_error_color(kMapErrorEnd_m * i / (kNumRampColors - 1))));
  }
  return fmt::format(
      "<span class=\"ramp\">map: {} 0<i "
      "style=\"background:linear-gradient(90deg,{})\"></i>{:.0f} cm or more"
      "</span>{}",
      name.empty() ? "distance to the nearest true surface" : io::escaped_markup(name), colors, 100.0 * kMapErrorEnd_m,
      name.empty() ? fmt::format("<span class=\"key\" style=\"--ink:{}\">true surface</span>", css_color(kMapTruth))
                   : "");
}

std::string legend_html(const MapBlock& block) {
  std::string html = block.picture.has_errors ? error_key(block.error_name) : "";
  for (const MapPath& path : block.paths) {
    html += fmt::format("<span class=\"key {}\">{}</span>", css_class(path.color), io::escaped_markup(path.name));
  }
  return html;
}

}  // namespace

std::string to_html(const MapBlock& block) {
  const Eigen::Vector2d size_m = block.picture.high_m - block.picture.low_m;
  std::string html = fmt::format(
      "<figure class=\"map\"><div class=\"view\" style=\"aspect-ratio:{0:.2f}/{1:.2f}\">"
      "<svg viewBox=\"0 0 {0:.2f} {1:.2f}\" role=\"img\" aria-label=\"Map\">\n",
      size_m.x(), size_m.y());
  html += sheet_html("overview", block.picture.overview) + sheet_html("detail", block.picture.detail);
  for (const MapPath& path : block.paths) html += path_html(path, block.picture);
  for (const MapMark& mark : block.marks) html += mark_html(mark, block.picture);
  return html + fmt::format(
                    "</svg></div><figcaption>{}<span class=\"hint\">Ctrl and wheel, or two fingers: zoom; drag: "
                    "move</span></figcaption></figure>\n",
                    legend_html(block));
}

}  // namespace patrol::report
