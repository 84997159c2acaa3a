#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/frames.h"
#include "render/film/moment.h"
#include "render/film/run_history.h"
#include "render/film/speed_plan.h"
#include "render/video.h"

namespace patrol::render {

enum class Cut {
  kStory,  ///< slows down at the notable moments, and goes near
  kPlain,  ///< even, one camera
};

/// "story" or "plain"; throws InputError for anything else.
Cut cut_named(const std::string& name);

enum class ShotKind {
  kBeside,    ///< the robot from near, low
  kTwoShot,   ///< the robot and what it meets
  kOverhead,  ///< from above, with the ground for a map
};

/// A part of a film that another camera takes than the one that follows.
struct Shot {
  TimeSpan span;  ///< of the run
  ShotKind kind = ShotKind::kBeside;
  std::vector<std::string> caption;  ///< lines
  Pose3 T_world_body;  ///< true, at the moment that the shot is about
  std::optional<Eigen::Vector2d> p_world_subject = {};  ///< of a two-shot, m
};

struct StorySettings {
  double lead_s = 4.0;  ///< of the run, before a moment
  double hold_s = 3.0;  ///< and after
  double same_scene_s = 4.0;  ///< moments nearer to each other than this are one scene
  int most_shots = 8;   ///< beyond, the less notable scenes are chapters only
};

struct ShotPlan {
  Cut cut = Cut::kStory;
  SpeedPlan speed;
  std::vector<Shot> shots;  ///< in order, apart; between them the camera follows
  std::vector<Chapter> chapters;  ///< from the film's begin to its end; of every scene
};

/// `moments` as find_moments gives them. A plain cut has the chapters only.
ShotPlan plan_shots(const RunHistory& history, const std::vector<Moment>& moments, Cut cut, const SpeedSettings& speed,
                    const StorySettings& settings = {});

}  // namespace patrol::render
