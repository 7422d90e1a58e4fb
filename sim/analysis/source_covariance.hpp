/// @file
/// The covariance of filters' errors as it comes from some sources, under the gains of filters that
/// need not know them. Part of covariance_analysis.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "leeway/model/error_state.hpp"
#include "leeway/model/process_noise.hpp"
#include "leeway/sensors/imu_error_model.hpp"
#include "leeway/sim/analysis/error_track.hpp"
#include "sim/analysis/fix_rows.hpp"

namespace leeway::sim {

/// Components of the errors of some filters on the same sensors and fixes, one filter below the
/// other. A single filter follows a track whose biases decay as its own do. Several share a track
/// whose biases do not decay: each filter's decay is then added beside it.
template <int kFilters>
inline constexpr int kErrorsOf{kErrorStates * (kFilters)};

/// Second moment E[x x^T] of these errors.
template <int kFilters>
using ErrorMoment = Eigen::Matrix<double, kErrorsOf<kFilters>, kErrorsOf<kFilters>>;

/// Gains of each filter on the rows of a fix.
template <int kFilters>
using FixGains = Eigen::Matrix<double, kErrorsOf<kFilters>, 6>;

/// What enters the errors through each filter's own innovation, a column each.
template <int kFilters>
using ErrorGains = Eigen::Matrix<double, kErrorsOf<kFilters>, kFilters>;

/// One row of a fix and the filters' gains on it: error' = error - K innovation.
template <int kFilters>
struct RowGain {
  int row{};
  double per_sigma{};
  ErrorVector h{ErrorVector::Zero()};
  ErrorGains<kFilters> K{ErrorGains<kFilters>::Zero()};
};

/// A Gauss-Markov process g of three axes, or a constant (tau infinite), that enters the errors
/// through a bias state or through the position fixes, and is correlated with them.
template <int kFilters>
struct MarkovSource {
  static constexpr int kFixes = -1;
  using Cross = Eigen::Matrix<double, kErrorsOf<kFilters>, 3>;

  int enters_at{kFixes};  ///< kBa, kBg or kFixes
  GaussMarkov process{};
  Cross S{Cross::Zero()};                      ///< E[error g^T]
  Eigen::Matrix3d G{Eigen::Matrix3d::Zero()};  ///< E[g g^T]
};

/// How such a process starts: a mean, of which the filters may know some, and a variance.
struct MarkovStart {
  Eigen::Vector3d variance{Eigen::Vector3d::Zero()};
  Eigen::Vector3d mean{Eigen::Vector3d::Zero()};
  Eigen::Vector3d known{Eigen::Vector3d::Zero()};

  /// E[x x^T] of the bias error at the start.
  Eigen::Matrix3d error_moment() const;
};

/// E[x x^T] from initial errors and white noise, and from processes with a memory of their own.
template <int kFilters>
class SourceCovariance {
 public:
  /// @param filters  of which only the times of the bias states count
  explicit SourceCovariance(const std::array<ProcessNoise, kFilters>& filters)
      : filters_(filters) {}

  ErrorMoment<kFilters> P{ErrorMoment<kFilters>::Zero()};
  ProcessNoise noise{};
  Eigen::Matrix<double, 6, 1> fix_variance{Eigen::Matrix<double, 6, 1>::Zero()};  ///< by row

  /// Adds the moment of an error that all filters share, to its rows from `row` on.
  template <class Moment>
  void add_shared(int row, const Moment& moment) {
    for (int i = row; i < P.rows(); i += kErrorStates) {
      for (int j = row; j < P.cols(); j += kErrorStates) {
        P.block(i, j, moment.rows(), moment.cols()) += moment;
      }
    }
  }

  void add_process(MarkovSource<kFilters> source, const MarkovStart& start);
  bool has_processes() const { return !processes_.empty(); }

  void propagate(const Leg& leg);
  void update(const RowGain<kFilters>& gain);

 private:
  void step_processes(double dt_s);
  void step_process(MarkovSource<kFilters>& source, double dt_s);
  void let_biases_decay(double dt_s);
  double own_decay(int filter, int bias, double dt_s) const;
  void step_errors(const Leg& leg);

  std::array<ProcessNoise, kFilters> filters_;
  std::vector<MarkovSource<kFilters>> processes_{};
};

/// Unknown constants of the sensors: the errors are linear in them. One sensitivity serves all.
template <int kFilters>
class ParameterSources {
 public:
  void propagate(const Leg& leg);
  void update(const RowGain<kFilters>& gain);

  /// @param second_moment  E[p p^T] of the parameters that belong to the source
  ErrorMoment<kFilters> covariance(
      const Eigen::Matrix<double, kSensorParameters, kSensorParameters>& second_moment) const {
    return S_ * second_moment * S_.transpose();
  }

 private:
  using Sensitivity = Eigen::Matrix<double, kErrorsOf<kFilters>, kSensorParameters>;
  Sensitivity S_{Sensitivity::Zero()};
};

}  // namespace leeway::sim
