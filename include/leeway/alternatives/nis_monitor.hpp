/// @file
/// Whether a filter's innovations are as large as it claims.
#pragma once

namespace leeway {

/// The sum of all NIS against what chi-square allows it. For filters that judge no fix themselves.
/// NIS of white measurements only: errors that last from fix to fix make the band too narrow.
class NisMonitor {
 public:
  /// Of a right filter, the probability that it is called high, and the same for low.
  static constexpr double kFalseAlarm = 1e-4;

  /// @param dof  components of the fix. A NIS that is not finite counts as high for good.
  void note(double nis, int dof);

  /// Mean of NIS / dof: 1 is consistent; 1 before any.
  double ratio() const { return dof_ > 0 ? nis_ / dof_ : 1.0; }

  /// Innovations are larger than claimed: the filter is too sure, or its model is wrong.
  bool is_high() const;

  /// Innovations are smaller than claimed: the filter makes too little of what it is given.
  bool is_low() const;

 private:
  double nis_{0.0};
  int dof_{0};
};

}  // namespace leeway
