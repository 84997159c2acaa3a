#include "localize/calibration/clustered_least_squares.h"

#include <cmath>
#include <utility>

#include <Eigen/Cholesky>
#include <Eigen/LU>

namespace patrol::localize {
namespace {

/// Number of measurements with nominal errors with which the variance factor starts.
constexpr double kNominalRows = 20.0;

Eigen::MatrixXd inverse_of(const Eigen::MatrixXd& A) {
  return A.ldlt().solve(Eigen::MatrixXd::Identity(A.rows(), A.cols()));
}

}  // namespace

ClusteredLeastSquares::ClusteredLeastSquares(const Eigen::VectorXd& prior_std, const Settings& settings)
    : settings_(settings), prior_information_(prior_std.cwiseAbs2().cwiseInverse()) {
  reset();
}

void ClusteredLeastSquares::reset() {
  const Eigen::Index size = prior_information_.size();
  group_s_ = settings_.group_s;
  groups_.clear();
  H_ = Eigen::MatrixXd::Zero(size, size);
  g_ = Eigen::VectorXd::Zero(size);
  squared_errors_ = num_rows_ = 0.0;
}

void ClusteredLeastSquares::add(const LinearMeasurement& measurement) {
  if (groups_.empty() || to_seconds(measurement.stamp - groups_.back().begin) >= group_s_) {
    if (static_cast<int>(groups_.size()) >= settings_.max_groups) merge_pairs();
    groups_.push_back({measurement.stamp, 0.0 * H_, 0.0 * g_});
  }
  const Eigen::MatrixXd JW = measurement.J.transpose() * measurement.W;
  const Eigen::MatrixXd H = JW * measurement.J;
  const Eigen::VectorXd g = JW * measurement.r;
  groups_.back().H += H;
  groups_.back().g += g;
  H_ += H;
  g_ += g;
  const Eigen::VectorXd error = measurement.r - measurement.J * (H_ + prior_information()).ldlt().solve(g_);
  squared_errors_ += error.dot(measurement.W * error);
  num_rows_ += static_cast<double>(error.size());
}

void ClusteredLeastSquares::merge_pairs() {
  std::vector<Group> merged;
  for (std::size_t i = 0; i < groups_.size(); ++i) {
    if (i % 2 == 0) {
      merged.push_back(std::move(groups_[i]));
    } else {
      merged.back().H += groups_[i].H;
      merged.back().g += groups_[i].g;
    }
  }
  groups_ = std::move(merged);
  group_s_ *= 2.0;
}

double ClusteredLeastSquares::variance_factor() const {
  return (kNominalRows + squared_errors_) / (kNominalRows + num_rows_);
}

LinearEstimate ClusteredLeastSquares::estimate() const {
  const Eigen::MatrixXd inverse = inverse_of(H_ + prior_information());
  const Eigen::VectorXd value = inverse * g_;
  return {.value = value, .covariance = inverse * (score_covariance(value, inverse) + prior_information()) * inverse};
}

Eigen::MatrixXd ClusteredLeastSquares::score_covariance(const Eigen::VectorXd& value,
                                                        const Eigen::MatrixXd& inverse) const {
  const auto num_groups = static_cast<double>(groups_.size());
  const Eigen::MatrixXd identity = Eigen::MatrixXd::Identity(H_.rows(), H_.cols());
  Eigen::MatrixXd scores = 0.0 * H_;
  for (const Group& group : groups_) {
    const Eigen::VectorXd score = (identity - group.H * inverse).partialPivLu().solve(group.g - group.H * value);
    scores += score * score.transpose();
  }
  const Eigen::MatrixXd nominal = settings_.prior_variance_factor * variance_factor() * H_;
  return (num_groups * scores + settings_.prior_groups * nominal) / (num_groups + settings_.prior_groups);
}

double ClusteredLeastSquares::distance(const LinearMeasurement& measurement) const {
  const Eigen::MatrixXd inverse = inverse_of(H_ + prior_information());
  const Eigen::VectorXd error = measurement.r - measurement.J * (inverse * g_);
  const Eigen::MatrixXd covariance =
      variance_factor() * inverse_of(measurement.W) + measurement.J * inverse * measurement.J.transpose();
  return error.dot(covariance.ldlt().solve(error)) / static_cast<double>(error.size());
}

}  // namespace patrol::localize
