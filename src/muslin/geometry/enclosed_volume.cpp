#include "muslin/geometry/enclosed_volume.hpp"

#include <algorithm>
#include <map>
#include <numeric>

#include <fmt/format.h>

#include "muslin/core/error.hpp"
#include "muslin/core/index.hpp"
#include "muslin/core/parallel.hpp"

namespace muslin {
namespace {

constexpr std::size_t volume_grain = 1024;

/// Directed edges and the corner opposite to them.
using DirectedEdges = std::map<std::pair<int, int>, int>;

DirectedEdges directed_edges(const std::vector<Vec3i>& triangles) {
  DirectedEdges edges;
  for (const Vec3i& t : triangles) {
    for (int c = 0; c < 3; ++c) {
      const int a = t[c], b = t[(c + 1) % 3];
      if (edges.emplace(std::pair(a, b), t[(c + 2) % 3]).second) continue;
      throw Error(
          ErrorKind::input,
          fmt::format(
              "the edge between vertices {} and {} runs the same way in two triangles, so the surface "
              "has no inside",
              a + 1, b + 1),
          "orient all faces alike, and leave at most two at an edge");
    }
  }
  return edges;
}

}  // namespace

EnclosedVolume::EnclosedVolume(const std::vector<Vec3i>& triangles, std::size_t vertex_count)
    : vertex_count_(vertex_count), triangles_(triangles) {
  DirectedEdges edges = directed_edges(triangles);
  // The rim of a hole runs against the edges of its triangles.
  std::multimap<int, int> rim;
  for (const auto& [edge, corner] : edges)
    if (!edges.contains({edge.second, edge.first})) rim.emplace(edge.first, edge.second);
  while (!rim.empty()) {
    std::vector<int>& hole = holes_.emplace_back();
    const int start = rim.begin()->first;
    int v = start;
    do {
      const auto next = rim.find(v);
      if (next == rim.end()) break;  // cannot happen: at every vertex as many edges end as begin
      hole.push_back(v);
      v = next->second;
      rim.erase(next);
    } while (v != start);
    const int centre = static_cast<int>(vertex_count_ + holes_.size()) - 1;
    for (std::size_t i = 0; i < hole.size(); ++i)
      triangles_.emplace_back(hole[(i + 1) % hole.size()], hole[i], centre);
  }
  edges = directed_edges(triangles_);
  for (const auto& [edge, corner] : edges)
    if (edge.first < edge.second)
      edges_.push_back({edge.first, edge.second, corner, edges.at({edge.second, edge.first})});

  const std::size_t count = vertex_count_ + holes_.size();
  first_.assign(count + 1, 0);
  for (const Vec3i& t : triangles_)
    for (const int v : t) ++first_[at(v) + 1];
  std::partial_sum(first_.begin(), first_.end(), first_.begin());
  opposite_.resize(3 * triangles_.size());
  std::vector<int> next = first_;
  for (const Vec3i& t : triangles_)
    for (int c = 0; c < 3; ++c) opposite_[at(next[at(t[c])]++)] = {t[(c + 1) % 3], t[(c + 2) % 3]};
}

std::vector<Vec3> EnclosedVolume::with_centres(ConstVectors x) const {
  std::vector<Vec3> all(x.begin(), x.end());
  for (const std::vector<int>& hole : holes_) {
    Vec3 sum = Vec3::Zero();
    for (const int v : hole) sum += x[at(v)];
    all.push_back(sum / static_cast<double>(hole.size()));
  }
  return all;
}

std::vector<Vec3> EnclosedVolume::relative(ConstVectors x) const {
  std::vector<Vec3> all = with_centres(x);
  if (triangles_.empty()) return all;
  const Vec3 origin = all[at(triangles_[0][0])];
  for (Vec3& p : all) p -= origin;
  return all;
}

double EnclosedVolume::value(ConstVectors x) const {
  const std::vector<Vec3> all = relative(x);
  return parallel_sum(triangles_.size(), volume_grain, 0.0,
                      [&](std::size_t begin, std::size_t end) {
                        double sum = 0;
                        for (std::size_t t = begin; t < end; ++t) {
                          const Vec3i& c = triangles_[t];
                          sum += all[at(c[0])].dot(all[at(c[1])].cross(all[at(c[2])]));
                        }
                        return sum;
                      }) /
         6;
}

template <class Share>
void EnclosedVolume::add_to_vertices(double factor, const Share& share, Vectors to) const {
  const auto sum = [&](std::size_t v) {
    Vec3 total = Vec3::Zero();
    for (int k = first_[v]; k < first_[v + 1]; ++k) total += share(opposite_[at(k)][0], opposite_[at(k)][1]);
    return Vec3(factor / 6 * total);
  };
  parallel_for(vertex_count_, volume_grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v)
      if (first_[v] < first_[v + 1]) to[v] += sum(v);
  });
  for (std::size_t h = 0; h < holes_.size(); ++h) {
    const Vec3 of_each = sum(vertex_count_ + h) / static_cast<double>(holes_[h].size());
    for (const int v : holes_[h]) to[at(v)] += of_each;
  }
}

void EnclosedVolume::add_gradient(ConstVectors x, double factor, Vectors g) const {
  const std::vector<Vec3> all = relative(x);
  add_to_vertices(factor, [&](int b, int c) { return Vec3(all[at(b)].cross(all[at(c)])); }, g);
}

void EnclosedVolume::add_hessian_product(ConstVectors x, ConstVectors p, double factor, Vectors y) const {
  const std::vector<Vec3> all = relative(x), moves = relative(p);
  add_to_vertices(
      factor,
      [&](int b, int c) { return Vec3(moves[at(b)].cross(all[at(c)]) + all[at(b)].cross(moves[at(c)])); }, y);
}

}  // namespace muslin
