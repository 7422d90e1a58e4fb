/// @file
/// Vectors, quaternions and matrices of plain numbers, for the inner steps of the strapdown: the
/// compiler keeps them in registers, where Eigen's go through memory.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace leeway {

struct Triple {
  double x{0.0};
  double y{0.0};
  double z{0.0};
};

inline Triple triple(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }
inline Eigen::Vector3d vector(const Triple& v) { return {v.x, v.y, v.z}; }

inline void assign(Eigen::Vector3d& to, const Triple& v) {
  to.x() = v.x;
  to.y() = v.y;
  to.z() = v.z;
}

/// By columns, two numbers at a time as they will be read: a load of two that were stored one by
/// one waits for both.
[[gnu::always_inline]] inline void assign(Eigen::Matrix3d& to, const Triple& x, const Triple& y,
                                          const Triple& z) {
  using Pair = Eigen::Array2d;
  Eigen::Map<Pair>(to.data()) = Pair(x.x, x.y);
  Eigen::Map<Pair>(to.data() + 2) = Pair(x.z, y.x);
  Eigen::Map<Pair>(to.data() + 4) = Pair(y.y, y.z);
  Eigen::Map<Pair>(to.data() + 6) = Pair(z.x, z.y);
  to(2, 2) = z.z;
}

inline Triple operator+(const Triple& a, const Triple& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}

inline Triple operator-(const Triple& a, const Triple& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}

inline Triple operator*(double factor, const Triple& v) {
  return {factor * v.x, factor * v.y, factor * v.z};
}

inline Triple cross(const Triple& a, const Triple& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

inline double squared_norm(const Triple& v) { return v.x * v.x + v.y * v.y + v.z * v.z; }

struct Quadruple {
  double w;
  double x;
  double y;
  double z;
};

inline Quadruple quadruple(const Eigen::Quaterniond& q) { return {q.w(), q.x(), q.y(), q.z()}; }

inline void assign(Eigen::Quaterniond& to, const Quadruple& q) {
  to.w() = q.w;
  to.x() = q.x;
  to.y() = q.y;
  to.z() = q.z;
}

inline Quadruple operator+(const Quadruple& a, const Quadruple& b) {
  return {a.w + b.w, a.x + b.x, a.y + b.y, a.z + b.z};
}

inline double squared_norm(const Quadruple& q) {
  return (q.w * q.w + q.x * q.x) + (q.y * q.y + q.z * q.z);
}

/// A matrix by its columns.
struct Columns {
  Triple x;
  Triple y;
  Triple z;
};

inline Triple operator*(const Columns& m, const Triple& v) {
  return v.x * m.x + v.y * m.y + v.z * m.z;
}

/// Of the rotation by a unit quaternion.
inline Columns rotation_matrix(const Quadruple& q) {
  const double x2 = 2.0 * q.x;
  const double y2 = 2.0 * q.y;
  const double z2 = 2.0 * q.z;
  return {{1.0 - (y2 * q.y + z2 * q.z), y2 * q.x + z2 * q.w, z2 * q.x - y2 * q.w},
          {y2 * q.x - z2 * q.w, 1.0 - (x2 * q.x + z2 * q.z), z2 * q.y + x2 * q.w},
          {z2 * q.x + y2 * q.w, z2 * q.y - x2 * q.w, 1.0 - (x2 * q.x + y2 * q.y)}};
}

}  // namespace leeway
