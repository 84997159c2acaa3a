#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <vector>

#include <Eigen/Core>

#include "core/settings.h"

namespace patrol::realism {

/// Relation of a recorded beam to the surfaces of the site.
enum class BeamClass : std::uint8_t {
  kStatic,       ///< return within `max_residual_m` of a smooth surface
  kEdge,         ///< return beside a jump of the expected range: candidate of a mixed pixel
  kDropout,      ///< no return, but a surface is expected
  kShort,        ///< isolated return before the expected surface: false return
  kMoving,       ///< return far before or behind the expected surface, as its neighbor: moving or unmapped
  kFar,          ///< isolated return far behind the expected surface
  kUnexplained,  ///< return without expected surface
  kEmpty,        ///< neither return nor surface
  kGlass,        ///< the expected surface is glass, which the model lets pass off its normal
  kNear          ///< below the minimum range (-Inf)
};
inline constexpr std::array<const char*, 10> kBeamClassNames = {
    "static", "edge", "dropout", "short", "moving or unmapped", "far", "unexplained", "empty", "glass", "too near"};

/// Beam of a scan without errors: geometry of the site along it.
struct ExpectedBeam {
  double range_m = std::numeric_limits<double>::infinity();  ///< expected range; infinite without surface
  double cosine = 1.0;                                       ///< cosine of the angle of incidence
  double reflectivity = 0.0;
  double slope_m_per_rad = 0.0;              ///< change of the range with the azimuth, by the site
  Eigen::Vector3d normal = {0.0, 0.0, 0.0};  ///< normal of the surface, in site
  bool is_glass = false;
  bool is_smooth = false;  ///< whether the surface continues to both sides and to the neighboring beams
  bool is_jump = false;    ///< whether the range jumps by 0.1 to 1.5 m from the previous beam (sim/sensors/lidar.cc)

  bool has_surface() const { return range_m < std::numeric_limits<double>::infinity(); }
};

/// Beam with its recorded range.
struct Beam {
  ExpectedBeam expected;
  double recorded_m = 0.0;       ///< range, REP 117
  std::uint32_t scan = 0;        ///< number of the scan in the set
  std::uint32_t index = 0;       ///< number of the beam in the scan
  float x_m = 0.0f, y_m = 0.0f;  ///< expected point, in site
  BeamClass kind = BeamClass::kEmpty;

  bool is_return() const { return recorded_m < std::numeric_limits<double>::infinity() && recorded_m > 0.0; }
  double residual_m() const { return recorded_m - expected.range_m; }
};

/// Rules of the classes.
struct BeamRules {
  double max_residual_m = 0.3;  ///< residual from which on a return is not of the expected static surface
  double neighbor_m = 0.3;      ///< difference of range of neighboring beams on one unmapped object
  double margin_deg = 0.6;      ///< azimuth to each side over which a smooth surface continues
  double margin_m = 0.05;       ///< distance across the beam to each side over which a smooth surface continues, too:
                                ///< one cell of a map, by which edges of a site made from it are off
  double jump_m = 0.06;         ///< deviation from a smooth surface that counts as an edge
  double max_turn_deg = 20.0;   ///< change of the normal within the margin that counts as an edge; 180: none does, for
                                ///< sites with walls of square cells

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("max_residual_m", self.max_residual_m, between(0.02, 10.0));
    visit("neighbor_m", self.neighbor_m, between(0.01, 10.0));
    visit("margin_deg", self.margin_deg, between(0.1, 5.0));
    visit("margin_m", self.margin_m, between(0.0, 2.0));
    visit("jump_m", self.jump_m, between(0.01, 0.1));
    visit("max_turn_deg", self.max_turn_deg, between(1.0, 180.0));
  }
};

/// Classifies the beams of one scan, in order of their index.
void classify(const BeamRules& rules, std::vector<Beam>& beams);

}  // namespace patrol::realism
