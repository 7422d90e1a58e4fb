/// @file
/// Whether innovations are larger than a filter claims, told as soon as chance allows.
#pragma once

namespace leeway {

/// Page's cumulative sum test of the claimed innovation covariance against four times as much.
/// Where the claim holds it errs once in 22,000 measurements or less often: Lorden's bound, e^10.
/// Source: Page (1954), Biometrika 41; Basseville and Nikiforov (1993), section 2.2.
class NisCusum {
 public:
  /// @param nis  normalized innovation squared; however large, one alone is no alarm
  /// @param dof  components of the measurement
  /// @returns whether the measurements so far are beyond chance; the test then begins anew
  bool push(double nis, int dof);

  /// Names every member that changes, for a snapshot.
  template <class Archive>
  void visit(Archive& archive) {
    archive(sum_);
  }

 private:
  double sum_{0.0};  // log likelihood ratio, since it was last in favour of the claim
};

}  // namespace leeway
