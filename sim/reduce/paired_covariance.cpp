#include "sim/reduce/paired_covariance.hpp"

#include "sim/analysis/truth_model.hpp"

namespace leeway::sim {

PairedCovariance::PairedCovariance(const Scene& scene, const ErrorMatrix& initial_nav,
                                   const std::array<BiasTimes, kFilters>& filters)
    : triads_{&scene.imu.accelerometer, &scene.imu.gyro},
      receiver_(&scene.gnss.errors),
      filters_(filters),
      has_parameters_(TruthModel::needs_parameters(scene.imu)) {
  for (int i = 0; i < kFilters; ++i) {
    for (int j = 0; j < kFilters; ++j) {
      Z_.block<kErrorStates, kErrorStates>(i * kErrorStates, j * kErrorStates) = initial_nav;
    }
  }
  start_triad(*triads_[0], scene.filter.imu.accelerometer.bias, 0);
  start_triad(*triads_[1], scene.filter.imu.gyro.bias, 1);
  Z_.diagonal().segment<3>(kReceiver) = receiver_->correlated_sigma_n_m.cwiseAbs2();
  for (const auto& [source, moment] : TruthModel::parameter_moments(scene.imu)) moment_ += moment;
}

void PairedCovariance::start_triad(const TriadErrorModel& triad, const Eigen::Vector3d& known,
                                   int which) {
  const int turn_on = kTurnOn + 3 * which;
  const int in_run = kInRun + 3 * which;
  const Eigen::Vector3d error = triad.bias - known;
  const double turn_on_m2 = triad.bias_sigma * triad.bias_sigma;
  const double in_run_m2 = triad.in_run.sigma * triad.in_run.sigma;
  const Eigen::Matrix3d I = Eigen::Matrix3d::Identity();
  const auto set = [this](int i, int j, const Eigen::Matrix3d& block) {
    Z_.block<3, 3>(i, j) = block;
    Z_.block<3, 3>(j, i) = block.transpose();
  };
  set(turn_on, turn_on, turn_on_m2 * I + triad.bias * triad.bias.transpose());
  set(in_run, in_run, in_run_m2 * I);
  for (int i = 0; i < kFilters; ++i) {
    const int bias = i * kErrorStates + kBa + 3 * which;
    set(bias, turn_on, turn_on_m2 * I + error * triad.bias.transpose());
    set(bias, in_run, in_run_m2 * I);
    for (int j = 0; j <= i; ++j) {
      set(bias, j * kErrorStates + kBa + 3 * which,
          (turn_on_m2 + in_run_m2) * I + error * error.transpose());
    }
  }
}

void PairedCovariance::propagate(const Leg& leg) {
  // Half of the noise before and half after, as leeway::propagate() does: second order in the step.
  step_biases(0.5 * leg.Phi.dt_s);
  add_white_noise(0.5 * leg.Phi.dt_s);
  transform([&leg](Joint& Z) {
    for (int i = 0; i < kFilters; ++i) {
      const Eigen::Matrix<double, kErrorStates, kAll> rows =
          Z.middleRows<kErrorStates>(i * kErrorStates);
      Z.middleRows<kErrorStates>(i * kErrorStates) = times(leg.Phi, rows);
    }
  });
  add_white_noise(0.5 * leg.Phi.dt_s);
  step_biases(0.5 * leg.Phi.dt_s);
  if (!has_parameters_) return;
  for (ParameterMatrix& S : S_) S = times(leg.Phi, S) + leg.B;
}

/// The true bias is turn-on + in-run; a filter lets its estimate decay by its own idea of it.
void PairedCovariance::step_triad(double dt_s, int which) {
  const GaussMarkov& in_run = triads_[static_cast<std::size_t>(which)]->in_run;
  const double phi = bias_decay(dt_s, in_run.tau_s);
  std::array<double, kFilters> believed{};
  for (std::size_t i = 0; i < kFilters; ++i) {
    believed[i] = bias_decay(dt_s, which == 0 ? filters_[i].tau_a_s : filters_[i].tau_g_s);
  }
  const auto rows = [which](Joint& Z, int first) { return Z.middleRows<3>(first + 3 * which); };
  transform([&](Joint& Z) {
    for (int i = 0; i < kFilters; ++i) {
      const double own = believed[static_cast<std::size_t>(i)];
      rows(Z, i * kErrorStates + kBa) = own * rows(Z, i * kErrorStates + kBa).eval() +
                                        (1.0 - own) * rows(Z, kTurnOn) +
                                        (phi - own) * rows(Z, kInRun);
    }
    rows(Z, kInRun) *= phi;
  });
  const double variance = in_run.sigma * in_run.sigma * (1.0 - phi * phi);
  const std::array<int, 3> driven{kBa + 3 * which, kErrorStates + kBa + 3 * which,
                                  kInRun + 3 * which};
  for (const int i : driven) {
    for (const int j : driven) Z_.block<3, 3>(i, j).diagonal().array() += variance;
  }
}

void PairedCovariance::step_biases(double dt_s) {
  step_triad(dt_s, 0);
  step_triad(dt_s, 1);
  const double phi = bias_decay(dt_s, receiver_->correlation_time_s);
  transform([phi](Joint& Z) { Z.middleRows<3>(kReceiver) *= phi; });
  Z_.diagonal().segment<3>(kReceiver) +=
      (1.0 - phi * phi) * receiver_->correlated_sigma_n_m.cwiseAbs2();
}

void PairedCovariance::add_to_errors(int row, double variance) {
  for (int i = 0; i < kFilters; ++i) {
    for (int j = 0; j < kFilters; ++j) {
      Z_.block<3, 3>(i * kErrorStates + row, j * kErrorStates + row).diagonal().array() += variance;
    }
  }
}

void PairedCovariance::add_white_noise(double dt_s) {
  const auto variance = [dt_s](const TriadErrorModel& triad) {
    return dt_s * triad.noise_density * triad.noise_density;
  };
  add_to_errors(kDv, variance(*triads_[0]));
  add_to_errors(kPsi, variance(*triads_[1]));
}

void PairedCovariance::update(const FixRows& fix, const std::array<FixGain, kFilters>& gains) {
  Eigen::Matrix<double, 6, 1> white_sigma;
  white_sigma << receiver_->position_sigma_n_m, receiver_->velocity_sigma_n_mps;
  white_sigma = white_sigma.cwiseProduct(fix.per_sigma);
  const auto gain = [&gains](int i) -> const FixGain& {
    return gains[static_cast<std::size_t>(i)];
  };
  transform([&](Joint& Z) {
    for (int i = 0; i < kFilters; ++i) {
      auto errors = Z.middleRows<kErrorStates>(i * kErrorStates);
      Eigen::Matrix<double, 6, kAll> innovation = fix.H * errors;
      innovation.topRows<3>() += fix.per_sigma.head<3>().asDiagonal() * Z.middleRows<3>(kReceiver);
      errors -= gain(i) * innovation;
    }
  });
  for (int i = 0; i < kFilters; ++i) {
    for (int j = 0; j < kFilters; ++j) {
      Z_.block<kErrorStates, kErrorStates>(i * kErrorStates, j * kErrorStates) +=
          gain(i) * white_sigma.cwiseAbs2().asDiagonal() * gain(j).transpose();
    }
  }
  if (!has_parameters_) return;
  for (std::size_t i = 0; i < kFilters; ++i) S_[i] -= gains[i] * (fix.H * S_[i]).eval();
}

ErrorMatrix PairedCovariance::of_parameters(int filter, const ParameterMoment& moment) const {
  const ParameterMatrix& S = S_[static_cast<std::size_t>(filter)];
  return S * moment * S.transpose();
}

ErrorMatrix PairedCovariance::of(int filter) const {
  const int at = filter * kErrorStates;
  return Z_.block<kErrorStates, kErrorStates>(at, at) + of_parameters(filter, moment_);
}

ErrorMatrix PairedCovariance::difference() const {
  const auto block = [this](int i, int j) {
    return Z_.block<kErrorStates, kErrorStates>(i * kErrorStates, j * kErrorStates);
  };
  const ParameterMatrix S = S_[1] - S_[0];
  return block(0, 0) - block(0, 1) - block(1, 0) + block(1, 1) + S * moment_ * S.transpose();
}

}  // namespace leeway::sim
