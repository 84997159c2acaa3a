#pragma once

#include <cstddef>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "core/frames.h"
#include "core/settings.h"

namespace patrol::localize {

struct KldSettings {
  double bin_m = 0.5;
  double bin_rad = 0.1745;      ///< 10 degrees
  double max_error = 0.05;      ///< Kullback-Leibler distance between particles and belief ...
  double quantile = 2.326;      ///< ... that is kept with this upper quantile of the normal distribution: 0.99
  int min_particles = 300;
  int max_particles = 5000;

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("bin_m", self.bin_m, between(0.01, 10.0));
    visit("bin_rad", self.bin_rad, between(0.01, 3.2));
    visit("max_error", self.max_error, between(1e-4, 1.0));
    visit("quantile", self.quantile, between(0.0, 6.0));
    visit("min_particles", self.min_particles, between(1, 1000000));
    visit("max_particles", self.max_particles, between(1, 1000000));
  }
};

/// The number of particles with which a belief that fills `bins` bins is approximated to `max_error`, within the limits of
/// the settings (Fox, "Adapting the sample size in particle filters through KLD-sampling", IJRR 2003, equation 7:
/// the chi-square quantile by Wilson and Hilferty).
int kld_particles(std::size_t bins, const KldSettings& settings);

/// The bins of position and heading that poses fall into.
class PoseBins {
 public:
  /// The circle is cut into equal bins, as near to `bin_rad` as goes.
  explicit PoseBins(const KldSettings& settings);

  /// Number of the pose's bin; bins are numbered in the order in which they are first met.
  std::size_t add(const Pose2& pose);
  std::size_t size() const { return keys_.size(); }
  /// Which clump of touching bins each belongs to (corners count; headings close round the circle): [bin] -> the smallest
  /// number of a bin of its clump.
  std::vector<std::size_t> clumps() const;

 private:
  struct Key {
    int col, row, turn;
    friend bool operator==(const Key&, const Key&) = default;
  };
  struct Hash {
    std::size_t operator()(const Key& key) const;
  };
  Key key_of(const Pose2& pose) const;

  double inverse_bin_m_;
  int num_turns_;  ///< bins round the circle
  std::unordered_map<Key, std::size_t, Hash> bins_;
  std::vector<Key> keys_;  ///< [bin]
};

}  // namespace patrol::localize
