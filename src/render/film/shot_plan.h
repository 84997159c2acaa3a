#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/frames.h"
#include "render/film/highlight.h"
#include "render/film/run_history.h"
#include "render/film/speed_plan.h"
#include "render/video/chapter.h"

namespace patrol::render {

/// Editing style of a film.
enum class FilmStyle {
  kHighlights,  ///< slow motion and close shots at the highlights
  kContinuous,  ///< constant speed, one camera
};

/// Parses "highlights" or "continuous". Throws InputError for any other text.
FilmStyle parse_film_style(const std::string& name);

/// Perspective of a shot.
enum class ShotKind {
  kClose,        ///< robot from near and low
  kTwoSubjects,  ///< robot and the subject of the highlight
  kOverhead,     ///< vertically down on robot and estimate
};

/// Segment of a film with its own camera instead of the following one.
struct Shot {
  TimeSpan span;  ///< run time
  ShotKind kind = ShotKind::kClose;
  std::vector<std::string> caption;                     ///< text lines
  Pose3 T_world_body;                                   ///< true pose at the highlight
  std::optional<Eigen::Vector2d> p_world_subject = {};  ///< subject of a two-shot, m
  double subject_height_m = 0.0;                        ///< height of the subject over the robot's body
};

/// Composition of highlights into shots.
struct ShotSettings {
  double lead_s = 4.0;        ///< run time before a highlight
  double lag_s = 3.0;         ///< run time after a highlight
  double same_scene_s = 4.0;  ///< highlights less than this apart belong to one scene
  int max_shots = 8;          ///< maximum number of shots; lower-priority scenes are chapters only
};

/// Speeds, shots and chapters of a film.
struct ShotPlan {
  FilmStyle style = FilmStyle::kHighlights;
  SpeedPlan speed;
  std::vector<Shot> shots;        ///< ordered, not overlapping; between shots the camera rig follows the robot
  std::vector<Chapter> chapters;  ///< cover the whole film: the start, then one per scene
};

/// Plans the shots of a film. `moments` is the result of find_highlights. A plain film has chapters only.
ShotPlan plan_shots(const RunHistory& history, const std::vector<Highlight>& highlights, FilmStyle style,
                    const SpeedSettings& speed, const ShotSettings& settings = {});

}  // namespace patrol::render
