#include "studies/landmark_track.h"

#include "core/thread_cpu_time.h"

namespace patrol::studies {

std::vector<Pose2> LandmarkTrack::poses() const {
  std::vector<Pose2> poses;
  for (const LandmarkSlamEstimate& estimate : estimates) poses.push_back(estimate.T_map_body);
  return poses;
}

LandmarkTrack follow(const LandmarkMethod& method, const LandmarkWorld& world, const LandmarkRun& run,
                     std::uint64_t seed) {
  const std::unique_ptr<LandmarkSlam> slam = method.make(world, seed);
  LandmarkTrack track;
  const double start_s = thread_cpu_time_s();
  for (std::size_t k = 0; k < run.odometry.size(); ++k)
    track.estimates.push_back(slam->step(run.odometry[k], run.observations[k]));
  track.landmarks = slam->landmarks();
  track.seconds = thread_cpu_time_s() - start_s;
  return track;
}

}  // namespace patrol::studies
