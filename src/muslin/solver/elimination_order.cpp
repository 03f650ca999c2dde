#include "muslin/solver/elimination_order.hpp"

#include <algorithm>
#include <cassert>
#include <cstdlib>
#include <numeric>
#include <tuple>
#include <utility>

#include "muslin/core/index.hpp"

namespace muslin {
namespace {

constexpr int smallest_slab = 4096;  // vertices: below, threads gain nothing
constexpr int usual_slab = 131072;   // vertices: every second border between slabs costs iterations
constexpr int max_slabs = 64;
constexpr int reaches_per_slab = 4;  // the layers between slabs must be thin beside the slabs

/// One slab, or an even number of them.
int slab_count(int vertex_count, int reach) {
  const int most = vertex_count / std::max(smallest_slab, reaches_per_slab * reach) / 2 * 2;
  if (most < 2) return 1;
  return std::clamp(vertex_count / usual_slab / 2 * 2, 2, std::min(max_slabs, most));
}

using Pair = std::pair<int, int>;

/// Calls body(a, b, kind, index) for every coupling.
template <class Body>
void for_each_coupling(std::span<const CouplingRun> runs, const Body& body) {
  std::int64_t index = 0;
  for (const CouplingRun& run : runs)
    for (int i = 0; i < run.length; ++i) body(run.a + i, run.b + i, run.kind, index++);
}

/// A layer of a sheet is a chain along its rows, with one or two vertices per level. Its rows are eliminated
/// from both ends towards the middle, which drops no more fill-in than from one end, in parallel with those
/// of other layers.
template <class Split>
void gather_thin_layers(std::span<const CouplingRun> runs, int slabs, Split& split) {
  std::vector<std::vector<Pair>> inside(at(3 * slabs));  // couplings of each layer
  for_each_coupling(runs, [&](int a, int b, int, std::int64_t) {
    const int t = split.task[at(a)];
    if (split.task[at(b)] == t && (t < slabs || t >= 2 * slabs))
      inside[at(t)].push_back({std::max(a, b), std::min(a, b)});
  });
  std::vector<int> level(split.task.size());
  const auto depth = [&level](const std::vector<Pair>& couplings) {
    int deepest = 0;
    for (const auto& [high, low] : couplings) {
      level[at(high)] = std::max(level[at(high)], level[at(low)] + 1);
      deepest = std::max(deepest, level[at(high)]);
    }
    return deepest + 1;
  };
  for (const int phase : {0, 2 * slabs}) {
    std::vector<int> thin;
    int host = -1;
    std::size_t room = 0;
    for (int t = phase; t < phase + slabs; ++t) {
      std::vector<int>& vertices = split.members[at(t)];
      std::vector<Pair>& couplings = inside[at(t)];
      std::sort(couplings.begin(), couplings.end());
      const std::size_t size = vertices.size(), wide = at(EliminationOrder::lanes) * at(depth(couplings));
      if (size == 0 || size >= wide) continue;
      for (std::size_t begin = 0, end = 0; begin < size; begin = end) {
        do ++end;
        while (end < size && std::binary_search(couplings.begin(), couplings.end(),
                                                Pair{vertices[end], vertices[end] - 1}));
        for (std::size_t i = begin; i < end; ++i) {
          const bool nearer_to_end = 2 * i > begin + end - 1;
          level[at(vertices[i])] = static_cast<int>(nearer_to_end ? 2 * (end - 1 - i) + 1 : 2 * (i - begin));
        }
      }
      if (host < 0 || room < size) {
        host = t;
        thin.push_back(t);
        room = wide / 2;
      } else {
        for (const int v : vertices) split.task[at(v)] = host;
        split.members[at(host)].insert(split.members[at(host)].end(), vertices.begin(), vertices.end());
        vertices.clear();
      }
      room -= std::min(room, size);
    }
    for (const int t : thin) {
      std::vector<int>& vertices = split.members[at(t)];
      std::sort(vertices.begin(), vertices.end(), [&](int u, int v) {
        const int of_u = level[at(u)], of_v = level[at(v)];
        return of_u != of_v ? of_u < of_v : of_u % 2 == 0 ? u < v : u > v;
      });
    }
  }
}

}  // namespace

bool EliminationOrder::Split::before(int u, int v) const {
  const int task_u = task[at(u)], task_v = task[at(v)];
  return task_u != task_v ? task_u < task_v : rank[at(u)] < rank[at(v)];
}

EliminationOrder::EliminationOrder(std::span<const CouplingRun> runs, int vertex_count,
                                   std::vector<std::int64_t>* order) {
  position_.resize(at(vertex_count));
  const Split split = this->split(runs);
  EarlierEnds earlier;
  earlier.begin.assign(at(vertex_count) + 1, 0);
  for_each_coupling(
      runs, [&](int a, int b, int, std::int64_t) { ++earlier.begin[at(split.before(a, b) ? b : a) + 1]; });
  std::partial_sum(earlier.begin.begin(), earlier.begin.end(), earlier.begin.begin());
  earlier.couplings.resize(at(earlier.begin.back()));
  std::vector<std::int64_t> fill(earlier.begin.begin(), earlier.begin.end() - 1);
  for_each_coupling(runs, [&](int a, int b, int kind, std::int64_t index) {
    if (split.before(b, a)) std::swap(a, b);
    earlier.couplings[at(fill[at(b)]++)] = {a, 2 * kind + (a < b ? 1 : 0), index};
  });
  // In the layers of a thin sheet, vertices with many couplings are best separated from those with few; in
  // other shapes that breaks runs of neighbours.
  arrange(earlier, split, true);
  make_blocks(earlier, order);
  const std::size_t blocks = blocks_.size();
  arrange(earlier, split, false);
  make_blocks(earlier, order);
  if (blocks < blocks_.size()) {
    arrange(earlier, split, true);
    make_blocks(earlier, order);
  }
  make_links();
}

EliminationOrder::Split EliminationOrder::split(std::span<const CouplingRun> runs) const {
  int reach = 0;
  for (const CouplingRun& run : runs) {
    assert(run.kind >= 0 && run.kind < 256);
    reach = std::max(reach, std::abs(run.b - run.a));
  }
  const int slabs = slab_count(vertex_count(), reach);
  // Tasks 0 … slabs − 1 are the layers that go first, then the slabs, then the layers eliminated last.
  Split split;
  split.phase = {0, slabs, 2 * slabs, 3 * slabs};
  split.task.resize(position_.size());
  std::vector<int> slab(position_.size());
  for (int s = 0; s < slabs; ++s) {
    const std::int64_t count = vertex_count(), begin = count * s / slabs, end = count * (s + 1) / slabs;
    std::fill(slab.begin() + begin, slab.begin() + end, s);
    std::fill(split.task.begin() + begin, split.task.begin() + end, slabs + s);
  }
  for_each_coupling(runs, [&](int a, int b, int, std::int64_t) {
    assert(a != b);
    const int low = std::min(a, b), high = std::max(a, b), s = slab[at(high)];
    if (slab[at(low)] != s) split.task[at(high)] = s % 2 == 0 ? s : 2 * slabs + s;
  });
  split.members.resize(at(3 * slabs));
  for (int v = 0; v < vertex_count(); ++v) split.members[at(split.task[at(v)])].push_back(v);
  for (int t = slabs + 1; t < 2 * slabs; t += 2)
    std::reverse(split.members[at(t)].begin(), split.members[at(t)].end());
  gather_thin_layers(runs, slabs, split);
  split.rank.resize(position_.size());
  for (const std::vector<int>& vertices : split.members)
    for (std::size_t i = 0; i < vertices.size(); ++i) split.rank[at(vertices[i])] = static_cast<int>(i);
  return split;
}

void EliminationOrder::arrange(const EarlierEnds& earlier, const Split& split, bool by_count) {
  vertex_.clear(), groups_.clear(), tasks_.clear(), phases_.clear();
  const int count = vertex_count();
  std::int64_t most = 0;  // couplings of a vertex with earlier ones
  for (int v = 0; v < count; ++v) most = std::max(most, earlier.begin[at(v) + 1] - earlier.begin[at(v)]);

  const auto empty_group = [&] {
    groups_.emplace_back();
    vertex_.insert(vertex_.end(), lanes, -1);
  };
  empty_group();
  std::vector<int> level(at(count));
  struct Place {
    int level;
    bool crowded;
    int rank;
    auto operator<=>(const Place&) const = default;
  };
  std::vector<Place> places;
  for (std::size_t phase = 0; phase + 1 < split.phase.size(); ++phase) {
    phases_.push_back(static_cast<int>(tasks_.size()));
    for (int t = split.phase[phase]; t < split.phase[phase + 1]; ++t) {
      const std::vector<int>& vertices = split.members[at(t)];
      if (vertices.empty()) continue;
      places.clear();
      for (std::size_t rank = 0; rank < vertices.size(); ++rank) {
        const int v = vertices[rank];
        int highest = 0;
        for (std::int64_t i = earlier.begin[at(v)]; i < earlier.begin[at(v) + 1]; ++i) {
          const int u = earlier.couplings[at(i)].vertex;
          if (split.task[at(u)] == t) highest = std::max(highest, level[at(u)] + 1);
        }
        level[at(v)] = highest;
        const bool crowded = by_count && 2 * (earlier.begin[at(v) + 1] - earlier.begin[at(v)]) > most;
        places.push_back({highest, crowded, static_cast<int>(rank)});
      }
      std::sort(places.begin(), places.end());
      Task task;
      task.group_begin = static_cast<int>(groups_.size());
      // A group takes consecutive vertices as long as none of them are coupled.
      std::size_t base = 0, taken = lanes;
      for (const Place& place : places) {
        const int v = vertices[at(place.rank)];
        bool waits = taken == lanes;
        for (std::int64_t i = earlier.begin[at(v)]; i < earlier.begin[at(v) + 1] && !waits; ++i) {
          const int u = earlier.couplings[at(i)].vertex;
          waits = split.task[at(u)] == t && at(position_[at(u)]) >= base;
        }
        if (waits) {
          base = vertex_.size();
          taken = 0;
          empty_group();
        }
        vertex_[base + taken] = v;
        position_[at(v)] = static_cast<int>(base + taken++);
      }
      task.group_end = static_cast<int>(groups_.size());
      tasks_.push_back(task);
      empty_group();  // reads past the ends of a task then do not touch data another one writes
    }
  }
  phases_.push_back(static_cast<int>(tasks_.size()));
}

void EliminationOrder::make_blocks(const EarlierEnds& earlier, std::vector<std::int64_t>* order) {
  struct Entry {
    int kind, lane, base;  // base: position of the earlier end less the lane
    std::int64_t index;
  };
  blocks_.clear();
  if (order) order->clear();
  std::vector<Entry> entries;
  for (std::size_t g = 0; g < groups_.size(); ++g) {
    entries.clear();
    for (int l = 0; l < lanes; ++l) {
      const int v = vertex_[g * lanes + at(l)];
      if (v < 0) continue;
      for (std::int64_t i = earlier.begin[at(v)]; i < earlier.begin[at(v) + 1]; ++i) {
        const Coupling& c = earlier.couplings[at(i)];
        entries.push_back({c.kind, l, position_[at(c.vertex)] - l, c.index});
      }
    }
    std::stable_sort(entries.begin(), entries.end(), [](const Entry& p, const Entry& q) {
      return std::tie(p.kind, p.lane) < std::tie(q.kind, q.lane);
    });
    groups_[g].block_begin = static_cast<int>(blocks_.size());
    // A block takes lanes in ascending order for as long as two bases are enough.
    int kind = -1, last_lane = lanes, breaks = 2;
    for (const Entry& e : entries) {
      const bool fits =
          e.kind == kind && e.lane > last_lane && (e.base == blocks_.back().second || breaks == 0);
      if (!fits) {
        blocks_.push_back({static_cast<int>(g), e.base, e.base, 0, static_cast<std::uint8_t>(e.kind / 2), 0});
        if (order) order->insert(order->end(), lanes, -1);
        breaks = 0;
      } else if (e.base != blocks_.back().second) {
        blocks_.back().second = e.base;
        blocks_.back().cut = static_cast<std::uint8_t>(e.lane);
        breaks = 1;
      }
      kind = e.kind;
      last_lane = e.lane;
      blocks_.back().used = static_cast<std::uint16_t>(blocks_.back().used | 1U << e.lane);
      if (order) (*order)[(blocks_.size() - 1) * lanes + at(e.lane)] = e.index;
    }
    groups_[g].block_end = static_cast<int>(blocks_.size());
  }
}

void EliminationOrder::make_links() {
  struct Entry {
    int kind, block, shift, lane;  // lane of the earlier end; that of the later one less it
  };
  const auto for_each_end = [&](const auto& body) {
    for (std::size_t b = 0; b < blocks_.size(); ++b) {
      const Block& block = blocks_[b];
      for (int l = 0; l < lanes; ++l) {
        if ((block.used >> l & 1) == 0) continue;
        const int position = l + (l < block.cut ? block.first : block.second);
        body(position / lanes,
             Entry{block.kind, static_cast<int>(b), l - position % lanes, position % lanes});
      }
    }
  };
  std::vector<std::int64_t> begin(groups_.size() + 1);
  for_each_end([&](int group, const Entry&) { ++begin[at(group) + 1]; });
  std::partial_sum(begin.begin(), begin.end(), begin.begin());
  std::vector<Entry> entries(at(begin.back()));
  std::vector<std::int64_t> fill(begin.begin(), begin.end() - 1);
  for_each_end([&](int group, const Entry& e) { entries[at(fill[at(group)]++)] = e; });

  for (std::size_t g = 0; g < groups_.size(); ++g) {
    const auto first = entries.begin() + begin[g], last = entries.begin() + begin[g + 1];
    std::sort(first, last, [](const Entry& p, const Entry& q) {
      return std::tie(p.kind, p.block, p.shift, p.lane) < std::tie(q.kind, q.block, q.shift, q.lane);
    });
    groups_[g].link_begin = static_cast<int>(links_.size());
    int kind = -1, halves = 2;
    for (auto e = first; e != last;) {
      // One stretch: the lanes that one block serves at one distance.
      auto end = e;
      std::uint16_t used = 0;
      for (; end != last && end->block == e->block && end->shift == e->shift; ++end)
        used = static_cast<std::uint16_t>(used | 1U << end->lane);
      const bool fits = e->kind == kind && halves == 1 && (links_.back().used[0] & used) == 0;
      if (!fits) {
        links_.emplace_back();
        halves = 0;
      }
      Link& link = links_.back();
      for (std::size_t h = at(halves); h < 2; ++h) {  // the second half is like the first until it is known
        link.block[h] = e->block;
        link.shift[h] = static_cast<std::int8_t>(e->shift);
        link.position[h] = lanes * blocks_[at(e->block)].group + e->shift;
        link.used[h] = h == at(halves) ? used : std::uint16_t{0};
      }
      ++halves;
      kind = e->kind;
      e = end;
    }
    groups_[g].link_end = static_cast<int>(links_.size());
  }
}

std::size_t EliminationOrder::bytes() const {
  return (vertex_.size() + position_.size()) * sizeof(int) + groups_.size() * sizeof(Group) +
         blocks_.size() * sizeof(Block) + links_.size() * sizeof(Link) + tasks_.size() * sizeof(Task) +
         phases_.size() * sizeof(int);
}

}  // namespace muslin
