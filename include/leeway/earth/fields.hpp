/// @file
/// The fields of configurations: each struct lists its own once, in visit(), with the numbers that
/// they may hold. Validation, fingerprints and files go by these lists.
///
///     struct Config {
///       double interval_s{0.1};
///       static auto visit(auto& c, const auto& visitor) {
///         return visitor(Field{"interval_s", c.interval_s, between(0.0, 10.0)});
///       }
///     };
#pragma once

#include <limits>
#include <string>

namespace leeway {

/// Which numbers a field may hold, in its unit, which its name ends with.
struct Range {
  double low{std::numeric_limits<double>::lowest()};
  double high{std::numeric_limits<double>::max()};
  bool above_low{false};  ///< low itself is not one of them
  bool or_zero{false};    ///< zero too

  constexpr bool contains(double value) const {
    if (or_zero && value == 0.0) return true;
    return (above_low ? value > low : value >= low) && value <= high;
  }
  std::string text() const;  ///< as in "must be 0 to 10"
};

inline constexpr Range kFinite{};
inline constexpr Range kNotNegative{.low = 0.0};
inline constexpr Range kPositive{.low = 0.0, .above_low = true};
inline constexpr Range kPositiveOrInfinite{
    .low = 0.0, .high = std::numeric_limits<double>::infinity(), .above_low = true};
constexpr Range between(double low, double high) { return {.low = low, .high = high}; }
constexpr Range positive_to(double high) { return {.low = 0.0, .high = high, .above_low = true}; }
constexpr Range zero_or(double low, double high) {
  return {.low = low, .high = high, .or_zero = true};
}

/// A field of a struct. Each element of a vector or matrix is within the range.
template <class T>
struct Field {
  const char* name;
  T& value;
  Range range{};
};
template <class T>
Field(const char*, T&) -> Field<T>;
template <class T>
Field(const char*, T&, Range) -> Field<T>;

/// Stands in a list for a member that is no data, such as a function.
struct NoData {};

}  // namespace leeway
