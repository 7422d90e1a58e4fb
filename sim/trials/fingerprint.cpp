#include "sim/trials/fingerprint.hpp"

#include <cstddef>
#include <string>
#include <type_traits>

#include "leeway/ekf/ekf_config.hpp"
#include "leeway/model/initial_covariance.hpp"

namespace leeway::sim {
namespace {

/// The bytes of what is added, in order.
class Bytes {
 public:
  template <class T>
  requires(std::is_arithmetic_v<T> || std::is_enum_v<T>) void add(const T& value) {
    const char* first = reinterpret_cast<const char*>(&value);
    bytes_.append(first, sizeof value);
  }
  template <class Derived>
  void add(const Eigen::MatrixBase<Derived>& m) {
    for (Eigen::Index j = 0; j < m.cols(); ++j) {
      for (Eigen::Index i = 0; i < m.rows(); ++i) add(m(i, j));
    }
  }
  void add(const TriadErrorModel& triad);
  void add(const ImuErrorModel& model);
  void add(const GnssScenario& gnss);
  void add(const EkfConfig& filter);
  void add(const NavState& nav);
  void add(std::string_view text) { bytes_ += text; }

  const std::string& all() const { return bytes_; }

 private:
  std::string bytes_;
};

void Bytes::add(const TriadErrorModel& triad) {
  add(triad.bias);
  add(triad.bias_sigma);
  add(triad.M);
  add(triad.scale_sigma);
  add(triad.misalignment_sigma_rad);
  add(triad.noise_density);
  add(triad.in_run.sigma);
  add(triad.in_run.tau_s);
  add(triad.quantum);
  add(triad.range);
}

void Bytes::add(const ImuErrorModel& model) {
  add(model.accelerometer);
  add(model.gyro);
  add(model.G_g_radps_per_mps2);
  add(model.G_g_sigma_radps_per_mps2);
}

void Bytes::add(const GnssScenario& gnss) {
  add(gnss.errors.position_sigma_n_m);
  add(gnss.errors.velocity_sigma_n_mps);
  add(gnss.errors.correlated_sigma_n_m);
  add(gnss.errors.correlation_time_s);
  add(gnss.errors.lever_arm_b_m);
  add(gnss.outlier_probability);
  add(gnss.outlier_sigma_m);
}

void Bytes::add(const EkfConfig& filter) {
  add(filter.imu);
  add(filter.strapdown.scheme);
  add(filter.strapdown.gravity);
  add(filter.strapdown.rotation);
  add(filter.lever_arm_b_m);
  add(filter.gnss_correlation_s);
  add(filter.gate_probability);
  add(filter.covariance_interval_s);
  add(filter.gravity_gradient);
  add(filter.biases.accelerometer);
  add(filter.biases.gyro);
}

void Bytes::add(const NavState& nav) {
  add(nav.q_eb.coeffs());
  add(nav.v_e_mps);
  add(nav.r_e_m);
}

}  // namespace

std::uint64_t hash_of(std::string_view bytes) {
  std::uint64_t hash = 0xcbf29ce484222325;
  for (const char c : bytes) {
    hash ^= static_cast<unsigned char>(c);
    hash *= 0x100000001b3;
  }
  return hash;
}

std::uint64_t fingerprint(const TrialPlan& plan) {
  const Scene& scene = plan.scene();
  Bytes bytes;
  bytes.add(std::string_view(LEEWAY_VERSION));
  bytes.add(scene.imu);
  bytes.add(scene.gnss);
  bytes.add(scene.filter);
  bytes.add(scene.imu_divider);
  const InitialSigma& initial = plan.initial();
  for (const double sigma :
       {initial.tilt_rad, initial.heading_rad, initial.velocity_mps, initial.position_m}) {
    bytes.add(sigma);
  }
  for (const TrialPlan::Fix& fix : plan.fixes()) {
    bytes.add(fix.at);
    bytes.add(fix.arrives);
    bytes.add(fix.scored);
  }
  bytes.add(truth_at(scene.trajectory, 0.0).nav);
  bytes.add(plan.increments().size());
  // A thousand of them tell two motions apart.
  const std::size_t stride = 1 + plan.increments().stored() / 1000;
  for (std::size_t k = 0; k < plan.increments().stored(); k += stride) {
    const ImuIncrement inc = plan.increments()[k];
    bytes.add(inc.dt_s);
    bytes.add(inc.dtheta_b_rad);
    bytes.add(inc.dv_b_mps);
  }
  return hash_of(bytes.all());
}

}  // namespace leeway::sim
