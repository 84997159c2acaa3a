#include "navigator_config.h"

#include <iterator>
#include <string>
#include <utility>

#include "core/geometry/angles.h"

namespace mrpt_stack {

void configure(mrpt::config::CConfigFileMemory& config, const std::vector<Eigen::Vector2d>& footprint_m,
               const NavigationSettings& settings) {
  const std::string abstract = "CAbstractPTGBasedReactive", reactive = "CReactiveNavigationSystem";
  config.write("CAbstractNavigator", "alarm_seems_not_approaching_target_timeout", 60.0);
  config.write("CAbstractNavigator", "dist_check_target_is_blocked", 0.0);
  config.write(abstract, "robotMax_V_mps", settings.speed_mps);
  config.write(abstract, "robotMax_W_degps", patrol::to_deg(settings.yaw_rate_radps));
  config.write(abstract, "holonomic_method", "mrpt::nav::CHolonomicFullEval");
  config.write(abstract, "motion_decider_method", "mrpt::nav::CMultiObjMotionOpt_Scalarization");
  config.write(abstract, "ref_distance", settings.ref_distance_m);
  config.write(abstract, "secure_distance_start", 0.05);
  config.write(abstract, "secure_distance_end", settings.full_speed);
  config.write("CHolonomicFullEval", "TOO_CLOSE_OBSTACLE", settings.too_close);
  config.write(abstract, "use_delays_model", false);
  config.write(abstract, "enable_obstacle_filtering", false);
  // Scores of a candidate; an empty name ends the list.
  const std::string optimizer = "CMultiObjectiveMotionOptimizerBase";
  const std::pair<const char*, const char*> scores[] = {
      {"free_distance", "collision_free_distance"},
      {"nearness", "(ref_dist - dist_eucl_final) / ref_dist"},
      {"same_as_before", "hysteresis"},
      {"toward_target",
       "var d := abs(target_k - move_k); if (d > num_paths / 2) { d := num_paths - d; }; exp(-d / (0.1 * num_paths))"},
      {"", ""}};
  for (std::size_t i = 0; i < std::size(scores); ++i) {
    const std::string prefix = "score" + std::to_string(i + 1);
    config.write(optimizer, prefix + "_name", std::string(scores[i].first));
    config.write(optimizer, prefix + "_formula", std::string(scores[i].second));
  }
  config.write(optimizer, "scores_to_normalize", std::string());
  config.write("CMultiObjMotionOpt_Scalarization", "scalar_score_formula", settings.score);
  config.write(reactive, "min_obstacles_height", -1.0);
  config.write(reactive, "max_obstacles_height", 2.0);
  std::string xs, ys;
  for (const Eigen::Vector2d& corner : footprint_m) {
    const Eigen::Vector2d outer = corner + settings.margin_m * corner.normalized();
    xs += " " + std::to_string(outer.x());
    ys += " " + std::to_string(outer.y());
  }
  config.write(reactive, "RobotModel_shape2D_xs", xs);
  config.write(reactive, "RobotModel_shape2D_ys", ys);
  config.write(reactive, "RobotModel_circular_shape_radius", 0.62);
  // Circular arcs forward, and turns toward a heading.
  const char* const types[] = {"CPTG_DiffDrive_C", "CPTG_DiffDrive_alpha"};
  config.write(reactive, "PTG_COUNT", 2);
  for (int i = 0; i < 2; ++i) {
    const std::string prefix = "PTG" + std::to_string(i) + "_";
    config.write(reactive, prefix + "Type", types[i]);
    config.write(reactive, prefix + "resolution", settings.resolution_m);
    config.write(reactive, prefix + "refDistance", settings.ref_distance_m);
    config.write(reactive, prefix + "num_paths", 121);
    config.write(reactive, prefix + "v_max_mps", settings.speed_mps);
    config.write(reactive, prefix + "w_max_dps", patrol::to_deg(settings.yaw_rate_radps));
    config.write(reactive, prefix + "K", 1.0);
    config.write(reactive, prefix + "cte_a0v_deg", 57.0);
    config.write(reactive, prefix + "cte_a0w_deg", 57.0);
    config.write(reactive, prefix + "score_priority", 1.0);
  }
}

}  // namespace mrpt_stack
