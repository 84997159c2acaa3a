#pragma once

#include <cmath>
#include <vector>

#include <Eigen/Core>

#include "core/time.h"

namespace patrol::localize {

/// Estimate of the parameters of a linear model.
struct LinearEstimate {
  Eigen::VectorXd value;
  Eigen::MatrixXd covariance;

  double std(Eigen::Index parameter) const { return std::sqrt(covariance(parameter, parameter)); }
};

/// Measurement r = J x + e of the parameters x, with the nominal information W of the error e.
struct LinearMeasurement {
  Time stamp{};
  Eigen::MatrixXd J;
  Eigen::VectorXd r;
  Eigen::MatrixXd W;
};

/// Recursive linear least squares with a covariance that holds for correlated errors.
///
/// The normal equations are summed separately for groups of consecutive measurements. The scores of the groups at the
/// estimate give the clustered sandwich covariance with the correction CR3 for few groups [Cameron15, section VI.B]:
/// errors may be correlated within a group. The prior enters as a further measurement. When the groups are too many,
/// neighbors are merged, and groups become longer.
///
/// The scores of few groups are uncertain. They are averaged with the nominal covariance times `prior_variance_factor`,
/// which counts as `prior_groups` groups.
class ClusteredLeastSquares {
 public:
  struct Settings {
    double group_s = 2.0;  ///< initial length of a group
    int max_groups = 48;
    double prior_variance_factor = 3.0;
    double prior_groups = 4.0;
  };

  /// `prior_std` > 0, [parameter]; the prior mean is zero.
  ClusteredLeastSquares(const Eigen::VectorXd& prior_std, const Settings& settings);

  /// Adds a measurement. Stamps must not decrease.
  void add(const LinearMeasurement& measurement);
  /// Discards all measurements.
  void reset();

  LinearEstimate estimate() const;
  /// Returns the squared Mahalanobis distance of a measurement from the estimate, divided by its dimension: 1 on
  /// average for measurements of the model, whatever the scale of their errors.
  double distance(const LinearMeasurement& measurement) const;

  template <typename Archive>
  void serialize_state(Archive& archive) {
    archive(prior_information_, group_s_, groups_, H_, g_, squared_errors_, num_rows_);
  }

 private:
  struct Group {
    Time begin{};
    Eigen::MatrixXd H;
    Eigen::VectorXd g;
  };
  void merge_pairs();
  Eigen::MatrixXd prior_information() const { return prior_information_.asDiagonal(); }
  /// Returns the covariance of the sum of the scores.
  Eigen::MatrixXd score_covariance(const Eigen::VectorXd& value, const Eigen::MatrixXd& inverse) const;
  /// Returns the variance of the errors relative to the nominal one.
  double variance_factor() const;

  Settings settings_;
  Eigen::VectorXd prior_information_;
  double group_s_;
  std::vector<Group> groups_;
  Eigen::MatrixXd H_;  ///< J^T W J and J^T W r, summed over the groups
  Eigen::VectorXd g_;
  double squared_errors_ = 0.0;  ///< r^T W r minus J x, each at the estimate of its time
  double num_rows_ = 0.0;
};

}  // namespace patrol::localize
