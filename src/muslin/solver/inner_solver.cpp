#include "muslin/solver/inner_solver.hpp"

#include <algorithm>
#include <cmath>

#include "muslin/core/parallel.hpp"
#include "muslin/core/vector_code.hpp"

namespace muslin {
namespace {

constexpr std::size_t grain = 8192;

/// x += alpha p, p = z + beta p.
MUSLIN_VECTOR_CODE void advance(std::size_t begin, std::size_t end, float alpha, float beta, Floats x,
                                Floats z, Floats p) {
  MUSLIN_INDEPENDENT
  for (std::size_t v = begin; v < end; ++v) {
    const float px = p.x[v], py = p.y[v], pz = p.z[v];
    x.x[v] += alpha * px, x.y[v] += alpha * py, x.z[v] += alpha * pz;
    p.x[v] = z.x[v] + beta * px, p.y[v] = z.y[v] + beta * py, p.z[v] = z.z[v] + beta * pz;
  }
}

double largest_entry(ConstVectors b) {
  struct Largest {
    double value = 0;
    Largest operator+(const Largest& other) const { return {std::max(value, other.value)}; }
  };
  return parallel_sum(b.size(), grain, Largest{},
                      [&](std::size_t begin, std::size_t end) {
                        double largest = 0;
                        for (std::size_t v = begin; v < end; ++v)
                          largest = std::max(largest, b[v].cwiseAbs().maxCoeff());
                        return Largest{largest};
                      })
      .value;
}

}  // namespace

void InnerSolver::linearize(const IncrementalPotential& function, ConstVectors x) {
  function.linearize(x, h_);
  const std::size_t count = function.size();
  for (FloatVectors* vectors : {&x_, &r_, &z_, &p_, &q_}) vectors->resize(count);
  if (h_.stiffest() <= float_limit) preconditioner_.factor(h_, p_, q_);
}

LinearReport InnerSolver::solve(ConstVectors b, const LinearSettings& settings, Vectors s, double& norm) {
  const std::size_t count = b.size();
  const Floats x = x_.data(), r = r_.data(), z = z_.data(), p = p_.data(), q = q_.data();
  // Scaled to entries of at most 1, far from the ends of float's range.
  const double scale = largest_entry(b);
  LinearReport report;
  norm = 0;
  if (scale == 0) {
    std::fill(s.begin(), s.end(), Vec3::Zero());
    report.converged = true;
    report.relative_residual = 0;
    return report;
  }
  const double per_scale = 1 / scale;
  parallel_for(count, grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) {
      r.x[v] = static_cast<float>(per_scale * b[v].x());
      r.y[v] = static_cast<float>(per_scale * b[v].y());
      r.z[v] = static_cast<float>(per_scale * b[v].z());
      x.x[v] = x.y[v] = x.z[v] = 0;
      p.x[v] = p.y[v] = p.z[v] = 0;
      q.x[v] = q.y[v] = q.z[v] = 0;
    }
  });
  double rz = preconditioner_.apply(0, q_, r_, z_);
  const double first = rz;
  const double stop = settings.tolerance * settings.tolerance * rz;
  norm = scale * std::sqrt(rz);
  if (norm <= settings.enough) {
    std::fill(s.begin(), s.end(), Vec3::Zero());
    report.converged = true;
    return report;
  }
  const auto step = [&](double alpha, double beta) {
    parallel_for(count, grain, [&](std::size_t begin, std::size_t end) {
      advance(begin, end, static_cast<float>(alpha), static_cast<float>(beta), x, z, p);
    });
  };
  double alpha = 0, beta = 0;
  while (report.iterations < settings.max_iterations && std::isfinite(rz)) {
    step(alpha, beta);  // p = z at first
    alpha = 0;
    const double curvature = h_.product(p_, q_);
    ++report.iterations;
    if (!std::isfinite(curvature) || curvature == 0) break;
    if (curvature < 0 && settings.negative_curvature == NegativeCurvature::stop) {
      if (report.iterations == 1) alpha = 1;
      report.negative_curvature = true;
      break;
    }
    alpha = rz / curvature;
    const double rz_next = preconditioner_.apply(static_cast<float>(alpha), q_, r_, z_);
    beta = rz_next / rz;
    rz = rz_next;
    if (rz <= stop) {
      report.converged = true;
      break;
    }
  }
  parallel_for(count, grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) {
      s[v] = Vec3(x.x[v] + alpha * p.x[v], x.y[v] + alpha * p.y[v], x.z[v] + alpha * p.z[v]) * scale;
    }
  });
  report.relative_residual = first > 0 ? std::sqrt(std::max(0.0, rz) / first) : 0;
  return report;
}

std::size_t InnerSolver::bytes() const {
  std::size_t bytes = h_.bytes() + preconditioner_.bytes();
  for (const FloatVectors* vectors : {&x_, &r_, &z_, &p_, &q_}) bytes += vectors->bytes();
  return bytes;
}

}  // namespace muslin
