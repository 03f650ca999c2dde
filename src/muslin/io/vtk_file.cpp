#include "muslin/io/vtk_file.hpp"

#include <array>
#include <charconv>
#include <cstring>
#include <string_view>

#include <fmt/format.h>

#include "muslin/core/error.hpp"
#include "muslin/core/input_file.hpp"
#include "muslin/core/output_file.hpp"

namespace muslin {
namespace {

namespace fs = std::filesystem;

/// VTK counts a hexahedron's corners around its bottom, then around its top; the lattice counts in binary.
constexpr std::array<std::size_t, 8> vtk_corners = {0, 1, 3, 2, 4, 5, 7, 6};

template <class Number>
constexpr const char* vtk_type();
template <>
constexpr const char* vtk_type<float>() {
  return "Float32";
}
template <>
constexpr const char* vtk_type<double>() {
  return "Float64";
}
template <>
constexpr const char* vtk_type<std::int64_t>() {
  return "Int64";
}
template <>
constexpr const char* vtk_type<std::uint8_t>() {
  return "UInt8";
}

/// Collects arrays: their XML elements are written immediately, their bytes at the end of the file.
class Appendix {
 public:
  template <class Number>
  std::string element(const std::string& name, int components, const std::vector<Number>& values) {
    std::string text = fmt::format(
        "<DataArray type=\"{}\" Name=\"{}\" NumberOfComponents=\"{}\" format=\"appended\" offset=\"{}\"/>\n",
        vtk_type<Number>(), name, components, offset_);
    blocks_.push_back({values.data(), values.size() * sizeof(Number)});
    offset_ += sizeof(std::uint64_t) + blocks_.back().bytes;
    return text;
  }
  std::string element(const VtkArray& array) {
    return std::visit([&](const auto& values) { return element(array.name, array.components, values); },
                      array.values);
  }
  void write(WholeFile& out) const {
    out.append("<AppendedData encoding=\"raw\">\n_");
    for (const Block& block : blocks_) {
      const std::uint64_t bytes = block.bytes;
      out.append(&bytes, sizeof bytes);
      out.append(block.data, block.bytes);
    }
    out.append("\n</AppendedData>\n</VTKFile>\n");
  }

 private:
  struct Block {
    const void* data;
    std::size_t bytes;
  };
  std::vector<Block> blocks_;
  std::uint64_t offset_ = 0;
};

std::string opening(const char* type) {
  return fmt::format(
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"{}\" version=\"1.0\" byte_order=\"LittleEndian\" "
      "header_type=\"UInt64\">\n",
      type);
}

}  // namespace

std::size_t VtkGrid::point_count() const {
  return std::visit([](const auto& numbers) { return numbers.size() / 3; }, points);
}

void VtkGrid::add_cell(VtkCell type, const std::int64_t* corners, int count) {
  connectivity.insert(connectivity.end(), corners, corners + count);
  offsets.push_back(static_cast<std::int64_t>(connectivity.size()));
  types.push_back(static_cast<std::uint8_t>(type));
}

void VtkGrid::add_voxel(const std::array<int, 8>& corners) {
  std::array<std::int64_t, 8> ordered{};
  for (std::size_t c = 0; c < 8; ++c) ordered[c] = corners[vtk_corners[c]];
  add_cell(VtkCell::hexahedron, ordered.data(), 8);
}

void write_vtu(const fs::path& path, const VtkGrid& grid) {
  Appendix appendix;
  std::string head = opening("UnstructuredGrid");
  head += fmt::format("<UnstructuredGrid>\n<Piece NumberOfPoints=\"{}\" NumberOfCells=\"{}\">\n<Points>\n",
                      grid.point_count(), grid.types.size());
  head += std::visit([&](const auto& points) { return appendix.element("Points", 3, points); }, grid.points);
  head += "</Points>\n<Cells>\n";
  head += appendix.element("connectivity", 1, grid.connectivity);
  head += appendix.element("offsets", 1, grid.offsets);
  head += appendix.element("types", 1, grid.types);
  head += "</Cells>\n<PointData>\n";
  for (const VtkArray& array : grid.point_data) head += appendix.element(array);
  head += "</PointData>\n<CellData>\n";
  for (const VtkArray& array : grid.cell_data) head += appendix.element(array);
  head += "</CellData>\n</Piece>\n</UnstructuredGrid>\n";
  WholeFile out(path);
  out.append(head);
  appendix.write(out);
  out.commit();
}

void write_vti(const fs::path& path, const VtkImage& image) {
  Appendix appendix;
  const Vec3i last = image.samples - Vec3i::Ones();
  const std::string extent = fmt::format("0 {} 0 {} 0 {}", last.x(), last.y(), last.z());
  std::string head = opening("ImageData");
  head += fmt::format("<ImageData WholeExtent=\"{}\" Origin=\"{} {} {}\" Spacing=\"{} {} {}\">\n", extent,
                      image.origin.x(), image.origin.y(), image.origin.z(), image.width, image.width,
                      image.width);
  head += fmt::format("<Piece Extent=\"{}\">\n<PointData Scalars=\"{}\">\n", extent, image.name);
  head += appendix.element(image.name, 1, image.values);
  head += "</PointData>\n</Piece>\n</ImageData>\n";
  WholeFile out(path);
  out.append(head);
  appendix.write(out);
  out.commit();
}

void write_pvd(const fs::path& path, const std::vector<std::pair<double, std::string>>& steps) {
  std::string text = "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"1.0\">\n<Collection>\n";
  for (const auto& [time, file] : steps)
    text += fmt::format("<DataSet timestep=\"{}\" part=\"0\" file=\"{}\"/>\n", time, file);
  text += "</Collection>\n</VTKFile>\n";
  WholeFile out(path);
  out.append(text);
  out.commit();
}

VtkVoxels read_voxels(const fs::path& path) {
  const std::string text = read_file(path);
  const auto refuse = [&path]() -> Error {
    return {ErrorKind::input, {path.string()}, "this is not a lattice of a run", "run the scene again"};
  };
  constexpr std::string_view marker = "<AppendedData encoding=\"raw\">\n_";
  const std::size_t data = text.find(marker);
  if (data == std::string::npos || !text.ends_with("</VTKFile>\n")) throw refuse();
  const auto array = [&](const std::string& name, const char* type) {
    const std::string_view head(text.data(), data);
    const std::size_t at = head.find(fmt::format("type=\"{}\" Name=\"{}\"", type, name));
    const std::size_t found = head.find("offset=\"", at);
    if (at == std::string_view::npos || found == std::string_view::npos) throw refuse();
    std::uint64_t offset = 0;
    std::from_chars(text.data() + found + 8, text.data() + data, offset);
    const std::size_t begin = data + marker.size();
    std::uint64_t bytes = 0;
    if (offset > text.size() || begin + offset + sizeof bytes > text.size()) throw refuse();
    std::memcpy(&bytes, text.data() + begin + offset, sizeof bytes);
    if (bytes > text.size() - begin - offset - sizeof bytes) throw refuse();
    return std::string_view(text.data() + begin + offset + sizeof bytes, bytes);
  };
  VtkVoxels result;
  const std::string_view points = array("Points", "Float64");
  result.points.resize(points.size() / sizeof(Vec3));
  if (!result.points.empty())
    std::memcpy(static_cast<void*>(result.points.data()), points.data(), result.points.size() * sizeof(Vec3));
  const std::string_view corners = array("connectivity", "Int64");
  result.voxels.resize(corners.size() / (8 * sizeof(std::int64_t)));
  for (std::size_t voxel = 0; voxel < result.voxels.size(); ++voxel) {
    for (std::size_t c = 0; c < 8; ++c) {
      std::int64_t corner = 0;
      std::memcpy(&corner, corners.data() + (8 * voxel + c) * sizeof corner, sizeof corner);
      if (corner < 0 || static_cast<std::size_t>(corner) >= result.points.size()) throw refuse();
      result.voxels[voxel][vtk_corners[c]] = static_cast<int>(corner);
    }
  }
  return result;
}

std::vector<float> flat(const std::vector<Eigen::Vector3f>& vectors) {
  std::vector<float> numbers;
  numbers.reserve(3 * vectors.size());
  for (const auto& v : vectors) numbers.insert(numbers.end(), v.data(), v.data() + 3);
  return numbers;
}

std::vector<double> flat(ConstVectors vectors) {
  std::vector<double> numbers;
  numbers.reserve(3 * vectors.size());
  for (const auto& v : vectors) numbers.insert(numbers.end(), v.data(), v.data() + 3);
  return numbers;
}

}  // namespace muslin
