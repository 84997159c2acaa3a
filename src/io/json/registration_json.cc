#include "io/json/registration_json.h"

#include "core/geometry/linear_algebra.h"
#include "io/files/atomic_file.h"
#include "io/json/json_object.h"

namespace patrol::io {
namespace {

constexpr std::size_t kMaxEntries = 100;
constexpr double kMaxAsymmetry = 1e-9;

using RowMajor = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;

}  // namespace

SiteRegistration load_registration(const std::filesystem::path& file) {
  const Json json = load_json(file, kMaxEntries);
  const JsonObject reader(file.string(), json, {"position", "orientation", "covariance"});
  SiteRegistration registration{.T_site_map = reader.pose()};
  registration.covariance = Eigen::Map<const RowMajor>(reader.numbers("covariance", 9).data());
  const bool is_symmetric =
      (registration.covariance - registration.covariance.transpose()).cwiseAbs().maxCoeff() < kMaxAsymmetry;
  if (!is_symmetric || !is_positive_definite(registration.covariance))
    reader.fail("covariance must be symmetric and positive definite");
  return registration;
}

void save_registration(const std::filesystem::path& file, const SiteRegistration& registration) {
  const Pose2& T = registration.T_site_map;
  const Eigen::Quaterniond q = quaternion_from_yaw(T.yaw);
  const RowMajor covariance = registration.covariance;
  const Json json = {{"position", {T.x, T.y, 0.0}},
                     {"orientation", {q.x(), q.y(), q.z(), q.w()}},
                     {"covariance", std::vector<double>(covariance.data(), covariance.data() + covariance.size())}};
  save_text(file, json.dump(1) + "\n");
}

}  // namespace patrol::io
