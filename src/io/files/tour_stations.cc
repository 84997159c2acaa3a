#include "io/files/tour_stations.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <string_view>

#include <fmt/format.h>

#include "core/error.h"
#include "core/letter_case.h"
#include "io/files/line_reader.h"
#include "io/files/utf16_mark.h"

namespace patrol::io {
namespace {

constexpr std::size_t kMaxStations = 200;  // paths between all pairs are planned
constexpr double kMaxDuration_s = 1e7;
constexpr const char* kStationColumns =
    "name, x, y and optionally heading_deg, service_s, earliest_s, latest_s, priority";

/// Splits a line into cells. `refuse` does not return.
template <typename Refuse>
std::vector<std::string> split_cells(std::string_view line, const Refuse& refuse) {
  std::vector<std::string> cells(1);
  bool is_quoted = false;
  for (std::size_t i = 0; i < line.size(); ++i) {
    const char c = line[i];
    if (is_quoted) {
      if (c != '"') cells.back() += c;
      else if (i + 1 < line.size() && line[i + 1] == '"') cells.back() += line[++i];
      else is_quoted = false;
    } else if (c == ',') {
      cells.emplace_back();
    } else if (c == '"' && cells.back().empty()) {
      is_quoted = true;
    } else {
      cells.back() += c;
    }
  }
  if (is_quoted) refuse("a quotation mark is not closed");
  for (std::string& cell : cells) {
    const std::size_t first = cell.find_first_not_of(" \t"), last = cell.find_last_not_of(" \t");
    cell = first == std::string::npos ? "" : cell.substr(first, last - first + 1);
  }
  return cells;
}

/// Returns whether the bytes are well-formed as UTF-8: lead bytes with their number of continuation bytes.
bool is_utf8(std::string_view text) {
  for (std::size_t i = 0; i < text.size();) {
    const auto lead = static_cast<unsigned char>(text[i]);
    const std::size_t length = lead < 0x80                   ? 1
                               : lead >= 0xC2 && lead < 0xE0 ? 2
                               : lead >= 0xE0 && lead < 0xF0 ? 3
                               : lead >= 0xF0 && lead < 0xF5 ? 4
                                                             : 0;
    if (length == 0 || i + length > text.size()) return false;
    for (std::size_t k = 1; k < length; ++k) {
      if ((static_cast<unsigned char>(text[i + k]) & 0xC0) != 0x80) return false;
    }
    i += length;
  }
  return true;
}

class StationReader {
 public:
  explicit StationReader(const std::filesystem::path& file) : lines_(file) {}

  std::vector<TourStation> read() {
    while (const auto line = lines_.next()) {
      number_ = line->number;
      if (line->is_cut) refuse("is too long");
      std::string_view text = line->text;
      if (number_ == 1 && text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
      if (number_ == 1 && has_utf16_mark(text)) refuse(std::string(kUtf16Refusal));
      if (text.ends_with('\r')) text.remove_suffix(1);
      if (text.empty() && !columns_.empty()) continue;
      const std::vector<std::string> cells = split_cells(text, [&](const std::string& what) { refuse(what); });
      if (columns_.empty()) read_header(cells);
      else read_station(cells);
    }
    if (lines_.read_error()) throw InputError(fmt::format("{}: {}", lines_.file().string(), *lines_.read_error()));
    if (stations_.empty()) throw InputError(fmt::format("{}: contains no stations", lines_.file().string()));
    return std::move(stations_);
  }

 private:
  [[noreturn]] void refuse(const std::string& what) const { throw input_error(lines_.file().string(), number_, what); }

  void read_header(std::vector<std::string> cells) {
    std::transform(cells.begin(), cells.end(), cells.begin(), to_lower);
    for (std::size_t i = 0; i < cells.size(); ++i) {
      const auto known = {"name", "x", "y", "heading_deg", "service_s", "earliest_s", "latest_s", "priority"};
      if (std::find(known.begin(), known.end(), cells[i]) == known.end()) {
        refuse(fmt::format("{}: unknown column: the first line must name {}", cells[i], kStationColumns));
      }
      if (!columns_.emplace(cells[i], i).second) refuse(fmt::format("{}: duplicate column", cells[i]));
    }
    for (const char* column : {"name", "x", "y"}) {
      if (!columns_.contains(column))
        refuse(fmt::format("{}: is missing: the first line must name {}", column, kStationColumns));
    }
  }

  void read_station(const std::vector<std::string>& cells) {
    if (cells.size() != columns_.size())
      refuse(fmt::format("has {} cells, must have {}", cells.size(), columns_.size()));
    TourStation station{.name = cells[columns_.at("name")], .line = number_};
    if (station.name.empty()) refuse("name: is empty");
    if (!is_utf8(station.name)) refuse("name: is not valid UTF-8");
    if (std::any_of(stations_.begin(), stations_.end(),
                    [&](const TourStation& other) { return other.name == station.name; })) {
      refuse(fmt::format("name: {}: duplicate", station.name));
    }
    for (const char* column : {"x", "y"}) {
      if (cells[columns_.at(column)].empty()) refuse(fmt::format("{}: is empty", column));
    }
    const auto take = [&](const char* column, double& value, double min, double max) {
      const auto index = columns_.find(column);
      if (index != columns_.end() && !cells[index->second].empty())
        value = number(column, cells[index->second], min, max);
    };
    constexpr double kMaxCoordinate = 1e8;
    take("x", station.x, -kMaxCoordinate, kMaxCoordinate);
    take("y", station.y, -kMaxCoordinate, kMaxCoordinate);
    double heading_deg = std::numeric_limits<double>::quiet_NaN();
    take("heading_deg", heading_deg, -360.0, 360.0);
    if (std::isfinite(heading_deg)) station.heading_deg = heading_deg;
    take("service_s", station.service_s, 0.0, kMaxDuration_s);
    take("earliest_s", station.earliest_s, 0.0, kMaxDuration_s);
    take("latest_s", station.latest_s, 0.0, kMaxDuration_s);
    double priority = 0.0;
    take("priority", priority, -1e6, 1e6);
    if (priority != std::floor(priority)) refuse(fmt::format("priority: {}: must be an integer", priority));
    station.priority = static_cast<int>(priority);
    if (station.latest_s < station.earliest_s)
      refuse(fmt::format("latest_s: {}: must not be before earliest_s = {}", station.latest_s, station.earliest_s));
    if (stations_.size() == kMaxStations)
      refuse(fmt::format("too many stations: at most {} are allowed", kMaxStations));
    stations_.push_back(station);
  }

  double number(const char* column, const std::string& text, double min, double max) const {
    double value = 0.0;
    const auto [rest, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || rest != text.data() + text.size() || !std::isfinite(value))
      refuse(fmt::format("{}: {}: must be a number", column, text));
    if (value < min || value > max) refuse(fmt::format("{}: {}: must be in [{}, {}]", column, text, min, max));
    return value;
  }

  LineReader lines_;
  int number_ = 0;
  std::map<std::string, std::size_t> columns_;  ///< column name to its index in a line
  std::vector<TourStation> stations_;
};

}  // namespace

std::vector<TourStation> load_tour_stations(const std::filesystem::path& file) { return StationReader(file).read(); }

}  // namespace patrol::io
