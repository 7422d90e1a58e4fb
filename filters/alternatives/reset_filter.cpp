#include "leeway/alternatives/reset_filter.hpp"

namespace leeway {

void ResetFilter::update(const GnssFix& fix) {
  if (!is_usable(fix)) return;
  const Measurement m = inertial_.measurement(fix);
  ErrorVector x = ErrorVector::Zero();
  if (fix.position) x.segment<3>(kDr) = m.innovation.head<3>();
  if (fix.velocity) x.segment<3>(kDv) = m.innovation.tail<3>();
  inertial_.inject(x);
}

}  // namespace leeway
