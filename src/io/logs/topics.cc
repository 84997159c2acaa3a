#include "io/logs/topics.h"

namespace patrol::io {
namespace {

template <typename... Messages>
void add(std::vector<TopicInfo>& infos) {
  (infos.push_back(kTopicInfo<Messages>), ...);
}

}  // namespace

std::vector<TopicInfo> topic_infos() {
  std::vector<TopicInfo> infos;
  Sensors::for_each([&]<typename Message>(std::type_identity<Message>) { add<Message>(infos); });
  infos.insert(infos.end(), {kTransforms, kStaticTransforms});
  add<OdometryEstimate, PoseEstimate, UwbPoseEstimate, SiteRegistration, CalibrationEstimate, LocalizationConfidence,
      ParticleSet, MapUpdate, Path, VelocityCommand, ScanCommand, AntennaCommand, SoundingCommand, WarningCommand,
      LiningResult, WaterResult, Event, GroundTruth, SimState, AsBuiltTruth, Collision>(infos);
  return infos;
}

}  // namespace patrol::io
