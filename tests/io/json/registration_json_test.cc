#include "io/json/registration_json.h"

#include <gtest/gtest.h>

#include "core/error.h"
#include "tests/support/pose_near.h"
#include "tests/support/temporary_file.h"

namespace patrol::io::registration_json_test {
namespace {

using test::Pose2Near, test::TemporaryFile;

std::string complaint_about(const std::string& text) {
  const TemporaryFile file("registration.json", text);
  try {
    load_registration(file.path());
  } catch (const InputError& error) {
    const std::string what = error.what();
    return what.substr(what.find("registration.json"));
  }
  return "";
}

TEST(RegistrationJson, LoadsWhatItHasSaved) {
  SiteRegistration saved{.T_site_map = {3.0, -2.0, 0.25}};
  saved.covariance << 4e-4, 1e-5, 0.0, 1e-5, 9e-4, 2e-6, 0.0, 2e-6, 1e-6;
  const TemporaryFile file("registration.json", "");
  save_registration(file.path(), saved);
  const SiteRegistration loaded = load_registration(file.path());
  EXPECT_THAT(loaded.T_site_map, Pose2Near(saved.T_site_map, 1e-12, 1e-12));
  EXPECT_EQ(loaded.covariance, saved.covariance);
}

TEST(RegistrationJson, RefusesWhatIsNoCovariance) {
  const std::string pose = R"({"position": [1, 2, 0], "orientation": [0, 0, 0, 1], "covariance": )";
  EXPECT_EQ(complaint_about(pose + "[1, 0, 0, 0, 1, 0, 0, 0, 1]}"), "");
  EXPECT_EQ(complaint_about(pose + "[1, 0, 0, 0, -1, 0, 0, 0, 1]}"),
            "registration.json: covariance must be symmetric and positive definite");
  EXPECT_EQ(complaint_about(pose + "[1, 0.5, 0, 0, 1, 0, 0, 0, 1]}"),
            "registration.json: covariance must be symmetric and positive definite");
  EXPECT_NE(complaint_about(pose + "[1, 0]}"), "");
}

}  // namespace
}  // namespace patrol::io::registration_json_test
