#include "importer/site/points/panorama.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>

#include "core/error.h"
#include "core/random.h"

namespace patrol::importer {
namespace {

constexpr double kCircle_rad = 2.0 * std::numbers::pi;
constexpr int kMinColumns = 90, kMaxColumns = 20'000;
constexpr double kNearHorizon_rad = 0.6;  // rows whose columns are well separated

/// Returns the median of the angles between consecutive points.
double typical_step_rad(const std::vector<Eigen::Vector3f>& directions) {
  constexpr std::size_t kSamples = 20'000;
  const RandomStream draw(1, "importer/panorama");
  std::vector<float> steps;
  for (std::size_t i = 0; i < std::min(kSamples, directions.size()); ++i) {
    const auto at = static_cast<std::size_t>(draw.uniform(i) * static_cast<double>(directions.size() - 1));
    if (std::abs(directions[at].z()) > std::sin(kNearHorizon_rad)) continue;
    steps.push_back((directions[at + 1] - directions[at]).norm());
  }
  if (steps.size() < 16) return kCircle_rad / kMinColumns;
  std::nth_element(steps.begin(), steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2), steps.end());
  return static_cast<double>(steps[steps.size() / 2]);
}

/// Mean of exp(i n angle) over the angles: its length is 1 if all are on a grid of n per turn.
std::complex<double> alignment(const std::vector<double>& angles_rad, int n) {
  std::complex<double> sum = 0.0;
  for (const double angle : angles_rad) sum += std::polar(1.0, n * angle);
  return sum / static_cast<double>(std::max<std::size_t>(1, angles_rad.size()));
}

/// Returns the smallest number of columns from `first` to `last` with nearly the best alignment; none if the angles are
/// on no such grid.
std::optional<int> best_columns(const std::vector<double>& angles_rad, int first, int last) {
  constexpr double kMinAlignment = 0.3;
  std::optional<int> best;
  double best_length = kMinAlignment;
  for (int n = std::max(kMinColumns, first); n <= std::min(last, kMaxColumns); ++n) {
    const double length = std::abs(alignment(angles_rad, n));
    if (length <= 1.05 * best_length) continue;
    best_length = length;
    best = n;
  }
  return best;
}

double elevation_of(const Eigen::Vector3f& direction) {
  return std::asin(std::clamp(static_cast<double>(direction.z()), -1.0, 1.0));
}

}  // namespace

bool is_continuous(float a_m, float b_m, float c_m, float d_m, double angle_rad) {
  if (b_m <= 0.0f || c_m <= 0.0f) return false;
  constexpr double kSteepest = 12.0;  // tangent of the largest incidence, 85 degrees
  const double b = double{b_m}, c = double{c_m};
  const double jump = std::abs(b - c), lateral = angle_rad * std::min(b, c);
  if (jump <= 1.5 * lateral + 0.004) return true;
  if (jump > kSteepest * lateral + 0.01) return false;
  // The inverse range of a plane is linear over small angles. Errors of the angles (scanner.h: 19") change the jump
  // more, the closer the beams are: by two standard deviations of a second difference.
  constexpr double kCurvature = 0.15, kAngleError_rad = 9.2e-5, kMaxTolerance = 0.3;
  const double by_angles = 2.0 * std::sqrt(6.0) * kAngleError_rad / angle_rad;
  const double tolerance = std::min(kMaxTolerance, std::hypot(kCurvature, by_angles)) * jump + 0.004;
  const auto continues = [&](double before, double at, double after) {
    if (before <= 0.0) return false;
    const double inverse = 2.0 / at - 1.0 / before;
    return inverse > 0.0 && std::abs(1.0 / inverse - after) <= tolerance;
  };
  return continues(double{a_m}, b, c) || continues(double{d_m}, c, b);
}

Panorama::Panorama(const io::StationScan& scan)
    : T_site_scanner_(scan.T_map_scanner), R_site_scanner_(scan.T_map_scanner.rotation.toRotationMatrix()) {
  std::vector<Eigen::Vector3f> directions;
  directions.reserve(scan.points.size());
  const Eigen::Matrix3d R_scanner_site = R_site_scanner_.transpose();
  for (const ScannerPoint& point : scan.points) {
    const Eigen::Vector3d offset = Eigen::Vector3f(point.x, point.y, point.z).cast<double>() - T_site_scanner_.position;
    if (offset.squaredNorm() > 1e-6) directions.push_back((R_scanner_site * offset).normalized().cast<float>());
  }
  if (directions.size() < 16) throw InputError(scan.station + ": has fewer than 16 points away from the scanner");
  find_grid(directions);
  fill_pixels(scan);
  interpolate_gaps();
  connect();
}

void Panorama::find_grid(const std::vector<Eigen::Vector3f>& directions) {
  constexpr std::size_t kSamples = 4000;
  const RandomStream draw(2, "importer/panorama");
  std::vector<double> azimuths, elevations;
  for (std::size_t i = 0; i < kSamples; ++i) {
    const Eigen::Vector3f& d =
        directions[static_cast<std::size_t>(draw.uniform(i) * static_cast<double>(directions.size()))];
    if (std::abs(d.z()) > std::sin(kNearHorizon_rad)) continue;
    azimuths.push_back(std::atan2(static_cast<double>(d.y()), static_cast<double>(d.x())));
    elevations.push_back(elevation_of(d));
  }
  const int guess =
      std::clamp(static_cast<int>(std::lround(kCircle_rad / typical_step_rad(directions))), kMinColumns, kMaxColumns);
  columns_ = best_columns(elevations, guess - guess / 20, guess + guess / 20).value_or(0);
  if (columns_ == 0) {
    // The points are not in the order of columns: begin with the number that the count of all points gives.
    const double band_rad2 = 2.0 * kCircle_rad;  // about the part of the sphere that a scanner sees
    const int by_count =
        std::clamp(static_cast<int>(kCircle_rad * std::sqrt(static_cast<double>(directions.size()) / band_rad2)),
                   kMinColumns, kMaxColumns);
    if (elevations.size() > 500) elevations.resize(500);
    columns_ = best_columns(elevations, by_count - by_count / 5, 3 * by_count).value_or(by_count);
  }
  step_rad_ = kCircle_rad / columns_;
  azimuth_rad_ = std::arg(alignment(azimuths, columns_)) / columns_;
  double lowest = std::numbers::pi, highest = -std::numbers::pi;
  for (const Eigen::Vector3f& d : directions) {
    lowest = std::min(lowest, elevation_of(d));
    highest = std::max(highest, elevation_of(d));
  }
  const double phase = std::arg(alignment(elevations, columns_)) / columns_;
  elevation_rad_ = phase + step_rad_ * std::round((lowest - phase) / step_rad_);
  rows_ = static_cast<int>(std::round((highest - elevation_rad_) / step_rad_)) + 1;
  for (int col = 0; col < columns_; ++col) {
    const double azimuth = azimuth_rad_ + step_rad_ * col;
    col_direction_.emplace_back(std::cos(azimuth), std::sin(azimuth));
  }
  for (int row = 0; row < rows_; ++row) {
    row_cosine_.push_back(static_cast<float>(std::cos(elevation_rad_ + step_rad_ * row)));
    row_sine_.push_back(static_cast<float>(std::sin(elevation_rad_ + step_rad_ * row)));
  }
}

void Panorama::fill_pixels(const io::StationScan& scan) {
  const std::size_t size = static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_);
  range_m_.assign(size, 0.0f);
  intensity_.assign(size, 0.0f);
  state_.assign(size, 0);
  std::vector<float> distance(size, std::numeric_limits<float>::max());
  constexpr double kSameRange = 0.05;
  std::size_t num_hidden = 0;
  for (const ScannerPoint& point : scan.points) {
    const Eigen::Vector3d p = Eigen::Vector3f(point.x, point.y, point.z).cast<double>();
    const std::optional<Pixel> pixel = pixel_of(p);
    const double range = (p - origin()).norm();
    if (!pixel || range < 1e-3) continue;
    const auto off = static_cast<float>((p - (origin() + range * direction(*pixel))).norm() / range);
    const std::size_t at = index(*pixel);
    if (range_m_[at] > 0.0f && std::abs(double{range_m_[at]} / range - 1.0) > kSameRange) ++num_hidden;
    if (off >= distance[at]) continue;
    distance[at] = off;
    range_m_[at] = static_cast<float>(range);
    intensity_[at] = point.intensity;
    max_range_m_ = std::max(max_range_m_, range);
  }
  hidden_part_ = static_cast<double>(num_hidden) / static_cast<double>(scan.points.size());
}

Eigen::Vector3d Panorama::direction(double col, double row) const {
  const double azimuth = azimuth_rad_ + step_rad_ * col, elevation = elevation_rad_ + step_rad_ * row;
  const double c = std::cos(elevation);
  return R_site_scanner_ * Eigen::Vector3d(c * std::cos(azimuth), c * std::sin(azimuth), std::sin(elevation));
}

Eigen::Vector3d Panorama::direction(Pixel pixel) const {
  const Eigen::Vector2d& ahead = col_direction_[static_cast<std::size_t>(pixel.col)];
  const auto row = static_cast<std::size_t>(pixel.row);
  const double c = double{row_cosine_[row]};
  return R_site_scanner_ * Eigen::Vector3d(c * ahead.x(), c * ahead.y(), double{row_sine_[row]});
}

Pixel Panorama::nearest_pixel(const Eigen::Vector3d& p_site) const {
  const Eigen::Vector3d p = R_site_scanner_.transpose() * (p_site - origin());
  const double elevation = std::atan2(p.z(), p.head<2>().norm());
  double turn = (std::atan2(p.y(), p.x()) - azimuth_rad_) / step_rad_;
  if (turn < -0.5) turn += columns_;
  return {.col = wrapped(static_cast<int>(std::lround(turn))),
          .row = static_cast<int>(std::lround((elevation - elevation_rad_) / step_rad_))};
}

std::optional<Pixel> Panorama::pixel_of(const Eigen::Vector3d& p_site) const {
  const Pixel pixel = nearest_pixel(p_site);
  if (!contains_row(pixel.row)) return std::nullopt;
  return pixel;
}

void Panorama::interpolate_gaps() {
  std::vector<std::pair<std::size_t, std::pair<float, float>>> fills;
  const auto fill = [&](Pixel pixel, Pixel before, Pixel after, double angle) {
    const float b = range_m(before), a = range_m(after);
    if (b <= 0.0f || a <= 0.0f || std::abs(b - a) > static_cast<float>(3.0 * angle * double{std::min(a, b)} + 0.004))
      return false;
    fills.push_back({index(pixel), {2.0f * a * b / (a + b), 0.5f * (intensity(before) + intensity(after))}});
    return true;
  };
  for (int col = 0; col < columns_; ++col) {
    for (int row = 0; row < rows_; ++row) {
      if (range_m({col, row}) > 0.0f) continue;
      if (row > 0 && row + 1 < rows_ && fill({col, row}, {col, row - 1}, {col, row + 1}, step_rad_)) continue;
      fill({col, row}, {wrapped(col - 1), row}, {wrapped(col + 1), row}, column_angle_rad(row));
    }
  }
  for (const auto& [at, value] : fills) {
    range_m_[at] = value.first;
    intensity_[at] = value.second;
  }
}

void Panorama::connect() {
  const auto range_at = [&](int col, int row) { return contains_row(row) ? range_m({wrapped(col), row}) : 0.0f; };
  for (int col = 0; col < columns_; ++col) {
    const int next = wrapped(col + 1), before = wrapped(col - 1), after = wrapped(next + 1);
    for (int row = 0; row < rows_; ++row) {
      const float here = range_m({col, row});
      if (here <= 0.0f) continue;
      std::uint8_t bits = 0;
      if (is_continuous(range_m({before, row}), here, range_m({next, row}), range_m({after, row}),
                        column_angle_rad(row)))
        bits |= kPixelRight;
      if (row + 1 < rows_ &&
          is_continuous(range_at(col, row - 1), here, range_m({col, row + 1}), range_at(col, row + 2), step_rad_))
        bits |= kPixelUp;
      state({col, row}) |= bits;
    }
  }
}

Eigen::Vector3d Panorama::normal(Pixel pixel) const {
  const Eigen::Vector3d d = direction(pixel);
  const Eigen::Vector3d up = R_site_scanner_.col(2);
  Eigen::Vector3d aside = up.cross(d);
  if (aside.squaredNorm() < 1e-8) return -d;
  aside.normalize();
  // Noise of millimeters tilts a normal from points that are closer together than centimeters.
  constexpr double kBaseline_m = 0.03;
  constexpr int kMaxSteps = 12;
  const double range = double{range_m(pixel)};
  const auto steps = [&](double angle_rad) {
    return std::clamp(static_cast<int>(std::ceil(kBaseline_m / (angle_rad * range + 1e-9))), 1, kMaxSteps);
  };
  const int across = steps(column_angle_rad(pixel.row)), upward = steps(step_rad_);
  Pixel left = pixel, right = pixel, down = pixel, top = pixel;
  for (int k = 0; k < across && is_connected_left(left); ++k) left.col = wrapped(left.col - 1);
  for (int k = 0; k < across && is_connected_right(right); ++k) right.col = wrapped(right.col + 1);
  for (int k = 0; k < upward && is_connected_down(down); ++k) --down.row;
  for (int k = 0; k < upward && is_connected_up(top); ++k) ++top.row;
  if (left.col != right.col) aside = point(left) - point(right);
  Eigen::Vector3d along = d.cross(up.cross(d));
  if (down.row != top.row) along = point(top) - point(down);
  Eigen::Vector3d n = aside.cross(along);
  const double length = n.norm();
  if (length < 1e-12) return -d;
  n /= length;
  return n.dot(d) > 0.0 ? Eigen::Vector3d(-n) : n;
}

}  // namespace patrol::importer
