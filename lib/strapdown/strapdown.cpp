#include "leeway/strapdown/strapdown.hpp"

#include <array>
#include <cstddef>
#include <utility>

#include "lib/strapdown/euler_step.hpp"
#include "lib/strapdown/increment_step.hpp"
#include "lib/strapdown/runge_kutta_step.hpp"
#include "lib/strapdown/scheme_terms.hpp"
#include "lib/strapdown/trapezoid_step.hpp"

namespace leeway {
namespace {

/// A scheme: the terms it takes, and its step but for the state's time.
struct SchemeRow {
  Scheme scheme;
  SchemeTerms takes;
  StrapdownFunction step;
};

constexpr SchemeTerms kPair{.turning_force = true, .coning = true, .sculling = true};
constexpr SchemeTerms kPairConing{.turning_force = true, .coning = true};
constexpr SchemeTerms kPairSculling{.turning_force = true, .sculling = true};

/// The table of the schemes, in the order of the enumeration.
template <GravityModel gravity, EarthRotation rotation>
constexpr std::array kSchemes{
    SchemeRow{Scheme::kExplicitEuler, {}, &schemes::euler_step<false, gravity, rotation>},
    SchemeRow{Scheme::kSemiImplicitEuler, {}, &schemes::euler_step<true, gravity, rotation>},
    SchemeRow{Scheme::kTrapezoid, {true}, &schemes::trapezoid_step<gravity, rotation>},
    SchemeRow{Scheme::kOneSample, {true}, &schemes::one_sample_step<gravity, rotation>},
    SchemeRow{Scheme::kTwoSample, kPair, &schemes::two_sample_step<kPair, gravity, rotation>},
    SchemeRow{Scheme::kRungeKutta4, kPair, &schemes::runge_kutta_step<gravity, rotation>},
    SchemeRow{Scheme::kConing, kPairConing,
              &schemes::two_sample_step<kPairConing, gravity, rotation>},
    SchemeRow{Scheme::kSculling, kPairSculling,
              &schemes::two_sample_step<kPairSculling, gravity, rotation>}};

template <GravityModel gravity, EarthRotation rotation>
constexpr const SchemeRow& row(Scheme scheme) {
  return kSchemes<gravity, rotation>.at(static_cast<std::size_t>(scheme));
}

}  // namespace

template <Scheme scheme, GravityModel gravity, EarthRotation rotation>
StrapdownStep strapdown_step(NavState& state, const ImuIncrement& inc, ImuHistory& history) {
  static_assert(row<gravity, rotation>(scheme).scheme == scheme);
  constexpr StrapdownFunction kStep = row<gravity, rotation>(scheme).step;
  if (history.count > 0 && history.recent[0].time != state.time) history = ImuHistory{};
  const StrapdownStep step = kStep(state, inc, history);
  state.time = inc.time;
  return step;
}

namespace {

constexpr std::size_t kGravities = 3;
constexpr std::size_t kRotations = 4;

/// All steps, the rotation running fastest, then the gravity, then the scheme.
template <std::size_t... k>
constexpr std::array<StrapdownFunction, sizeof...(k)> every_step(std::index_sequence<k...>) {
  return {&strapdown_step<static_cast<Scheme>(k / kRotations / kGravities),
                          static_cast<GravityModel>(k / kRotations % kGravities),
                          static_cast<EarthRotation>(k % kRotations)>...};
}

constexpr auto kSteps =
    every_step(std::make_index_sequence<kSchemes<GravityModel{}, EarthRotation{}>.size() *
                                        kGravities * kRotations>{});

}  // namespace

StrapdownFunction strapdown_function(const StrapdownPolicy& policy) {
  const auto scheme = static_cast<std::size_t>(policy.scheme);
  const auto gravity = static_cast<std::size_t>(policy.gravity);
  return kSteps.at((scheme * kGravities + gravity) * kRotations +
                   static_cast<std::size_t>(policy.rotation));
}

SchemeTerms scheme_terms(Scheme scheme) {
  return row<GravityModel{}, EarthRotation{}>(scheme).takes;
}

}  // namespace leeway
