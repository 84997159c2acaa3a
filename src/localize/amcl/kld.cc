#include "localize/amcl/kld.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

namespace patrol::localize {

int kld_particles(std::size_t bins, const KldSettings& settings) {
  const int max_particles = std::max(settings.min_particles, settings.max_particles);
  if (bins < 2) return settings.min_particles;
  const auto degrees = static_cast<double>(bins - 1);
  const double a = 2.0 / (9.0 * degrees);
  const double root = 1.0 - a + std::sqrt(a) * settings.normal_quantile;
  const double wanted = std::ceil(degrees / (2.0 * settings.max_kl_divergence) * root * root * root);
  return static_cast<int>(
      std::clamp(wanted, static_cast<double>(settings.min_particles), static_cast<double>(max_particles)));
}

std::size_t PoseBins::Hash::operator()(const Key& key) const {
  const auto mix = [](std::uint64_t hash, int value) {
    return (hash ^ static_cast<std::uint32_t>(value)) * 0x9E3779B97F4A7C15ULL;
  };
  const std::uint64_t hash = mix(mix(mix(0, key.col), key.row), key.heading);
  return static_cast<std::size_t>(hash ^ (hash >> 32));
}

PoseBins::PoseBins(const KldSettings& settings)
    : inverse_bin_m_(1.0 / settings.bin_m),
      num_headings_(std::max(1, static_cast<int>(std::lround(2.0 * std::numbers::pi / settings.bin_rad)))) {}

PoseBins::Key PoseBins::key_of(const Pose2& pose) const {
  const double heading = (wrap_angle(pose.yaw) / std::numbers::pi + 1.0) * 0.5 * num_headings_;
  return {static_cast<int>(std::floor(pose.x * inverse_bin_m_)), static_cast<int>(std::floor(pose.y * inverse_bin_m_)),
          static_cast<int>(heading) % num_headings_};
}

std::size_t PoseBins::add(const Pose2& pose) {
  const auto [bin, is_new] = bins_.try_emplace(key_of(pose), keys_.size());
  if (is_new) keys_.push_back(bin->first);
  return bin->second;
}

std::vector<std::size_t> PoseBins::clusters() const {
  std::vector<std::size_t> parent(keys_.size());
  std::iota(parent.begin(), parent.end(), std::size_t{0});
  const auto root_of = [&](std::size_t bin) {
    while (parent[bin] != bin) bin = parent[bin] = parent[parent[bin]];
    return bin;
  };
  for (std::size_t bin = 0; bin < keys_.size(); ++bin) {
    for (int step = 0; step < 27; ++step) {
      const Key& key = keys_[bin];
      const auto found = bins_.find({key.col + step % 3 - 1, key.row + step / 3 % 3 - 1,
                                     (key.heading + step / 9 - 1 + num_headings_) % num_headings_});
      if (found == bins_.end()) continue;
      const std::size_t mine = root_of(bin), other = root_of(found->second);
      parent[std::max(mine, other)] = std::min(mine, other);
    }
  }
  for (std::size_t bin = 0; bin < parent.size(); ++bin) parent[bin] = root_of(bin);
  return parent;
}

}  // namespace patrol::localize
