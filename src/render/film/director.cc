#include "render/film/director.h"

#include <algorithm>

namespace patrol::render {

const Shot* Director::shot_at(Time now) const {
  const auto shot =
      std::ranges::find_if(plan_.shots, [&](const Shot& s) { return now >= s.span.from && now <= s.span.to; });
  return shot == plan_.shots.end() ? nullptr : &*shot;
}

View Director::view(const RunSnapshot& snapshot, double elapsed_s) {
  const Pose3& T_world_body = snapshot.T_world_body;
  View following = rig_.follow(T_world_body, elapsed_s);
  const Shot* const shot = shot_at(snapshot.state.stamp);
  if (shot == nullptr) {
    shot_ = nullptr;
    return following;
  }
  if (shot != shot_) camera_.emplace(*shot, free_distance_, T_world_body);
  shot_ = shot;
  const Eigen::Vector2d p_world_estimate = snapshot.T_map_body ? snapshot.T_world_map * snapshot.T_map_body->position()
                                                               : Eigen::Vector2d(T_world_body.position.head<2>());
  return camera_->follow(T_world_body, p_world_estimate, elapsed_s);
}

FilmNote Director::note(Time now) const {
  FilmNote note{.caption = {},
                .speed = plan_.speed.speed(now),
                .film_s = plan_.speed.film_s(now),
                .length_s = plan_.speed.length_s(),
                .marks_s = {}};
  if (const Shot* shot = shot_at(now)) note.caption = shot->caption;
  for (const Shot& shot : plan_.shots) note.marks_s.push_back(plan_.speed.film_s(shot.span.from));
  return note;
}

}  // namespace patrol::render
