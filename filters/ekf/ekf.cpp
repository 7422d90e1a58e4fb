#include "leeway/ekf/ekf.hpp"

#include "filters/ekf/basic_ekf.hpp"
#include "leeway/covariance/covariance.hpp"
#include "leeway/earth/earth.hpp"
#include "leeway/model/heading.hpp"

namespace leeway {

template class BasicEkf<SymmetricKernel<double>>;

void bridge(Ekf& filter, Time to, double before_s) {
  edit(filter, [&](Belief& belief) {
    bridge(belief, to, filter.inertial().noise(), before_s);
  });
}

double heading_sigma_rad(const Ekf& filter) {
  return heading_sigma_rad(filter.estimate(), filter.kernel().matrix());
}

bool rest_hides_heading(const Ekf& filter) {
  return rest_hides_heading(filter.inertial().config().imu, filter.estimate(), filter.covariance());
}

bool repair_covariance(Ekf& filter) {
  if (is_positive_definite(filter.covariance())) return true;
  edit(filter, [](Belief& belief) { make_positive_definite(belief.P); });
  return false;
}

Ekf filter_anywhere(const EkfConfig& config) {
  Estimate somewhere;
  somewhere.nav.r_e_m.x() = wgs84::kSemiMajorAxisM;
  return Ekf(config, somewhere, ErrorMatrix(ErrorMatrix::Identity()));
}

}  // namespace leeway
