/// @file
/// Solutions as text. Another format is a file in this folder and a row of kSolutionFormats.
/// Private to the solution writer.
#pragma once

#include <array>

#include "leeway/strapdown/solution.hpp"
#include "lib/logs/text_file.hpp"

namespace leeway {

/// A place with the axes east, north, up that positions are written about.
struct LocalFrame {
  explicit LocalFrame(const Geodetic& origin)
      : r_e_m(ecef_from_geodetic(origin)), C_ue(east_north_up(origin)) {}

  static Eigen::Matrix3d east_north_up(const Geodetic& origin) {
    const Eigen::Matrix3d C_en = ned_to_ecef(origin);
    Eigen::Matrix3d C_eu;
    C_eu << C_en.col(1), C_en.col(0), -C_en.col(2);
    return C_eu.transpose();
  }
  Eigen::Vector3d position_m(const NavState& nav) const { return C_ue * (nav.r_e_m - r_e_m); }

  Eigen::Vector3d r_e_m;
  Eigen::Matrix3d C_ue;  ///< ECEF to east, north, up
};

/// A solution to be written, in the forms that formats need.
struct SolutionRow {
  const Solution& solution;
  const NavStateNed& nav;
  const LocalFrame& local;  ///< about the origin given, or the first position
  bool is_first;

  double lat_deg() const { return nav.position.lat_rad / kRadPerDeg; }
  double lon_deg() const { return nav.position.lon_rad / kRadPerDeg; }
};

/// Text of a row as it grows. @pre it stays within 1 KiB
class RowText {
 public:
  explicit RowText(TextFile& file) : file_(file), out_(file.begin(1024)) {}
  ~RowText() { file_.end(out_); }
  RowText(const RowText&) = delete;
  RowText& operator=(const RowText&) = delete;

  RowText& add(std::string_view text) {
    out_ = std::copy(text.begin(), text.end(), out_);
    return *this;
  }
  RowText& add(double value, int decimals) {
    out_ = put_number(out_, value, decimals);
    return *this;
  }
  RowText& add(Time time) {
    out_ = put_time(out_, time);
    return *this;
  }
  /// Three numbers, each after the text.
  RowText& add(std::string_view before, const Eigen::Vector3d& values, int decimals) {
    for (const double value : values) add(before).add(value, decimals);
    return *this;
  }

 private:
  TextFile& file_;
  char* out_;
};

/// A format: what stands before the rows, a row, and what stands after them.
struct SolutionFormat {
  std::string_view name;  ///< and the file's ending
  std::string_view before;
  void (*row)(RowText&, const SolutionRow&);
  std::string_view after;
};

extern const SolutionFormat kPosFormat;
extern const SolutionFormat kTumFormat;
extern const SolutionFormat kKmlFormat;
extern const SolutionFormat kGpxFormat;
extern const SolutionFormat kGeojsonFormat;

inline constexpr std::array kSolutionFormats{&kPosFormat, &kTumFormat, &kKmlFormat, &kGpxFormat,
                                             &kGeojsonFormat};

}  // namespace leeway
