#pragma once

#include <optional>
#include <utility>

#include "render/film/shot_camera.h"
#include "render/film/shot_plan.h"
#include "render/film_note.h"
#include "render/run_snapshot.h"
#include "render/scene/camera.h"

namespace patrol::render {

/// Selects the view and the annotations of each frame of a film.
class Director {
 public:
  /// `rig` is the camera outside of planned shots; `free_distance` is for the shots' cameras.
  Director(ShotPlan plan, CameraRig rig, FreeDistance free_distance)
      : plan_(std::move(plan)), rig_(std::move(rig)), free_distance_(std::move(free_distance)) {}

  /// View of the next frame, `elapsed_s` of film time after the previous one. Must be called in the order of the film.
  View view(const RunSnapshot& snapshot, double elapsed_s);
  /// Annotations of the frame at a time of the run.
  FilmNote note(Time now) const;

  const ShotPlan& plan() const { return plan_; }

 private:
  /// Shot at a time of the run, null outside of planned shots.
  const Shot* shot_at(Time now) const;

  ShotPlan plan_;
  CameraRig rig_;
  FreeDistance free_distance_;
  const Shot* shot_ = nullptr;  ///< shot of `camera_`
  std::optional<ShotCamera> camera_;
};

}  // namespace patrol::render
