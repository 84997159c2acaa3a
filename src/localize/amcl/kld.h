#pragma once

#include <cstddef>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "core/frames.h"
#include "localize/amcl/kld_settings.h"

namespace patrol::localize {

/// Number of particles that approximates a belief over `bins` bins to `max_kl_divergence`, within the limits of the
/// settings [Fox03, equation 7]. The chi-square quantile is that of Wilson and Hilferty.
int kld_particles(std::size_t bins, const KldSettings& settings);

/// Set of occupied bins of position and heading.
class PoseBins {
 public:
  /// Divides the circle into equal bins with a size close to `bin_rad`.
  explicit PoseBins(const KldSettings& settings);

  /// Adds a pose and returns the index of its bin; bins are indexed in order of first use.
  std::size_t add(const Pose2& pose);
  std::size_t size() const { return keys_.size(); }
  /// Clusters of adjacent bins, including diagonal neighbors; headings are cyclic. Returns [bin] -> smallest bin index
  /// of its cluster.
  std::vector<std::size_t> clusters() const;

 private:
  struct Key {
    int col, row, heading;
    friend bool operator==(const Key&, const Key&) = default;
  };
  struct Hash {
    std::size_t operator()(const Key& key) const;
  };
  Key key_of(const Pose2& pose) const;

  double inverse_bin_m_;
  int num_headings_;  ///< number of heading bins
  std::unordered_map<Key, std::size_t, Hash> bins_;
  std::vector<Key> keys_;  ///< [bin]
};

}  // namespace patrol::localize
