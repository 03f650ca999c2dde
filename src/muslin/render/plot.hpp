// Plots numbers over time, as SVG and as PNG, from one layout.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "muslin/render/image.hpp"

namespace muslin {

struct Series {
  std::string name;
  std::vector<double> values;  ///< one for each of Plot::x; the line has a gap where one is not finite
  bool dashed = false;
};

/// Lines over a common axis. Up to seven series keep colours that colour-blind readers tell apart.
struct Plot {
  std::string title;
  std::string x_label;  ///< with the unit, such as "time [s]"
  std::string y_label;
  std::vector<double> x;
  std::vector<Series> series;
  bool from_zero = false;  ///< the y axis includes 0
  int width = 900;         ///< [points]; PNG files have twice as many pixels
  int height = 480;
};

/// Plots kinetic, elastic and potential energy, work of the external forces, dissipated energy [J], and their
/// balance. Energies count from the first row; the balance, kinetic + elastic + potential + dissipated −
/// work, would be 0 without numerical error. A suitable prefix (mJ, kJ, MJ) is chosen.
Plot energy_plot(std::span<const double> time, std::span<const double> kinetic,
                 std::span<const double> elastic, std::span<const double> potential,
                 std::span<const double> work, std::span<const double> dissipated);

/// Plots the largest stretch over time [s], given as length / rest length: 1.05 shows as 5 %.
Plot stretch_plot(std::span<const double> time, std::span<const double> ratio);

/// Each throws Error(usage) if a series and x differ in length or the size is outside 200…8000 points.
std::string plot_svg(const Plot& plot);
Image plot_image(const Plot& plot, double pixels_per_point = 2);

/// Writes .svg or .png, by the suffix. Throws Error(usage) on another suffix, Error(file) if it cannot be
/// written.
void write_plot(const std::filesystem::path& path, const Plot& plot);

}  // namespace muslin
