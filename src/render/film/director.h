#pragma once

#include <optional>
#include <utility>

#include "render/camera.h"
#include "render/film/film_note.h"
#include "render/film/shot_camera.h"
#include "render/film/shot_plan.h"
#include "render/run_snapshot.h"

namespace patrol::render {

/// Says from where each frame of a film is taken, and what is written on it.
class Director {
 public:
  /// `rig` follows the robot where the plan has no shot; `free_distance` is for the shots' own cameras.
  Director(ShotPlan plan, CameraRig rig, FreeDistance free_distance)
      : plan_(std::move(plan)), rig_(std::move(rig)), free_distance_(std::move(free_distance)) {}

  /// In order of the film; `elapsed_s` of film since the last frame.
  View view(const RunSnapshot& snapshot, double elapsed_s);
  FilmNote note(Time now) const;

  const ShotPlan& plan() const { return plan_; }

 private:
  /// The shot that an instant of the run is in; null: the camera follows.
  const Shot* shot_at(Time now) const;

  ShotPlan plan_;
  CameraRig rig_;
  FreeDistance free_distance_;
  const Shot* shot_ = nullptr;  ///< that `camera_` takes
  std::optional<ShotCamera> camera_;
};

}  // namespace patrol::render
