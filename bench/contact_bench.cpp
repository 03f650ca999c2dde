// Speeds of the parts of contact, on cloth draped over a sphere.
#include <memory>
#include <vector>

#include "support/draped_cloth.hpp"
#include <benchmark/benchmark.h>

#include "muslin/contact/pair_search.hpp"

namespace muslin {
namespace {

struct Drape {
  test::ClothGrid rest, cloth;
  std::shared_ptr<const ContactSurface> surface;
  double distance;  ///< contact distance: 2 mm, or a fifth of an edge if that is less [m]

  explicit Drape(int n) : rest(n, n, 1.0 / (n - 1)), cloth(test::draped_cloth(n)) {
    surface = std::make_shared<ContactSurface>(cloth.triangles, std::vector<int>(cloth.positions.size(), 0),
                                               std::vector<ContactBody>{{}});
    distance = std::min(2e-3, 0.2 / (n - 1));
  }
  /// Where the points go in a step of 1/240 s when the cloth falls slowly [m].
  std::vector<Vec3> moved() const {
    std::vector<Vec3> after = cloth.positions;
    for (Vec3& p : after) p += Vec3(0.1, -0.5, 0.05) / 240;
    return after;
  }
};

void find_pairs(benchmark::State& state, bool moving) {
  const Drape drape(static_cast<int>(state.range(0)));
  PairSearch search(drape.surface, drape.rest.positions);
  const std::vector<Vec3> after = moving ? drape.moved() : drape.cloth.positions;
  std::vector<Vec3> lower, upper;
  for (std::size_t p = 0; p < after.size(); ++p) {
    lower.push_back(after[p].cwiseMin(drape.cloth.positions[p]));
    upper.push_back(after[p].cwiseMax(drape.cloth.positions[p]));
  }
  FeaturePairs found;
  for (auto _ : state) {
    search.find(lower, upper, drape.distance, found);
    benchmark::DoNotOptimize(found);
  }
  state.counters["vertex_triangle"] = static_cast<double>(found.vertex_triangle.size());
  state.counters["edge_edge"] = static_cast<double>(found.edge_edge.size());
}

void broad_phase_at_rest(benchmark::State& state) { find_pairs(state, false); }
void broad_phase_moving(benchmark::State& state) { find_pairs(state, true); }
BENCHMARK(broad_phase_at_rest)->Arg(50)->Arg(100)->Arg(300)->Unit(benchmark::kMillisecond);
BENCHMARK(broad_phase_moving)->Arg(50)->Arg(100)->Arg(300)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace muslin

BENCHMARK_MAIN();
