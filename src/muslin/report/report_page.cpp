#include "muslin/report/report_page.hpp"

#include <cmath>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "muslin/core/counted.hpp"
#include "muslin/core/markup.hpp"
#include "muslin/report/json_list.hpp"
#include "muslin/report/quantity.hpp"
#include "muslin/report/report_curves.hpp"
#include "muslin/report/report_template.hpp"
#include "muslin/version.hpp"
#include "muslin/view/deflater.hpp"

namespace muslin {
namespace {

using Json = nlohmann::ordered_json;

const char* style_of(Verdict verdict) {
  return verdict == Verdict::kept ? "kept" : verdict == Verdict::broken ? "broken" : "none";
}

const char* sign_of(Verdict verdict) {
  return verdict == Verdict::kept ? "✓" : verdict == Verdict::broken ? "✗" : "–";
}

/// A value of the resolved scene in words: text as it is, numbers with six digits, lists in brackets.
std::string plain(const Json& value) {
  if (value.is_null()) return "–";
  if (value.is_string()) return value.get<std::string>();
  if (value.is_number_float()) return fmt::format("{:.6g}", value.get<double>());
  if (!value.is_array()) return value.dump();
  std::string list;
  for (const Json& item : value) list += (list.empty() ? "" : ", ") + plain(item);
  return "(" + list + ")";
}

/// Returns escaped text in which what stands between backticks is code.
std::string worded(const std::string& text) {
  std::string html;
  bool in_code = false;
  for (const char c : escaped_markup(text)) {
    if (c == '`')
      html += (in_code = !in_code) ? "<code>" : "</code>";
    else
      html += c;
  }
  return in_code ? html + "</code>" : html;
}

/// Builds a table row by row; cells are escaped.
class HtmlTable {
 public:
  explicit HtmlTable(const std::vector<std::string>& heads) {
    text_ = "<div class=\"scroll\"><table>\n<thead><tr>";
    for (const std::string& head : heads)
      text_ += head.starts_with('#') ? cell("th class=\"number\"", head.substr(1)) : cell("th", head);
    text_ += "</tr></thead>\n<tbody>\n";
  }
  HtmlTable& row(const std::string& head) {
    end_row();
    open_ = true;
    text_ += "<tr>" + cell("th scope=\"row\"", head);
    return *this;
  }
  HtmlTable& text(const std::string& words) {
    text_ += cell("td", words);
    return *this;
  }
  HtmlTable& number(const std::string& digits) {
    text_ += cell("td class=\"number\"", digits);
    return *this;
  }
  /// A cell of markup.
  HtmlTable& markup(const std::string& html) {
    text_ += "<td>" + html + "</td>";
    return *this;
  }
  std::string html() {
    end_row();
    return text_ + "</tbody></table></div>\n";
  }

 private:
  static std::string cell(const std::string& tag, const std::string& words) {
    return "<" + tag + ">" + escaped_markup(words) + "</" + tag.substr(0, tag.find(' ')) + ">";
  }
  void end_row() {
    if (open_) text_ += "</tr>\n";
    open_ = false;
  }
  std::string text_;
  bool open_ = false;
};

std::string heading(std::string_view words) { return fmt::format("<h2>{}</h2>\n", words); }

std::string paragraph(const std::string& words, const char* style = "soft") {
  return fmt::format("<p class=\"{}\">{}</p>\n", style, worded(words));
}

class Page {
 public:
  Page(const RunReader& run, const RunReport& report)
      : run_(run), report_(report), evidence_(report.evidence), summary_(report.evidence.summary) {
    scene_ = summary_.value("scene", Json());
  }

  std::string body(const std::vector<ReportPicture>& pictures) const {
    return head() + verdicts() + pictures_of(pictures) + simulated() + fabrics() + places() + accounts() +
           curves() + history() + foot();
  }

 private:
  std::string head() const {
    const int frames = run_.frame_count();
    std::string facts =
        fmt::format("{} of {} frames at {:g}/s", frames, run_.last_frame() + 1, run_.frame_rate());
    if (frames > 0) facts += fmt::format(", {:.4g} s", run_.diagnostics().back().time);
    facts += fmt::format(" · {}", name_of(run_.status()));
    const Json version =
        summary_["muslin"].is_object() ? summary_["muslin"].value("version", Json()) : Json();
    if (version.is_string()) facts += " · simulated with muslin " + version.get<std::string>();
    std::string html = "<p class=\"kind\">Certificate of a run</p>\n<h1>" + escaped_markup(report_.title) +
                       "</h1>\n" + paragraph(facts);
    if (run_.status() != RunStatus::finished) {
      const Promise& complete = report_.promises.front();
      html += paragraph(
          "This run is not finished, and the verdicts are about what there is. " + complete.finding, "alarm");
    }
    html += "<div class=\"seal\">";
    for (const Verdict verdict : {Verdict::kept, Verdict::broken, Verdict::not_measured})
      html += fmt::format("<div class=\"{}\"><b>{}</b>{} {}</div>",
                          report_.count(verdict) == 0 ? "none" : style_of(verdict), report_.count(verdict),
                          report_.count(verdict) == 1 ? "promise" : "promises", name_of(verdict));
    return html + "</div>\n";
  }

  std::string verdicts() const {
    std::string rows;
    for (const Promise& promise : report_.promises)
      rows += fmt::format(
          "<tr><td class=\"verdict {}\">{} {}</td><th scope=\"row\">{}</th><td>{}<span "
          "class=\"limit\">Limit: "
          "{}</span></td></tr>\n",
          style_of(promise.verdict), sign_of(promise.verdict), name_of(promise.verdict),
          escaped_markup(promise.title), worded(promise.finding), worded(promise.limit));
    return heading("Promises") +
           "<div "
           "class=\"scroll\"><table>\n<thead><tr><th>verdict</th><th>promise</th><th>finding</th></tr></"
           "thead>\n"
           "<tbody>\n" +
           rows + "</tbody></table></div>\n";
  }

  static std::string pictures_of(const std::vector<ReportPicture>& pictures) {
    if (pictures.empty()) return "";
    std::string html = heading("Pictures") + "<div class=\"pictures\">\n";
    for (const ReportPicture& picture : pictures) {
      const std::string caption = escaped_markup(picture.caption);
      html += fmt::format(
          "<figure><img alt=\"{0}\" "
          "src=\"data:image/png;base64,{1}\"><figcaption>{0}</figcaption></figure>\n",
          caption, base64(picture.png));
    }
    return html + "</div>\n";
  }

  std::string simulated() const {
    std::string html = heading("What was simulated");
    const Json none = Json::object();
    const auto table_of = [&](const char* key) -> const Json& {
      return scene_.is_object() && scene_.contains(key) && scene_[key].is_object() ? scene_[key] : none;
    };
    std::string settings;
    const auto fact = [&](const char* name, const std::string& value) {
      settings += fmt::format("<div><dt>{}</dt><dd>{}</dd></div>", name, escaped_markup(value));
    };
    const auto add = [&](const char* name, const Json& table, const char* key, const char* unit) {
      if (table.contains(key)) fact(name, plain(table[key]) + (*unit == 0 ? "" : " ") + unit);
    };
    add("duration", table_of("time"), "duration", "s");
    add("frame rate", table_of("time"), "frame_rate", "1/s");
    add("steps per frame", table_of("time"), "steps_per_frame", "");
    add("integrator", table_of("solver"), "integrator", "");
    add("effort", table_of("solver"), "effort", "");
    add("tolerance", table_of("solver"), "tolerance", "");
    if (summary_.contains("contact") && summary_["contact"].is_object()) {
      const Json distance = summary_["contact"].value("distance", Json());
      if (distance.is_number()) fact("contact distance", quantity(distance.get<double>(), "m"));
      add("friction", table_of("contact"), "friction", "");
    }
    html += "<dl>" + settings + "</dl>\n<h3>Bodies and colliders</h3>\n" + bodies();
    html += acting();
    if (scene_.is_object())
      html += "<details><summary>Every setting of the scene, in SI units</summary><pre>" +
              escaped_markup(scene_.dump(2)) + "</pre></details>\n";
    return html;
  }

  std::string bodies() const {
    HtmlTable table({"name", "kind", "#vertices", "#elements", "#mass"});
    for (const char* list : {"bodies", "colliders"}) {
      for (const Json& body : json_list(evidence_.statistics, list)) {
        const auto count = [&](const char* key) { return plain(body.value(key, Json())); };
        const std::string kind =
            body.contains("model") ? plain(body["model"]) : "collider, " + count("shape");
        const bool has_voxels = body.contains("voxels") && body["voxels"] != 0;
        const std::string elements =
            has_voxels ? count("voxels") + " voxels" : count("triangles") + " triangles";
        const Json mass = body.value("mass", Json());
        table.row(plain(body.value("name", Json()))).text(kind).number(count("vertices")).number(elements);
        table.number(mass.is_number() ? fmt::format("{:.6g} kg", mass.get<double>()) : "–");
      }
    }
    return table.html();
  }

  std::string acting() const {
    std::string items;
    const auto item = [&](const std::string& words) { items += "<li>" + worded(words) + "</li>\n"; };
    for (const Json& force : json_list(scene_, "force")) {
      std::string words = plain(force.value("type", Json()));
      for (const auto& [key, unit] : {std::pair{"acceleration", "m/s²"},
                                      std::pair{"force", "N at each vertex"}, std::pair{"velocity", "m/s"}})
        if (force.contains(key) && !force[key].is_null())
          words += fmt::format(", {} {}", plain(force[key]), unit);
      if (force.contains("keyframes")) words += ", along keyframes";
      item(fmt::format("force {}: {}", plain(force.value("name", Json())), words));
    }
    for (const Chosen& pin : run_.selections().pins)
      item(fmt::format("pin {} of {}: {}, from {:g} s{}", pin.name,
                       run_.bodies()[static_cast<std::size_t>(pin.body)],
                       counted(pin.vertices.size(), "vertex", "vertices"), pin.from,
                       std::isfinite(pin.until) ? fmt::format(" until {:g} s", pin.until) : std::string()));
    return items.empty() ? "" : "<h3>Forces and pins</h3>\n<ul>\n" + items + "</ul>\n";
  }

  std::string fabrics() const {
    if (report_.fabrics.empty()) return "";
    std::string html = heading("Fabrics, and where their numbers come from");
    for (const Fabric& fabric : report_.fabrics) {
      html += fmt::format(
          "<h3>{}: {}</h3>\n", escaped_markup(fabric.body),
          escaped_markup(fabric.material == "inline" ? "a table of the scene file" : fabric.material));
      if (!fabric.description.empty()) html += paragraph(fabric.description);
      HtmlTable table({"number", "#value", "unit", "meaning", "origin"});
      for (const FabricNumber& number : fabric.numbers) {
        std::string value = number.curve.empty() ? fmt::format("{:.6g}", number.value) : "";
        for (const Vec2& point : number.curve) value += fmt::format("({:.6g}, {:.6g}) ", point[0], point[1]);
        table.row(number.key).number(value).text(number.unit).text(number.meaning);
        table.markup(escaped_markup(name_of(number.origin)) +
                     (number.guess ? "<span class=\"guess\">guess</span>" : ""));
      }
      html += table.html();
      if (!fabric.source.empty()) html += paragraph("Sources: " + fabric.source);
    }
    return html;
  }

  std::string places() const {
    std::string items;
    const auto item = [&](const std::string& words) { items += "<li>" + worded(words) + "</li>\n"; };
    if (evidence_.frame_of_stretch) {
      const Diagnostics& row = run_.diagnostics()[static_cast<std::size_t>(*evidence_.frame_of_stretch)];
      const std::string where =
          evidence_.stretch
              ? fmt::format("in {} near {}", evidence_.stretch->body, position_text(evidence_.stretch->at))
              : std::string("at a place that the caches do not tell, as the shape at rest is another");
      item(fmt::format("Largest stretch: {:.4g} % in frame {}, {}.", 100 * (row.max_stretch - 1), row.frame,
                       where));
    }
    if (evidence_.frame_of_gap) {
      const Diagnostics& row = run_.diagnostics()[static_cast<std::size_t>(*evidence_.frame_of_gap)];
      std::string words =
          fmt::format("Smallest gap: {} during frame {}", quantity(row.min_distance, "m"), row.frame);
      if (evidence_.gap) {
        const Gap& gap = *evidence_.gap;
        words += fmt::format("; at its end {} between {} near {}", quantity(gap.size, "m"),
                             gap.first_body == gap.second_body ? "parts of " + gap.first_body
                                                               : gap.first_body + " and " + gap.second_body,
                             position_text(gap.at));
      }
      item(words + ".");
    }
    for (const CrossingFrame& crossing : evidence_.crossing_frames) {
      if (&crossing - evidence_.crossing_frames.data() >= 3) break;
      for (const std::string& place : crossing.places)
        item(fmt::format("Frame {}: {}.", crossing.frame, place));
    }
    return items.empty() ? "" : heading("Extremes, and where they are") + "<ul>\n" + items + "</ul>\n";
  }

  std::string accounts() const {
    if (run_.diagnostics().empty()) return "";
    const Diagnostics &start = run_.diagnostics().front(), &end = run_.diagnostics().back();
    HtmlTable table({"account", "#at the start", "#at the end", "#change"});
    const auto add = [&](const char* name, double a, double b) {
      table.row(name).number(quantity(a, "J")).number(quantity(b, "J")).number(quantity(b - a, "J"));
    };
    add("kinetic", start.kinetic, end.kinetic);
    add("elastic", start.elastic, end.elastic);
    add("potential", start.potential, end.potential);
    add("work from outside", start.work, end.work);
    add("dissipated", start.dissipated, end.dissipated);
    const auto vector = [](const Vec3& v) {
      return fmt::format("({:.4g}, {:.4g}, {:.4g})", v.x(), v.y(), v.z());
    };
    const auto& energy = report_.energy;
    return heading("Energy and momentum") + table.html() +
           paragraph(
               fmt::format("Turned over: {}. Unbalanced at most: {}, in frame {}. Momentum: {} kg·m/s at the "
                           "start, {} kg·m/s at the end.",
                           quantity(energy.turned_over, "J"), quantity(std::abs(energy.unbalanced), "J"),
                           energy.frame_of_unbalanced, vector(start.momentum), vector(end.momentum)));
  }

  std::string curves() const {
    if (run_.diagnostics().size() < 2) return "";
    std::string html = heading("Curves") + "<div class=\"pictures\">\n";
    for (const Plot& plot : report_curves(run_.diagnostics())) {
      const std::string drawn = plot_svg(plot);
      html += "<figure class=\"curve\">" + drawn.substr(drawn.find("<svg")) + "</figure>\n";
    }
    return html + "</div>\n";
  }

  std::string history() const {
    std::string html = heading("How it was run");
    HtmlTable table({"session", "#from frame", "#to frame", "#time", "settings changed"});
    const Json timings = summary_.value("timings", Json::object());
    int number = 0;
    for (const Json& session : json_list(timings, "sessions")) {
      const Json seconds = session.value("wall_s", Json());
      table.row(std::to_string(++number))
          .number(plain(session.value("from_frame", Json())))
          .number(plain(session.value("to_frame", Json())))
          .number(seconds.is_number() ? fmt::format("{:.1f} s", seconds.get<double>()) : "–");
      const Json& changed = json_list(session, "changed");
      table.text(changed.empty() ? "none" : plain(changed));
    }
    html += table.html();
    const Json machine = summary_.value("machine", Json());
    if (machine.is_object())
      html += paragraph(
          fmt::format("{}, {} threads of {} cores, compiler {}.", plain(machine.value("processor", Json())),
                      plain(machine.value("threads", Json())), plain(machine.value("cores", Json())),
                      plain(machine.value("compiler", Json()))));
    const Json& warnings = json_list(summary_, "warnings");
    if (warnings.empty()) return html + paragraph("The run gave no warning.");
    html += "<h3>Warnings of the run</h3>\n<ul>\n";
    for (const Json& warning : warnings) html += "<li>" + worded(plain(warning)) + "</li>\n";
    return html + "</ul>\n";
  }

  std::string foot() const {
    return fmt::format(
        "<footer>Examined with muslin {}.{} This page holds everything it shows.</footer>", version(),
        evidence_.searched
            ? " Crossings were searched anew in the written surfaces, by exact arithmetic that shares "
              "no code with the step limiter of contact."
            : "");
  }

  const RunReader& run_;
  const RunReport& report_;
  const RunEvidence& evidence_;
  const Json& summary_;
  Json scene_;
};

}  // namespace

std::string report_page(const RunReader& run, const RunReport& report,
                        const std::vector<ReportPicture>& pictures) {
  const std::string_view page = report_template();
  const std::size_t title_at = page.find("%TITLE%"), body_at = page.find("%BODY%");
  std::string html(page.substr(0, title_at));
  html += escaped_markup(report.title);
  html += page.substr(title_at + 7, body_at - title_at - 7);
  html += Page(run, report).body(pictures);
  html += page.substr(body_at + 6);
  return html;
}

}  // namespace muslin
