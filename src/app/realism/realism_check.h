#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "app/realism/log_on_site.h"
#include "app/realism/realism_page.h"
#include "app/realism/realism_result.h"

namespace patrol::app {

/// Settings of `patrol realism --set`, and of `patrol calibrate --sensor lidar`.
struct RealismSettings {
  std::uint64_t seed = 1;  ///< seed of the simulated scans
  LogOnSiteSettings input;
  realism::PositionSettings positions;

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("seed", self.seed);
    visit("input", self.input);
    visit("positions", self.positions);
  }
};

/// Log, site and scans of a comparison, resolved.
struct RealismInput {
  LogOnSite source;
  ScansOnPath scans;
  realism::Site site;
};

/// Reads the settings of `--set`. Scans on an exact path are not aligned unless the settings say so.
RealismSettings realism_settings(const LogOnSiteOptions& options, std::vector<std::string> overrides,
                                 bool skip_invalid);

/// Reads log and site; none if interrupted.
std::optional<RealismInput> read_realism_input(const LogOnSiteOptions& options, const RealismSettings& settings);

/// Facts of the page header, and notes about assumptions and limits of the comparison.
std::vector<std::pair<std::string, std::string>> facts_of(const RealismInput& input, const RealismSettings& settings);
std::vector<std::string> notes_of(const RealismInput& input, const RealismSettings& settings,
                                  const RealismResult& result);

/// Positions the recorded scans and simulates them with a device; none if interrupted. `name`: for the progress line.
std::optional<RealismResult> compare(const RealismInput& input, const RealismSettings& settings,
                                     const realism::LidarDevice& device, const std::string& name);
std::optional<realism::PositionedScans> position(const RealismInput& input, const RealismSettings& settings,
                                                 const std::string& name);

}  // namespace patrol::app
