#include "leeway/alternatives/nis_monitor.hpp"

#include "leeway/model/chi_square.hpp"

namespace leeway {

void NisMonitor::note(double nis, int dof) {
  nis_ += nis;
  dof_ += dof;
}

bool NisMonitor::is_high() const {
  return dof_ > 0 && !(nis_ <= chi_square_threshold(kFalseAlarm, dof_));
}

bool NisMonitor::is_low() const {
  return dof_ > 0 && nis_ < chi_square_threshold(1.0 - kFalseAlarm, dof_);
}

}  // namespace leeway
