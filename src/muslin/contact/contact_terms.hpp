// Contact terms express the contact energy as a sum over feature pairs that counts every contact of a vertex
// once.
//
// A vertex v meets a surface S at its distance d(v, S). The pairs of v with single triangles overlap: above
// an edge v is equally near to two triangles, above a corner to six. Inclusion and exclusion over the
// triangles T, edges e and corners p of S removes double counting,
//
//   W(v) = Σ_T b(d(v, T)) + Σ_e c_e b(d(v, e)) + Σ_p c_p b(d(v, p)),
//   c_e = 1 − n_e,   c_p = 1 − n_p − Σ_{e ∋ p} c_e,
//
// n_e and n_p the numbers of triangles at e and p: −1 and 1 inside a manifold, 0 on its border. With ψ = −b′,
// W(v) = ∫ ψ(r) χ(S ∩ B_r(v)) dr, χ the Euler characteristic of the part of S within r of v: 1 for a disc,
// wherever its nearest point lies. All coefficients are constant, so W is as smooth as b and the distances,
// and its gradient and Hessian are the sums over the terms.
//
// The centre of a sphere is equally near to many triangles of a cloth that lies on it. There the vertices of
// the cloth act first: contact of a round body with the inside of faces and edges begins at half the range.
//
// Two edges touch where both closest points are inside them. Towards their ends, and where they are parallel,
// the term fades and vertex contacts take over. Only the fading factor is lagged: it is evaluated where the
// terms are made and constant from then on. docs/theory/contact.md.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "muslin/contact/pair_distances.hpp"

namespace muslin {

/// stiffness · b(distance − thickness) of two features.
struct ContactTerm {
  enum class Kind : std::uint8_t { point_plane, vertex_triangle, vertex_edge, vertex_vertex, edge_edge };
  Kind kind = Kind::point_plane;
  std::int8_t rule = -1;                         ///< as in ContactPair
  std::array<int, 4> points = {-1, -1, -1, -1};  ///< of the first feature, then of the second; −1: none
  int plane = -1;                                ///< of point_plane
  std::uint64_t key = 0;            ///< ContactPair::key() of its pair; 0 for subtracted edges and corners
  double thickness = 0, range = 0;  ///< as in ContactPair [m]
  double stiffness = 0;             ///< negative where it cancels double counting [N/m]

  int first_size() const { return kind == Kind::edge_edge ? 2 : 1; }
};

PairGeometry term_geometry(const ContactSurface& surface, const ContactTerm& term, ConstVectors x);

/// Returns all terms that may be in range near the points of `distances`, of pairs whose gap is less than
/// PairDistances::ranges_known times their range; rigid bodies are stopped within `dt` [s]. Terms of one
/// vertex against one body are consecutive. Pairs without a gap are left out.
std::vector<ContactTerm> contact_terms(const PairDistances& distances, double dt);

/// The merged terms of one vertex with the same closest points.
struct MergedContact {
  std::array<int, 4> points = {-1, -1, -1, -1};
  int first_size = 1;
  std::int8_t rule = -1;            ///< of the same term as the key
  std::uint64_t key = 0;            ///< of the first of its terms that has one
  std::array<double, 4> weights{};  ///< ∂d/∂xᵢ = weights[i] · normal
  Vec3 normal = Vec3::Zero();
  double slope = 0, curvature = 0;  ///< of the energy by the distance [N], [N/m]
  double stiffness = 0;             ///< sum of those of the terms [N/m]
  double magnitude = 0;             ///< sum of the absolute slopes of the terms [N]
  double distance = 0;              ///< [m]
};

/// Returns the contacts in range at x (#P by 3, [m]), in the order of the terms. Terms that cancel are left
/// out.
std::vector<MergedContact> merged_contacts(const ContactSurface& surface, std::span<const ContactTerm> terms,
                                           ConstVectors x);

}  // namespace muslin
