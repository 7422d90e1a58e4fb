/// @file
/// Filters of every kind behind one set of calls, with what the library's detectors say of them.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "leeway/filters/ekf.hpp"
#include "leeway/filters/navigator.hpp"
#include "leeway/sim/atlas.hpp"
#include "leeway/sim/variant.hpp"
#include "sim/trial_parts.hpp"

namespace leeway::sim {

class WatchedFilter {
 public:
  virtual ~WatchedFilter() = default;

  virtual void predict(const ImuIncrement& inc) = 0;
  /// @pre fix.time is that of the newest increment.
  virtual void update(const GnssFix& fix) = 0;

  /// @pre of a Navigator: it is aligned.
  virtual Estimate estimate() const = 0;
  /// Nothing of a filter that claims nothing.
  virtual std::optional<ErrorMatrix> covariance() const = 0;

  /// What the detectors have said since the start, in an order of their own: "gated; NIS high".
  virtual std::string reported() const = 0;
};

/// A way of running a filter: a column of a scene.
struct AtlasColumn {
  AtlasGroup group{};
  std::string name{};
  std::function<std::unique_ptr<WatchedFilter>(const EkfConfig&, const TrialStart&)> make{};
};

/// Navigator, Ekf and ResetFilter as they are configured; KernelEkf over every kernel, precision
/// and update form; the invariant EKF over the symmetric kernel in both precisions and over UD.
std::vector<AtlasColumn> atlas_columns();

/// Those of some groups.
std::vector<AtlasColumn> atlas_columns(const std::vector<AtlasGroup>& groups);

/// A KernelEkf or ResetFilter of this variant, without its strapdown's IMU rate.
AtlasColumn column_of(const Variant& variant);

std::unique_ptr<WatchedFilter> watched(const Ekf& filter);
std::unique_ptr<WatchedFilter> watched(const Navigator& navigator);

}  // namespace leeway::sim
