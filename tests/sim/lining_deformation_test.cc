#include "sim/lining_deformation.h"

#include <algorithm>
#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "core/error.h"
#include "core/geometry/angles.h"
#include "io/json/route_json.h"
#include "sim/lidar_scene.h"
#include "sim/mujoco.h"

namespace patrol::sim::lining_moves_test {
namespace {

const std::string kTunnelXml = PATROL_SOURCE_DIR "/worlds/tunnel/tunnel.xml";

TunnelLining tunnel_lining() { return *io::load_route(PATROL_SOURCE_DIR "/worlds/tunnel/site.json").route.lining; }

LiningDeformationSettings convergence(int first, int last, double mm) {
  return {.kind = "convergence", .first_ring = first, .last_ring = last, .inward_mm = mm};
}
LiningDeformationSettings settlement(int ring, double mm) {
  return {.kind = "settlement", .first_ring = ring, .last_ring = ring, .inward_mm = mm};
}
LiningDeformationSettings bulge(int ring, double mm, double clock_deg, double half_width_deg) {
  return {.kind = "bulge",
          .first_ring = ring,
          .last_ring = ring,
          .inward_mm = mm,
          .clock_deg = clock_deg,
          .half_width_deg = half_width_deg};
}

TEST(LiningMoves, AConvergenceIsTheSameAllRoundItsRingsAndNothingElsewhere) {
  for (const double clock_deg : {0.0, 90.0, 200.0, 359.0}) {
    EXPECT_DOUBLE_EQ(inward_m({convergence(4, 6, 3.0)}, 4, clock_deg), 0.003);
    EXPECT_DOUBLE_EQ(inward_m({convergence(4, 6, 3.0)}, 6, clock_deg), 0.003);
    EXPECT_EQ(inward_m({convergence(4, 6, 3.0)}, 3, clock_deg), 0.0);
    EXPECT_EQ(inward_m({convergence(4, 6, 3.0)}, 7, clock_deg), 0.0);
  }
}

TEST(LiningMoves, ASettlementOf12MillimetresIs12InwardsAtTheCrown6At2OClockAndNothingFrom3OClockDown) {
  EXPECT_DOUBLE_EQ(inward_m({settlement(9, 12.0)}, 9, 0.0), 0.012);
  EXPECT_NEAR(inward_m({settlement(9, 12.0)}, 9, 60.0), 0.006, 1e-12);
  EXPECT_NEAR(inward_m({settlement(9, 12.0)}, 9, 300.0), 0.006, 1e-12);
  for (const double clock_deg : {90.0, 110.0, 180.0, 269.0})
    EXPECT_NEAR(inward_m({settlement(9, 12.0)}, 9, clock_deg), 0.0, 1e-12);
}

// cos^2 of half way to the edge is a half.
TEST(LiningMoves, ABulgeOf6MillimetresHas3HalfWayToItsEdgeAcrossTheCrownToo) {
  const std::vector<LiningDeformationSettings> moves = {bulge(20, 6.0, 350.0, 40.0)};
  EXPECT_DOUBLE_EQ(inward_m(moves, 20, 350.0), 0.006);
  EXPECT_NEAR(inward_m(moves, 20, 10.0), 0.003, 1e-12);
  EXPECT_NEAR(inward_m(moves, 20, 330.0), 0.003, 1e-12);
  EXPECT_EQ(inward_m(moves, 20, 30.5), 0.0);
  EXPECT_EQ(inward_m(moves, 20, 309.5), 0.0);
}

TEST(LiningMoves, MovesOfOneRingAddUp) {
  EXPECT_NEAR(inward_m({convergence(1, 9, 3.0), bulge(5, 6.0, 0.0, 30.0), settlement(5, -2.0)}, 5, 0.0), 0.007, 1e-12);
}

/// The tunnel's lining before and after, as rays from the half circle's centre see it.
class MovedTunnel : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    lining_ = new TunnelLining(tunnel_lining());
    moves_ = {convergence(5, 5, 12.0), settlement(20, 6.0), bulge(35, 12.0, 60.0, 25.0), convergence(44, 45, -3.0),
              bulge(46, 6.0, 270.0, 30.0)};
    before_ = load_spec(kTunnelXml), after_ = load_spec(kTunnelXml);
    before_model_ = compile(*before_, kTunnelXml), after_model_ = compile(*after_, kTunnelXml);
    deform_lining(moves_, *lining_, *after_model_);
    for (const ModelPtr* model : {&before_model_, &after_model_})
      lining_id_ = mj_name2id(model->get(), mjOBJ_GEOM, "lining");
    before_scene_ = new LidarScene(*before_model_), after_scene_ = new LidarScene(*after_model_);
  }
  static void TearDownTestSuite() {
    delete before_scene_;
    delete after_scene_;
    delete lining_;
    before_model_.reset();
    after_model_.reset();
    before_.reset();
    after_.reset();
  }

  /// From 3 cm before the intrados, along the radius: where it is met, as a radius. Below 0 if something else is.
  static double seen_radius_m(const LidarScene& scene, double chainage_m, double clock_deg) {
    constexpr double kBefore_m = 0.03;
    const double angle = to_rad(clock_deg), from_m = lining_->radius_at(clock_deg) - kBefore_m;
    const auto at = [&](double radius_m) {
      const Eigen::Vector2d p = lining_->point_at(chainage_m, -radius_m * std::sin(angle));
      return Eigen::Vector3d(p.x(), p.y(), lining_->crown_center_m + radius_m * std::cos(angle));
    };
    const Eigen::Vector3d direction = (at(from_m + 1.0) - at(from_m)).normalized();
    const auto hit = scene.cast(at(from_m), direction, 0.1, kRayScenery);
    return hit && hit->geom == lining_id_ ? from_m + hit->distance_m : -1.0;
  }

  static bool has_moved(int ring) {
    return std::any_of(moves_.begin(), moves_.end(),
                       [ring](const auto& move) { return ring >= move.first_ring && ring <= move.last_ring; });
  }

  static inline TunnelLining* lining_;
  static inline std::vector<LiningDeformationSettings> moves_;
  static inline SpecPtr before_, after_;
  static inline ModelPtr before_model_, after_model_;
  static inline LidarScene *before_scene_, *after_scene_;
  static inline int lining_id_ = -1;
};

constexpr double kFacetTol_m = 0.2e-3;  // corners 2.1 degrees apart: between them a bulge is drawn straight

TEST_F(MovedTunnel, EveryRingIsMovedByWhatItsMovesSayWithinAFifthOfAMillimetreAndTheOthersNotAtAll) {
  int looked = 0;
  for (int ring = 1; ring <= lining_->rings; ++ring) {
    for (const double into_ring_m : {-0.98, -0.6, 0.0, 0.5, 0.98}) {
      for (double clock_deg = 3.0; clock_deg < 360.0; clock_deg += 7.3) {
        if (clock_deg > 112.0 && clock_deg < 248.0) continue;  // below the invert
        const double chainage_m = lining_->middle_of_ring_m(ring) + into_ring_m;
        const double before_m = seen_radius_m(*before_scene_, chainage_m, clock_deg),
                     after_m = seen_radius_m(*after_scene_, chainage_m, clock_deg);
        if (before_m < 0.0 || after_m < 0.0) continue;
        ++looked;
        EXPECT_NEAR(before_m - after_m, inward_m(moves_, ring, clock_deg), kFacetTol_m)
            << "ring " << ring << " at " << clock_deg;
        if (!has_moved(ring)) {
          EXPECT_NEAR(before_m, after_m, 1e-5) << "ring " << ring << " at " << clock_deg;
        }
      }
    }
  }
  EXPECT_GT(looked, 6000);
}

TEST_F(MovedTunnel, TheIntradosIsWithinAMillimetreOfTheDesign) {
  for (double chainage_m = 0.1; chainage_m < 99.9; chainage_m += 0.37) {
    for (double clock_deg = 0.5; clock_deg < 360.0; clock_deg += 5.1) {
      const double radius_m = seen_radius_m(*before_scene_, chainage_m, clock_deg);
      if (radius_m < 0.0) continue;  // something hangs before it
      EXPECT_NEAR(radius_m, lining_->radius_at(clock_deg), 1e-3) << chainage_m << " at " << clock_deg;
    }
  }
}

std::string error_text(const LiningDeformationSettings& move, const std::optional<TunnelLining>& design,
                       const std::string& world = "<mujoco/>") {
  const SpecPtr spec = parse_spec(world);
  const ModelPtr model = compile(*spec, "world");
  try {
    deform_lining({convergence(1, 1, 1.0), move}, design, *model);
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(LiningMoves, WhatCannotBeMovedIsRefusedByItsPlaceInTheList) {
  EXPECT_EQ(error_text(convergence(2, 51, 3.0), tunnel_lining()),
            "lining_deformation.1.last_ring = 51: must be at most 50, the last ring of the lining");
  EXPECT_EQ(error_text(convergence(7, 5, 3.0), tunnel_lining()),
            "lining_deformation.1.last_ring = 5: must be at least first_ring, 7");
  EXPECT_EQ(error_text(bulge(2, 3.0, 0.0, 0.0), tunnel_lining()),
            "lining_deformation.1.half_width_deg = 0: must be in [1, 180]");
  EXPECT_EQ(error_text(convergence(2, 2, 3.0), std::nullopt),
            "lining_deformation.0.first_ring = 1: requires a lining in the mission file");
  EXPECT_EQ(error_text(convergence(2, 2, 3.0), tunnel_lining()),
            "lining_deformation.0.first_ring: requires a world with a mesh named lining");
}

TEST(LiningMoves, WithoutMovesAnyWorldIsGood) {
  const SpecPtr spec = parse_spec("<mujoco/>");
  const ModelPtr model = compile(*spec, "world");
  EXPECT_NO_THROW(deform_lining({}, std::nullopt, *model));
}

}  // namespace
}  // namespace patrol::sim::lining_moves_test
