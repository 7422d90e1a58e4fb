/// @file
/// A least-squares fit of the age of measurements, over a grid of ages.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <optional>

namespace leeway {

/// How much older than its stamp a measurement is, s. Negative: younger.
struct Age {
  double value_s{0.0};
  double sigma_s{1.0};        ///< 1 s: as before anything is known
  bool beyond_chance{false};  ///< the value is not zero

  template <class Archive>
  void visit(Archive& archive) {
    archive(value_s, sigma_s, beyond_chance);
  }
};

/// Ages of the grid, s: -1.6, -1.4, .. 1.6. A leap second is within it.
struct AgeGrid {
  static constexpr int kHalf = 8;
  static constexpr std::size_t kCount = 2 * kHalf + 1;
  static constexpr double kStepS = 0.2;
  static constexpr double kLargestS = kHalf * kStepS;

  static constexpr double at(std::size_t k) { return (static_cast<double>(k) - kHalf) * kStepS; }
};

/// Fits the age at which a motion explains measurements best. What it sees of both is what changes
/// within seconds: slow errors, of tilt, biases and the receiver's, drop out. An
/// error of the heading, as the motion has it, is fitted beside it. Near each age of the grid the
/// fit is linear. No heap, no exceptions. Source: docs/theory/monitors/clock_monitor.md.
class LagFit {
 public:
  /// A measurement beside the motion of one age ago.
  struct Pair {
    Eigen::Vector3d measured{Eigen::Vector3d::Zero()};
    Eigen::Vector3d motion{Eigen::Vector3d::Zero()};  ///< the same of the motion
    Eigen::Vector3d slope{Eigen::Vector3d::Zero()};   ///< d(motion)/dt, 1/s

    template <class Archive>
    void visit(Archive& archive) {
      archive(measured, motion, slope);
    }
  };
  using Pairs = std::array<Pair, AgeGrid::kCount>;

  /// @param pairs    of each age of the grid
  /// @param down     unit vector; only what is level counts
  /// @param sigma    claimed, of a component of the measurement
  /// @param t_s      of the measurement; what is not later than the one before is left out
  void add(const Pairs& pairs, const Eigen::Vector3d& down, double sigma, double t_s);

  /// The measurements that come have no connection to those before. The age stays.
  void restart() {
    last_s_.reset();
    settled_s_ = 0.0;
  }

  const Age& age() const { return age_; }

  template <class Archive>
  void visit(Archive& archive) {
    archive(cells_, age_, weight_sum_, settled_s_, last_s_, scale2_);
  }

 private:
  struct Slow {
    Eigen::Vector3d level{Eigen::Vector3d::Zero()};
    Eigen::Vector3d ramp{Eigen::Vector3d::Zero()};

    template <class Archive>
    void visit(Archive& archive) {
      archive(level, ramp);
    }
  };

  /// What is left of a pair without what is slow, level and in sigmas.
  struct Fast {
    Eigen::Vector3d excess;  // of the measurement over the motion
    Eigen::Vector3d slope;
    Eigen::Vector3d turn;  // what a turn of the motion by 1 rad would add
  };
  using Fasts = std::array<Fast, AgeGrid::kCount>;

  /// Weighted sums over fast parts: excess (e), slope (s), turn (t).
  struct Cell {
    Slow excess{};
    Slow slope{};
    Slow motion{};
    double ee{0.0}, es{0.0}, ss{0.0}, et{0.0}, st{0.0}, tt{0.0};

    void add(const Fast& fast, double kept, double weight);

    template <class Archive>
    void visit(Archive& archive) {
      archive(excess, slope, motion, ee, es, ss, et, st, tt);
    }
  };

  /// The squares that are left, as a parabola over the age less that of the cell.
  struct Parabola {
    explicit Parabola(const Cell& cell);
    double left(double change_s) const { return ee + change_s * (2.0 * es + change_s * ss); }
    double change_s() const;  // for which the least is left
    double least() const { return left(change_s()); }

    double ee, es, ss;
  };

  Eigen::Vector3d fast_part(Slow& slow, const Eigen::Vector3d& value, double dt_s) const;
  void sum_up(const Fasts& fasts, double dt_s);
  void fit();

  std::array<Cell, AgeGrid::kCount> cells_{};
  Age age_{};
  double weight_sum_{0.0};
  double settled_s_{0.0};           // since a restart
  std::optional<double> last_s_{};  // time of the measurement before
  double scale2_{1.0};              // of what is left, to what is claimed
};

}  // namespace leeway
