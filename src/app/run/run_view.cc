#include "app/run/run_view.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "core/geometry/angles.h"
#include "core/map_cells.h"
#include "io/files/one_line.h"

namespace patrol::app {
namespace {

constexpr double kDot_m = 0.15;
constexpr int kDotsAcross = 2, kDotsDown = 4;  // dots of a braille character
constexpr int kNumEvents = 4;
constexpr const char* kLineEnd = "\033[K\r\n";

enum class Layer { kNothing, kWall, kDriven, kPath, kTruth, kRobot };

const char* color_of(Layer layer) {
  switch (layer) {
    case Layer::kDriven:
      return "\033[38;5;172m";
    case Layer::kPath:
      return "\033[38;5;75m";
    case Layer::kTruth:
      return "\033[1;32m";
    case Layer::kRobot:
      return "\033[1;38;5;208m";
    default:
      return "\033[0m";
  }
}

std::string utf8(int code) {
  return {static_cast<char>(0xe0 | code >> 12), static_cast<char>(0x80 | (code >> 6 & 0x3f)),
          static_cast<char>(0x80 | (code & 0x3f))};
}

/// Grid of braille characters. Each has the color of the highest layer that set a dot in it.
class DotMap {
 public:
  DotMap(int columns, int rows, const Eigen::Vector2d& center_m)
      : columns_(columns),
        rows_(rows),
        corner_m_(center_m + 0.5 * kDot_m * Eigen::Vector2d(-columns * kDotsAcross, rows * kDotsDown)),
        cells_(static_cast<std::size_t>(columns * rows)) {}

  void put(const Eigen::Vector2d& p_m, Layer layer) {
    const auto [x, y] = dot_of(p_m);
    Cell* cell = cell_at(x, y);
    if (cell == nullptr) return;
    // Braille dots 1, 2, 3, 7 are in the left column, 4, 5, 6, 8 in the right one.
    static constexpr std::array<std::array<int, kDotsDown>, kDotsAcross> kBits = {
        {{0x01, 0x02, 0x04, 0x40}, {0x08, 0x10, 0x20, 0x80}}};
    cell->dots |= kBits[static_cast<std::size_t>(x % kDotsAcross)][static_cast<std::size_t>(y % kDotsDown)];
    cell->layer = std::max(cell->layer, layer);
  }

  void put_sign(const Eigen::Vector2d& p_m, Layer layer, const std::string& sign) {
    const auto [x, y] = dot_of(p_m);
    if (Cell* cell = cell_at(x, y)) cell->layer = layer, cell->sign = sign;
  }

  std::string text() const {
    std::string text;
    for (int row = 0; row < rows_; ++row) {
      Layer pen = Layer::kNothing;
      for (int col = 0; col < columns_; ++col) {
        const Cell& cell = cells_[static_cast<std::size_t>(row * columns_ + col)];
        const Layer layer = cell.dots == 0 && cell.sign.empty() ? Layer::kNothing : cell.layer;
        if (layer != pen) text += color_of(pen = layer);
        text += !cell.sign.empty() ? cell.sign : cell.dots == 0 ? " " : utf8(0x2800 + cell.dots);
      }
      text += std::string("\033[0m") + kLineEnd;
    }
    return text;
  }

 private:
  struct Cell {
    int dots = 0;
    Layer layer = Layer::kNothing;
    std::string sign;
  };

  std::pair<int, int> dot_of(const Eigen::Vector2d& p_m) const {
    return {static_cast<int>(std::floor((p_m.x() - corner_m_.x()) / kDot_m)),
            static_cast<int>(std::floor((corner_m_.y() - p_m.y()) / kDot_m))};
  }
  Cell* cell_at(int x, int y) {
    if (x < 0 || y < 0 || x >= columns_ * kDotsAcross || y >= rows_ * kDotsDown) return nullptr;
    return &cells_[static_cast<std::size_t>(y / kDotsDown * columns_ + x / kDotsAcross)];
  }

  int columns_, rows_;
  Eigen::Vector2d corner_m_;  ///< upper left corner
  std::vector<Cell> cells_;
};

void put_line(DotMap& dots, const Eigen::Vector2d& from_m, const Eigen::Vector2d& to_m, Layer layer) {
  const int steps = std::max(1, static_cast<int>(std::ceil((to_m - from_m).norm() / (0.5 * kDot_m))));
  for (int i = 0; i <= steps; ++i) dots.put(from_m + (to_m - from_m) * i / steps, layer);
}

const char* arrow_of(double yaw_rad) {
  static constexpr std::array<const char*, 8> kArrows = {"→", "↗", "↑", "↖", "←", "↙", "↓", "↘"};
  const long eighth = std::lround(yaw_rad / (std::numbers::pi / 4.0));
  return kArrows[static_cast<std::size_t>((eighth % 8 + 8) % 8)];
}

std::string map_text(const RunView& run, int columns, int rows) {
  const Eigen::Vector2d center_m = run.estimate ? run.estimate->T_map_body.position() : Eigen::Vector2d::Zero();
  DotMap dots(columns, rows, center_m);
  for (int row = 0; row < run.map.geometry().height; ++row) {
    for (int col = 0; col < run.map.geometry().width; ++col) {
      if (is_occupied(run.map.at({col, row}))) dots.put(run.map.geometry().center_of({col, row}), Layer::kWall);
    }
  }
  for (const Eigen::Vector2d& p_m : run.traveled_m) dots.put(p_m, Layer::kDriven);
  for (std::size_t i = 1; i < run.path.size(); ++i)
    put_line(dots, run.path[i - 1].position(), run.path[i].position(), Layer::kPath);
  if (run.truth) dots.put_sign(run.truth->position(), Layer::kTruth, "◆");
  if (run.estimate)
    dots.put_sign(run.estimate->T_map_body.position(), Layer::kRobot, arrow_of(run.estimate->T_map_body.yaw));
  return dots.text();
}

std::string values_text(const RunView& run) {
  std::string text = fmt::format("{:+.2f} m/s {:+.2f} rad/s", run.command.vx_mps, run.command.yaw_rate_radps);
  if (run.estimate && run.truth) {
    const Pose2 error = run.truth->inverse() * run.estimate->T_map_body;
    const Eigen::Matrix3d& covariance = run.estimate->covariance;
    text += fmt::format("   error {:.3f} m {:.2f}°   estimated 2σ {:.3f} m", error.position().norm(),
                        to_deg(std::abs(error.yaw)), 2.0 * std::sqrt(covariance(0, 0) + covariance(1, 1)));
  }
  if (run.confidence)
    text += fmt::format("   confidence {:.2f}{}", run.confidence->confidence, run.confidence->is_lost ? " LOST" : "");
  return text;
}

}  // namespace

std::string render_run_view(const RunView& run, int columns, int rows) {
  std::string text =
      fmt::format("\033[1m{}\033[0m   {:.1f} s simulated, {:.1f}x real time   {:.1f} m{}{}{}", run.name,
                  to_seconds(run.now), run.real_time_factor, run.distance_m, kLineEnd, values_text(run), kLineEnd);
  text += map_text(run, columns, std::max(1, rows - 2 - kNumEvents - 1));
  for (int i = 0; i < kNumEvents; ++i) {
    const std::size_t first = run.events.size() > kNumEvents ? run.events.size() - kNumEvents : 0;
    const std::size_t at = first + static_cast<std::size_t>(i);
    if (at < run.events.size()) {
      const Event& event = run.events[at];
      const std::string line =
          fmt::format("{:7.1f} s  {}", to_seconds(event.stamp), event.text.empty() ? kind_text(event) : event.text);
      text += io::first_bytes(line, static_cast<std::size_t>(columns));
    }
    text += kLineEnd;
  }
  return text + fmt::format("{}→ estimate {}◆ truth {}⠒ planned {}⠒ traveled\033[0m\033[K", color_of(Layer::kRobot),
                            color_of(Layer::kTruth), color_of(Layer::kPath), color_of(Layer::kDriven));
}

}  // namespace patrol::app
