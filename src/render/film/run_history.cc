#include "render/film/run_history.h"

#include <optional>

#include "io/logs/run_log.h"

namespace patrol::render {
namespace {

constexpr Time kApproachPeriod = std::chrono::milliseconds(100);

}  // namespace

RunHistory read_run_history(const std::filesystem::path& log_mcap, const mjModel& view, const Pose2& T_world_map) {
  RunHistory history;
  ApproachFinder approaches(view);
  std::optional<Time> last_approach;
  io::LogHandlers handlers;
  handlers.on<GroundTruth>([&](Time, const GroundTruth& truth) {
    if (!history.T_world_body.empty() && truth.stamp <= history.T_world_body.back().stamp) return;
    history.T_world_body.push_back({truth.stamp, truth.T_world_body});
  });
  handlers.on<PoseEstimate>([&](Time, const PoseEstimate& estimate) {
    const std::optional<Pose3> truth = pose_at(history.T_world_body, estimate.stamp);
    if (!truth) return;
    history.errors.push_back(
        {estimate.stamp, T_world_map * estimate.T_map_body.position() - truth->position.head<2>()});
  });
  handlers.on<Event>([&](Time, const Event& event) { history.events.push_back(event); });
  handlers.on<LiningResult>([&](Time, const LiningResult& result) {
    history.ring_findings.insert(history.ring_findings.end(), result.findings.begin(), result.findings.end());
  });
  handlers.on<Collision>([&](Time, const Collision& collision) { history.collisions.push_back(collision); });
  handlers.on<SimState>([&](Time, const SimState& state) {
    if (history.num_states++ == 0) history.begin = state.stamp;
    history.end = state.stamp;
    if (last_approach && state.stamp < *last_approach + kApproachPeriod) return;
    last_approach = state.stamp;
    if (const std::optional<Approach> nearest = approaches.nearest(state)) history.approaches.push_back(*nearest);
  });
  history.log_is_complete = io::read_run_log(log_mcap, handlers);
  return history;
}

}  // namespace patrol::render
