#include "render/film/shot_plan.h"

#include <algorithm>

#include "core/error.h"
#include "core/text.h"

namespace patrol::render {
namespace {

/// Highlights that are close in time, shown in one shot.
struct Scene {
  TimeSpan span;  ///< run time
  std::vector<std::string> titles;
  Highlight main_highlight;
};

/// Builds a scene from the highlights [`from`, `to`), which are ordered by time.
Scene scene_of(std::vector<Highlight>::const_iterator from, std::vector<Highlight>::const_iterator to,
               const ShotSettings& settings) {
  constexpr std::size_t kMaxTitles = 3;
  Scene scene{.span = {from->at - from_seconds(settings.lead_s), (to - 1)->at + from_seconds(settings.lag_s)},
              .titles = {},
              .main_highlight =
                  *std::min_element(from, to, [](const Highlight& a, const Highlight& b) { return a.kind < b.kind; })};
  std::vector<Highlight> main_highlights(from, to);
  std::ranges::stable_sort(main_highlights, {}, &Highlight::kind);
  if (main_highlights.size() > kMaxTitles) main_highlights.resize(kMaxTitles);
  std::ranges::stable_sort(main_highlights, {}, &Highlight::at);
  for (const Highlight& highlight : main_highlights) scene.titles.push_back(highlight.title);
  return scene;
}

/// Groups the highlights into scenes in order of time. Overlapping scenes are cut at the middle of the overlap.
std::vector<Scene> scenes_of(const std::vector<Highlight>& highlights, TimeSpan run, const ShotSettings& settings) {
  std::vector<Scene> scenes;
  for (auto from = highlights.begin(), to = from; from != highlights.end(); from = to) {
    for (++to; to != highlights.end() && to->at - (to - 1)->at < from_seconds(settings.same_scene_s);) ++to;
    Scene scene = scene_of(from, to, settings);
    scene.span = {std::max(scene.span.from, run.from), std::min(scene.span.to, run.to)};
    if (!scenes.empty() && scenes.back().span.to > scene.span.from) {
      const Time middle = (scenes.back().span.to + scene.span.from) / 2;
      scenes.back().span.to = scene.span.from = middle;
    }
    scenes.push_back(std::move(scene));
  }
  return scenes;
}

ShotKind shot_kind(const Highlight& highlight) {
  if (highlight.p_world_subject) return ShotKind::kTwoSubjects;
  switch (highlight.kind) {
    case HighlightKind::kKidnap:
    case HighlightKind::kLost:
    case HighlightKind::kRelocalized:
    case HighlightKind::kCorrection:
      return ShotKind::kOverhead;
    default:
      return ShotKind::kClose;
  }
}

/// Shots of the scenes with the highest priority, in order of time.
std::vector<Shot> shots_of(std::vector<Scene> scenes, const Trajectory& T_world_body, int max_shots) {
  const auto kind = [](const Scene& scene) { return scene.main_highlight.kind; };
  std::erase_if(scenes, [&](const Scene& scene) {
    return kind(scene) == HighlightKind::kMission || scene.span.to <= scene.span.from;
  });
  std::ranges::stable_sort(scenes, {}, kind);
  if (scenes.size() > static_cast<std::size_t>(max_shots)) scenes.resize(static_cast<std::size_t>(max_shots));
  std::ranges::sort(scenes, {}, [](const Scene& scene) { return scene.span.from; });
  const Pose3 last = T_world_body.empty() ? Pose3{} : T_world_body.back().pose;
  std::vector<Shot> shots;
  for (const Scene& scene : scenes) {
    const Highlight& highlight = scene.main_highlight;
    shots.push_back({.span = scene.span,
                     .kind = shot_kind(highlight),
                     .caption = scene.titles,
                     .T_world_body = pose_at(T_world_body, highlight.at).value_or(last),
                     .p_world_subject = highlight.p_world_subject,
                     .subject_height_m = highlight.subject_height_m});
  }
  return shots;
}

std::vector<Chapter> chapters_of(const std::vector<Scene>& scenes, const SpeedPlan& speed) {
  constexpr double kMinChapter_s = 0.2;
  constexpr const char* kStart = "Start";
  std::vector<Chapter> chapters = {{.begin_s = 0.0, .end_s = speed.length_s(), .title = kStart}};
  for (const Scene& scene : scenes) {
    const double begin_s = speed.film_s(scene.span.from);
    const std::string title = join(scene.titles, "; ");
    if (begin_s - chapters.back().begin_s < kMinChapter_s) {
      std::string& earlier = chapters.back().title;
      if (earlier == kStart) earlier = title;
      else earlier += "; " + title;
      continue;
    }
    chapters.back().end_s = begin_s;
    chapters.push_back({.begin_s = begin_s, .end_s = speed.length_s(), .title = title});
  }
  return chapters;
}

}  // namespace

FilmStyle parse_film_style(const std::string& name) {
  if (name == "highlights") return FilmStyle::kHighlights;
  if (name == "continuous") return FilmStyle::kContinuous;
  throw InputError(name + ": must be one of highlights, continuous");
}

ShotPlan plan_shots(const RunHistory& history, const std::vector<Highlight>& highlights, FilmStyle style,
                    const SpeedSettings& speed, const ShotSettings& settings) {
  const TimeSpan run{history.begin, history.end};
  const std::vector<Scene> scenes = scenes_of(highlights, run, settings);
  std::vector<Shot> shots;
  if (style == FilmStyle::kHighlights) shots = shots_of(scenes, history.T_world_body, settings.max_shots);
  std::vector<TimeSpan> slow_spans;
  for (const Shot& shot : shots) slow_spans.push_back(shot.span);
  const SpeedPlan speed_plan(run, slow_spans, speed);
  return {.style = style, .speed = speed_plan, .shots = std::move(shots), .chapters = chapters_of(scenes, speed_plan)};
}

}  // namespace patrol::render
