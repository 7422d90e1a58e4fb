#include "leeway/model/chi_square.hpp"

#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <limits>
#include <string>

#include "leeway/earth/error.hpp"
#include "tests/support/near.hpp"
#include "tests/support/temp_dir.hpp"

namespace leeway {
namespace {

using test::near;

/// Abramowitz and Stegun, table 26.8: chi-square by probability of being exceeded, as printed.
constexpr std::array kProbabilities{0.995, 0.99, 0.975, 0.95,  0.9,  0.75,  0.5,
                                    0.25,  0.1,  0.05,  0.025, 0.01, 0.005, 0.001};
struct TableRow {
  int dof;
  std::array<double, kProbabilities.size()> chi_square;
};
constexpr std::array kTable{
    TableRow{1,
             {0.0000392704, 0.000157088, 0.000982069, 0.00393214, 0.0157908, 0.101531, 0.454937,
              1.32330, 2.70554, 3.84146, 5.02389, 6.63490, 7.87944, 10.828}},
    TableRow{2,
             {0.0100251, 0.0201007, 0.0506356, 0.102587, 0.210720, 0.575364, 1.38629, 2.77259,
              4.60517, 5.99147, 7.37776, 9.21034, 10.5966, 13.816}},
    TableRow{3,
             {0.0717212, 0.114832, 0.215795, 0.351846, 0.584375, 1.212534, 2.36597, 4.10835,
              6.25139, 7.81473, 9.34840, 11.3449, 12.8381, 16.266}},
    TableRow{6,
             {0.675727, 0.872085, 1.237347, 1.63539, 2.20413, 3.45460, 5.34812, 7.84080, 10.6446,
              12.5916, 14.4494, 16.8119, 18.5476, 22.458}},
    TableRow{15,
             {4.60094, 5.22935, 6.26214, 7.26094, 8.54675, 11.0365, 14.3389, 18.2451, 22.3072,
              24.9958, 27.4884, 30.5779, 32.8013, 37.697}},
    TableRow{20,
             {7.43386, 8.26040, 9.59083, 10.8508, 12.4426, 15.4518, 19.3374, 23.8277, 28.4120,
              31.4104, 34.1696, 37.5662, 39.9968, 45.315}},
};

}  // namespace

TEST_CASE("thresholds are those of the printed table") {
  for (const TableRow& row : kTable) {
    for (std::size_t i = 0; i < kProbabilities.size(); ++i) {
      CAPTURE(row.dof);
      CAPTURE(kProbabilities[i]);
      // Printed to five digits or six, of which the sixth is not reliable in the lower tail.
      const double ratio = chi_square_threshold(kProbabilities[i], row.dof) / row.chi_square[i];
      CHECK(near(ratio, 1.0, 5e-5));
    }
  }
}

TEST_CASE("survival in closed form") {
  for (const double x : {0.0, 1e-9, 0.1, 1.0, 7.0, 50.0, 400.0}) {
    CAPTURE(x);
    const double half = 0.5 * x;
    const double e = std::exp(-half);
    // The logarithm of the largest term, up to 200, carries that many roundings.
    CHECK(near(chi_square_survival(x, 1) / std::erfc(std::sqrt(half)), 1.0, 1e-13));
    CHECK(near(chi_square_survival(x, 2) / e, 1.0, 1e-13));
    CHECK(near(chi_square_survival(x, 4) / (e * (1.0 + half)), 1.0, 1e-13));
    CHECK(near(chi_square_survival(x, 6) / (e * (1.0 + half + half * half / 2.0)), 1.0, 1e-13));
  }
}

TEST_CASE("two degrees more add (x/2)^(n/2) exp(-x/2) / Gamma(n/2 + 1)") {
  // A&S (26.4.8). Both sides go through logarithms of up to 3000, which carry as many roundings.
  for (int dof = 1; dof <= 1000; dof = dof < 20 ? dof + 1 : 2 * dof + 1) {
    for (const double ratio : {0.5, 1.0, 1.5}) {
      const double x = ratio * dof;
      CAPTURE(dof);
      CAPTURE(x);
      const double step =
          std::exp(0.5 * dof * std::log(0.5 * x) - 0.5 * x - std::lgamma(0.5 * dof + 1.0));
      CHECK(near(chi_square_survival(x, dof + 2) - chi_square_survival(x, dof), step,
                 1e-13 + 1e-11 * step));
    }
  }
}

TEST_CASE("the threshold inverts the survival") {
  for (int dof = 1; dof <= 20; ++dof) {
    for (const double p : {0.999999, 0.5, 0.05, 1e-6, 1e-30, 1e-100}) {
      CAPTURE(dof);
      CAPTURE(p);
      // d ln p / d ln x is at most x / 2 = 300, times the 1e-10 of x.
      CHECK(near(chi_square_survival(chi_square_threshold(p, dof), dof) / p, 1.0, 3e-8));
    }
  }
}

TEST_CASE("the bands of Monte Carlo: thousands of degrees") {
  // Wilson and Hilferty, A&S (26.4.17): better than 1e-5 from 1000 degrees on.
  for (const int dof : {1000, 1499, 3000, 15'000}) {
    for (const double z : {-1.959964, 0.0, 1.959964}) {
      CAPTURE(dof);
      CAPTURE(z);
      const double c = 2.0 / (9.0 * dof);
      const double expected = dof * std::pow(1.0 - c + z * std::sqrt(c), 3.0);
      const double p = 0.5 * std::erfc(z / std::sqrt(2.0));
      CHECK(near(chi_square_threshold(p, dof) / expected, 1.0, 1e-5));
    }
  }
}

TEST_CASE("what has no threshold is refused with the allowed range") {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  struct Case {
    double probability;
    int dof;
  };
  for (const auto& [probability, dof] : {Case{0.0, 3}, Case{1.0, 3}, Case{-0.1, 3}, Case{1e-101, 3},
                                         Case{nan, 3}, Case{0.5, 0}, Case{0.5, -2}}) {
    const std::string message =
        test::message_of<Error>([&, p = probability, n = dof] { chi_square_threshold(p, n); });
    CAPTURE(message);
    CHECK(test::contains(message, "probability"));
    CHECK(test::contains(message, std::to_string(dof)));
    CHECK(test::contains(message, "[1e-100, 1)"));
  }
}

}  // namespace leeway
