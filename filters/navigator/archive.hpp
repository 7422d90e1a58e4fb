/// @file
/// Fixed-size bytes of a state: classes name their members in visit(), these write and read them.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cstddef>
#include <cstring>
#include <optional>
#include <span>
#include <type_traits>
#include <variant>

#include "leeway/navigator/timeline.hpp"

namespace leeway {

/// The structure that writing, reading and measuring share. Derived has bytes(void*, std::size_t)
/// and says whether it reads. What is absent takes the room of what could be there.
template <class Derived>
class Archive {
 public:
  template <class... T>
  void operator()(T&... values) {
    (visit(values), ...);
  }

  /// @param filler  takes the room of a value that is absent
  template <class T>
  void optional(std::optional<T>& value, const T& filler) {
    bool there = value.has_value();
    visit(there);
    T content = value.value_or(filler);
    visit(content);
    if (there) value = content;
    if (!there) value.reset();
  }

 private:
  template <class T>
  static constexpr bool kIsPlain = std::is_arithmetic_v<T> || std::is_enum_v<T>;

  /// Eigen leaves a matrix unset that T{} would zero.
  template <class T>
  static T blank() {
    if constexpr (requires { T::Zero(); }) {
      return T::Zero();
    } else {
      return T{};
    }
  }

  Derived& self() { return static_cast<Derived&>(*this); }

  template <class T>
  void visit(T& value) {
    if constexpr (kIsPlain<T>) {
      self().bytes(&value, sizeof(T));
    } else if constexpr (AidingReading<T>) {
      auto& [time, number, sigma] = value;
      (*this)(time, number, sigma);
    } else {
      value.visit(self());
    }
  }

  template <int R, int C, int Options>
  void visit(Eigen::Matrix<double, R, C, Options>& m) {
    static_assert(R > 0 && C > 0);
    self().bytes(m.data(), sizeof(double) * R * C);
  }

  void visit(Eigen::Quaterniond& q) { visit(q.coeffs()); }

  void visit(Duration& duration) {
    auto count = duration.count();
    visit(count);
    duration = Duration{count};
  }

  void visit(Time& t) {
    Duration since = t.time_since_epoch();
    visit(since);
    t = Time{since};
  }

  template <class T>
  void visit(std::optional<T>& value) {
    optional(value, blank<T>());
  }

  template <class T, std::size_t N>
  void visit(std::array<T, N>& values) {
    for (T& value : values) visit(value);
  }

  template <class T, std::size_t N>
  void visit(T (&values)[N]) {
    for (T& value : values) visit(value);
  }

  template <class... T>
  void visit(std::variant<T...>& value) {
    std::size_t index = value.index();
    visit(index);
    (visit_alternative<T>(value, index), ...);
  }

  template <class T, class Variant>
  void visit_alternative(Variant& value, std::size_t index) {
    const T* held = std::get_if<T>(&value);
    T content = held != nullptr ? *held : T{};
    visit(content);
    if (index == Variant(T{}).index()) value = content;
  }

  void visit(NavState& s) { (*this)(s.time, s.q_eb, s.v_e_mps, s.r_e_m); }
  void visit(Estimate& s) { (*this)(s.nav, s.bias.b_a_mps2, s.bias.b_g_radps); }
  void visit(ImuIncrement& s) { (*this)(s.time, s.dt_s, s.dtheta_b_rad, s.dv_b_mps); }
  void visit(ImuSample& s) { (*this)(s.time, s.omega_ib_b_radps, s.f_ib_b_mps2); }
  void visit(GnssPosition& s) { (*this)(s.r_e_m, s.R_e_m2); }
  void visit(GnssVelocity& s) { (*this)(s.v_e_mps, s.R_e_m2ps2); }
  void visit(GnssFix& s) { (*this)(s.time, s.position, s.velocity); }
  void visit(Event& s) { (*this)(s.time, s.reading, s.counts, s.done, s.verdict); }
  void visit(Step& s) { (*this)(s.inc, s.is_gap); }
  void visit(VehicleState& s) { (*this)(s.value, s.P, s.cross, s.random_walk_per_s); }
  void visit(Transition& s) { (*this)(s.dt_s, s.psi, s.v, s.r, s.a_a, s.g_g); }
  void visit(ImuHistory& s) {
    (*this)(s.recent, s.count, s.pair_open, s.coning_b_rad, s.sculling_b_mps, s.dv_e_mps, s.first,
            s.last);
  }
  void visit(UpdateOutcome& s) {
    (*this)(s.outcome, s.time, s.dof, s.nis, s.gate, s.position_nis, s.velocity_nis,
            s.position_innovation_e_m, s.velocity_innovation_e_mps, s.log_det_S,
            s.covariance_positive);
  }
};

/// Appends to a span. @pre the span has the room.
class Writer : public Archive<Writer> {
 public:
  static constexpr bool kReads = false;
  explicit Writer(std::span<std::byte> out) : out_(out) {}
  void bytes(const void* data, std::size_t size) {
    std::memcpy(out_.data(), data, size);
    out_ = out_.subspan(size);
  }

 private:
  std::span<std::byte> out_;
};

/// Takes from a span. @pre the span was written by a Writer.
class Reader : public Archive<Reader> {
 public:
  static constexpr bool kReads = true;
  explicit Reader(std::span<const std::byte> in) : in_(in) {}
  void bytes(void* data, std::size_t size) {
    std::memcpy(data, in_.data(), size);
    in_ = in_.subspan(size);
  }

 private:
  std::span<const std::byte> in_;
};

/// Counts the bytes that a Writer would need.
class Measure : public Archive<Measure> {
 public:
  static constexpr bool kReads = false;
  void bytes(const void*, std::size_t size) { size_ += size; }
  std::size_t size() const { return size_; }

 private:
  std::size_t size_{0};
};

}  // namespace leeway
