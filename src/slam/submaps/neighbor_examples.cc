#include "slam/submaps/neighbor_examples.h"

#include <cmath>

#include "core/random.h"
#include "slam/submaps/pair_features.h"

namespace patrol::slam {
namespace {

PoseGaussian sample_prediction(const Pose2& T_target_source, const NeighborExampleSettings& settings,
                               RandomSequence& random) {
  const double std_m = settings.min_prediction_std_m *
                       std::pow(settings.max_prediction_std_m / settings.min_prediction_std_m, random.uniform());
  const Eigen::Vector3d std_devs(std_m, std_m, settings.prediction_rad_per_m * std_m);
  const double factor = random.uniform() < settings.outlier_probability ? 4.0 : 1.0;
  const Eigen::Vector3d error =
      factor * std_devs.cwiseProduct(Eigen::Vector3d(random.normal(), random.normal(), random.normal()));
  return {.mean = perturbed(T_target_source, error), .covariance = std_devs.cwiseAbs2().asDiagonal()};
}

}  // namespace

void add_neighbor_examples(const SubmapRbpf& built, const std::vector<Pose2>& T_world_submap,
                           const SubmapSurfaceSettings& surfaces, const NeighborExampleSettings& settings,
                           std::uint64_t seed, LabeledFeatures& examples) {
  validate(settings, "examples");
  const RandomStream stream(seed, "slam/neighbour_examples");
  std::uint64_t pair = 0;
  for (std::size_t source = 0; source < T_world_submap.size(); ++source) {
    for (std::size_t target = 0; target < source; ++target) {
      const auto &of_target = built.surfaces_of(static_cast<int>(target)),
                 &of_source = built.surfaces_of(static_cast<int>(source));
      if (!of_target || !of_source) continue;
      const Pose2 T_target_source = T_world_submap[target].inverse() * T_world_submap[source];
      RandomSequence random(stream, pair++);
      for (int i = 0; i < settings.predictions; ++i) {
        const PoseGaussian prediction = sample_prediction(T_target_source, settings, random);
        if (!may_be_neighbors(of_target->descriptor, of_source->descriptor, prediction)) continue;
        SurfaceMatch match = match_surfaces(*of_target, *of_source, prediction, surfaces);
        bool is_right = false;
        if (match.fine) {
          const Pose2 off = T_target_source.inverse() * match.fine->T_target_source;
          is_right = off.position().norm() < settings.max_match_m && std::abs(off.yaw) < settings.max_match_rad;
        }
        examples.examples.push_back(std::move(match.features));
        examples.labels.push_back(is_right ? 1 : -1);
      }
    }
  }
}

}  // namespace patrol::slam
