/// @file
/// A vector as a function of time: three jets.
#pragma once

#include <Eigen/Core>

#include "leeway/sim/motion/jet.hpp"

namespace leeway::sim {

struct JetVector {
  Jet x{};
  Jet y{};
  Jet z{};
};

inline JetVector operator+(const JetVector& a, const JetVector& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}

inline JetVector operator-(const JetVector& a, const Eigen::Vector3d& b) {
  return {a.x - b.x(), a.y - b.y(), a.z - b.z()};
}

inline JetVector operator*(const Jet& scale, const JetVector& a) {
  return {scale * a.x, scale * a.y, scale * a.z};
}

/// By a name: an operator would be one for a plain number too, as Eigen's is.
inline JetVector scaled(const Eigen::Vector3d& a, const Jet& scale) {
  return {scale * a.x(), scale * a.y(), scale * a.z()};
}

inline JetVector operator*(const Eigen::Matrix3d& C, const JetVector& a) {
  const auto row = [&](int i) { return C(i, 0) * a.x + C(i, 1) * a.y + C(i, 2) * a.z; };
  return {row(0), row(1), row(2)};
}

inline Jet dot(const JetVector& a, const JetVector& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

inline JetVector cross(const JetVector& a, const JetVector& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

/// @pre a is not zero.
inline JetVector normalized(const JetVector& a) { return 1.0 / sqrt(dot(a, a)) * a; }

/// The derivative. Its own second derivative is not known and left zero.
inline JetVector derivative(const JetVector& a) {
  return {{a.x.first, a.x.second, 0.0}, {a.y.first, a.y.second, 0.0}, {a.z.first, a.z.second, 0.0}};
}

}  // namespace leeway::sim
