#include "report/block_html.h"

#include <fmt/format.h>

#include "io/files/markup_text.h"
#include "report/html.h"

namespace patrol::report {

std::string block_html(const Block& block) {
  return std::visit([](const auto& content) { return to_html(content); }, block);
}

std::string to_html(const TextBlock& block) {
  return fmt::format("<p class=\"note\">{}</p>\n", io::escaped_markup(block.text));
}

std::string to_html(const VerdictBlock& block) {
  return fmt::format("<div class=\"verdict {}\">\n<p class=\"word\">{}</p>\n<p class=\"reason\">{}</p>\n{}</div>\n",
                     css_class(block.tone), io::escaped_markup(block.word), io::escaped_markup(block.reason),
                     block.checks.rows.empty() ? "" : to_html(block.checks));
}

std::string to_html(const KeyMetrics& block) {
  std::string html = "<dl class=\"figures\">\n";
  for (const KeyMetric& figure : block.metrics) {
    html += fmt::format("<div><dt>{}</dt><dd><b>{}</b> <span>{}</span></dd><dd class=\"note\">{}</dd></div>\n",
                        io::escaped_markup(figure.label), io::escaped_markup(figure.value),
                        io::escaped_markup(figure.unit), io::escaped_markup(figure.note));
  }
  return html + "</dl>\n";
}

std::string to_html(const VideoBlock& block) {
  const std::string caption = fmt::format("<figcaption>{}</figcaption>", io::escaped_markup(block.caption));
  const std::string source = block.mp4.empty() ? io::escaped_markup(block.url) : data_uri("video/mp4", block.mp4);
  return fmt::format("<figure class=\"video\"><video controls preload=\"metadata\" src=\"{}\"></video>{}</figure>\n",
                     source, caption);
}

std::string to_html(const PictureBlock& block) {
  return fmt::format(
      "<figure class=\"svg picture\"><svg viewBox=\"0 0 {0} {1}\" role=\"img\" aria-label=\"{2}\"><image width=\"{0}\" "
      "height=\"{1}\" href=\"{3}\"/></svg><figcaption>{2}</figcaption></figure>\n",
      block.width_px, block.height_px, io::escaped_markup(block.caption), data_uri("image/png", block.png));
}

const char* css_class(Tone tone) {
  switch (tone) {
    case Tone::kGood:
      return "good";
    case Tone::kWarning:
      return "warning";
    case Tone::kBad:
      return "bad";
    case Tone::kFaint:
      return "faint";
    default:
      return "plain";
  }
}

const char* css_class(SeriesColor color) {
  switch (color) {
    case SeriesColor::kTruth:
      return "truth";
    case SeriesColor::kEstimate:
      return "estimate";
    case SeriesColor::kBound:
      return "bound";
    case SeriesColor::kOdometry:
      return "odometry";
    case SeriesColor::kRanges:
      return "ranges";
    case SeriesColor::kConfidence:
      return "confidence";
    case SeriesColor::kAlarm:
      return "alarm";
    default:
      return "event";
  }
}

}  // namespace patrol::report
