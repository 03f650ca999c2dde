// A material whose numbers change over time, at one time.
#pragma once

#include <vector>

#include "muslin/material/material.hpp"

namespace muslin {

/// Return the material with the numbers of a time [s] in place of those that are keyframed, and with the
/// numbers that follow from them. Numbers that vary by a map still do.
Material material_at(const Material& material, double time);
ShellMaterial material_at(const ShellMaterial& material, double time);

/// Returns the times of the keyframes of numbers that change, ascending; empty if none does [s].
std::vector<double> keyframe_times(const schema::Variations& variations);
/// Returns these times and several between each two, for checks of rules that join numbers [s].
std::vector<double> times_to_check(const schema::Variations& variations);
/// Returns the numbers at a time, the nominal ones of those that vary by a map.
std::vector<double> numbers_at(const schema::Variations& variations, double time);
/// Returns the keyframed numbers at a time.
std::vector<double> keyed_numbers(const schema::Variations& variations, double time);

}  // namespace muslin
