#include "leeway/model/chi_square.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "leeway/earth/error.hpp"

namespace leeway {

double chi_square_survival(double x, int dof) {
  if (x <= 0.0) return 1.0;
  const double half_x = 0.5 * x;
  const double last = 0.5 * dof - 1.0;
  const double first = dof % 2 == 0 ? 0.0 : 0.5;
  // Terms (x/2)^k exp(-x/2) / k! from the largest outwards, which alone is formed in logarithms:
  // for thousands of degrees of freedom the outer ones underflow, and may.
  const double top = std::clamp(first + std::floor(half_x - first), std::min(first, last), last);
  const auto term = [half_x](double k) {
    return std::exp(k * std::log(half_x) - half_x - std::lgamma(k + 1.0));
  };
  double sum = dof % 2 == 0 ? 0.0 : std::erfc(std::sqrt(half_x));
  double t = term(top);
  for (int i = 0; top - i >= first; ++i) {
    sum += t;
    t *= (top - i) / half_x;
  }
  t = term(top);
  for (int i = 1; top + i <= last; ++i) {
    t *= half_x / (top + i);
    sum += t;
  }
  return sum;
}

double chi_square_threshold(double probability, int dof) {
  if (dof < 1 || !(probability >= 1e-100 && probability < 1.0)) {
    throw Error("chi-square threshold for probability " + std::to_string(probability) + " and " +
                std::to_string(dof) +
                " degrees of freedom: the probability must be in [1e-100, 1) and the degrees >= 1");
  }
  double low = 0.0;
  double high = 4.0 * dof + 1000.0;
  while (high - low > 1e-11 * high) {
    const double middle = 0.5 * (low + high);
    (chi_square_survival(middle, dof) > probability ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

}  // namespace leeway
