#include "io/maps/moving_ai.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string_view>

#include <fmt/format.h>

#include "core/error.h"
#include "io/files/line_reader.h"
#include "io/files/line_tokenizer.h"

namespace patrol::io {
namespace {

constexpr std::size_t kMaxCells = 100'000'000;
constexpr int kMaxSide = 1'000'000;
constexpr std::string_view kLand = ".GS", kWater = "W", kBlocked = "@OT";

bool is_one_of(char terrain, std::string_view kinds) { return kinds.find(terrain) != std::string_view::npos; }

/// Line reader that removes carriage returns and adds the position to errors.
class Lines {
 public:
  explicit Lines(const std::filesystem::path& file) : reader_(file) {}

  /// Returns the next line; nullopt at the end.
  std::optional<std::string_view> next() {
    const std::optional<LineReader::Line> line = reader_.next();
    if (!line) {
      if (reader_.read_error()) throw InputError(fmt::format("{}: {}", reader_.file().string(), *reader_.read_error()));
      return std::nullopt;
    }
    number_ = line->number;
    if (line->is_cut) refuse("is too long");
    std::string_view text = line->text;
    if (!text.empty() && text.back() == '\r') text.remove_suffix(1);
    return text;
  }

  int number() const { return number_; }
  [[noreturn]] void refuse(const std::string& what) const { throw input_error(reader_.file().string(), number_, what); }
  [[noreturn]] void refuse_file(const std::string& what) const {
    throw InputError(fmt::format("{}: {}", reader_.file().string(), what));
  }

 private:
  LineReader reader_;
  int number_ = 0;
};

struct GridHeader {
  int width = 0, height = 0;
};

/// Reads the header up to and including the line "map".
GridHeader read_grid_header(Lines& lines) {
  GridHeader header;
  bool has_type = false;
  while (const auto text = lines.next()) {
    LineTokenizer fields(*text);
    try {
      const std::string_view key = fields.word("key");
      if (key == "map") {
        if (!has_type) lines.refuse("map: must come after the type");
        if (header.width == 0 || header.height == 0) lines.refuse("map: must come after height and width");
        return header;
      }
      if (key == "type") {
        if (const std::string_view type = fields.word("type"); type != "octile")
          lines.refuse(fmt::format("type: is {}, must be octile", type));
        has_type = true;
      } else if (key == "height") {
        header.height = static_cast<int>(fields.integer("height", 1, kMaxSide));
      } else if (key == "width") {
        header.width = static_cast<int>(fields.integer("width", 1, kMaxSide));
      } else {
        lines.refuse(fmt::format("{}: must be one of type, height, width, map", key));
      }
      if (!fields.is_empty()) lines.refuse(fmt::format("{}: must be a single value", key));
    } catch (const ParseError& error) {
      lines.refuse(error.what());
    }
  }
  lines.refuse_file("contains no map");
}

std::vector<std::string_view> split_words(std::string_view text) {
  // With tabs as separators map names may contain blanks.
  const std::string_view separators = text.find('\t') != std::string_view::npos ? "\t" : " ";
  std::vector<std::string_view> fields;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find_first_of(separators), text.size());
    if (end > 0) fields.push_back(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return fields;
}

MovingAiProblem parse_problem(std::string_view text) {
  constexpr std::size_t kNumFields = 9;
  const std::vector<std::string_view> fields = split_words(text);
  if (fields.size() != kNumFields) throw ParseError(fmt::format("has {} fields", fields.size()));
  const auto integer = [&](std::size_t index, const char* what, int min, int max) {
    return static_cast<int>(LineTokenizer(fields[index]).integer(what, min, max));
  };
  MovingAiProblem problem{.bucket = integer(0, "bucket", 0, std::numeric_limits<int>::max()),
                          .map = std::string(fields[1])};
  problem.width = integer(2, "width", 1, kMaxSide);
  problem.height = integer(3, "height", 1, kMaxSide);
  const auto cell = [&](std::size_t index, const char* x, const char* y) {
    const int col = integer(index, x, 0, problem.width - 1);
    return Cell{col, problem.height - 1 - integer(index + 1, y, 0, problem.height - 1)};
  };
  problem.start = cell(4, "start x", "start y");
  problem.goal = cell(6, "goal x", "goal y");
  problem.optimal_length = LineTokenizer(fields[8]).number("optimal length");
  if (problem.optimal_length < 0.0) throw ParseError("optimal length: must be at least 0");
  problem.length_rounding = rounding_of(fields[8]);
  return problem;
}

}  // namespace

double rounding_of(std::string_view length) {
  constexpr int kMinDigits = 6;
  const double value = LineTokenizer(length).number("optimal length");
  if (value == 0.0) return 0.0;
  const std::string_view mantissa = length.substr(0, length.find_first_of("eE"));
  const std::size_t first = std::min(mantissa.find_first_of("123456789"), mantissa.size());
  const std::string_view significant = mantissa.substr(first);
  const auto given =
      static_cast<int>(std::count_if(significant.begin(), significant.end(), [](char c) { return c != '.'; }));
  const double exponent_of_first = std::floor(std::log10(std::abs(value)));
  return 0.5 * std::pow(10.0, exponent_of_first - std::max(given, kMinDigits) + 1);
}

MovingAiMap load_moving_ai_map(const std::filesystem::path& file) {
  Lines lines(file);
  const GridHeader header = read_grid_header(lines);
  const auto width = static_cast<std::size_t>(header.width), height = static_cast<std::size_t>(header.height);
  if (width * height > kMaxCells)
    lines.refuse(fmt::format("map: {} x {} cells, at most {} are allowed", width, height, kMaxCells));
  std::vector<char> from_top;  // grows with the data, not with the size in the header
  for (std::size_t row = 0; row < height; ++row) {
    const auto text = lines.next();
    if (!text) lines.refuse_file(fmt::format("ends after {} of {} rows", row, height));
    if (text->size() != width)
      lines.refuse(fmt::format("row {}: has {} cells, must have {}", row, text->size(), width));
    for (const char terrain : *text) {
      if (is_one_of(terrain, kLand) || is_one_of(terrain, kWater) || is_one_of(terrain, kBlocked)) continue;
      lines.refuse(fmt::format("row {}: invalid character {}, must be of . G S W @ O T", row,
                               static_cast<int>(static_cast<unsigned char>(terrain))));
    }
    from_top.insert(from_top.end(), text->begin(), text->end());
  }
  while (const auto text = lines.next()) {
    if (!text->empty()) lines.refuse(fmt::format("must hold no more than {} rows", height));
  }
  MovingAiMap map{.terrain = Grid<char>({.resolution_m = 1.0, .width = header.width, .height = header.height})};
  for (std::size_t row = 0; row < height; ++row) {
    std::copy_n(from_top.begin() + static_cast<std::ptrdiff_t>(row * width), width,
                map.terrain.values().begin() + static_cast<std::ptrdiff_t>((height - 1 - row) * width));
  }
  return map;
}

OccupancyGrid to_occupancy(const MovingAiMap& map, Cell start) {
  const bool swims = map.terrain.contains(start) && is_one_of(map.terrain.at(start), kWater);
  OccupancyGrid occupancy(map.terrain.geometry(), kOccupied);
  for (std::size_t i = 0; i < map.terrain.values().size(); ++i) {
    if (is_one_of(map.terrain.values()[i], swims ? kWater : kLand)) occupancy.values()[i] = kFree;
  }
  return occupancy;
}

std::vector<MovingAiProblem> load_moving_ai_problems(const std::filesystem::path& file) {
  Lines lines(file);
  const auto first = lines.next();
  if (!first) lines.refuse_file("is empty");
  if (*first != "version 1" && *first != "version 1.0") lines.refuse("must be \"version 1\"");
  std::vector<MovingAiProblem> problems;
  while (const auto text = lines.next()) {
    if (text->empty()) continue;
    try {
      problems.push_back(parse_problem(*text));
      problems.back().line = lines.number();
    } catch (const ParseError& error) {
      lines.refuse(fmt::format("{}: a problem is bucket, map, width, height, start x, y, goal x, y, optimal length",
                               error.what()));
    }
  }
  if (problems.empty()) lines.refuse_file("contains no problems");
  return problems;
}

}  // namespace patrol::io
