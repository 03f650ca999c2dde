#include "muslin/report/report_curves.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>

namespace muslin {
namespace {

constexpr int plot_width = 620, plot_height = 400;  // points

using Column = std::function<double(const Diagnostics&)>;

std::vector<double> column(const std::vector<Diagnostics>& rows, const Column& number) {
  std::vector<double> values;
  for (const Diagnostics& row : rows) values.push_back(number(row));
  return values;
}

struct NamedColumn {
  const char* name;
  Column number;
};

Plot plot_of(const std::vector<Diagnostics>& rows, const char* title, const char* y_label,
             const std::vector<NamedColumn>& columns) {
  Plot plot;
  plot.title = title;
  plot.x_label = "time [s]";
  plot.y_label = y_label;
  plot.from_zero = true;
  plot.x = column(rows, [](const Diagnostics& row) { return row.time; });
  for (const NamedColumn& each : columns)
    plot.series.push_back({each.name, column(rows, each.number), false});
  return plot;
}

/// Plots lengths, in the unit that suits.
Plot length_plot(const std::vector<Diagnostics>& rows, const char* title, const char* name,
                 const NamedColumn& length) {
  Plot plot = plot_of(rows, title, "", {length});
  double largest = 0;
  for (const double value : plot.series[0].values)
    if (std::isfinite(value)) largest = std::max(largest, std::abs(value));
  struct Unit {
    double size;
    const char* name;
  };
  Unit chosen = {1e-9, "nm"};
  for (const Unit& unit : {Unit{1e-6, "µm"}, Unit{1e-3, "mm"}, Unit{1, "m"}})
    if (largest >= unit.size) chosen = unit;
  for (double& value : plot.series[0].values) value /= chosen.size;
  plot.y_label = std::string(name) + " [" + chosen.name + "]";
  return plot;
}

bool has_number(const Plot& plot) {
  return std::any_of(plot.series.begin(), plot.series.end(), [](const Series& series) {
    return std::any_of(series.values.begin(), series.values.end(),
                       [](double value) { return std::isfinite(value) && value != 0; });
  });
}

}  // namespace

std::vector<Plot> report_curves(const std::vector<Diagnostics>& rows) {
  const auto numbers = [&rows](double Diagnostics::* member) {
    return column(rows, [member](const Diagnostics& row) { return row.*member; });
  };
  const std::vector<double> time = numbers(&Diagnostics::time);
  std::vector<Plot> plots = {
      energy_plot(time, numbers(&Diagnostics::kinetic), numbers(&Diagnostics::elastic),
                  numbers(&Diagnostics::potential), numbers(&Diagnostics::work),
                  numbers(&Diagnostics::dissipated)),
      stretch_plot(time, numbers(&Diagnostics::max_stretch)),
      length_plot(rows, "Smallest gap", "gap",
                  {"gap", [](const Diagnostics& row) { return row.min_distance; }}),
      length_plot(rows, "Largest error of a step, estimated", "error",
                  {"error", [](const Diagnostics& row) { return row.error; }}),
      plot_of(rows, "Iterations of a frame", "iterations",
              {{"Newton", [](const Diagnostics& row) { return row.newton_iterations; }},
               {"linear solver", [](const Diagnostics& row) { return row.linear_iterations; }}}),
      plot_of(rows, "Steps of a frame", "steps",
              {{"made", [](const Diagnostics& row) { return row.steps; }},
               {"converged", [](const Diagnostics& row) { return row.converged_steps; }}})};
  std::erase_if(plots, [](const Plot& plot) { return !has_number(plot); });
  for (Plot& plot : plots) {
    plot.width = plot_width;
    plot.height = plot_height;
  }
  return plots;
}

}  // namespace muslin
