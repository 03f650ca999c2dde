// Speeds of the parts of contact, on cloth draped over a sphere.
#include <memory>
#include <vector>

#include "support/draped_cloth.hpp"
#include <benchmark/benchmark.h>

#include "muslin/contact/contact_candidates.hpp"
#include "muslin/contact/contact_potential.hpp"
#include "muslin/contact/intersections.hpp"
#include "muslin/contact/pair_search.hpp"
#include "muslin/contact/step_limiter.hpp"
#include "muslin/contact/surface_map.hpp"
#include "muslin/core/parallel.hpp"

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
  /// Returns the points after a step of 1/240 s in which the cloth falls slowly [m].
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
  MovingBoxes boxes(after.size());
  for (std::size_t p = 0; p < after.size(); ++p) boxes.stay(p, drape.cloth.positions[p], after[p], 0);
  FeaturePairs found;
  for (auto _ : state) {
    search.find(boxes, drape.distance, found);
    benchmark::DoNotOptimize(found);
  }
  state.counters["vertex_triangle"] = static_cast<double>(found.vertex_triangle.size());
  state.counters["edge_edge"] = static_cast<double>(found.edge_edge.size());
}

void broad_phase_at_rest(benchmark::State& state) { find_pairs(state, false); }
void broad_phase_moving(benchmark::State& state) { find_pairs(state, true); }
BENCHMARK(broad_phase_at_rest)->Arg(50)->Arg(100)->Arg(300)->Unit(benchmark::kMillisecond);
BENCHMARK(broad_phase_moving)->Arg(50)->Arg(100)->Arg(300)->Unit(benchmark::kMillisecond);

/// Cloth on the sphere, a lone point of 0.25 m radius, in contact with it over the whole cap.
struct Contact {
  Drape drape;
  std::vector<Vec3> rest, x, step;
  std::shared_ptr<const ContactSurface> surface;
  std::shared_ptr<const SurfaceMap> map;

  explicit Contact(int n) : drape(n), rest(drape.rest.positions), x(drape.cloth.positions) {
    std::vector<Vec3i> triangles = drape.cloth.triangles;
    std::vector<int> bodies(x.size(), 0);
    const int ball = static_cast<int>(x.size());
    triangles.emplace_back(ball, ball, ball);
    bodies.push_back(1);
    rest.push_back(Vec3(0, -1, 0));
    x.push_back(Vec3::Zero());
    surface = std::make_shared<ContactSurface>(triangles, bodies,
                                               std::vector<ContactBody>{{}, {0.2499, false, true}});
    map = std::make_shared<SurfaceMap>(SurfaceMap::identity(x.size()));
    step.assign(x.size(), Vec3(0.1, -0.5, 0.05) / 240);
    step.back().setZero();
  }
  std::vector<Vec3> after() const {
    std::vector<Vec3> to = x;
    for (std::size_t v = 0; v < to.size(); ++v) to[v] += step[v];
    return to;
  }
};

void find_candidates(benchmark::State& state) {
  const Contact contact(static_cast<int>(state.range(0)));
  ContactCandidates candidates(contact.surface, contact.rest, contact.drape.distance);
  const std::vector<Vec3> after = contact.after();
  for (auto _ : state) candidates.update(contact.x, after, contact.drape.distance / 4);
  state.counters["pairs"] = static_cast<double>(candidates.pairs().size());
}

void limit_step(benchmark::State& state) {
  const Contact contact(static_cast<int>(state.range(0)));
  ContactCandidates candidates(contact.surface, contact.rest, contact.drape.distance);
  candidates.update(contact.x, contact.after(), contact.drape.distance / 4);
  PairDistances distances(candidates);
  const StepLimiter limiter(contact.map, {});
  LimitReport report;
  for (auto _ : state) {
    std::vector<Vec3> step = contact.step;
    distances.forget();
    distances.update(contact.x);
    report = limiter.limit(distances, step);
    benchmark::DoNotOptimize(step);
  }
  state.counters["deflected"] = static_cast<double>(report.deflected);
  state.counters["shortened"] = static_cast<double>(report.shortened);
}

void make_potential(benchmark::State& state) {
  const Contact contact(static_cast<int>(state.range(0)));
  ContactCandidates candidates(contact.surface, contact.rest, contact.drape.distance);
  candidates.update(contact.x, contact.after(), contact.drape.distance / 4);
  std::size_t pairs = 0;
  PairDistances distances(candidates);
  for (auto _ : state) {
    distances.forget();
    distances.update(contact.x);
    const ContactPotential w(distances, contact.map, contact.x, {0.3, 4e-6}, contact.x);
    pairs = w.term_count();
  }
  state.counters["pairs"] = static_cast<double>(pairs);
}

void contact_gradient(benchmark::State& state) {
  const Contact contact(static_cast<int>(state.range(0)));
  ContactCandidates candidates(contact.surface, contact.rest, contact.drape.distance);
  candidates.update(contact.x, contact.after(), contact.drape.distance / 4);
  PairDistances distances(candidates);
  distances.update(contact.x);
  const ContactPotential w(distances, contact.map, contact.x, {0.3, 4e-6}, contact.x);
  std::vector<Vec3> g(contact.x.size(), Vec3::Zero());
  for (auto _ : state) {
    w.add_gradient(contact.x, g);
    benchmark::DoNotOptimize(g);
  }
}

void referee(benchmark::State& state) {
  const Drape drape(static_cast<int>(state.range(0)));
  std::size_t found = 0;
  for (auto _ : state) found = find_intersections(drape.cloth.positions, drape.cloth.triangles).size();
  state.counters["crossings"] = static_cast<double>(found);
}

BENCHMARK(find_candidates)->Arg(50)->Arg(100)->Arg(200)->Unit(benchmark::kMillisecond);
BENCHMARK(limit_step)->Arg(50)->Arg(100)->Arg(200)->Unit(benchmark::kMillisecond);
BENCHMARK(make_potential)->Arg(50)->Arg(100)->Arg(200)->Unit(benchmark::kMillisecond);
BENCHMARK(contact_gradient)->Arg(50)->Arg(100)->Arg(200)->Unit(benchmark::kMillisecond);
BENCHMARK(referee)->Arg(50)->Arg(100)->Arg(200)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace muslin

int main(int argc, char** argv) {
  muslin::set_thread_count(1);
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
}
