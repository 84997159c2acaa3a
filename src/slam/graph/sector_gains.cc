#include "slam/graph/sector_gains.h"

#include <cmath>
#include <numbers>

namespace patrol::slam {
namespace {

/// Minimum difference of the log likelihoods of a sector's points for a vote.
constexpr double kMinVote = 2.0;

}  // namespace

SectorGains::SectorGains(const std::vector<MatchPoint>& points, const std::vector<double>& a,
                         const std::vector<double>& b, double unknown) {
  const auto known_or = [unknown](double value) { return std::isnan(value) ? unknown : value; };
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double difference = known_or(a[i]) - known_or(b[i]);
    gains_[sector_of(points[i])] += difference;
    total_ += difference;
  }
}

std::size_t SectorGains::sector_of(const MatchPoint& point) {
  const double turn = std::atan2(point.p_body.y(), point.p_body.x()) / (2.0 * std::numbers::pi);
  return static_cast<std::size_t>((turn + 1.0) * kSectors) % kSectors;
}

int SectorGains::vote(std::size_t sector) const { return (gains_[sector] > kMinVote) - (gains_[sector] < -kMinVote); }

int SectorGains::votes() const {
  int sum = 0;
  for (std::size_t sector = 0; sector < kSectors; ++sector) sum += vote(sector);
  return sum;
}

}  // namespace patrol::slam
