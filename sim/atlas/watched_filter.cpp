#include "sim/atlas/watched_filter.hpp"

#include <algorithm>
#include <cmath>

#include "leeway/ekf/ekf_config.hpp"
#include "leeway/ekf/update_outcome.hpp"
#include "leeway/model/heading.hpp"
#include "sim/atlas/watched_ekf.hpp"
#include "sim/compare/variant_filter.hpp"

namespace leeway::sim {
namespace {

class WatchedResetFilter final : public WatchedFilter {
 public:
  explicit WatchedResetFilter(const ResetFilter& filter) : filter_(filter) {}
  void predict(const ImuIncrement& inc) override { filter_.predict(inc); }
  void update(const GnssFix& fix) override { filter_.update(fix); }
  Estimate estimate() const override { return filter_.estimate(); }
  std::optional<ErrorMatrix> covariance() const override { return std::nullopt; }
  Reports reported() const override { return {"no claim"}; }

 private:
  ResetFilter filter_;
};

class WatchedNavigator final : public WatchedFilter {
 public:
  explicit WatchedNavigator(const Navigator& navigator) : navigator_(navigator) {}

  void predict(const ImuIncrement& inc) override {
    const Verdict verdict = navigator_.push(inc);
    const bool is_integrated = verdict == Verdict::kAccepted || verdict == Verdict::kAligning;
    if (!is_integrated) reports_.insert(std::string(name(verdict)));
  }

  void update(const GnssFix& fix) override {
    note_state();
    const Verdict verdict = navigator_.push(fix);
    if (verdict != Verdict::kFused) reports_.insert(std::string(name(verdict)));
    note_state();
  }

  bool has_estimate() const override { return navigator_.aligned(); }
  Estimate estimate() const override { return navigator_.filter().estimate(); }
  std::optional<ErrorMatrix> covariance() const override {
    return navigator_.filter().covariance();
  }

  std::optional<double> heading_sigma_rad() const override {
    return navigator_.solution().sigma_attitude_rad.z();
  }

  Reports reported() const override {
    Reports all = reports_;
    const Health health = navigator_.health();
    if (health.repairs > 0) all.insert("repaired");
    if (health.resets > 0) all.insert("reset");
    if (health.realignments > 0) all.insert("realigned");
    return all;
  }

 private:
  void note_state() {
    const Health health = navigator_.health();
    if (health.state != Health::State::kAligned) reports_.insert(std::string(name(health.state)));
    if (health.correlated_fixes) reports_.insert("fixes correlated");
  }

  Navigator navigator_;
  Reports reports_{};
};

std::unique_ptr<WatchedFilter> watched(const ResetFilter& filter) {
  return std::make_unique<WatchedResetFilter>(filter);
}

template <class Kernel, class Error>
std::unique_ptr<WatchedFilter> watched(const BasicEkf<Kernel, Error>& filter,
                                       const FixTrust& trust = {}) {
  return std::make_unique<WatchedEkf<Kernel, Error>>(filter, trust);
}

AtlasGroup group_of(const Variant& variant) {
  if (variant.estimator == Estimator::kReset) return AtlasGroup::kReset;
  if (variant.estimator == Estimator::kInvariantEkf) return AtlasGroup::kInvariant;
  return variant.precision == Precision::kFloat ? AtlasGroup::kFloatKernel
                                                : AtlasGroup::kDoubleKernel;
}

std::vector<Variant> kernel_variants() {
  std::vector<Variant> variants;
  for (const Variant& v : covariance_variants()) {
    if (v.covariance_interval_s == Variant{}.covariance_interval_s) variants.push_back(v);
  }
  for (const Precision precision : {Precision::kFloat, Precision::kDouble}) {
    for (const KernelForm kernel : {KernelForm::kSymmetric, KernelForm::kUd}) {
      variants.push_back(
          {.estimator = Estimator::kInvariantEkf, .kernel = kernel, .precision = precision});
    }
  }
  variants.push_back({.estimator = Estimator::kReset});
  return variants;
}

}  // namespace

std::optional<double> WatchedFilter::heading_sigma_rad() const {
  const auto P = covariance();
  if (!P) return std::nullopt;
  return std::sqrt(std::max(0.0, heading_variance_rad2(estimate(), *P)));
}

std::string joined(const Reports& reports) {
  std::string text;
  for (const std::string& report : reports) text += (text.empty() ? "" : "; ") + report;
  return text;
}

AtlasColumn navigator_column(const std::string& name, const TimingConfig& timing) {
  return {AtlasGroup::kNavigator, name, [timing](const EkfConfig& config, const TrialStart& start) {
            Navigator navigator({.filter = config, .timing = timing});
            navigator.start(start.estimate, start.P);
            return std::make_unique<WatchedNavigator>(navigator);
          }};
}

AtlasColumn ekf_column(AtlasGroup group, const std::string& name, const FixTrust& trust) {
  return {group, name, [trust](const EkfConfig& config, const TrialStart& start) {
            return watched(Ekf(config, start.estimate, start.P), trust);
          }};
}

AtlasColumn column_of(const Variant& variant) {
  // Of "strapdown covariance" the second word.
  const std::string both = variant_name(variant, 1.0);
  return {group_of(variant), both.substr(both.find(' ') + 1),
          [variant](const EkfConfig& config, const TrialStart& start) {
            return visit_variant_filter(variant, config, start,
                                        [](const auto& filter) { return watched(filter); });
          }};
}

std::vector<AtlasColumn> atlas_columns() {
  std::vector<AtlasColumn> columns{navigator_column(), ekf_column()};
  for (const Variant& variant : kernel_variants()) columns.push_back(column_of(variant));
  return columns;
}

std::vector<AtlasColumn> claiming(std::vector<AtlasColumn> columns) {
  std::erase_if(columns, [](const AtlasColumn& c) { return c.group == AtlasGroup::kReset; });
  return columns;
}

std::vector<AtlasColumn> few_atlas_columns() {
  return {navigator_column(),
          ekf_column(),
          column_of({}),
          column_of({.precision = Precision::kFloat}),
          column_of({.estimator = Estimator::kInvariantEkf}),
          column_of({.estimator = Estimator::kReset})};
}

}  // namespace leeway::sim
