#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <vector>

#include <gtest/gtest.h>

#include "core/geometry/angles.h"
#include "core/random.h"
#include "io/points/station_scans.h"
#include "sim/sensors/panoramic_scanner.h"

namespace patrol::sim::reference_scans_test {
namespace {

constexpr std::uint64_t kInspectionSeed = 1;  // of worlds/tunnel/scenarios/inspection_round.yaml

/// Grid of the default scanner, and the beams that single points of a scan come from.
class BeamGrid {
 public:
  /// Number of the beam in direction `p` of the scanner, as PanoramicScanner counts; none where it lies off the grid by
  /// more than `tol_deg` along either angle, as means of several beams do.
  std::optional<std::uint64_t> beam_at(const Eigen::Vector3d& p, double tol_deg) const {
    const double up = (std::asin(p.z() / p.norm()) / kDegree - settings_.elevation_min_deg) / settings_.step_deg;
    const double about = (std::atan2(p.y(), p.x()) / kDegree + 90.0) / settings_.step_deg;
    const double row = std::round(up), column = std::round(about);
    const double tol = tol_deg / settings_.step_deg;
    if (std::abs(up - row) > tol || std::abs(about - column) * std::cos(std::asin(p.z() / p.norm())) > tol)
      return std::nullopt;
    const auto wrapped = (static_cast<std::int64_t>(column) + kColumns) % kColumns;
    return static_cast<std::uint64_t>(wrapped) * kRows + static_cast<std::uint64_t>(row);
  }

  static constexpr std::int64_t kColumns = 1000;
  static constexpr std::uint64_t kRows = 417;

 private:
  PanoramicScannerSettings settings_;
};

Eigen::Matrix3d tilt_from_gravity(double roll_deg, double pitch_deg) {
  return quaternion_from_rpy(roll_deg * kDegree, pitch_deg * kDegree, 0.0).toRotationMatrix();
}

/// Beams of single points of a reference. The tilt of the scanner, which the scan's points do not have any more, is
/// that under which most points lie on the grid.
std::vector<std::uint64_t> single_beams(const io::StationScan& scan) {
  const Eigen::Matrix3d R_level_map = scan.T_map_scanner.rotation.toRotationMatrix().transpose();
  std::vector<Eigen::Vector3d> points;
  for (const ScannerPoint& point : scan.points) {
    const Eigen::Vector3d p = R_level_map * (Eigen::Vector3d(point.x, point.y, point.z) - scan.T_map_scanner.position);
    if (p.norm() > 8.0) points.push_back(p);
  }
  const BeamGrid grid;
  double roll_deg = 0.0, pitch_deg = 0.0;
  const auto search = [&](double reach_deg, double step_deg, std::size_t stride) {
    const double roll_from = roll_deg - reach_deg, pitch_from = pitch_deg - reach_deg;
    int most = -1;
    for (double roll = roll_from; roll <= roll_from + 2.0 * reach_deg; roll += step_deg) {
      for (double pitch = pitch_from; pitch <= pitch_from + 2.0 * reach_deg; pitch += step_deg) {
        const Eigen::Matrix3d R_scanner_level = tilt_from_gravity(roll, pitch).transpose();
        int on_grid = 0;
        for (std::size_t i = 0; i < points.size(); i += stride)
          on_grid += grid.beam_at(R_scanner_level * points[i], step_deg).has_value();
        if (on_grid > most) most = on_grid, roll_deg = roll, pitch_deg = pitch;
      }
    }
  };
  search(2.0, 0.02, points.size() / 400);
  search(0.02, 0.004, points.size() / 4000);
  search(0.004, 0.0008, points.size() / 4000);
  std::vector<std::uint64_t> beams;
  for (const Eigen::Vector3d& p : points) {
    if (const auto beam = grid.beam_at(tilt_from_gravity(roll_deg, pitch_deg).transpose() * p, 0.004))
      beams.push_back(*beam);
  }
  return beams;
}

// A thousandth of an inspection's beams drop out. Were a reference made from the same draws, none of its beams would be
// among them.
TEST(ReferenceScans, OfTheTunnelAreIndependentOfTheDropoutsOfTheInspection) {
  const std::vector<io::StationScan> scans = io::load_station_scans(PATROL_SOURCE_DIR "/worlds/tunnel/round/scans");
  ASSERT_EQ(scans.size(), 3u);
  const PanoramicScannerSettings settings;
  const RandomStream dropout(kInspectionSeed, "scanner/dropout");
  std::size_t num_beams = 0, num_lost = 0;
  for (std::uint64_t number = 0; number < scans.size(); ++number) {
    for (const std::uint64_t beam : single_beams(scans[number])) {
      ++num_beams;
      num_lost += dropout.uniform(number, beam) < settings.dropout_probability;
    }
  }
  const double expected = settings.dropout_probability * static_cast<double>(num_beams);
  RecordProperty("beams", static_cast<int>(num_beams));
  RecordProperty("lost", static_cast<int>(num_lost));
  EXPECT_GT(num_beams, 20'000u) << "single beams were not found";
  EXPECT_NEAR(static_cast<double>(num_lost), expected, 4.0 * std::sqrt(expected)) << num_beams << " beams";
}

}  // namespace
}  // namespace patrol::sim::reference_scans_test
