#include "leeway/navigator/measured_heading.hpp"

#include <algorithm>
#include <cmath>

#include "filters/navigator/heading_spread.hpp"
#include "leeway/navigator/navigator_state.hpp"

namespace leeway {
namespace {

Measurement measurement_of(const MeasuredHeading& heading, const Ekf& filter) {
  const VehicleVector vehicle =
      filter.vehicle() ? filter.vehicle()->value : VehicleVector(VehicleVector::Zero());
  return measurement(heading, filter.estimate(), vehicle, filter.inertial().omega_ib_b_radps());
}

}  // namespace

void RefusedHeadings::fused(Time t) {
  good_since_ = good_since_.value_or(t);
  good_until_ = t;
  refused_since_.reset();
}

bool RefusedHeadings::refused(Time t, double innovation_rad, double sigma_rad) {
  constexpr double kAgreeSigmas = 5.0;
  constexpr double kLeastS = 5.0;            // an outlier or two are none
  constexpr double kLongestGoodS = 300.0;  // having been right for longer proves no more
  const bool agrees =
      refused_since_ &&
      std::abs(wrap_pi(innovation_rad - innovation_rad_)) < kAgreeSigmas * sigma_rad;
  if (!agrees) {
    refused_since_ = t;
    innovation_rad_ = innovation_rad;
    return false;
  }
  const double good_s = good_since_ ? to_seconds(*good_until_ - *good_since_) : 0.0;
  if (to_seconds(t - *refused_since_) < std::clamp(good_s, kLeastS, kLongestGoodS)) return false;
  *this = RefusedHeadings{};
  return true;
}

// Unlike the vehicle's own sensors it tells what alignment lacks, and needs no parameters.
Verdict NavigatorState::take(const MeasuredHeading& heading) {
  if (!config_.vehicle.heading) return Verdict::kUnused;
  if (!C_bs_) return Verdict::kAligning;  // where the body's x axis is, is not known yet
  if (!bank_) {
    MeasuredHeading of_body = heading;
    const bool mount_errs = config_.vehicle.uses_parameters();
    if (mount_errs)
      of_body.sigma_rad = std::hypot(heading.sigma_rad, config_.vehicle.mount_sigma_rad);
    aligner_.push(of_body);
    return Verdict::kAligning;
  }
  const NavState& nav = bank_->best().estimate().nav;
  if (!Azimuth(nav.q_eb * Eigen::Vector3d::UnitX(), nav.r_e_m).is_defined())
    return Verdict::kUnused;
  const Time now = nav.time;
  const double weight = heading_weight_.of(now);
  const UpdateOutcome update = bank_->update(
      [&](Ekf& filter) {
        return filter.update(measurement_of(heading, filter), Held::kNothing, weight);
      },
      true);
  if (update.outcome != UpdateOutcome::Outcome::kFused) {
    doubt_heading_by(heading);
    return Verdict::kGated;
  }
  heading_weight_.fused(now);
  refused_headings_.fused(now);
  return Verdict::kFused;
}

void NavigatorState::doubt_heading_by(const MeasuredHeading& heading) {
  const Ekf doubted = bank_->best();
  const double innovation_rad = measurement_of(heading, doubted).innovation(0);
  const Time now = doubted.estimate().nav.time;
  if (!refused_headings_.refused(now, innovation_rad, heading.sigma_rad)) return;
  auto headings = bank_of_headings(doubted, HeadingBank::kWholeCircleRad);
  if (!headings) return;
  headings->add(doubted, 1.0);
  bank_ = *headings;
  heading_weight_ = PositionWeight(kHeadingCorrelationS);  // the next one counts in full
}

}  // namespace leeway
