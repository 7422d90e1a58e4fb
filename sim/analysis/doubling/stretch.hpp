/// @file
/// The dynamics and the noise of a scene over stretches of time that are longer than the legs of
/// its track: what lies between two fixes in a few products. Part of covariance_analysis.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <utility>
#include <vector>

#include "leeway/model/process_noise.hpp"
#include "leeway/sim/analysis/error_track.hpp"
#include "leeway/sim/scene/scene.hpp"

namespace leeway::sim {

/// Over a stretch of time: P' = Phi P Phi^T + noise, for what a scene's filter claims and for what
/// is true of white noise.
struct Stretch {
  Transition Phi{};
  ErrorMatrix claimed_noise{ErrorMatrix::Zero()};
  ErrorMatrix true_noise{ErrorMatrix::Zero()};
  Eigen::Matrix<double, kErrorStates, Eigen::Dynamic> B{};  ///< of the parameters; empty without
};

/// The stretches of a scene's track: pairs of legs, pairs of pairs and so on, each made when it is
/// first asked for and then kept. Legs of the same run share theirs. Not for use by several
/// threads.
class Stretches {
 public:
  /// @param track  error_track() of the scene; both must live as long as this
  Stretches(const Scene& scene, const ErrorTrack& track);

  const ErrorTrack& track() const { return track_; }

  /// A walk from one time to the other: f is called with each Stretch or Leg, as few as there are.
  /// Their noise is that of the legs one by one.
  template <class F>
  void follow(double from_s, double to_s, F&& f) {
    if (const Stretch* whole = again(from_s, to_s)) return f(*whole);
    follow_parts(from_s, to_s, f);
  }

  /// The stretch from one time to the other as one.
  Stretch between(double from_s, double to_s);

 private:
  static constexpr double kSlack = 1e-7;  // of a step, as the track's

  /// A stretch within a run, and how often in a row one of this length has been asked for there.
  struct Repeated {
    std::size_t run{};
    double dt_s{0.0};
    int times{0};
    Stretch stretch{};
  };

  template <class F>
  void follow_parts(double from_s, double to_s, F&& f) {
    const double step_s = track_.step_s();
    auto step = static_cast<std::size_t>(std::ceil(from_s / step_s - kSlack));
    const auto last = static_cast<std::size_t>(std::floor(to_s / step_s + kSlack));
    if (step >= last) return track_.follow(from_s, to_s, f);
    const double begin_s = static_cast<double>(step) * step_s;
    if (begin_s - from_s > kSlack * step_s) track_.follow(from_s, begin_s, f);
    while (step < last) {
      if (const Stretch* next = longest(step, last)) {
        f(*next);
      } else {
        const auto t_s = static_cast<double>(step) * step_s;
        f(track_.leg(t_s, t_s + step_s));
        ++step;
      }
    }
    const double end_s = static_cast<double>(last) * step_s;
    if (to_s - end_s > kSlack * step_s) track_.follow(end_s, to_s, f);
  }

  /// Where fixes repeat in steady motion, so does what lies between them.
  /// @returns null where the stretch has not been asked for just before
  const Stretch* again(double from_s, double to_s);

  /// The longest kept stretch that begins with a leg and ends by another; the first is moved on.
  /// @returns null where the leg itself is all there is
  const Stretch* longest(std::size_t& step, std::size_t last);

  /// Of 2^level legs from 2^level * index on.
  const Stretch& node(std::size_t level, std::size_t index);
  Stretch made(std::size_t level, std::size_t index);
  bool is_steady(std::size_t level, std::size_t index) const;
  Stretch of(const Leg& leg) const;

  const Scene& scene_;
  const ErrorTrack& track_;
  ProcessNoise claimed_;
  ProcessNoise true_;
  std::size_t lowest_level_{0};                     // below it only steady stretches are kept
  std::vector<std::vector<std::uint32_t>> kept_{};  // by level and index: place and 1, or 0
  std::map<std::pair<std::size_t, std::size_t>, std::uint32_t> steady_{};  // by run and level
  std::deque<Stretch> nodes_{};
  Repeated repeated_{};
};

/// Of two stretches in a row.
Stretch joined(const Stretch& earlier, const Stretch& later);

}  // namespace leeway::sim
