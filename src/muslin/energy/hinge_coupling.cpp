#include "muslin/energy/hinge_coupling.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include "muslin/core/error.hpp"
#include "muslin/core/index.hpp"
#include "muslin/core/parallel.hpp"
#include "muslin/topology/topology.hpp"

namespace muslin {
namespace {

// The weight of small changes against exactness: it matters only where hinges are nearly dependent.
constexpr double ridge = 1e-3;
// A hinge that is bent further at rest is a crease: the curvatures at its two sides have nothing in common.
constexpr double crease = std::numbers::pi / 3;
// Every curvature has at least this share of the mean rigidity, so that compliances are finite.
constexpr double least_rigidity = 1e-8;
// Entries of K this small beside the diagonal are rounding.
constexpr double rounding = 1e-12;
constexpr std::size_t grain = 1024;

Mat3 plate_rigidity(const BendingModuli& m) {
  require(m.warp >= 0 && m.weft >= 0, "a bending modulus is negative", "give 0 or more");
  require(std::abs(m.poisson) < 1, "the Poisson ratio of a plate is not between -1 and 1", "give 0 to 0.5");
  const double least = lowest_bias(m.warp, m.weft, m.poisson);
  require(m.bias >= least * (1 - 1e-12), "the bending rigidity at 45° is too low",
          "give at least lowest_bias");
  const double coupling = m.poisson * std::sqrt(m.warp * m.weft);
  Mat3 d;
  d << m.warp, coupling, 0, coupling, m.weft, 0, 0, 0, std::max(0.0, m.bias - least);
  return d + least_rigidity / 3 * d.trace() * Mat3::Identity();
}

/// By triangle, or one for all. One without stiffness among others has the least share of the stiffest.
std::vector<Mat3> plate_rigidities(std::span<const BendingModuli> moduli) {
  std::vector<Mat3> rigidities;
  double stiffest = 0;
  for (const BendingModuli& m : moduli) {
    rigidities.push_back(plate_rigidity(m));
    stiffest = std::max(stiffest, rigidities.back().trace());
  }
  for (Mat3& rigidity : rigidities)
    if (rigidity.trace() == 0) rigidity = least_rigidity / 3 * stiffest * Mat3::Identity();
  return rigidities;
}

/// The side of a triangle opposite a corner, in the triangle's (warp, weft).
struct Side {
  int edge = 0;
  int number = 0;   // among the sides of the edge
  double turn = 1;  // −1 where the triangle's normal is against that of the edge's first side
  double length = 0, height = 0, foot = 0;  // foot of the height: its share of the way along the edge
  Vec2 along = Vec2::Zero(), outward = Vec2::Zero();  // along the edge from its first vertex
};

struct Edge {
  struct Part {
    int triangle = 0, corner = 0;  // opposite the edge
  };
  std::vector<Part> sides;
  int hinge = -1;       // first side with second; further sides with the first have the next numbers
  int held = -1;        // a side whose triangle is held
  bool smooth = false;  // two sides that curve alike
};

/// A combination of hinges.
struct Row {
  std::vector<int> hinges;
  std::vector<double> weights;
};

class Coupler {
 public:
  Coupler(const Shell& shell, std::span<const BendingModuli> moduli, std::span<const std::uint8_t> held)
      : shell_(shell), rigidities_(plate_rigidities(moduli)) {
    find_edges(held);
    find_triangles();
  }

  HingeCoupling couple() const { return assemble(triangles()); }

  PlateCurvatures curvatures() const {
    return rows_of<Vec2>([](const Vec3& curvature) -> Vec2 { return curvature.head<2>(); });
  }

  EvenCurvatures even() const {
    const Mat3 root = rigidities_.front().llt().matrixU();
    return {rows_of<Vec3>([&](const Vec3& curvature) -> Vec3 { return root * curvature; }), root};
  }

 private:
  using Matrix = Eigen::MatrixXd;
  using Vector = Eigen::VectorXd;

  /// α of a triangle's sides (rows) as combinations of hinges.
  struct Triangle {
    std::vector<int> hinges;
    Eigen::Matrix<double, 3, Eigen::Dynamic> turns;
  };

  /// `part` of every triangle's (κ_uu, κ_vv, 2 κ_uv).
  template <class Curvature, class Part>
  CurvatureRows<Curvature> rows_of(const Part& part) const {
    CurvatureRows<Curvature> result;
    result.hinge_count = shell_.hinges.size();
    result.first.push_back(0);
    const std::vector<Triangle> rows = triangles();
    for (std::size_t t = 0; t < rows.size(); ++t) {
      // The free sides follow from the others; κ = (1/A) Σ l α n⊗n.
      const Mat3 all = normals_of(t).transpose() * compliance_[t] * stiffness_[t] / shell_.areas[t];
      for (std::size_t i = 0; i < rows[t].hinges.size(); ++i) {
        result.hinges.push_back(rows[t].hinges[i]);
        result.weights.push_back(part(all * rows[t].turns.col(static_cast<Eigen::Index>(i))));
      }
      result.first.push_back(static_cast<int>(result.hinges.size()));
    }
    result.find_uses();
    return result;
  }

  void find_edges(std::span<const std::uint8_t> held) {
    const std::size_t count = shell_.triangles.size();
    held_.assign(count, 0);
    if (!held.empty()) {
      for (std::size_t t = 0; t < count; ++t) {
        const Vec3i& v = shell_.triangles[t];
        held_[t] = held[at(v[0])] != 0 && held[at(v[1])] != 0 && held[at(v[2])] != 0;
      }
    }
    sides_.resize(count);
    int hinge = 0;
    for_each_edge(triangle_sides(shell_.triangles), [&](std::span<const EdgeUse> uses) {
      Edge edge;
      for (std::size_t i = 0; i < uses.size(); ++i) {
        const int t = uses[i].face, first_corner = uses[i].corner % 3, corner = (first_corner + 2) % 3;
        const bool along = uses[i].ascends == uses[0].ascends;
        Side& s = sides_[at(t)][at(corner)];
        s.edge = static_cast<int>(edges_.size());
        s.number = static_cast<int>(i);
        s.turn = i > 0 && along ? -1 : 1;
        measure(at(t), first_corner, along, s);
        if (held_[at(t)] && edge.held < 0) edge.held = s.number;
        edge.sides.push_back({t, corner});
      }
      if (uses.size() > 1) edge.hinge = hinge;
      hinge += static_cast<int>(uses.size()) - 1;
      edge.smooth = uses.size() == 2 && std::abs(shell_.hinges[at(edge.hinge)].angle) < crease;
      edges_.push_back(std::move(edge));
    });
    require(at(hinge) == shell_.hinges.size(), "a shell's hinges are not those of its triangles",
            "build it with build_shell");
  }

  /// `corner` is the side's first in the triangle; `along`: it runs as the edge does.
  void measure(std::size_t t, int corner, bool along, Side& s) const {
    const Mat2 edges = shell_.inverses[t].inverse();
    const std::array<Vec2, 3> x = {Vec2::Zero(), edges.col(0), edges.col(1)};
    const Vec2 a = x[at(corner)], b = x[at((corner + 1) % 3)], o = x[at((corner + 2) % 3)];
    const Vec2 d = b - a;
    s.length = d.norm();
    const double foot = (o - a).dot(d) / d.squaredNorm();
    const Vec2 height = a + foot * d - o;
    s.height = height.norm();
    s.outward = Vec2(d.y(), -d.x()) / s.length;
    s.along = (along ? d : -d) / s.length;
    s.foot = along ? foot : 1 - foot;
  }

  void find_triangles() {
    const std::size_t count = shell_.triangles.size();
    stiffness_.resize(count);
    compliance_.resize(count);
    for (std::size_t t = 0; t < count; ++t) {
      const Mat3 inverse = normals_of(t).inverse();
      compliance_[t] = shell_.areas[t] * inverse.transpose() * rigidity_of(t).inverse() * inverse;
      stiffness_[t].setZero();
      if (held_[t]) {
        compliance_[t].setZero();
        continue;
      }
      condense(t);
    }
  }

  /// l (n_u², n_v², 2 n_u n_v) by side.
  Mat3 normals_of(std::size_t t) const {
    Mat3 normals;
    for (int c = 0; c < 3; ++c) {
      const Side& s = sides_[t][at(c)];
      const Vec2& n = s.outward;
      normals.row(c) = s.length * Eigen::RowVector3d(n.x() * n.x(), n.y() * n.y(), 2 * n.x() * n.y());
    }
    return normals;
  }

  /// Free sides bear no moment: the others' stiffness is the inverse of their compliance.
  void condense(std::size_t t) {
    std::array<int, 3> inner{};
    int n = 0;
    for (int c = 0; c < 3; ++c)
      if (!is_free(t, c)) inner[at(n++)] = c;
    if (n == 0) return;
    Matrix part(n, n);
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j) part(i, j) = compliance_[t](inner[at(i)], inner[at(j)]);
    part = part.inverse().eval();
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j) stiffness_[t](inner[at(i)], inner[at(j)]) = 0.5 * (part(i, j) + part(j, i));
  }

  bool is_free(std::size_t t, int c) const { return edges_[at(sides_[t][at(c)].edge)].hinge < 0; }

  /// α of a side by the constant curvature H_ss, H_nn, H_sn, s along the edge and n outward.
  static Vec3 turn_by_curvature(const Side& s) {
    return {-0.5 * s.length * s.length * s.foot * (1 - s.foot) / s.height, 0.5 * s.height,
            s.length * (0.5 - s.foot)};
  }

  /// A hinge near an edge: number `hinge` of its own edge, and the side through which it is near.
  struct Neighbour {
    int edge = 0, hinge = 0;
    Edge::Part side;
  };

  /// The edge's own hinges, then those of its triangles' other edges.
  std::vector<Neighbour> neighbours_of(int e) const {
    const Edge& edge = edges_[at(e)];
    std::vector<Neighbour> found;
    for (int k = 0; k + 1 < static_cast<int>(edge.sides.size()); ++k) found.push_back({e, k, edge.sides[0]});
    for (const Edge::Part& side : edge.sides) {
      for (int c = 0; c < 3; ++c) {
        const int f = sides_[at(side.triangle)][at(c)].edge;
        const bool seen =
            std::any_of(found.begin(), found.end(), [f](const Neighbour& n) { return n.edge == f; });
        if (!seen && edges_[at(f)].smooth) found.push_back({f, 0, {side.triangle, c}});
      }
    }
    return found;
  }

  /// 1 for the sides between which hinge `hinge` of an edge lies.
  static double takes_part(int hinge, int side) { return side == 0 || side == hinge + 1 ? 1 : 0; }

  /// Compliance between two hinges through the triangles they share.
  double compliance_between(const Neighbour& p, const Neighbour& q) const {
    double sum = 0;
    for (const Edge::Part& a : edges_[at(p.edge)].sides) {
      for (const Edge::Part& b : edges_[at(q.edge)].sides) {
        if (a.triangle != b.triangle) continue;
        const Side &s = side_of(a), &u = side_of(b);
        sum += takes_part(p.hinge, s.number) * s.turn * compliance_[at(a.triangle)](a.corner, b.corner) *
               takes_part(q.hinge, u.number) * u.turn;
      }
    }
    return sum;
  }

  const Side& side_of(const Edge::Part& part) const { return sides_[at(part.triangle)][at(part.corner)]; }

  /// For every edge: the turn of the first side beyond its mean share of the hinges.
  std::vector<Row> recover_slopes() const {
    std::vector<Row> rows(edges_.size());
    parallel_for(edges_.size(), grain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t e = begin; e < end; ++e) {
        const Edge& edge = edges_[e];
        if (edge.hinge < 0 || edge.held >= 0) continue;
        const std::vector<Neighbour> near = neighbours_of(static_cast<int>(e));
        const Vector weights = edge.smooth ? exact_weights(edge, near) : least_energy_weights(edge, near);
        for (std::size_t j = 0; j < near.size(); ++j) {
          const double weight = weights[static_cast<Eigen::Index>(j)];
          if (std::abs(weight) < rounding) continue;
          rows[e].hinges.push_back(edges_[at(near[j].edge)].hinge + near[j].hinge);
          rows[e].weights.push_back(weight);
        }
      }
    });
    return rows;
  }

  /// The smallest weights, in the norm of the compliances, with which constant curvatures are exact.
  Vector exact_weights(const Edge& edge, const std::vector<Neighbour>& near) const {
    const auto n = static_cast<Eigen::Index>(near.size());
    Matrix by_curvature(n, 3), weighted(n, 3);
    for (Eigen::Index j = 0; j < n; ++j) {
      const Neighbour& hinge = near[static_cast<std::size_t>(j)];
      by_curvature.row(j) = hinge_by_curvature(edge, hinge).transpose();
      weighted.row(j) = by_curvature.row(j) / compliance_between(hinge, hinge);
    }
    Vec3 first = turn_by_curvature(side_of(edge.sides[0])),
         second = turn_by_curvature(side_of(edge.sides[1]));
    second[2] = -second[2];
    const double areas = shell_.areas[at(edge.sides[0].triangle)] + shell_.areas[at(edge.sides[1].triangle)];
    const double trace = 0.5 * (rigidity_of(at(edge.sides[0].triangle)).trace() +
                                rigidity_of(at(edge.sides[1].triangle)).trace());
    // Few rows: products for large matrices would take longer, also to compile.
    const Mat3 normal =
        by_curvature.transpose().lazyProduct(weighted) + ridge * areas * trace / 3 * Mat3::Identity();
    return weighted.lazyProduct(normal.ldlt().solve(0.5 * (first - second)));
  }

  /// θ of a hinge by a constant curvature in the frame of `edge`, its second triangle unfolded about it.
  Vec3 hinge_by_curvature(const Edge& edge, const Neighbour& hinge) const {
    const bool second = hinge.side.triangle == edge.sides[1].triangle;
    const Side& base = side_of(edge.sides[second ? 1 : 0]);
    const Side& side = side_of(hinge.side);
    const Vec2 across = second ? Vec2(-base.outward) : base.outward;
    Vec3 turn = Vec3::Zero();
    for (const Edge::Part& part : edges_[at(hinge.edge)].sides) {
      if (held_[at(part.triangle)]) continue;
      Vec3 own = turn_by_curvature(side_of(part));
      if (part.triangle != hinge.side.triangle) own[2] = -own[2];
      turn += own;
    }
    const Vec2 s(side.along.dot(base.along), side.along.dot(across));
    const Vec2 n(side.outward.dot(base.along), side.outward.dot(across));
    const double sign = side.turn * (second ? base.turn : 1);
    return sign * (turn[0] * Vec3(s[0] * s[0], s[1] * s[1], 2 * s[0] * s[1]) +
                   turn[1] * Vec3(n[0] * n[0], n[1] * n[1], 2 * n[0] * n[1]) +
                   turn[2] * Vec3(s[0] * n[0], s[1] * n[1], s[0] * n[1] + s[1] * n[0]));
  }

  /// Returns the division of least energy for given angles of the hinges. It serves creases and edges with
  /// three and more triangles, whose curvatures have nothing in common.
  Vector least_energy_weights(const Edge& edge, const std::vector<Neighbour>& near) const {
    const auto n = static_cast<Eigen::Index>(near.size());
    Matrix compliance(n, n);
    Vector right = Vector::Zero(n);
    const double share = 1.0 / static_cast<double>(edge.sides.size());
    for (Eigen::Index j = 0; j < n; ++j) {
      const Neighbour& hinge = near[static_cast<std::size_t>(j)];
      for (Eigen::Index i = 0; i < n; ++i)
        compliance(i, j) = compliance_between(near[static_cast<std::size_t>(i)], hinge);
      compliance(j, j) *= 1 + rounding;
      for (const Edge::Part& a : edge.sides) {
        const Side& s = side_of(a);
        const double part = (s.number == 0 ? 1 : 0) - (s.number == 0 ? 1 - share : share);
        for (const Edge::Part& b : edges_[at(hinge.edge)].sides) {
          if (a.triangle != b.triangle) continue;
          const Side& u = side_of(b);
          right[j] += part * s.turn * compliance_[at(a.triangle)](a.corner, b.corner) *
                      takes_part(hinge.hinge, u.number) * u.turn;
        }
      }
    }
    return compliance.ldlt().solve(right);
  }

  std::vector<Triangle> triangles() const {
    const std::vector<Row> recovered = recover_slopes();
    std::vector<Triangle> rows(shell_.triangles.size());
    parallel_for(rows.size(), grain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t t = begin; t < end; ++t) rows[t] = curvature_of(t, recovered);
    });
    return rows;
  }

  Triangle curvature_of(std::size_t t, const std::vector<Row>& recovered) const {
    Triangle triangle;
    if (held_[t]) return triangle;
    std::array<Row, 3> rows;
    for (int c = 0; c < 3; ++c) {
      if (is_free(t, c)) continue;
      rows[at(c)] = turn_of(sides_[t][at(c)], recovered);
      for (const int h : rows[at(c)].hinges) triangle.hinges.push_back(h);
    }
    std::sort(triangle.hinges.begin(), triangle.hinges.end());
    triangle.hinges.erase(std::unique(triangle.hinges.begin(), triangle.hinges.end()), triangle.hinges.end());
    triangle.turns.setZero(3, static_cast<Eigen::Index>(triangle.hinges.size()));
    for (int c = 0; c < 3; ++c) {
      const Row& row = rows[at(c)];
      for (std::size_t i = 0; i < row.hinges.size(); ++i)
        triangle.turns(c, place(triangle, row.hinges[i])) += row.weights[i];
    }
    return triangle;
  }

  static Eigen::Index place(const Triangle& triangle, int hinge) {
    return std::lower_bound(triangle.hinges.begin(), triangle.hinges.end(), hinge) - triangle.hinges.begin();
  }

  /// α of a side. Beside a held triangle the sheet's normal is that triangle's.
  Row turn_of(const Side& s, const std::vector<Row>& recovered) const {
    const Edge& edge = edges_[at(s.edge)];
    const int others = static_cast<int>(edge.sides.size()) - 1;
    Row row;
    const auto add = [&](int hinge, double weight) {
      row.hinges.push_back(hinge);
      row.weights.push_back(s.turn * weight);
    };
    if (edge.held >= 0) {
      if (s.number > 0) add(edge.hinge + s.number - 1, 1);
      if (edge.held > 0) add(edge.hinge + edge.held - 1, s.number > 0 ? -1 : 1);
      return row;
    }
    const double share = 1.0 / (others + 1);
    for (int k = 0; k < others; ++k)
      add(edge.hinge + k, s.number == 0 ? share : (s.number == k + 1 ? 1 : 0) - share);
    const Row& change = recovered[at(s.edge)];
    for (std::size_t i = 0; i < change.hinges.size(); ++i)
      add(change.hinges[i], s.number == 0 ? change.weights[i] : -change.weights[i]);
    return row;
  }

  /// K = Σ aᵀ K a: its upper half by rows, mirrored.
  HingeCoupling assemble(const std::vector<Triangle>& triangles) const {
    const std::size_t count = shell_.hinges.size();
    std::vector<std::vector<int>> of_hinge(count);
    for (std::size_t t = 0; t < triangles.size(); ++t)
      for (const int h : triangles[t].hinges) of_hinge[at(h)].push_back(static_cast<int>(t));
    using Entries = std::vector<std::pair<int, double>>;
    std::vector<Entries> upper(count);
    parallel_for(count, grain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t h = begin; h < end; ++h) {
        Entries& row = upper[h];
        for (const int t : of_hinge[h]) {
          const Triangle& triangle = triangles[at(t)];
          const Eigen::Index own = place(triangle, static_cast<int>(h));
          const Vec3 moments = stiffness_[at(t)] * triangle.turns.col(own);
          for (std::size_t k = static_cast<std::size_t>(own); k < triangle.hinges.size(); ++k)
            row.emplace_back(triangle.hinges[k],
                             moments.dot(triangle.turns.col(static_cast<Eigen::Index>(k))));
        }
        std::stable_sort(row.begin(), row.end(),
                         [](const auto& p, const auto& q) { return p.first < q.first; });
        Entries sums;
        for (const auto& [column, value] : row) {
          if (sums.empty() || sums.back().first != column) sums.emplace_back(column, 0.0);
          sums.back().second += value;
        }
        row = std::move(sums);
      }
    });
    const auto diagonal = [&](std::size_t h) { return upper[h].empty() ? 0.0 : upper[h].front().second; };
    std::vector<Entries> rows(count);
    for (std::size_t h = 0; h < count; ++h) {
      for (const auto& [column, value] : upper[h]) {
        const double largest = std::sqrt(diagonal(h) * diagonal(at(column)));
        if (!(largest > 0 && std::abs(value) > rounding * largest)) continue;
        rows[h].emplace_back(column, value);
        if (at(column) != h) rows[at(column)].emplace_back(static_cast<int>(h), value);
      }
    }
    HingeCoupling coupling;
    coupling.first.push_back(0);
    for (std::size_t h = 0; h < count; ++h) {
      std::sort(rows[h].begin(), rows[h].end());
      double sum = 0;
      for (const auto& [column, value] : rows[h]) {
        coupling.columns.push_back(column);
        coupling.values.push_back(value);
        sum += std::abs(value) * std::sqrt(diagonal(h) / diagonal(at(column)));
      }
      coupling.first.push_back(static_cast<int>(coupling.columns.size()));
      coupling.lumped.push_back(0.5 * sum);
    }
    return coupling;
  }

  const Mat3& rigidity_of(std::size_t t) const { return rigidities_[rigidities_.size() > 1 ? t : 0]; }

  const Shell& shell_;
  std::vector<Mat3> rigidities_;  // by triangle, or one for all
  std::vector<Edge> edges_;
  std::vector<std::array<Side, 3>> sides_;    // by triangle and opposite corner
  std::vector<char> held_;                    // by triangle
  std::vector<Mat3> stiffness_, compliance_;  // by triangle: against α of its sides [N·m, 1/(N·m)]
};

}  // namespace

double lowest_bias(double warp, double weft, double poisson) {
  return (warp + weft + 2 * poisson * std::sqrt(warp * weft)) / 4;
}

std::vector<double> HingeCoupling::times(std::span<const double> d) const {
  std::vector<double> product(d.size());
  parallel_for(d.size(), 4096, [&](std::size_t begin, std::size_t end) {
    for (std::size_t e = begin; e < end; ++e) {
      double sum = 0;
      for (int k = first[e]; k < first[e + 1]; ++k) sum += values[at(k)] * d[at(columns[at(k)])];
      product[e] = sum;
    }
  });
  return product;
}

HingeCoupling couple_hinges(const Shell& shell, const BendingModuli& moduli,
                            std::span<const std::uint8_t> held) {
  return couple_hinges(shell, std::span(&moduli, 1), held);
}

HingeCoupling couple_hinges(const Shell& shell, std::span<const BendingModuli> moduli,
                            std::span<const std::uint8_t> held) {
  HingeCoupling none;
  none.first.assign(shell.hinges.size() + 1, 0);
  none.lumped.assign(shell.hinges.size(), 0.0);
  const bool stiff = std::any_of(moduli.begin(), moduli.end(), [](const BendingModuli& m) {
    return m.warp != 0 || m.weft != 0 || m.bias != 0;
  });
  return stiff ? Coupler(shell, moduli, held).couple() : none;
}

PlateCurvatures plate_curvatures(const Shell& shell, const BendingModuli& moduli,
                                 std::span<const std::uint8_t> held) {
  return Coupler(shell, std::span(&moduli, 1), held).curvatures();
}

EvenCurvatures even_curvatures(const Shell& shell, const BendingModuli& moduli,
                               std::span<const std::uint8_t> held) {
  require(moduli.warp > 0 || moduli.weft > 0 || moduli.bias > 0, "a plate has no bending rigidity",
          "give a modulus above 0");
  return Coupler(shell, std::span(&moduli, 1), held).even();
}

}  // namespace muslin
