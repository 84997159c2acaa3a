#include "app/plan/plan_map.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include <fmt/format.h>

#include "core/error.h"
#include "io/maps/map_server.h"

namespace patrol::app {
namespace {

std::optional<double> number_of(std::string_view text) {
  while (!text.empty() && text.front() == ' ') text.remove_prefix(1);
  while (!text.empty() && text.back() == ' ') text.remove_suffix(1);
  double value = 0.0;
  const auto [rest, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || rest != text.data() + text.size() || !std::isfinite(value)) return std::nullopt;
  return value;
}

}  // namespace

PlanMap::PlanMap(const std::filesystem::path& file) {
  if (file.extension() == ".map") moving_ai_ = io::load_moving_ai_map(file);
  else occupancy_ = io::load_map(file);
}

OccupancyGrid PlanMap::occupancy_from(const Eigen::Vector2d& p_m) const {
  return is_moving_ai() ? io::to_occupancy(*moving_ai_, geometry().cell_at(p_m)) : occupancy_;
}

Eigen::Vector2d PlanMap::parse_point(const std::string& key, const std::string& text) const {
  const std::size_t comma = std::min(text.find(','), text.size());
  const std::optional<double> x = number_of(std::string_view(text).substr(0, comma));
  const std::optional<double> y =
      comma < text.size() ? number_of(std::string_view(text).substr(comma + 1)) : std::nullopt;
  if (!x || !y) throw InputError(fmt::format("{}: {}: must be two numbers, X,Y", key, text));
  return parse_point(key, *x, *y);
}

Eigen::Vector2d PlanMap::parse_point(const std::string& key, double x, double y) const {
  const GridGeometry& grid = geometry();
  if (is_moving_ai() && (x != std::floor(x) || y != std::floor(y))) {
    throw InputError(
        fmt::format("{}: {}, {}: must be integers, column and row of a cell from the upper left", key, x, y));
  }
  Eigen::Vector2d p_m = is_moving_ai() ? Eigen::Vector2d(x + 0.5, grid.height - 0.5 - y) : Eigen::Vector2d(x, y);
  const Eigen::Array2d along = p_m - grid.origin_m, size = grid.resolution_m * Eigen::Array2d(grid.width, grid.height);
  if (!((along >= 0.0).all() && (along < size).all()))
    throw InputError(fmt::format("{}: {}, {} is outside the map, which spans {}", key, x, y, extent()));
  return p_m;
}

Eigen::Vector2d PlanMap::to_user(const Eigen::Vector2d& p_m) const {
  return is_moving_ai() ? Eigen::Vector2d(p_m.x() - 0.5, geometry().height - 0.5 - p_m.y()) : p_m;
}

std::string PlanMap::text_of(const Eigen::Vector2d& p_m) const {
  const Eigen::Vector2d p = to_user(p_m);
  return is_moving_ai() ? fmt::format("{}, {}", p.x(), p.y()) : fmt::format("{:.2f}, {:.2f}", p.x(), p.y());
}

std::string PlanMap::extent() const {
  const GridGeometry& grid = geometry();
  if (is_moving_ai()) return fmt::format("x 0 ... {}, y 0 ... {} (cells)", grid.width - 1, grid.height - 1);
  const Eigen::Vector2d end_m = grid.origin_m + grid.resolution_m * Eigen::Vector2d(grid.width, grid.height);
  return fmt::format("x {:.2f} ... {:.2f} m, y {:.2f} ... {:.2f} m", grid.origin_m.x(), end_m.x(), grid.origin_m.y(),
                     end_m.y());
}

}  // namespace patrol::app
