/// @file
/// Chi-square probabilities for gates and consistency bands.
#pragma once

namespace leeway {

/// The probability P(chi^2 > x) for dof >= 1. Relative error below 1e-12 times max(dof, 100), down
/// to 1e-100.
/// Source: Abramowitz and Stegun (26.4.4), (26.4.5), finite sums for integer dof.
double chi_square_survival(double x, int dof);

/// The x that chi^2 exceeds with the given probability. Relative error below 1e-10 for up to 1e5
/// degrees of freedom.
/// @throws Error unless dof >= 1 and 1e-100 <= probability < 1.
double chi_square_threshold(double probability, int dof);

}  // namespace leeway
