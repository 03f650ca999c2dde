// PageContent gathers the data of a run for a page: moving points, surfaces on them, pins, forces, curves.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "muslin/cache/run_reader.hpp"
#include "muslin/core/progress.hpp"

namespace muslin {

/// Moving points: all or some of one of the run's caches.
struct PageTrack {
  enum class Source { skin, contour, selectable } source = Source::skin;
  int body = 0;
  bool all = true;
  std::vector<int> picked;  ///< otherwise: the selected points of the cache
  std::size_t count = 0;
  Vec3 low = Vec3::Zero(), size = Vec3::Zero();  ///< the box of their whole motion [m]

  std::vector<Vec3f> at(const RunReader& run, int frame) const;
};

struct PageContent {
  nlohmann::ordered_json head;    ///< describes everything; arrays by their place in `arrays`
  std::string arrays;             ///< numbers, little-endian, each array at a multiple of 4
  std::vector<PageTrack> tracks;  ///< in their order in a frame
};

/// Errors: input, if a position is not finite.
PageContent page_content(const RunReader& run, bool skins_only, const Progress& progress);

}  // namespace muslin
