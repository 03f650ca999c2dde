#include "muslin/report/promises.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "muslin/core/counted.hpp"
#include "muslin/report/energy_turnover.hpp"
#include "muslin/report/momentum_check.hpp"
#include "muslin/report/quantity.hpp"
#include "muslin/scene/scene.hpp"

namespace muslin {
namespace {

using Json = nlohmann::ordered_json;

constexpr double energy_limit = 0.01;     // of the energy turned over
constexpr double momentum_limit = 0.001;  // of the largest momentum

/// Judges one run.
class Judge {
 public:
  Judge(const RunReader& run, const RunEvidence& evidence) : run_(run), evidence_(evidence) {}

  std::vector<Promise> all() const {
    return {complete(),  finite(), converged(),   energy(),        momentum(),
            crossings(), gap(),    penetration(), stretch_limit(), followed()};
  }

 private:
  const std::vector<Diagnostics>& rows() const { return run_.diagnostics(); }

  static Promise promise(const char* key, const char* title, const char* limit) {
    Promise p;
    p.key = key;
    p.title = title;
    p.limit = limit;
    return p;
  }
  static void set(Promise& p, bool kept, std::string finding) {
    p.verdict = kept ? Verdict::kept : Verdict::broken;
    p.finding = std::move(finding);
  }
  /// "frame 3 and …" of the promise.
  static std::string in_frames(const Promise& p) { return describe_frames(p.frames); }
  /// Sets the frames for which the condition holds.
  void set_frames(Promise& p, const std::function<bool(const Diagnostics&)>& broken) const {
    for (const Diagnostics& row : rows())
      if (broken(row)) p.frames.push_back(row.frame);
  }
  /// False, with the finding, for a run without frames.
  bool has_frames(Promise& p) const {
    if (rows().empty()) p.finding = "The run has no finished frame.";
    return !rows().empty();
  }
  bool has_step_columns(Promise& p) const {
    if (!has_frames(p)) return false;
    if (!evidence_.has_step_columns)
      p.finding = "The run is of an earlier version, whose table lacks these columns.";
    return evidence_.has_step_columns;
  }

  /// The frames that the scene's duration has, with frame 0; 0 if it is not recorded.
  int frames_of_scene() const {
    const Json scene = evidence_.summary.value("scene", Json::object());
    const Json time = scene.value("time", Json::object());
    if (!time.contains("duration") || !time.contains("frame_rate")) return 0;
    TimeSettings settings;
    settings.duration = time["duration"].get<double>();
    settings.frame_rate = time["frame_rate"].get<double>();
    return settings.frames() + 1;
  }

  Promise complete() const {
    Promise p = promise("complete", "The run is complete", "every frame from the first to the last");
    const int last = run_.last_frame(), frames = run_.frame_count();
    p.measured = frames;
    p.allowed = last + 1;
    p.unit = "frames";
    for (int i = 0; i < frames; ++i)
      if (rows()[static_cast<std::size_t>(i)].frame != i) p.frames.push_back(i);
    const Json timings = evidence_.summary.value("timings", Json::object());
    const Json sessions = timings.value("sessions", Json::array());
    int end = 0;
    bool joined = true;
    for (const Json& session : sessions) {
      joined = joined && session.value("from_frame", 0) <= end;
      end = session.value("to_frame", 0);
    }
    std::string counts = fmt::format("{} of {} frames are there", frames, last + 1);
    if (const int of_scene = frames_of_scene(); last + 1 < of_scene)
      counts += fmt::format(", {:.0f} % of the scene's {}, as `--frames {}` asked",
                            100.0 * (last + 1) / of_scene, of_scene, last);
    if (run_.status() == RunStatus::running && evidence_.being_written) {
      p.finding = counts + "; the run is going on at this moment.";
      return p;
    }
    const bool finished = run_.status() == RunStatus::finished;
    std::string text = counts;
    if (!p.frames.empty()) text += fmt::format("; the rows of {} are missing from the table", in_frames(p));
    if (!joined) text += "; its sessions do not join";
    if (!finished) {
      const std::string reason = evidence_.summary.value("reason", "");
      text += run_.status() == RunStatus::running ? "; the run was killed"
                                                  : fmt::format("; the run is {}", name_of(run_.status()));
      if (!reason.empty()) text += ": " + reason;
    } else if (sessions.size() > 1) {
      text += fmt::format(", computed in {} sessions that join", sessions.size());
    }
    set(p, finished && joined && p.frames.empty() && frames == last + 1, text + ".");
    return p;
  }

  Promise finite() const {
    Promise p = promise("finite", "Positions and energies are numbers", "none is infinite or not a number");
    if (!has_frames(p)) return p;
    for (const Diagnostics& row : rows()) {
      const double sum = row.balance() + row.unbalanced + row.momentum.sum() + row.max_stretch;
      if (!std::isfinite(sum) || !evidence_.is_finite(row.frame)) p.frames.push_back(row.frame);
    }
    set(p, p.frames.empty(),
        p.frames.empty() ? fmt::format("All numbers of {} are finite.", counted(rows().size(), "frame"))
                         : fmt::format("Numbers are not finite in {}.", in_frames(p)));
    return p;
  }

  Promise converged() const {
    Promise p = promise("steps_converge", "Every step converged", "all steps within their tolerance");
    if (!has_step_columns(p)) return p;
    const RunQuality& quality = evidence_.quality;
    if (quality.steps == 0) {
      p.finding = "The run has made no step.";
      return p;
    }
    p.frames = quality.frames_missed;
    p.measured = static_cast<double>(quality.converged_steps);
    p.allowed = static_cast<double>(quality.steps);
    p.unit = "steps";
    const std::string error =
        fmt::format("the largest estimate of a step's error is {}", quantity(quality.worst_error, "m"));
    if (p.frames.empty())
      set(p, true, fmt::format("All {} steps converged; {}.", quality.steps, error));
    else
      set(p, false,
          fmt::format("{} of {} steps missed their tolerance, in {}; {}.",
                      quality.steps - quality.converged_steps, quality.steps, in_frames(p), error));
    return p;
  }

  Promise energy() const {
    Promise p = promise("energy_closes", "The energy account closes",
                        "at most 1 % of the energy turned over is unaccounted for");
    if (!has_step_columns(p)) return p;
    const EnergyTurnover energy = measure_turnover(rows());
    p.measured = energy.share();
    p.allowed = energy_limit;
    p.unit = "";
    const bool kept = energy.share() <= energy_limit;
    if (!kept) p.frames = {energy.frame_of_unbalanced};
    set(p, kept,
        fmt::format(
            "{} of {} turned over are unbalanced at most (frame {}), which is {:.2g} %; apart from that the "
            "accounts are off by {}.",
            quantity(std::abs(energy.unbalanced), "J"), quantity(energy.turned_over, "J"),
            energy.frame_of_unbalanced, 100 * energy.share(), quantity(energy.account_error, "J")));
    return p;
  }

  Promise momentum() const {
    Promise p = promise("momentum_is_consistent", "Momentum is what gravity gave",
                        "at most 0.1 % of the largest momentum differs from the impulse of gravity");
    if (!has_frames(p)) return p;
    const Json scene = evidence_.summary.value("scene", Json());
    const MomentumCheck check = check_momentum(run_, scene, evidence_.statistics);
    if (!check.why_not.empty()) {
      p.finding = fmt::format("It cannot be told from the table: {}.", check.why_not);
      return p;
    }
    p.measured = check.share();
    p.allowed = momentum_limit;
    const bool kept = check.share() <= momentum_limit;
    if (!kept) p.frames = {check.frame};
    set(p, kept,
        fmt::format("Momentum differs from the impulse of gravity by at most {:.3g} kg·m/s of {:.3g} kg·m/s "
                    "(frame {}), which is {:.2g} %.",
                    check.deviation, check.scale, check.frame, 100 * check.share()));
    return p;
  }

  Promise crossings() const {
    Promise p = promise("nothing_crosses", "Nothing crosses",
                        "no two triangles meet, by exact arithmetic; nothing in a ball or beneath a plane");
    if (!has_frames(p)) return p;
    if (!evidence_.searched) {
      p.finding = fmt::format("Not searched: {}.", evidence_.why_not_searched);
      return p;
    }
    std::size_t most = 0;
    for (const CrossingFrame& frame : evidence_.crossing_frames) {
      p.frames.push_back(frame.frame);
      most = std::max(most, frame.count);
    }
    p.measured = static_cast<double>(most);
    p.allowed = 0;
    p.unit = "crossings";
    const std::string searched = fmt::format(
        "{} of {} triangles", counted(rows().size() - evidence_.frames_not_finite.size(), "frame"),
        evidence_.triangles_searched);
    if (p.frames.empty())
      set(p, true, fmt::format("No crossing in {}, every pair that may touch tested.", searched));
    else
      set(p, false,
          fmt::format("Surfaces cross in {}, in up to {} at once: {}.{}", in_frames(p),
                      counted(most, "place"), evidence_.crossing_frames.front().places.front(),
                      evidence_.summary.value("allow_tangled", false)
                          ? " The run was allowed to start with crossings."
                          : ""));
    return p;
  }

  /// Without contact, gaps and depths are not measured.
  bool has_contact(Promise& p) const {
    if (!evidence_.summary.contains("contact") || !evidence_.summary["contact"].is_null()) return true;
    p.finding = "Not measured: nothing can touch in this scene.";
    return false;
  }

  Promise gap() const {
    Promise p = promise("gaps_stay_open", "Gaps stay open", "every gap, thickness taken off, is above 0");
    if (!has_frames(p)) return p;
    if (!has_contact(p)) return p;
    double smallest = std::numeric_limits<double>::infinity();
    int frame = 0;
    for (const Diagnostics& row : rows())
      if (row.min_distance < smallest) smallest = row.min_distance, frame = row.frame;
    set_frames(p, [](const Diagnostics& row) { return !(row.min_distance > 0); });
    p.allowed = 0;
    p.unit = "m";
    if (std::isfinite(smallest)) p.measured = smallest;
    if (!std::isfinite(smallest) && p.frames.empty())
      set(p, true, "Nothing came within the contact distance.");
    else
      set(p, p.frames.empty(),
          fmt::format("The smallest gap of all steps is {} in frame {}{}.", quantity(smallest, "m"), frame,
                      p.frames.empty() ? "" : fmt::format("; it was closed in {}", in_frames(p))));
    return p;
  }

  Promise penetration() const {
    Promise p = promise("nothing_penetrates", "Nothing is inside a collider", "a depth of 0");
    if (!has_step_columns(p)) return p;
    if (!has_contact(p)) return p;
    double deepest = 0;
    for (const Diagnostics& row : rows()) deepest = std::max(deepest, row.penetration);
    set_frames(p, [](const Diagnostics& row) { return row.penetration > 0; });
    p.measured = deepest;
    p.allowed = 0;
    p.unit = "m";
    set(p, p.frames.empty(),
        p.frames.empty() ? std::string("The solver counted no penetration of bodies that may touch.")
                         : fmt::format("Up to {} deep, in {}.", quantity(deepest, "m"), in_frames(p)));
    return p;
  }

  Promise stretch_limit() const {
    Promise p = promise("stretch_limit_holds", "Limits of stretch hold",
                        "at most 1 % of the rest length beyond `stretch_limit`");
    if (!has_frames(p)) return p;
    if (!evidence_.has_stretch_limits) {
      p.finding = "No shell has a `stretch_limit`.";
      return p;
    }
    const std::vector<RunQuality::Overstretched>& shells = evidence_.quality.overstretched;
    std::string text;
    for (const RunQuality::Overstretched& shell : shells) {
      p.frames.insert(p.frames.end(), shell.frames.begin(), shell.frames.end());
      text += fmt::format(
          "{}Body {} was stretched to {:.4g} of its rest length, beyond its limit of {:.4g}, in {}.",
          text.empty() ? "" : " ", shell.body, shell.stretch, shell.limit, describe_frames(shell.frames));
      p.measured = std::max(p.measured.value_or(0), shell.stretch - shell.limit);
    }
    std::sort(p.frames.begin(), p.frames.end());
    p.frames.erase(std::unique(p.frames.begin(), p.frames.end()), p.frames.end());
    set(p, shells.empty(), shells.empty() ? std::string("No shell was stretched beyond its limit.") : text);
    return p;
  }

  Promise followed() const {
    Promise p = promise("paths_are_followed", "Pins and colliders follow their paths",
                        "no vertex is held back by an obstacle");
    if (!has_step_columns(p)) return p;
    const RunQuality& quality = evidence_.quality;
    p.frames = quality.frames_held_back;
    p.measured = quality.max_held_back;
    p.allowed = 0;
    p.unit = "vertices";
    set(p, p.frames.empty(),
        p.frames.empty()
            ? std::string("Nothing was held back.")
            : fmt::format("An obstacle held back up to {} in {}{}.",
                          counted(static_cast<std::size_t>(quality.max_held_back), "vertex", "vertices"),
                          in_frames(p), behind_text(quality)));
    return p;
  }

  const RunReader& run_;
  const RunEvidence& evidence_;
};

}  // namespace

const char* name_of(Verdict verdict) {
  switch (verdict) {
    case Verdict::kept:
      return "kept";
    case Verdict::broken:
      return "broken";
    case Verdict::not_measured:
      return "not measured";
  }
  return "";
}

std::vector<Promise> judge(const RunReader& run, const RunEvidence& evidence) {
  return Judge(run, evidence).all();
}

}  // namespace muslin
