#include "filters/navigator/heading_spread.hpp"

#include "leeway/covariance/covariance.hpp"
#include "leeway/earth/earth.hpp"

namespace leeway {

HeadingBank bank_around(const EkfConfig& config, const Estimate& estimate, ErrorMatrix P,
                        double sigma_rad, double course_turns_s) {
  const Eigen::Vector3d down_e = down_e_at(estimate.nav.r_e_m);
  transform_block(P, kPsi, Eigen::Matrix3d::Identity() - down_e * down_e.transpose());
  P.diagonal().segment<3>(kPsi).array() += 1e-12;  // rad^2: more than what rounding takes away
  return HeadingBank(config, estimate, P, down_e, sigma_rad, course_turns_s);
}

bool can_start(const Estimate& estimate, const ErrorMatrix& P) {
  constexpr double kLowestM = 6.35e6;       // from the Earth's centre
  constexpr double kLargestPsiRad = 10.0;   // beyond, rounding makes a negative variance of another
  return is_sane(estimate, P) && P.diagonal().minCoeff() > 0.0 &&
         P.diagonal().segment<3>(kPsi).maxCoeff() < kLargestPsiRad * kLargestPsiRad &&
         estimate.nav.r_e_m.norm() > kLowestM;
}

std::optional<HeadingBank> bank_of_headings(const Ekf& filter, double sigma_rad,
                                            double course_turns_s) {
  const ErrorMatrix P = filter.covariance();
  if (!can_start(filter.estimate(), P) || !is_positive_definite(P)) return std::nullopt;
  HeadingBank bank =
      bank_around(filter.inertial().config(), filter.estimate(), P, sigma_rad, course_turns_s);
  std::optional<VehicleState> vehicle = filter.vehicle();
  if (vehicle) vehicle->cross.setZero();
  bank.for_each([&](Ekf& member) {
    member.scale_imu_noise(filter.inertial().noise_scale());
    if (vehicle) edit(member, [&](Belief& belief) { belief.vehicle = vehicle; });
  });
  return bank;
}

bool is_sane(HeadingBank& bank) {
  bool all = true;
  bank.for_each([&](const Ekf& filter) {
    all = all && leeway::is_sane(filter.estimate(), filter.kernel().matrix());
  });
  return all;
}

}  // namespace leeway
