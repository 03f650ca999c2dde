#include "muslin/report/run_report.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include <fmt/format.h>

#include "muslin/core/error.hpp"
#include "muslin/core/markup.hpp"
#include "muslin/version.hpp"

namespace muslin {
namespace {

using Json = nlohmann::ordered_json;

Json finite(double x) { return std::isfinite(x) ? Json(x) : Json(); }
Json triple(const Vec3& v) { return Json::array({v.x(), v.y(), v.z()}); }

std::string title_of(const RunReader& run) {
  const std::filesystem::path directory = run.directory();
  const std::string name =
      (directory.filename().empty() ? directory.parent_path() : directory).filename().string();
  return run.title().empty() ? name : run.title();
}

Json promise_json(const Promise& promise) {
  const auto number = [](const std::optional<double>& x) { return x ? finite(*x) : Json(); };
  return {{"key", promise.key},
          {"title", promise.title},
          {"verdict", name_of(promise.verdict)},
          {"finding", promise.finding},
          {"limit", promise.limit},
          {"measured", number(promise.measured)},
          {"allowed", number(promise.allowed)},
          {"unit", promise.unit},
          {"frames", promise.frames}};
}

Json fabric_json(const Fabric& fabric) {
  Json json = {{"body", fabric.body},         {"model", fabric.model},
               {"material", fabric.material}, {"description", fabric.description},
               {"source", fabric.source},     {"numbers", Json::array()}};
  for (const FabricNumber& number : fabric.numbers) {
    Json value = number.value;
    if (!number.curve.empty()) value = Json::array();
    for (const Vec2& point : number.curve) value.push_back({point[0], point[1]});
    json["numbers"].push_back({{"key", number.key},
                               {"value", value},
                               {"unit", number.unit},
                               {"meaning", number.meaning},
                               {"origin", name_of(number.origin)},
                               {"guess", number.guess}});
  }
  return json;
}

Json run_json(const RunReader& run, const RunReport& report) {
  const Json& summary = report.evidence.summary;
  const Json timings = summary.value("timings", Json::object());
  return {{"title", report.title},
          {"status", name_of(run.status())},
          {"reason", summary.value("reason", Json())},
          {"being_written", report.evidence.being_written},
          {"muslin", summary["muslin"].is_object() ? summary["muslin"].value("version", Json()) : Json()},
          {"frames", run.frame_count()},
          {"frames_planned", run.last_frame() + 1},
          {"frame_rate", run.frame_rate()},
          {"machine", summary.value("machine", Json())},
          {"sessions", timings.value("sessions", Json::array())},
          {"warnings", summary.value("warnings", Json::array())}};
}

Json energy_json(const RunReader& run, const EnergyTurnover& energy) {
  Json json = {{"turned_over", energy.turned_over},
               {"unbalanced", energy.unbalanced},
               {"frame_of_unbalanced", energy.frame_of_unbalanced},
               {"account_error", energy.account_error},
               {"share", finite(energy.share())}};
  if (run.diagnostics().empty()) return json;
  const auto accounts = [](const Diagnostics& row) {
    return Json{{"kinetic", finite(row.kinetic)},       {"elastic", finite(row.elastic)},
                {"potential", finite(row.potential)},   {"work", finite(row.work)},
                {"dissipated", finite(row.dissipated)}, {"momentum", triple(row.momentum)}};
  };
  json["at_start"] = accounts(run.diagnostics().front());
  json["at_end"] = accounts(run.diagnostics().back());
  return json;
}

Json gap_json(const RunReader& run, const RunEvidence& evidence) {
  if (!evidence.frame_of_gap) return nullptr;
  const Diagnostics& row = run.diagnostics()[static_cast<std::size_t>(*evidence.frame_of_gap)];
  Json json = {{"size", finite(row.min_distance)}, {"frame", row.frame}, {"at_end_of_frame", nullptr}};
  if (evidence.gap)
    json["at_end_of_frame"] = {{"size", evidence.gap->size},
                               {"bodies", {evidence.gap->first_body, evidence.gap->second_body}},
                               {"at", triple(evidence.gap->at)}};
  return json;
}

Json stretch_json(const RunReader& run, const RunEvidence& evidence) {
  if (!evidence.frame_of_stretch) return nullptr;
  const Diagnostics& row = run.diagnostics()[static_cast<std::size_t>(*evidence.frame_of_stretch)];
  Json json = {{"ratio", finite(row.max_stretch)}, {"frame", row.frame}, {"body", nullptr}, {"at", nullptr}};
  if (evidence.stretch) json["body"] = evidence.stretch->body, json["at"] = triple(evidence.stretch->at);
  return json;
}

Json crossings_json(const RunEvidence& evidence) {
  Json json = {{"searched", evidence.searched},
               {"reason", evidence.searched ? Json() : Json(evidence.why_not_searched)},
               {"triangles", evidence.triangles_searched},
               {"frames", Json::array()}};
  for (const CrossingFrame& frame : evidence.crossing_frames)
    json["frames"].push_back({{"frame", frame.frame}, {"count", frame.count}, {"first", frame.places}});
  return json;
}

}  // namespace

std::size_t RunReport::count(Verdict verdict) const {
  return static_cast<std::size_t>(std::count_if(
      promises.begin(), promises.end(), [&](const Promise& promise) { return promise.verdict == verdict; }));
}

RunReport make_report(const RunReader& run, const Progress& progress) {
  try {
    RunReport report;
    report.title = title_of(run);
    report.evidence = examine(run, progress);
    report.promises = judge(run, report.evidence);
    const std::string copy = (run.directory() / "scene.toml").string();  // runs of earlier versions
    report.fabrics =
        trace_fabrics(run, report.evidence.scene_text, report.evidence.summary.value("scene_file", copy));
    report.energy = measure_turnover(run.diagnostics());
    return report;
  } catch (const Json::exception& error) {
    throw Error(ErrorKind::input, {(run.directory() / "run.json").string()},
                fmt::format("run.json or stats.json is damaged ({})", error.what()), "run the scene again");
  }
}

Json report_json(const RunReader& run, const RunReport& report) {
  const RunEvidence& evidence = report.evidence;
  const RunQuality& quality = evidence.quality;
  Json json = {{"format", 1}, {"muslin", version()}};
  json["verdict"] = {{"kept", report.count(Verdict::kept)},
                     {"broken", report.count(Verdict::broken)},
                     {"not_measured", report.count(Verdict::not_measured)}};
  json["promises"] = Json::array();
  for (const Promise& promise : report.promises) json["promises"].push_back(promise_json(promise));
  json["run"] = run_json(run, report);
  json["fabrics"] = Json::array();
  for (const Fabric& fabric : report.fabrics) json["fabrics"].push_back(fabric_json(fabric));
  json["energy"] = energy_json(run, report.energy);
  json["convergence"] = {{"steps", quality.steps},
                         {"converged_steps", quality.converged_steps},
                         {"worst_error", quality.worst_error},
                         {"frames_missed", quality.frames_missed}};
  json["held_back"] = {{"frames", quality.frames_held_back},
                       {"most", quality.max_held_back},
                       {"farthest", quality.farthest_behind}};
  json["smallest_gap"] = gap_json(run, evidence);
  json["largest_stretch"] = stretch_json(run, evidence);
  json["crossings"] = crossings_json(evidence);
  json["statistics"] = evidence.statistics;
  json["scene"] = evidence.summary.value("scene", Json());
  return json;
}

std::string report_junit(const RunReport& report) {
  std::string cases;
  for (const Promise& promise : report.promises) {
    const std::string finding = escaped_markup(promise.finding);
    cases +=
        fmt::format("    <testcase classname=\"muslin.report\" name=\"{}\">", escaped_markup(promise.key));
    if (promise.verdict == Verdict::broken)
      cases += fmt::format("<failure message=\"{}\">{} (limit: {})</failure>", finding, finding,
                           escaped_markup(promise.limit));
    else if (promise.verdict == Verdict::not_measured)
      cases += fmt::format("<skipped message=\"{}\"/>", finding);
    else
      cases += fmt::format("<system-out>{}</system-out>", finding);
    cases += "</testcase>\n";
  }
  const std::string counts =
      fmt::format("tests=\"{}\" failures=\"{}\" errors=\"0\" skipped=\"{}\"", report.promises.size(),
                  report.count(Verdict::broken), report.count(Verdict::not_measured));
  return fmt::format(
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites {0}>\n  <testsuite name=\"{1}\" {0}>\n{2}  "
      "</testsuite>\n</testsuites>\n",
      counts, escaped_markup(report.title), cases);
}

}  // namespace muslin
