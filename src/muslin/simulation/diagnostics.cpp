#include "muslin/simulation/diagnostics.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "muslin/core/parallel.hpp"

namespace muslin {
double max_stretch(const Body& body, ConstVectors x) {
  if (body.is_shell()) return max_stretch(body.shell, x);
  const Springs& springs = body.springs;
  if (springs.count == 0) return 1;
  struct Largest {
    double ratio = 0;
    Largest operator+(const Largest& other) const { return {std::max(ratio, other.ratio)}; }
  };
  constexpr std::size_t runs_per_block = 64;
  return parallel_sum(springs.runs.size(), runs_per_block, Largest{},
                      [&](std::size_t begin, std::size_t end) {
                        Largest largest;
                        for (std::size_t r = begin; r < end; ++r) {
                          const SpringRun& run = springs.runs[r];
                          const auto& direction = springs.directions[static_cast<std::size_t>(run.direction)];
                          const double rest = body.lattice.width * direction.offset.cast<double>().norm();
                          double squared = 0;
                          for (int i = 0; i < run.length; ++i) {
                            const auto a = static_cast<std::size_t>(run.a + i);
                            const auto b = static_cast<std::size_t>(run.b + i);
                            squared = std::max(squared, (x[b] - x[a]).squaredNorm());
                          }
                          largest.ratio = std::max(largest.ratio, std::sqrt(squared) / rest);
                        }
                        return largest;
                      })
      .ratio;
}

double max_stretch(const Model& model, ConstVectors x) {
  double largest = model.bodies.empty() ? 1 : 0;
  for (const Body& body : model.bodies) largest = std::max(largest, max_stretch(body, model.of(body, x)));
  return largest;
}

std::vector<LimitedStretch> limited_stretches(const Model& model, ConstVectors x, int frame) {
  std::vector<LimitedStretch> rows;
  for (std::size_t b = 0; b < model.scene.bodies.size(); ++b) {
    const std::optional<double>& limit = model.scene.bodies[b].stretch_limit;
    const Body& body = model.bodies[b];
    if (limit) rows.push_back({frame, max_stretch(body, model.of(body, x)), *limit, body.name});
  }
  return rows;
}

}  // namespace muslin
