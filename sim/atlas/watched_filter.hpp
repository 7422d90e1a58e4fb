/// @file
/// Filters of every kind behind one set of calls, with what the library's detectors say of them.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "leeway/ekf/ekf.hpp"
#include "leeway/navigator/navigator.hpp"
#include "leeway/sim/atlas/atlas.hpp"
#include "leeway/sim/compare/variant.hpp"
#include "sim/trials/trial_score.hpp"

namespace leeway::sim {

/// Detectors that spoke, by their names: "gated", "NIS high".
using Reports = std::set<std::string>;

/// As a cell has it: "NIS high; gated".
std::string joined(const Reports& reports);

class WatchedFilter {
 public:
  virtual ~WatchedFilter() = default;

  virtual void predict(const ImuIncrement& inc) = 0;
  /// @pre fix.time is that of the newest increment.
  virtual void update(const GnssFix& fix) = 0;

  /// @pre has_estimate()
  virtual Estimate estimate() const = 0;
  /// False while a Navigator aligns.
  virtual bool has_estimate() const { return true; }
  /// Nothing of a filter that claims nothing. @pre has_estimate()
  virtual std::optional<ErrorMatrix> covariance() const = 0;
  /// As an application is told it: of a Navigator, over all headings that are possible. Likewise.
  virtual std::optional<double> heading_sigma_rad() const;

  /// What the detectors have said since the start.
  virtual Reports reported() const = 0;
};

/// A way of running a filter.
struct AtlasColumn {
  AtlasGroup group{};
  std::string name{};
  std::function<std::unique_ptr<WatchedFilter>(const EkfConfig&, const TrialStart&)> make{};
};

/// Navigator, Ekf and ResetFilter; BasicEkf over every kernel, precision and update form; the
/// invariant EKF over the symmetric kernel in both precisions and over UD. P every 0.1 s.
std::vector<AtlasColumn> atlas_columns();

/// One of each group but kNotOffered, kStrapdown and kInput: for scenes in which the kernel does
/// not matter.
std::vector<AtlasColumn> few_atlas_columns();

/// Those of which the filter claims a covariance: all but ResetFilter.
std::vector<AtlasColumn> claiming(std::vector<AtlasColumn> columns);

AtlasColumn navigator_column(const std::string& name = "Navigator",
                             const TimingConfig& timing = {});
AtlasColumn ekf_column(AtlasGroup group = AtlasGroup::kEkf, const std::string& name = "Ekf",
                       const FixTrust& trust = {});

/// A BasicEkf or a ResetFilter.
AtlasColumn column_of(const Variant& variant);

}  // namespace leeway::sim
