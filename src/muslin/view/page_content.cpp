#include "muslin/view/page_content.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "muslin/core/error.hpp"
#include "muslin/geometry/thicken.hpp"
#include "muslin/render/scene_view.hpp"
#include "muslin/surface/edge_stretch.hpp"
#include "muslin/version.hpp"
#include "muslin/view/page_surface.hpp"

namespace muslin {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t max_pinned_points = 400;  ///< drawn of one pin

Json triple(const Vec3& v) { return Json::array({v.x(), v.y(), v.z()}); }

/// Reads three finite numbers from a scene, perhaps of another version; nothing if invalid.
Json triple_or_null(const Json& value) {
  const bool good = value.is_array() && value.size() == 3 &&
                    std::all_of(value.begin(), value.end(), [](const Json& x) { return x.is_number(); });
  return good ? value : Json();
}

class Gatherer {
 public:
  Gatherer(const RunReader& run, bool skins_only) : run_(run), skins_only_(skins_only) {}

  PageContent gather(const Progress& progress) {
    describe_run();
    for (std::size_t b = 0; b < run_.bodies().size(); ++b) add_body(static_cast<int>(b));
    add_pins();
    add_forces();
    add_curves();
    measure(progress);
    return std::move(content_);
  }

 private:
  template <class Number>
  Json array(const std::vector<Number>& numbers) {
    static_assert(sizeof(Number) == 4);
    Json place = {{"at", content_.arrays.size()}, {"count", numbers.size()}};
    content_.arrays.append(reinterpret_cast<const char*>(numbers.data()), 4 * numbers.size());
    return place;
  }

  int add_track(PageTrack::Source source, int body, std::size_t cached, const std::vector<int>* picked) {
    PageTrack track;
    track.source = source;
    track.body = body;
    track.all = picked == nullptr || picked->size() == cached;
    if (!track.all) track.picked = *picked;
    track.count = picked ? picked->size() : cached;
    content_.tracks.push_back(std::move(track));
    stretches_.emplace_back();
    return static_cast<int>(content_.tracks.size()) - 1;
  }

  void describe_run() {
    const std::string name = run_.directory().filename().empty()
                                 ? run_.directory().parent_path().filename().string()
                                 : run_.directory().filename().string();
    content_.head = {{"format", 1},
                     {"muslin", version()},
                     {"title", run_.title().empty() ? name : run_.title()},
                     {"status", name_of(run_.status())},
                     {"frame_rate", run_.frame_rate()},
                     {"frame_count", run_.frame_count()},
                     {"last_frame", run_.last_frame()},
                     {"bodies", Json::array()}};
  }

  void add_surface(Json& body, const char* kind, const Mesh& mesh, int track) {
    const PageSurface surface = page_surface(mesh);
    body["surfaces"][kind] = {{"track", track},
                              {"triangles", array(surface.triangles)},
                              {"points", array(surface.points)},
                              {"normals", array(surface.normals)},
                              {"normal_count", surface.normal_count},
                              {"pattern", array(surface.pattern)},
                              {"ends", array(surface.ends)},
                              {"rest_lengths", array(surface.rest_lengths)}};
    stretches_[static_cast<std::size_t>(track)] = EdgeStretch(mesh);
  }

  void add_body(int b) {
    const Vec3 colour = run_.colour(b);
    const Mesh& skin = run_.mesh(b, SurfaceKind::skin);
    const bool closed = is_closed(skin);
    const Look look = closed ? solid_look(colour) : fabric_look(colour);
    Json body = {{"name", run_.bodies()[static_cast<std::size_t>(b)]},
                 {"colour", triple(look.colour)},
                 {"back_colour", triple(look.back_colour.value_or(look.colour))},
                 {"solid", closed},
                 {"surfaces", Json::object()}};
    add_surface(body, "skin", skin, add_track(PageTrack::Source::skin, b, skin.vertex_count(), nullptr));
    if (!skins_only_ && run_.has(b, SurfaceKind::contour)) {
      const Mesh& contour = run_.mesh(b, SurfaceKind::contour);
      if (contour.vertex_count() > 0)
        add_surface(body, "contour", contour,
                    add_track(PageTrack::Source::contour, b, contour.vertex_count(), nullptr));
    }
    if (!skins_only_ && run_.has_cells(b)) {
      const CellsOutside outside = outside_of(run_.cells(b));
      add_surface(body, "lattice", outside.mesh,
                  add_track(PageTrack::Source::selectable, b, run_.selectable_count(b), &outside.vertices));
    }
    content_.head["bodies"].push_back(std::move(body));
  }

  /// Adds a track of the vertices of a pin or force; evenly thinned if there are very many.
  int add_chosen(const Chosen& chosen) {
    std::vector<int> vertices;
    const std::size_t stride = (chosen.vertices.size() + max_pinned_points - 1) / max_pinned_points;
    for (std::size_t i = 0; i < chosen.vertices.size(); i += stride) vertices.push_back(chosen.vertices[i]);
    return add_track(PageTrack::Source::selectable, chosen.body, run_.selectable_count(chosen.body),
                     &vertices);
  }

  void add_pins() {
    content_.head["pins"] = Json::array();
    for (const Chosen& pin : run_.selections().pins) {
      Json entry = {{"name", pin.name}, {"body", pin.body}, {"from", pin.from}, {"track", add_chosen(pin)}};
      entry["until"] = std::isfinite(pin.until) ? Json(pin.until) : Json();
      entry["vertices"] = pin.vertices.size();
      content_.head["pins"].push_back(std::move(entry));
    }
  }

  void add_forces() {
    content_.head["forces"] = Json::array();
    const Json scene = Json::parse(run_.resolved_scene(), nullptr, false);
    const Json forces = scene.is_object() ? scene.value("force", Json::array()) : Json::array();
    for (std::size_t f = 0; f < forces.size(); ++f) {
      const Json& force = forces[f];
      if (!force.is_object()) continue;
      Json entry = {{"name", force.value("name", Json())}, {"type", force.value("type", Json())}};
      if (!entry["name"].is_string() || !entry["type"].is_string()) continue;
      entry["keys"] = Json::array();
      for (const char* key : {"acceleration", "force", "velocity"}) {
        const Json value = triple_or_null(force.value(key, Json()));
        if (!value.is_null()) entry["keys"].push_back({{"time", 0}, {"value", value}});
      }
      for (const Json& key : force.value("keyframes", Json::array())) {
        if (!key.is_object() || !key.value("time", Json()).is_number()) continue;
        const Json value = triple_or_null(key.value("value", Json()));
        if (!value.is_null()) entry["keys"].push_back({{"time", key["time"]}, {"value", value}});
      }
      if (entry["keys"].empty()) continue;
      for (const char* key : {"from", "until"}) {
        const Json time = force.value(key, Json());
        entry[key] = time.is_number() ? time : Json();
      }
      for (const Chosen& chosen : run_.selections().point_forces)
        if (chosen.force == static_cast<int>(f)) entry["track"] = add_chosen(chosen);
      for (std::size_t b = 0; b < run_.bodies().size(); ++b)
        if (force.value("body", Json()) == Json(run_.bodies()[b])) entry["body"] = b;
      content_.head["forces"].push_back(std::move(entry));
    }
  }

  void add_curves() {
    const std::vector<std::pair<const char*, double Diagnostics::*>> columns = {
        {"time", &Diagnostics::time},
        {"kinetic", &Diagnostics::kinetic},
        {"elastic", &Diagnostics::elastic},
        {"potential", &Diagnostics::potential},
        {"work", &Diagnostics::work},
        {"dissipated", &Diagnostics::dissipated},
        {"max_stretch", &Diagnostics::max_stretch},
        {"min_distance", &Diagnostics::min_distance}};
    Json curves = Json::object();
    for (const auto& [name, column] : columns) {
      std::vector<float> values;
      for (const Diagnostics& row : run_.diagnostics()) values.push_back(static_cast<float>(row.*column));
      curves[name] = array(values);
    }
    content_.head["curves"] = std::move(curves);
  }

  /// Computes the boxes of all motions, and the largest stretch of each surface.
  void measure(const Progress& progress) {
    std::vector<Box> boxes(content_.tracks.size());
    std::vector<double> largest(content_.tracks.size(), 0.0);
    std::vector<Vec3> wide;
    for (int frame = 0; frame < run_.frame_count(); ++frame) {
      progress.at(static_cast<double>(frame) / run_.frame_count(), "measuring");
      for (std::size_t t = 0; t < content_.tracks.size(); ++t) {
        wide.clear();
        for (const Vec3f& point : content_.tracks[t].at(run_, frame)) {
          if (!point.allFinite()) {
            throw Error(ErrorKind::input, {run_.directory().string()},
                        fmt::format("body \"{}\" has a position that is not finite at frame {}",
                                    run_.bodies()[static_cast<std::size_t>(content_.tracks[t].body)], frame),
                        "run the scene again");
          }
          wide.push_back(point.cast<double>());
          boxes[t].extend(wide.back());
        }
        if (!stretches_[t]) continue;
        for (const double percent : stretches_[t]->at(wide)) largest[t] = std::max(largest[t], percent);
      }
    }
    content_.head["tracks"] = Json::array();
    for (std::size_t t = 0; t < content_.tracks.size(); ++t) {
      PageTrack& track = content_.tracks[t];
      if (!boxes[t].isEmpty()) {
        track.low = boxes[t].min();
        track.size = boxes[t].sizes();
      }
      content_.head["tracks"].push_back({{"points", track.count},
                                         {"low", triple(track.low)},
                                         {"size", triple(track.size)},
                                         {"largest_stretch", largest[t]}});
    }
  }

  const RunReader& run_;
  bool skins_only_;
  PageContent content_;
  std::vector<std::optional<EdgeStretch>> stretches_;  // of tracks that carry a surface
};

}  // namespace

std::vector<Vec3f> PageTrack::at(const RunReader& run, int frame) const {
  std::vector<Vec3f> points =
      source == Source::selectable
          ? run.selectable_points(body, frame)
          : run.points(body, source == Source::skin ? SurfaceKind::skin : SurfaceKind::contour, frame);
  if (all) return points;
  std::vector<Vec3f> chosen;
  chosen.reserve(picked.size());
  for (const int p : picked) chosen.push_back(points[static_cast<std::size_t>(p)]);
  return chosen;
}

PageContent page_content(const RunReader& run, bool skins_only, const Progress& progress) {
  return Gatherer(run, skins_only).gather(progress);
}

}  // namespace muslin
