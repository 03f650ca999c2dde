#include "muslin/view/view_page.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include <fmt/format.h>

#include "muslin/core/error.hpp"
#include "muslin/core/markup.hpp"
#include "muslin/core/output_file.hpp"
#include "muslin/view/deflater.hpp"
#include "muslin/view/page_content.hpp"
#include "muslin/view/page_template.hpp"
#include "muslin/view/point_packer.hpp"

namespace muslin {
namespace {

using Json = nlohmann::ordered_json;

/// Returns JSON that cannot end its script element: "<" is escaped.
std::string escaped_for_script(const Json& json) {
  std::string safe;
  for (const char c : json.dump(-1, ' ', false, Json::error_handler_t::replace)) {
    if (c == '<')
      safe += "\\u003c";
    else
      safe += c;
  }
  return safe;
}

/// Returns every stride-th frame, and the last.
std::vector<int> chosen_frames(int count, int stride) {
  std::vector<int> frames;
  for (int frame = 0; frame < count; frame += stride) frames.push_back(frame);
  if (frames.back() != count - 1) frames.push_back(count - 1);
  return frames;
}

/// The packed arrays and frames; or the share of frames reached before the size limit.
struct Packed {
  std::optional<std::string> data;
  double share = 1;  ///< of the frames
};

Packed pack(const RunReader& run, const PageContent& content, const std::vector<int>& frames,
            std::uint64_t largest, const Progress& progress) {
  Deflater deflater;
  deflater.append(content.arrays);
  std::vector<PointPacker> packers;
  for (const PageTrack& track : content.tracks) packers.emplace_back(track.low, track.size, track.count);
  for (std::size_t f = 0; f < frames.size(); ++f) {
    progress.at(static_cast<double>(f) / static_cast<double>(frames.size()), "packing");
    for (std::size_t t = 0; t < packers.size(); ++t) {
      std::string record;
      packers[t].append(content.tracks[t].at(run, frames[f]), record);
      deflater.append(record);
    }
    if (deflater.size() > largest)
      return {std::nullopt, static_cast<double>(f + 1) / static_cast<double>(frames.size())};
  }
  std::string data = deflater.finish();
  if (data.size() > largest) return {};
  return {std::move(data), 1};
}

struct Page {
  PageContent content;
  std::vector<int> frames;
  std::string data;
  std::vector<std::string> notes;
};

/// Returns the number of packed bytes that fit beside the page's own text and the description of the run.
std::uint64_t room_for(const PageContent& content, int frames, std::uint64_t largest_page) {
  constexpr std::uint64_t notes = 1000, digits_of_a_frame = 11;
  const std::uint64_t text = page_template().size() + escaped_for_script(content.head).size() + notes +
                             digits_of_a_frame * static_cast<std::uint64_t>(frames);
  return largest_page > text ? (largest_page - text) / 4 * 3 : 0;  // base64
}

/// Returns as much of the run as fits.
Page fitting_page(const RunReader& run, std::uint64_t largest, const std::string& limit,
                  const Progress& progress) {
  const int count = run.frame_count();
  Page page;
  const auto try_frames = [&](int stride) {
    page.frames = chosen_frames(count, stride);
    Packed packed = pack(run, page.content, page.frames, room_for(page.content, count, largest), progress);
    if (packed.data) page.data = std::move(*packed.data);
    return packed;
  };
  page.content = page_content(run, false, progress);
  Packed packed = try_frames(1);
  if (packed.data) return page;
  const std::size_t tracks = page.content.tracks.size();
  page.content = page_content(run, true, progress);
  if (page.content.tracks.size() < tracks) {
    page.notes.push_back("Contour and lattice are left out to keep the page below " + limit + ".");
    packed = try_frames(1);
  }
  int stride = 1;
  while (!packed.data) {
    if (page.frames.size() <= 2)
      throw Error(ErrorKind::usage, {run.directory().string()},
                  "not even two frames fit into a page of " + limit, "allow more with --max-size");
    const int guess = static_cast<int>(std::ceil(stride / packed.share));
    stride = std::min(count - 1, std::max(stride + 1, guess));
    packed = try_frames(stride);
  }
  if (stride > 1)
    page.notes.push_back(fmt::format("One frame in {} is shown, to keep the page below {}.", stride, limit));
  return page;
}

}  // namespace

ViewReport write_view(const RunReader& run, const std::filesystem::path& file, const ViewOptions& options,
                      const Progress& progress) {
  if (run.frame_count() == 0) {
    throw Error(ErrorKind::input, {run.directory().string()}, "the run has no finished frame",
                "run the scene first");
  }
  WholeFile out(file);
  const std::string_view page = page_template();
  const std::string limit = fmt::format("{:g} MB", static_cast<double>(options.largest_bytes) / 1e6);
  Page fitting = fitting_page(run, options.largest_bytes, limit, progress);
  fitting.content.head["frames"] = fitting.frames;
  fitting.content.head["frames_at"] = fitting.content.arrays.size();
  fitting.content.head["notes"] = fitting.notes;

  const std::string title = escaped_markup(fitting.content.head["title"].get<std::string>());
  const std::string content =
      "<script id=\"run\" type=\"application/json\">" + escaped_for_script(fitting.content.head) +
      "</script>\n<script id=\"data\" type=\"text/plain\">" + base64(fitting.data) + "</script>";
  const std::size_t title_at = page.find("%TITLE%"), run_at = page.find("%RUN%");
  out.append(page.substr(0, title_at));
  out.append(title);
  out.append(page.substr(title_at + 7, run_at - title_at - 7));
  out.append(content);
  out.append(page.substr(run_at + 5));
  ViewReport report;
  report.bytes = out.file().size();
  report.frames = static_cast<int>(fitting.frames.size());
  report.notes = std::move(fitting.notes);
  out.commit();
  return report;
}

}  // namespace muslin
