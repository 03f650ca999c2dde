#include "muslin/cache/tables.hpp"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "muslin/core/error.hpp"
#include "muslin/core/input_file.hpp"

namespace muslin {
namespace {

/// Quotes a field as in RFC 4180.
std::string quoted(const std::string& text) {
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  std::string result = "\"";
  for (char c : text) result += c == '"' ? std::string("\"\"") : std::string(1, c);
  return result + "\"";
}

constexpr std::size_t all_columns = 24;

/// Last columns of the tables of this version and of earlier ones, whose further columns are missing.
constexpr std::array<std::string_view, 3> last_columns{",behind", ",penetration", ",wall_ms"};

/// Returns the number of columns of a table of diagnostics; 0 if `text` is none.
std::size_t columns_of(std::string_view text) {
  for (const std::string_view last : last_columns) {
    const std::string_view header = diagnostics_header.substr(0, diagnostics_header.find(last) + last.size());
    if (text.starts_with(header) && text.substr(header.size()).starts_with('\n'))
      return static_cast<std::size_t>(std::count(header.begin(), header.end(), ',')) + 1;
  }
  return 0;
}

}  // namespace

const std::string_view diagnostics_header =
    "frame,time,kinetic,elastic,potential,work,dissipated,momentum_x,momentum_y,momentum_z,"
    "newton_iterations,linear_iterations,residual,max_stretch,min_distance,wall_ms,steps,converged_steps,"
    "error,unbalanced,crossings,held_back,penetration,behind\n";
const std::string_view probes_header = "frame,time,name,x,y,z,vx,vy,vz\n";
const std::string_view pins_header = "frame,time,name,x,y,z,mean,largest\n";
const std::string_view attachments_header = "frame,time,name,x,y,z,mean,largest,holding\n";
const std::string_view stretch_header = "frame,stretch,limit,body\n";

std::string diagnostics_row(const Diagnostics& row) {
  return fmt::format("{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{:.3f},{},{},{},{},{},{},{},{}\n",
                     row.frame, row.time, row.kinetic, row.elastic, row.potential, row.work, row.dissipated,
                     row.momentum.x(), row.momentum.y(), row.momentum.z(), row.newton_iterations,
                     row.linear_iterations, row.residual, row.max_stretch, row.min_distance, row.wall_ms,
                     row.steps, row.converged_steps, row.error, row.unbalanced, row.crossings, row.held_back,
                     row.penetration, row.behind);
}

std::string probe_rows(const Simulation& simulation) {
  const Model& model = simulation.model();
  const State& state = simulation.state();
  const Diagnostics& row = simulation.diagnostics();
  std::string text;
  for (const Probe& probe : model.probes) {
    const Component& body = model.bodies[static_cast<std::size_t>(probe.body)];
    Vec3 x = Vec3::Zero(), v = Vec3::Zero();
    probe.point.apply(model.of(body, state.positions), Vectors(&x, 1));
    probe.point.apply(model.of(body, state.velocities), Vectors(&v, 1));
    text += fmt::format("{},{},{},{},{},{},{},{},{}\n", row.frame, row.time, quoted(probe.name), x.x(), x.y(),
                        x.z(), v.x(), v.y(), v.z());
  }
  return text;
}

std::string pin_rows(const Simulation& simulation) {
  const Diagnostics& row = simulation.diagnostics();
  std::string text;
  for (const Pin& pin : simulation.model().pins) {
    const PinForce force = simulation.pin_force(pin.name);
    text += fmt::format("{},{},{},{},{},{},{},{}\n", row.frame, row.time, quoted(pin.name), force.sum.x(),
                        force.sum.y(), force.sum.z(), force.mean, force.largest);
  }
  return text;
}

std::string attachment_rows(const Simulation& simulation) {
  const Diagnostics& row = simulation.diagnostics();
  std::string text;
  for (const Attached& attached : simulation.model().attachments) {
    const AttachmentForce force = simulation.attachment_force(attached.name);
    text +=
        fmt::format("{},{},{},{},{},{},{},{},{}\n", row.frame, row.time, quoted(attached.name), force.sum.x(),
                    force.sum.y(), force.sum.z(), force.mean, force.largest, force.holding);
  }
  return text;
}

std::vector<Diagnostics> read_diagnostics(const std::filesystem::path& path) {
  const std::string text = read_file(path);
  const std::size_t columns = columns_of(text);
  if (columns == 0) {
    throw Error(ErrorKind::input, {path.string(), 1}, "this is not a table of diagnostics",
                "run the scene again");
  }
  std::vector<Diagnostics> rows;
  int line = 1;
  for (std::size_t at = text.find('\n') + 1; at < text.size();) {
    const std::size_t end = text.find('\n', at);
    if (end == std::string::npos) break;
    ++line;
    std::array<double, all_columns> numbers{};
    const char* field = text.c_str() + at;
    for (std::size_t column = 0; column < columns; ++column) {
      char* after = nullptr;
      numbers[column] = std::strtod(field, &after);
      const char separator = column + 1 < columns ? ',' : '\n';
      if (after == field || *after != separator) {
        throw Error(ErrorKind::input, {path.string(), line}, "a number is missing", "run the scene again");
      }
      field = after + 1;
    }
    Diagnostics row;
    row.frame = static_cast<int>(numbers[0]);
    row.time = numbers[1];
    row.kinetic = numbers[2];
    row.elastic = numbers[3];
    row.potential = numbers[4];
    row.work = numbers[5];
    row.dissipated = numbers[6];
    row.momentum = {numbers[7], numbers[8], numbers[9]};
    row.newton_iterations = static_cast<int>(numbers[10]);
    row.linear_iterations = static_cast<int>(numbers[11]);
    row.residual = numbers[12];
    row.max_stretch = numbers[13];
    row.min_distance = numbers[14];
    row.wall_ms = numbers[15];
    row.steps = static_cast<int>(numbers[16]);
    row.converged_steps = static_cast<int>(numbers[17]);
    row.error = numbers[18];
    row.unbalanced = numbers[19];
    row.crossings = static_cast<int>(numbers[20]);
    row.held_back = static_cast<int>(numbers[21]);
    row.penetration = numbers[22];
    row.behind = numbers[23];
    rows.push_back(row);
    at = end + 1;
  }
  return rows;
}

std::vector<int> read_holding(const std::filesystem::path& path, const std::string& attachment) {
  const std::string text = read_file(path), name = quoted(attachment) + ",";
  std::vector<int> holding;
  for (std::size_t at = text.find('\n') + 1; at != 0 && at < text.size();) {
    const std::size_t end = text.find('\n', at);
    if (end == std::string::npos) break;
    const std::string_view line = std::string_view(text).substr(at, end - at);
    const std::size_t after_time = line.find(',', line.find(',') + 1) + 1;
    if (line.substr(after_time).starts_with(name)) {
      const auto frame = static_cast<std::size_t>(std::max(std::atoi(line.data()), 0));
      if (holding.size() <= frame) holding.resize(frame + 1, -1);
      holding[frame] = std::atoi(line.data() + line.rfind(',') + 1);
    }
    at = end + 1;
  }
  return holding;
}

std::string stretch_row(const LimitedStretch& row) {
  return fmt::format("{},{},{},{}\n", row.frame, row.stretch, row.limit, quoted(row.body));
}

std::vector<LimitedStretch> read_stretches(const std::filesystem::path& path) {
  const std::string text = read_file(path);
  if (!text.starts_with(stretch_header))
    throw Error(ErrorKind::input, {path.string(), 1}, "this is not a table of stretches",
                "run the scene again");
  std::vector<LimitedStretch> rows;
  int line = 1;
  for (std::size_t at = stretch_header.size(); at < text.size();) {
    const std::size_t end = text.find('\n', at);
    if (end == std::string::npos) break;
    ++line;
    std::array<double, 3> numbers{};
    const char* field = text.c_str() + at;
    for (double& number : numbers) {
      char* after = nullptr;
      number = std::strtod(field, &after);
      if (after == field || *after != ',')
        throw Error(ErrorKind::input, {path.string(), line}, "a number is missing", "run the scene again");
      field = after + 1;
    }
    std::string body(field, text.c_str() + end);
    if (body.size() > 1 && body.front() == '"') {
      body = body.substr(1, body.size() - 2);
      for (std::size_t quote = 0; (quote = body.find("\"\"", quote)) != std::string::npos; ++quote)
        body.erase(quote, 1);
    }
    rows.push_back({static_cast<int>(numbers[0]), numbers[1], numbers[2], std::move(body)});
    at = end + 1;
  }
  return rows;
}

std::size_t table_length(std::string_view table, int last_frame) {
  std::size_t at = table.find('\n');
  if (at == std::string_view::npos) return 0;
  ++at;
  while (at < table.size()) {
    const std::size_t end = table.find('\n', at);
    if (end == std::string_view::npos) break;
    if (std::atoi(std::string(table.substr(at, 12)).c_str()) > last_frame) break;
    at = end + 1;
  }
  return at;
}

}  // namespace muslin
