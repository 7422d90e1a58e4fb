/// @file
/// The covariance of filters' errors as it comes from some sources, under the gains of filters that
/// need not know them. Part of covariance_analysis.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "leeway/covariance/covariance.hpp"
#include "leeway/model/error_state.hpp"
#include "leeway/model/process_noise.hpp"
#include "leeway/sensors/imu_error_model.hpp"
#include "leeway/sim/analysis/error_track.hpp"
#include "sim/analysis/doubling/stretch.hpp"
#include "sim/analysis/fix_rows.hpp"

namespace leeway::sim {

/// Components of the errors of some filters on the same sensors and fixes, one filter below the
/// other. A single filter follows a track whose biases decay as its own do. Several share a track
/// whose biases do not decay: each filter's decay is then added beside it.
/// @tparam kParameters  of the vehicle, which a single filter may estimate too: 0 or kVehicleStates
template <int kFilters, int kParameters = 0>
inline constexpr int kErrorsOf{kErrorStates * (kFilters) + (kParameters)};

/// Second moment E[x x^T] of these errors.
template <int kFilters, int kParameters = 0>
using ErrorMoment =
    Eigen::Matrix<double, kErrorsOf<kFilters, kParameters>, kErrorsOf<kFilters, kParameters>>;

/// Gains of each filter on the rows of a fix.
template <int kFilters, int kParameters = 0>
using FixGains = Eigen::Matrix<double, kErrorsOf<kFilters, kParameters>, 6>;

/// What enters the errors through each filter's own innovation, a column each.
template <int kFilters, int kParameters = 0>
using ErrorGains = Eigen::Matrix<double, kErrorsOf<kFilters, kParameters>, kFilters>;

/// One row of a fix and the filters' gains on it: error' = error - K innovation.
template <int kFilters, int kParameters = 0>
struct RowGain {
  int row{};
  double per_sigma{};
  double readings{1.0};  ///< whose mean this is
  Eigen::Matrix<double, kErrorStates + kParameters, 1> h =
      Eigen::Matrix<double, kErrorStates + kParameters, 1>::Zero();
  ErrorGains<kFilters, kParameters> K{ErrorGains<kFilters, kParameters>::Zero()};
};

/// A Gauss-Markov process g of three axes, or a constant (tau infinite), that enters the errors
/// through a bias state or through the position fixes, and is correlated with them.
template <int kFilters, int kParameters = 0>
struct MarkovSource {
  static constexpr int kFixes = -1;
  using Cross = Eigen::Matrix<double, kErrorsOf<kFilters, kParameters>, 3>;

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
  Eigen::Matrix3d error_moment() const {
    const Eigen::Vector3d error = mean - known;
    return Eigen::Matrix3d(variance.asDiagonal()) + error * error.transpose();
  }
};

/// Calls f(rows, first) with the 15 rows of every filter's errors.
template <class Errors, class F>
void for_each_filter(Errors& X, F&& f) {
  for (int first = 0; first + kErrorStates <= X.rows(); first += kErrorStates) {
    f(X.template middleRows<kErrorStates>(first), first);
  }
}

template <class Errors>
void carry(const Transition& Phi, Errors& X) {
  for_each_filter(X, [&Phi](auto rows, int) { rows = times(Phi, rows); });
}

/// What a row measures of every filter's errors.
template <class Row, class Errors>
auto measured(const Row& h, const Errors& X) {
  Eigen::Matrix<double, Errors::RowsAtCompileTime / kErrorStates, Errors::ColsAtCompileTime> all;
  if constexpr (Row::RowsAtCompileTime > kErrorStates) {
    all = h.transpose() * X;
  } else {
    for_each_filter(
        X, [&](auto rows, int first) { all.row(first / kErrorStates) = h.transpose() * rows; });
  }
  return all;
}

/// E[x x^T] from initial errors and white noise, and from processes with a memory of their own.
template <int kFilters, int kParameters = 0>
class SourceCovariance {
 public:
  /// @param filters  of which only the times of the bias states count
  explicit SourceCovariance(const std::array<ProcessNoise, kFilters>& filters)
      : filters_(filters) {}

  ErrorMoment<kFilters, kParameters> P{ErrorMoment<kFilters, kParameters>::Zero()};
  ProcessNoise noise{};
  RowVariances row_variance{RowVariances::Zero()};  ///< by RowKind
  Eigen::Matrix<double, kParameters, 1> walk_per_s =
      Eigen::Matrix<double, kParameters, 1>::Zero();  ///< of the vehicle's parameters

  /// Adds the moment of an error that all filters share, to its rows from `row` on.
  template <class Moment>
  void add_shared(int row, const Moment& moment) {
    constexpr int kAll = kErrorStates * kFilters;
    for (int i = row; i < kAll; i += kErrorStates) {
      for (int j = row; j < kAll; j += kErrorStates) {
        P.block(i, j, moment.rows(), moment.cols()) += moment;
      }
    }
  }

  void add_process(MarkovSource<kFilters, kParameters> source, const MarkovStart& start) {
    const Eigen::Matrix3d variance = start.variance.asDiagonal();
    source.G = variance + start.mean * start.mean.transpose();
    if (source.enters_at != MarkovSource<kFilters, kParameters>::kFixes) {
      add_shared(source.enters_at, start.error_moment());
      for_each_filter(source.S, [&](auto rows, int) {
        rows.template middleRows<3>(source.enters_at) =
            variance + (start.mean - start.known) * start.mean.transpose();
      });
    }
    processes_.push_back(source);
  }

  const std::vector<MarkovSource<kFilters, kParameters>>& processes() const { return processes_; }
  std::vector<MarkovSource<kFilters, kParameters>>& processes() { return processes_; }

  void propagate(const Leg& leg) {
    // Half before and half after, as propagate() does with noise: second order in the step.
    step_processes(0.5 * leg.Phi.dt_s);
    step_errors(leg);
    for (MarkovSource<kFilters, kParameters>& source : processes_) carry(leg.Phi, source.S);
    step_processes(0.5 * leg.Phi.dt_s);
  }

  /// Over many legs. @pre one filter of 15 states, and no process enters between fixes
  void propagate(const Stretch& stretch) {
    leeway::propagate(P, stretch.Phi, ProcessNoise{});
    P += stretch.true_noise;
    for (MarkovSource<kFilters, kParameters>& source : processes_) {
      carry(stretch.Phi, source.S);
      source.S *= bias_decay(stretch.Phi.dt_s, source.process.tau_s);
    }
  }

  /// error' = error - K innovation, in second moments.
  void update(const RowGain<kFilters, kParameters>& gain) {
    const double per_sigma = gain.per_sigma;
    ErrorGains<kFilters, kParameters> cross;  // E[error innovation^T]
    constexpr int kOwn = kErrorStates + kParameters;
    for (int i = 0; i < kFilters; ++i) {
      cross.col(i) = P.template middleCols<kOwn>(i * kOwn) * gain.h;
    }
    Eigen::Matrix<double, kFilters, kFilters> variance = measured(gain.h, cross);
    variance.array() += row_variance(gain.row) * per_sigma * per_sigma / gain.readings;
    for (MarkovSource<kFilters, kParameters>& source : processes_) {
      auto innovation_g = measured(gain.h, source.S);  // E[innovation g^T]
      if (source.enters_at == MarkovSource<kFilters, kParameters>::kFixes && gain.row < 3) {
        // Of the variance only the symmetric part counts.
        variance.array().colwise() += 2.0 * per_sigma * innovation_g.col(gain.row).array() +
                                      per_sigma * per_sigma * source.G(gain.row, gain.row);
        cross.colwise() += per_sigma * source.S.col(gain.row);
        innovation_g.rowwise() += per_sigma * source.G.row(gain.row);
      }
      source.S -= gain.K * innovation_g;
    }
    const ErrorGains<kFilters, kParameters> half = cross - gain.K * (0.5 * variance);
    if constexpr (kFilters == 1) {
      for (int j = 0; j < P.cols(); ++j) P.col(j) -= half(j) * gain.K + gain.K(j) * half;
    } else {
      P.noalias() -= gain.K * half.transpose() + half * gain.K.transpose();
    }
  }

 private:
  void step_errors(const Leg& leg) {
    P.diagonal().template tail<kParameters>() += leg.Phi.dt_s * walk_per_s;
    if constexpr (kFilters == 1 && kParameters == 0) {
      leeway::propagate(P, leg.Phi, noise);
    } else if constexpr (kFilters == 1) {
      ErrorMatrix errors = P.template topLeftCorner<kErrorStates, kErrorStates>();
      leeway::propagate(errors, leg.Phi, noise);
      P.template topLeftCorner<kErrorStates, kErrorStates>() = errors;
      const Eigen::Matrix<double, kErrorStates, kParameters> cross =
          times(leg.Phi, P.template topRightCorner<kErrorStates, kParameters>());
      P.template topRightCorner<kErrorStates, kParameters>() = cross;
      P.template bottomLeftCorner<kParameters, kErrorStates>() = cross.transpose();
    } else {
      const ErrorMatrix half = noise_variance(noise, 0.5 * leg.Phi.dt_s).asDiagonal();
      add_shared(0, half);
      carry(leg.Phi, P);
      P.transposeInPlace();
      carry(leg.Phi, P);
      add_shared(0, half);
      P = (0.5 * (P + P.transpose())).eval();  // as for one: update() does not damp the asymmetry
    }
  }

  void step_processes(double dt_s) {
    if constexpr (kFilters > 1) let_biases_decay(dt_s);
    for (MarkovSource<kFilters, kParameters>& source : processes_) step_process(source, dt_s);
  }

  /// What a filter leaves of its bias state.
  double own_decay(int filter, int bias, double dt_s) const {
    const ProcessNoise& own = filters_[static_cast<std::size_t>(filter)];
    return bias_decay(dt_s, bias == kBa ? own.tau_a_s : own.tau_g_s);
  }

  void let_biases_decay(double dt_s) {
    for (int filter = 0; filter < kFilters; ++filter) {
      for (const int bias : {kBa, kBg}) {
        const double own = own_decay(filter, bias, dt_s);
        const int row = filter * kErrorStates + bias;
        P.template middleRows<3>(row) *= own;
        P.template middleCols<3>(row) *= own;
        for (MarkovSource<kFilters, kParameters>& source : processes_) {
          source.S.template middleRows<3>(row) *= own;
        }
      }
    }
  }

  /// g' = phi g + w; a bias state that a filter lets decay by its own phi gains delta g + w on the
  /// filter's idea of it.
  void step_process(MarkovSource<kFilters, kParameters>& source, double dt_s) {
    const double phi = bias_decay(dt_s, source.process.tau_s);
    if (source.enters_at == MarkovSource<kFilters, kParameters>::kFixes) {
      source.S *= phi;
      return;
    }
    const double variance = source.process.sigma * source.process.sigma;
    const Eigen::Matrix3d Q = variance * (1.0 - phi * phi) * Eigen::Matrix3d::Identity();
    const auto at = [&](int filter) { return filter * kErrorStates + source.enters_at; };
    Eigen::Matrix<double, kFilters, 1> delta;
    for (int i = 0; i < kFilters; ++i) {
      delta(i) = phi - own_decay(i, source.enters_at, dt_s);
      P.template middleCols<3>(at(i)) += delta(i) * source.S;
      P.template middleRows<3>(at(i)) += delta(i) * source.S.transpose();
    }
    source.S *= phi;
    for (int i = 0; i < kFilters; ++i) {
      for (int j = 0; j < kFilters; ++j) {
        P.template block<3, 3>(at(i), at(j)) += delta(i) * delta(j) * source.G + Q;
      }
      source.S.template middleRows<3>(at(i)) += delta(i) * phi * source.G + Q;
    }
    source.G = phi * phi * source.G + Q;
  }

  std::array<ProcessNoise, kFilters> filters_;
  std::vector<MarkovSource<kFilters, kParameters>> processes_{};
};

/// Unknown constants of the sensors: the errors are linear in them. One sensitivity serves all.
template <int kFilters, int kParameters = 0>
class ParameterSources {
 public:
  void propagate(const Leg& leg) {
    for_each_filter(S_, [&leg](auto rows, int) { rows = times(leg.Phi, rows) + leg.B; });
  }

  void propagate(const Stretch& stretch) { S_ = times(stretch.Phi, S_) + stretch.B; }

  void update(const RowGain<kFilters, kParameters>& gain) { S_ -= gain.K * measured(gain.h, S_); }

  /// @param second_moment  E[p p^T] of the parameters that belong to the source
  ErrorMoment<kFilters, kParameters> covariance(
      const Eigen::Matrix<double, kSensorParameters, kSensorParameters>& second_moment) const {
    const Sensitivity half = S_.lazyProduct(second_moment);
    return half.lazyProduct(S_.transpose());
  }

  using Sensitivity = Eigen::Matrix<double, kErrorsOf<kFilters, kParameters>, kSensorParameters>;
  const Sensitivity& sensitivity() const { return S_; }
  void set_sensitivity(const Sensitivity& S) { S_ = S; }

 private:
  Sensitivity S_{Sensitivity::Zero()};
};

}  // namespace leeway::sim
