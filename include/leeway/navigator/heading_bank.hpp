/// @file
/// A Gaussian sum filter over heading: a few EKFs that differ in heading, weighted by how well each
/// foretells the fixes, until one is left.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <optional>

#include "leeway/earth/rotation.hpp"
#include "leeway/earth/time.hpp"
#include "leeway/ekf/ekf.hpp"
#include "leeway/model/error_state.hpp"

namespace leeway {

/// After construction nothing here allocates, throws, logs or locks; same inputs give the same
/// bits. A copy of a collapsed bank copies one filter. The object takes 50 kB.
/// Source: Alspach and Sorenson (1972); docs/theory/navigator/heading_bank.md.
class HeadingBank {
 public:
  static constexpr std::size_t kMaxHeadings = 12;
  static constexpr std::size_t kMaxFilters = kMaxHeadings + 2;
  static constexpr std::size_t kMaxRivals = 3;  ///< more at a time cost more than they tell
  /// Up to this spread one filter is enough.
  static constexpr double kOneFilterRad = 15.0 * kRadPerDeg;
  /// From this spread on the heading is anywhere on the circle.
  static constexpr double kWholeCircleRad = 1.5;

  /// A known heading: one filter, no spread.
  explicit HeadingBank(const Ekf& filter);

  /// An attitude that is uncertain by a turn about an axis.
  /// @param estimate   the middle of the spread
  /// @param P          covariance around every member, without the variance of that turn. Its
  ///                   attitude errors are those of the body axes (levelling): they turn along
  /// @param axis_e     unit vector, ECEF: the local vertical, or the specific force that levelled
  /// @param sigma_rad  of the turn, >= 0; kWholeCircleRad and more: nothing is known of it
  /// @param course_turns_s  time ahead over which the velocity turns as far as the heading, evenly;
  ///                        0: it is known
  /// The members turn about the antenna, which is where the fixes saw it.
  /// @throws Error as Ekf does, and unless axis_e is of unit length and sigma_rad >= 0.
  HeadingBank(const EkfConfig& config, const Estimate& estimate, const ErrorMatrix& P,
              const Eigen::Vector3d& axis_e, double sigma_rad, double course_turns_s = 0.0);

  /// Runs f on every member: predict, bridge. f: void(Ekf&), the same for all.
  template <class F>
  void for_each(F&& f) {
    for (std::optional<Ekf>& member : members_) {
      if (member) f(*member);
    }
  }

  /// Runs f on every member, weights the members by the likelihood of the outcomes, drops those
  /// that it refutes and those that agree with a heavier one.
  /// @param f  UpdateOutcome(Ekf&): a fix, or a pseudo measurement. It fills nis, gate and
  /// log_det_S.
  /// @param of_heading  whether f is a measurement of the heading: those count for themselves
  /// @returns the outcome of best().
  template <class F>
  UpdateOutcome update(F&& f, bool of_heading = false) {
    Outcomes outcomes{};
    for (std::size_t k = 0; k < kMaxFilters; ++k) {
      if (members_[k]) outcomes[k] = f(*members_[k]);
    }
    weigh(outcomes, of_heading);
    return outcomes[best_];
  }

  /// Sets another filter beside the others, of which the lightest goes when there are too many:
  /// later measurements tell which is right, and until then covariance() spans them.
  /// @param odds  of it to best(), > 0
  void add(const Ekf& filter, double odds, std::size_t max_count = kMaxFilters);

  /// The same, where best() refuses a fix. Errors of a receiver last: that the incumbent goes on to
  /// refuse says little more, as long as it did so at once.
  void challenge(const Ekf& rival, double odds);

  bool collapsed() const { return count_ == 1; }
  std::size_t count() const { return count_; }

  /// Which of the members best() is.
  std::size_t best_index() const { return best_; }

  /// The heaviest member.
  const Ekf& best() const { return *members_[best_]; }
  Ekf& best() { return *members_[best_]; }

  /// The one that takes its IMU for the noisiest.
  const Ekf& most_doubting() const;

  /// Probability of best(), 0 to 1.
  double best_weight() const;

  /// Second moment of the error of best().estimate() by the whole mixture: every member's
  /// covariance and the square of its distance. Its attitude errors may reach pi.
  ErrorMatrix covariance() const;

  /// Names every member that changes, for a snapshot.
  template <class Archive>
  void visit(Archive& archive) {
    const Ekf any = best();
    for (std::optional<Ekf>& member : members_) archive.optional(member, any);
    archive(log_weight_, refused_, count_, best_, incumbent_, last_evidence_);
  }

 private:
  using Outcomes = std::array<UpdateOutcome, kMaxFilters>;

  void weigh(const Outcomes& outcomes, bool of_heading);
  std::size_t lightest_but_best() const;
  void normalize();
  void merge();
  void join();
  void drop(std::size_t k);

  std::array<std::optional<Ekf>, kMaxFilters> members_{};
  std::array<double, kMaxFilters> log_weight_{};  // of the members that are left
  std::array<bool, kMaxFilters> refused_{};       // the newest fix
  std::size_t count_{0};
  std::size_t best_{0};
  std::optional<std::size_t> incumbent_{};  // which was the best before it was challenged
  // By the components of the measurement; at 0 that of the heading.
  std::array<std::optional<Time>, 7> last_evidence_{};
};

}  // namespace leeway
