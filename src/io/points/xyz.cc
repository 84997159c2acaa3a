#include "io/points/xyz.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "core/error.h"
#include "core/letter_case.h"
#include "io/files/line_tokenizer.h"
#include "io/files/utf16_mark.h"
#include "io/points/file_text.h"
#include "io/points/point_collector.h"

namespace patrol::io {
namespace {

constexpr std::size_t kMaxXyzColumns = 100;
constexpr std::int64_t kMaxXyzPoints = 1'000'000'000;

/// Columns of x, y, z and intensity among the numbers of a line.
struct XyzColumns {
  std::size_t count = 0;
  std::array<std::optional<std::size_t>, 4> sources;
};

bool is_comment(std::string_view line) { return line.starts_with('#') || line.starts_with("//"); }

/// Returns a line with blanks as its only separators.
std::string with_blanks(std::string_view line) {
  std::string words(line);
  std::ranges::replace_if(
      words, [](char c) { return c == ',' || c == ';' || c == '\t' || c == '"'; }, ' ');
  return words;
}

bool begins_with_number(const std::string& words) {
  try {
    LineTokenizer(words).any_number("number");
    return true;
  } catch (const ParseError&) {
    return false;
  }
}

/// Returns the columns that a line names; none if it does not name x, y and z.
std::optional<XyzColumns> named_columns(std::string_view line) {
  while (line.starts_with('#') || line.starts_with('/')) line.remove_prefix(1);
  LineTokenizer words(line);
  XyzColumns columns;
  for (; !words.is_empty(); ++columns.count) {
    const std::string name = to_lower(std::string(words.word("name")));
    std::size_t source = 0;
    if (name == "x" || name == "y" || name == "z") {
      source = static_cast<std::size_t>(name.front() - 'x');
    } else if (name == "intensity" || name == "scalar_intensity" || name == "reflectance") {
      source = 3;
    } else {
      continue;
    }
    if (!columns.sources[source]) columns.sources[source] = columns.count;
  }
  if (!columns.sources[0] || !columns.sources[1] || !columns.sources[2]) return std::nullopt;
  return columns;
}

/// Returns the columns of lines of `count` numbers without names.
XyzColumns usual_columns(std::size_t count) {
  XyzColumns columns{.count = count, .sources = {0, 1, 2, std::nullopt}};
  if (count == 4 || count == 7) columns.sources[3] = 3;
  return columns;
}

/// Returns whether the commas of a line are in its numbers: semicolons or blanks separate these, and a comma has
/// neither beside it.
bool has_decimal_commas(std::string_view line) {
  bool has_separator = line.find(';') != std::string_view::npos, has_inner_comma = false;
  std::string_view before;
  for (LineTokenizer words(line); !words.is_empty();) {
    const std::string_view word = words.word("number");
    has_separator |= !before.empty() && before.back() != ',' && word.front() != ',';
    has_inner_comma |= word.find(',', 1) < word.size() - 1;
    before = word;
  }
  return has_separator && has_inner_comma;
}

std::array<double, 4> read_point(const FileText& text, std::string_view line, const XyzColumns& columns) {
  if (has_decimal_commas(line)) text.refuse("has commas in its numbers: decimals must have a point");
  const std::string words = with_blanks(line);
  std::array<double, 4> point{};
  try {
    LineTokenizer numbers(words);
    for (std::size_t column = 0; column < columns.count; ++column) {
      const double number = numbers.any_number("number");
      for (std::size_t i = 0; i < point.size(); ++i) {
        if (columns.sources[i] == column) point[i] = number;
      }
    }
    if (numbers.is_empty()) return point;
  } catch (const ParseError&) {}
  text.refuse(fmt::format("must be {} numbers", columns.count));
}

/// First lines of a file, up to the first point.
struct XyzStart {
  XyzColumns columns;
  bool is_named = false;                       ///< a line names the columns
  std::optional<std::size_t> num_points = {};  ///< number of points by the first line of PTS
  std::optional<std::string_view> first_line;  ///< line of the first point; none if there are no points
};

std::size_t read_count(const FileText& text, const std::string& words) {
  try {
    return static_cast<std::size_t>(LineTokenizer(words).integer("count", 0, kMaxXyzPoints));
  } catch (const ParseError&) {
    text.refuse("must be the number of points, or 3 numbers or more");
  }
}

XyzStart read_start(FileText& text) {
  std::optional<XyzColumns> named, commented;
  std::optional<std::size_t> num_points;
  while (const auto line = text.next_line()) {
    const std::string words = with_blanks(*line);
    const std::size_t count = LineTokenizer(words).num_words();
    if (count == 0) continue;
    if (is_comment(*line)) {
      if (const auto columns = named_columns(words)) commented = columns;
    } else if (!named && !begins_with_number(words)) {
      named = named_columns(words);
      if (!named) text.refuse("names no columns x, y and z");
    } else if (count == 1 && !num_points) {
      num_points = read_count(text, words);
    } else {
      if (!named && commented && commented->count == count) named = commented;
      if (!named && (count < 3 || count > kMaxXyzColumns))
        text.refuse(fmt::format("must be 3 to {} numbers", kMaxXyzColumns));
      return {.columns = named ? *named : usual_columns(count),
              .is_named = named.has_value(),
              .num_points = num_points,
              .first_line = line};
    }
  }
  return {.columns = {}, .num_points = num_points, .first_line = {}};
}

std::string sentence_about(const XyzColumns& columns) {
  return fmt::format("the first three of {} numbers in a line are x, y and z, {}", columns.count,
                     columns.sources[3] ? "the fourth is the intensity" : "none is the intensity");
}

}  // namespace

std::vector<ScannerPoint> load_shifted_xyz(const std::filesystem::path& file, PointShift& shift, std::string& columns) {
  constexpr std::string_view kUtf8Mark = "\xEF\xBB\xBF";
  FileText text(file);
  if (has_utf16_mark(text.rest())) throw InputError(fmt::format("{}: {}", file.string(), kUtf16Refusal));
  if (text.rest().starts_with(kUtf8Mark)) text.replace_rest(std::string(text.rest().substr(kUtf8Mark.size())));
  const XyzStart start = read_start(text);
  PointCollector points(&shift);
  std::size_t num_lines = 0;
  for (auto line = start.first_line; line; line = text.next_line()) {
    if (is_comment(*line) || LineTokenizer(*line).is_empty()) continue;
    if (!points.add(read_point(text, *line, start.columns))) text.refuse("is not finite");
    ++num_lines;
  }
  if (start.num_points.value_or(num_lines) != num_lines) {
    throw InputError(
        fmt::format("{}: has {} points, and {} by its first line", file.string(), num_lines, *start.num_points));
  }
  if (start.first_line && !start.is_named) columns = sentence_about(start.columns);
  return points.take();
}

}  // namespace patrol::io
