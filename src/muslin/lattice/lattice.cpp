#include "muslin/lattice/lattice.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <sstream>
#include <utility>

#include <tbb/parallel_sort.h>

#include "muslin/core/error.hpp"
#include "muslin/core/memory.hpp"
#include "muslin/core/parallel.hpp"
#include "muslin/geometry/orientation.hpp"
#include "muslin/lattice/connect.hpp"
#include "muslin/lattice/fill.hpp"
#include "muslin/lattice/rows.hpp"
#include "muslin/lattice/surface_pieces.hpp"

namespace muslin {
namespace {

constexpr std::int64_t max_voxels = std::int64_t{1} << 30;
/// Memory of a body of many voxels while it is built, 385 measured; a run takes more.
constexpr double bytes_per_voxel = 385;
constexpr double least_fill = 1e-3;
constexpr std::size_t row_grain = 64;

std::string number(double value) {
  std::ostringstream text;
  text.precision(3);
  text << value;
  return text.str();
}

struct Size {
  double area = 0;    ///< [m²]
  double volume = 0;  ///< signed [m³]
};

Size measure(const Mesh& mesh, const Triangulation& triangulation) {
  Size size;
  const Vec3 middle = mesh.bounds().center();
  for (const Vec3i& t : triangulation.triangles) {
    const Vec3 a = mesh.positions[t[0]] - middle, b = mesh.positions[t[1]] - middle,
               c = mesh.positions[t[2]] - middle;
    size.area += 0.5 * (b - a).cross(c - a).norm();
    size.volume += a.dot(b.cross(c)) / 6;
  }
  return size;
}

[[noreturn]] void throw_too_fine(double width, double count, const Size& size) {
  // The width that gives about four million voxels.
  const double target = 1 << 22;
  const double coarser =
      std::max(std::cbrt(std::abs(size.volume) / target), std::sqrt(0.5 * size.area / target));
  throw Error(ErrorKind::input,
              "a voxel width of " + number(width) + " m would need about " + number(count) +
                  " voxels, more than 2^30",
              "use a larger voxel width; " + number(coarser) + " m gives a few million voxels");
}

/// Returns the number of voxels along each axis; near-integer multiples of the width are rounded.
VoxelKeys place_grid(const Box& bounds, const LatticeSettings& settings, const Size& size) {
  const int margin = settings.rule == VoxelRule::threshold
                         ? static_cast<int>(std::max(0.0, std::ceil(settings.threshold - 0.5 - 1e-6)))
                         : 0;
  Vec3i extent;
  int bits = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const double voxels = bounds.sizes()[axis] / settings.width;
    if (!(voxels < static_cast<double>(max_voxels))) throw_too_fine(settings.width, voxels, size);
    extent[axis] = std::max(1, static_cast<int>(std::ceil(voxels - face_tolerance))) + 2 * margin;
    bits += std::bit_width(static_cast<unsigned>(extent[axis]));
  }
  const double w = settings.width;
  // Both sides of a sheet may pass one voxel, so half the area is the least that can be needed.
  const double count = std::max(std::abs(size.volume) / (w * w * w), 0.5 * size.area / (w * w));
  if (count > static_cast<double>(max_voxels)) throw_too_fine(w, count, size);
  if (count * bytes_per_voxel > static_cast<double>(available_memory())) {
    throw Error(ErrorKind::input,
                "a voxel width of " + number(w) + " m would need about " + number(count) + " voxels and " +
                    number(count * bytes_per_voxel / 1e9) + " GB of memory, more than there is",
                "use a larger voxel width");
  }
  if (bits > 62) {
    throw Error(ErrorKind::input,
                "a voxel width of " + number(w) + " m gives a grid of more than 2^62 places",
                "use a larger voxel width");
  }
  return {bounds.center() - 0.5 * w * extent.cast<double>(), w, extent};
}

/// A voxel near the surface. `behind` is ∫ n_x dA over the surface in the voxels of its row with greater x:
/// for a closed mesh the mean winding number over the voxel's upper face.
struct Candidate {
  Vec3i voxel;
  bool crossed = false;
  bool kept = false;
  double fill = 0;
  double behind = 0;
};

/// Adds the voxels whose centre may be within the threshold of the surface though the surface is not in them.
std::vector<SurfaceVoxel> widen(std::vector<SurfaceVoxel> voxels, const VoxelKeys& grid, int steps) {
  for (int axis = 0; axis < 3; ++axis) {
    const std::size_t count = voxels.size();
    for (std::size_t v = 0; v < count; ++v) {
      for (int step = -steps; step <= steps; ++step) {
        Vec3i moved = grid.unpack(voxels[v].key);
        moved[axis] += step;
        if (step != 0 && grid.contains(moved)) voxels.push_back({grid.pack(moved), false, 0, 0});
      }
    }
    // The original comes before the copies that were moved onto it.
    std::stable_sort(voxels.begin(), voxels.end(),
                     [](const SurfaceVoxel& a, const SurfaceVoxel& b) { return a.key < b.key; });
    const auto same_voxel = [](const SurfaceVoxel& a, const SurfaceVoxel& b) { return a.key == b.key; };
    voxels.erase(std::unique(voxels.begin(), voxels.end(), same_voxel), voxels.end());
  }
  return voxels;
}

std::vector<Candidate> candidates_of(const std::vector<SurfaceVoxel>& voxels, const VoxelKeys& grid) {
  std::vector<Candidate> candidates(voxels.size());
  double behind = 0;
  for (std::size_t v = voxels.size(); v-- > 0;) {
    Candidate& candidate = candidates[v];
    candidate.voxel = grid.unpack(voxels[v].key);
    candidate.crossed = voxels[v].crossed;
    if (v + 1 < voxels.size()) {
      const Vec3i& next = candidates[v + 1].voxel;
      if (next.y() != candidate.voxel.y() || next.z() != candidate.voxel.z()) behind = 0;
    }
    candidate.behind = behind;
    candidate.fill = behind + voxels[v].moment;
    behind += voxels[v].area;
  }
  return candidates;
}

/// True if the exact volumes are valid: no part of the solid is counted twice.
bool is_simple(const std::vector<Candidate>& candidates) {
  constexpr double tolerance = 1e-5;
  return std::all_of(candidates.begin(), candidates.end(), [](const Candidate& c) {
    return c.fill > -tolerance && c.fill < 1 + tolerance && c.behind > -tolerance && c.behind < 1 + tolerance;
  });
}

class Builder {
 public:
  Builder(const SignedDistance& distance, const VoxelKeys& grid, const LatticeSettings& settings,
          const Progress& progress)
      : distance_(distance), grid_(grid), settings_(settings), progress_(progress) {}

  void decide(std::vector<Candidate>& candidates) const {
    for_batches(candidates.size(), 1024, 0.5, 0.7, [&](std::size_t begin, std::size_t end) {
      for (std::size_t c = begin; c < end; ++c) candidates[c].kept = keep(candidates[c]);
    });
  }

  void sample_fills(ConstVectors positions, std::span<const Vec3i> triangles,
                    std::vector<Candidate>& candidates) const {
    const FillSampler fill(positions, triangles, grid_);
    for_batches(candidates.size(), 16, 0.7, 0.9, [&](std::size_t begin, std::size_t end) {
      for (std::size_t c = begin; c < end; ++c) {
        Candidate& candidate = candidates[c];
        if (candidate.kept) candidate.fill = fill(candidate.voxel);
      }
    });
  }

  /// Finds the kept voxels of a closed mesh: between candidates of a row all voxels are on one side of the
  /// surface.
  void fill_rows(const std::vector<Candidate>& candidates, Lattice& lattice) const {
    std::vector<std::size_t> rows;
    for (std::size_t c = 0; c < candidates.size(); ++c)
      if (c == 0 || !same_row(candidates[c - 1], candidates[c])) rows.push_back(c);
    rows.push_back(candidates.size());

    struct Block {
      std::vector<Vec3i> voxels;
      std::vector<double> fill;
    };
    std::vector<Block> blocks((rows.size() - 1 + row_grain - 1) / row_grain);
    for_batches(rows.size() - 1, row_grain, 0.9, 0.95, [&](std::size_t begin, std::size_t end) {
      Block& block = blocks[begin / row_grain];
      for (std::size_t c = rows[begin]; c < rows[end]; ++c) {
        const Candidate& candidate = candidates[c];
        Vec3i between = candidate.voxel;
        if (c > rows[begin] && same_row(candidates[c - 1], candidate)) {
          const int first = candidates[c - 1].voxel.x() + 1, last = candidate.voxel.x() - 1;
          between.x() = first + (last - first) / 2;
          if (first <= last && distance_.inside(grid_.centre(between))) {
            for (between.x() = first; between.x() <= last; ++between.x()) {
              block.voxels.push_back(between);
              block.fill.push_back(1);
            }
          }
        }
        if (candidate.kept) {
          block.voxels.push_back(candidate.voxel);
          block.fill.push_back(candidate.fill);
        }
      }
    });
    std::int64_t count = 0;
    for (const Block& block : blocks) count += static_cast<std::int64_t>(block.voxels.size());
    require_count(count);
    lattice.voxels.reserve(count);
    lattice.fill.reserve(count);
    for (Block& block : blocks) {
      lattice.voxels.insert(lattice.voxels.end(), block.voxels.begin(), block.voxels.end());
      lattice.fill.insert(lattice.fill.end(), block.fill.begin(), block.fill.end());
      block = {};
    }
  }

  /// Finds the kept voxels of a mesh with holes: the inside is not bounded by the surface there, so it is
  /// flood-filled from the candidates. It is connected to them because the winding number, a harmonic
  /// function off the surface, has no maximum elsewhere.
  void flood(const std::vector<Candidate>& candidates, Lattice& lattice) const {
    std::vector<std::pair<std::uint64_t, double>> kept;
    std::vector<std::uint64_t> before, wave, sources;
    for (const Candidate& candidate : candidates) {
      wave.push_back(grid_.pack(candidate.voxel));
      if (candidate.kept) kept.push_back({wave.back(), candidate.fill});
    }
    sources = wave;
    while (!sources.empty()) {
      progress_.at(0.9, "lattice");
      std::vector<std::uint64_t> next = neighbours(sources);
      // A neighbour of this wave was reached by this wave, by the one before, or is new.
      for (const auto* known : {&before, &wave}) {
        std::vector<std::uint64_t> rest;
        std::set_difference(next.begin(), next.end(), known->begin(), known->end(), std::back_inserter(rest));
        next = std::move(rest);
      }
      std::vector<char> inside(next.size());
      parallel_for(next.size(), 256, [&](std::size_t begin, std::size_t end) {
        for (std::size_t n = begin; n < end; ++n)
          inside[n] = distance_.inside(grid_.centre(grid_.unpack(next[n])));
      });
      sources.clear();
      for (std::size_t n = 0; n < next.size(); ++n) {
        if (!inside[n]) continue;
        sources.push_back(next[n]);
        kept.push_back({next[n], 1.0});
      }
      require_count(static_cast<std::int64_t>(kept.size()));
      before = std::move(wave);
      wave = std::move(next);
    }
    tbb::parallel_sort(kept.begin(), kept.end());
    for (const auto& [key, fill] : kept) {
      lattice.voxels.push_back(grid_.unpack(key));
      lattice.fill.push_back(fill);
    }
  }

 private:
  static bool same_row(const Candidate& a, const Candidate& b) {
    return a.voxel.y() == b.voxel.y() && a.voxel.z() == b.voxel.z();
  }

  bool keep(const Candidate& candidate) const {
    const Vec3 centre = grid_.centre(candidate.voxel);
    if (settings_.rule == VoxelRule::cover) return candidate.crossed || distance_.inside(centre);
    return distance_(centre) < (settings_.threshold - 1e-6) * grid_.width;
  }

  static void require_count(std::int64_t count) {
    if (count > max_voxels)
      throw Error(ErrorKind::input, "the lattice would have more than 2^30 voxels",
                  "use a larger voxel width");
  }

  std::vector<std::uint64_t> neighbours(const std::vector<std::uint64_t>& sources) const {
    std::vector<std::uint64_t> found;
    for (const std::uint64_t key : sources) {
      for (int side = 0; side < 6; ++side) {
        Vec3i voxel = grid_.unpack(key);
        voxel[side / 2] += side % 2 == 0 ? -1 : 1;
        if (grid_.contains(voxel)) found.push_back(grid_.pack(voxel));
      }
    }
    tbb::parallel_sort(found.begin(), found.end());
    found.erase(std::unique(found.begin(), found.end()), found.end());
    return found;
  }

  /// Runs parallel_for in batches and reports progress from one fraction to another between them.
  template <class Body>
  void for_batches(std::size_t count, std::size_t grain, double from, double to, const Body& body) const {
    const std::size_t batch = 256 * grain;
    for (std::size_t start = 0; start < count; start += batch) {
      progress_.at(from + (to - from) * static_cast<double>(start) / static_cast<double>(count), "lattice");
      parallel_for(std::min(batch, count - start), grain,
                   [&](std::size_t begin, std::size_t end) { body(start + begin, start + end); });
    }
  }

  const SignedDistance& distance_;
  const VoxelKeys& grid_;
  const LatticeSettings& settings_;
  const Progress& progress_;
};

void require_settings(const LatticeSettings& settings) {
  if (!(settings.width > 0) || !std::isfinite(settings.width))
    throw Error(ErrorKind::usage, "the voxel width is not a positive number",
                "give a width in metres above 0");
  if (settings.rule == VoxelRule::threshold && !(std::abs(settings.threshold) <= 100))
    throw Error(ErrorKind::usage, "the threshold is not a number of voxel widths between -100 and 100",
                "0.5 covers most meshes");
}

int find(const std::vector<Vec3i>& sorted, const Vec3i& coordinates) {
  const auto at = std::lower_bound(sorted.begin(), sorted.end(), coordinates, row_order);
  return at != sorted.end() && *at == coordinates ? static_cast<int>(at - sorted.begin()) : -1;
}

}  // namespace

int Lattice::find_voxel(const Vec3i& coordinates) const { return find(voxels, coordinates); }
int Lattice::find_vertex(const Vec3i& coordinates) const { return find(vertices, coordinates); }

Vec3 Lattice::offset(const Vec3i& coordinates) const {
  Vec3 offset = Vec3::Zero();
  for (const LatticeSlab& slab : slabs) {
    if (coordinates[slab.axis] < slab.first) break;
    offset = slab.offset;
  }
  return offset;
}

Lattice build_lattice(const Mesh& mesh, const SignedDistance& distance, const LatticeSettings& settings,
                      const Progress& progress) {
  require_settings(settings);
  progress.at(0, "lattice");
  Triangulation triangulation = triangulate(mesh);
  OrientedTriangles oriented = orient(mesh.positions, triangulation.triangles);
  triangulation.triangles = std::move(oriented.triangles);
  const Size size = measure(mesh, triangulation);
  const VoxelKeys grid = place_grid(mesh.bounds(), settings, size);

  auto surface = cut_surface(mesh, triangulation, grid, progress);
  if (settings.rule == VoxelRule::threshold) {
    const double reach = std::ceil(std::abs(settings.threshold) - 0.5 - 1e-6);
    if (reach > 0) surface = widen(std::move(surface), grid, static_cast<int>(reach));
  }
  std::vector<Candidate> candidates = candidates_of(surface, grid);
  surface = {};

  const Builder builder(distance, grid, settings, progress);
  builder.decide(candidates);
  if (!oriented.watertight || !is_simple(candidates))
    builder.sample_fills(mesh.positions, triangulation.triangles, candidates);

  Lattice lattice;
  lattice.origin = grid.origin;
  lattice.width = grid.width;
  lattice.extent = grid.extent;
  if (oriented.watertight) {
    builder.fill_rows(candidates, lattice);
  } else {
    builder.flood(candidates, lattice);
  }
  if (lattice.voxels.empty()) {
    throw Error(ErrorKind::input,
                "no voxel is kept: no voxel centre is closer to the solid than the threshold",
                "use the cover rule, a higher threshold or a smaller voxel width");
  }
  for (double& fill : lattice.fill) fill = std::clamp(fill, least_fill, 1.0);

  if (settings.rule == VoxelRule::threshold) {
    std::vector<std::uint64_t> keys;
    keys.reserve(lattice.voxels.size());
    for (const Vec3i& voxel : lattice.voxels) keys.push_back(grid.pack(voxel));
    lattice.coverage = std::min(1.0, area_within(mesh, triangulation, grid, keys) / size.area);
  }
  progress.at(0.95, "lattice");
  connect_voxels(lattice);
  progress.at(1, "lattice");
  return lattice;
}

}  // namespace muslin
