/// @file
/// Banks of headings around what a filter believes.
#pragma once

#include <optional>

#include "leeway/navigator/heading_bank.hpp"

namespace leeway {

/// Whether a new filter would start from this. What it would refuse goes on in the old one: push
/// does not throw.
bool can_start(const Estimate& estimate, const ErrorMatrix& P);

/// Several headings about the one of the estimate.
/// @param sigma_rad       of the heading; its variance in P does not count
/// @param course_turns_s  over which its course may have turned along
HeadingBank bank_around(const EkfConfig& config, const Estimate& estimate, ErrorMatrix P,
                        double sigma_rad, double course_turns_s = 0.0);

/// The filter several times, its heading as uncertain as told; nothing where it cannot start anew.
std::optional<HeadingBank> bank_of_headings(const Ekf& filter, double sigma_rad,
                                            double course_turns_s = 0.0);

/// is_sane() of all its filters.
bool is_sane(HeadingBank& bank);

}  // namespace leeway
