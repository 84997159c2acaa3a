#include "app/mapping/mapping_stack.h"

#include <utility>

#include "app/mapping/log_documents.h"
#include "core/error.h"
#include "core/thread_cpu_time.h"
#include "io/logs/topics.h"

namespace patrol::app {
namespace {

template <typename Message>
PublishedMessage published_message(Message message) {
  PublishedMessage published{
      .content = {}, .topic = io::kTopic<Message>, .type = {}, .definition = {}, .cdr = io::encode(message)};
  published.content = std::move(message);
  return published;
}

}  // namespace

MappingStack::MappingStack(const LogMappingSettings& settings, const io::TransformSet& mounts)
    : settings_(settings),
      mapper_(make_log_mapper(settings)),
      calibrated_(settings.calibration),
      T_body_lidar_(T_body_lidar_of(mounts)) {}

void MappingStack::deliver(link::DeliveredMessage message) {
  const double start_s = thread_cpu_time_s();
  if (message.topic == io::kTopic<RecordedOdometry>) {
    T_odom_last_ = io::decode<RecordedOdometry>(message.cdr).T_odom_body;
    if (!T_odom_first_) T_odom_first_ = T_odom_last_;
  } else if (message.topic == io::kTopic<LaserScan>) {
    map_scan(io::decode<LaserScan>(message.cdr));
  }
  seconds_ += thread_cpu_time_s() - start_s;
}

StackAnswer MappingStack::end_turn() {
  return {
      .messages = std::exchange(published_, {}), .next_turn = turn_ + Time{1}, .mission_is_over = false, .delay = {}};
}

std::vector<PublishedMessage> MappingStack::finish(Time now) {
  const double start_s = thread_cpu_time_s();
  mapper_->finish();
  TrajectoryEstimate trajectory{.stamp = now, .T_map_body = {}};
  const std::vector<Pose2> path = mapper_->path();
  for (std::size_t i = 0; i < path.size(); ++i) trajectory.T_map_body.push_back({stamps_[i], to_pose3(path[i])});
  published_.push_back(published_message(std::move(trajectory)));
  published_.push_back(published_message(MapUpdate{.stamp = now, .map = mapper_->map()}));
  seconds_ += thread_cpu_time_s() - start_s;
  return std::exchange(published_, {});
}

void MappingStack::map_scan(LaserScan scan) {
  if (!T_odom_first_) throw InputError("the recorded log has a scan without odometry");
  RecordedScan recorded{.scan = std::move(scan),
                        .T_odom_body = *T_odom_first_,
                        .T_body_lidar = T_body_lidar_,
                        .T_begin_end = T_odom_first_->inverse() * *T_odom_last_};
  T_odom_first_.reset();
  calibrated_.correct(recorded);
  const slam::SlamUpdate update = mapper_->update(slam::planar_scan(recorded, settings_.scan), recorded.T_odom_body);
  stamps_.push_back(recorded.scan.stamp);
  published_.push_back(published_message(
      PoseEstimate{.stamp = recorded.scan.stamp, .T_map_body = update.T_map_body, .covariance = update.covariance}));
}

}  // namespace patrol::app
