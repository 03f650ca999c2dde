#include "muslin/io/number_file.hpp"

#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "muslin/core/input_file.hpp"
#include "muslin/io/binary_reader.hpp"
#include "muslin/io/text_scanner.hpp"

namespace muslin {
namespace {

bool begins_a_number(std::string_view word) {
  return word.find_first_not_of("+-.0123456789") > 0 && word != "-" && word != "+";
}

std::vector<double> read_csv(std::string_view text, const std::string& file) {
  TextScanner scanner(text, file, TextScanner::Syntax::plain);
  std::vector<double> numbers;
  bool first = true;
  do {
    const std::string_view line = scanner.rest_of_line();
    if (line.empty()) continue;
    const bool title = std::exchange(first, false) && !begins_a_number(line) && line != "nan";
    if (title) continue;
    if (line.find_first_of(",; \t") != line.npos)
      scanner.fail(line, "the line has more than one number", "give one number for each vertex");
    numbers.push_back(scanner.number(line, "a number"));
  } while (scanner.next_line());
  return numbers;
}

class NpyReader {
 public:
  NpyReader(std::string_view bytes, const std::string& file) : bytes_(bytes), file_(file) {}

  std::vector<double> read() {
    constexpr std::string_view magic = "\x93NUMPY";
    if (!bytes_.starts_with(magic) || bytes_.size() < 12) refuse("this is not a NumPy file");
    const bool long_header = bytes_[6] >= 2;
    const std::size_t begin = long_header ? 12 : 10;
    const std::size_t length = long_header ? load<std::uint32_t>(bytes_.data() + 8, false)
                                           : load<std::uint16_t>(bytes_.data() + 8, false);
    if (length > bytes_.size() - begin) refuse("the file is cut off");
    header_ = bytes_.substr(begin, length);
    const std::string_view data = bytes_.substr(begin + length);
    const auto [scalar, big_endian] = type();
    const std::size_t count = this->count(), size = size_of(scalar);
    if (count > data.size() / size || data.size() != count * size)
      refuse(fmt::format("its data have {} bytes, but {} numbers need {}", data.size(), count, count * size));
    std::vector<double> numbers;
    numbers.reserve(count);
    for (std::size_t i = 0; i < count; ++i) {
      numbers.push_back(load_number(data.data() + i * size, scalar, big_endian));
      if (!std::isfinite(numbers.back())) refuse(fmt::format("number {} is not finite", i));
    }
    return numbers;
  }

 private:
  /// The text behind `'key':`.
  std::string_view value_of(std::string_view key) const {
    const std::string quoted = fmt::format("'{}':", key);
    const std::size_t at = header_.find(quoted);
    if (at == header_.npos) refuse(fmt::format("its header has no `{}`", key));
    std::string_view value = header_.substr(at + quoted.size());
    value.remove_prefix(std::min(value.find_first_not_of(' '), value.size()));
    return value;
  }

  std::pair<Scalar, bool> type() const {
    constexpr std::array<std::pair<std::string_view, Scalar>, 9> types = {{{"f4", Scalar::float32},
                                                                           {"f8", Scalar::float64},
                                                                           {"i1", Scalar::int8},
                                                                           {"u1", Scalar::uint8},
                                                                           {"b1", Scalar::uint8},
                                                                           {"i2", Scalar::int16},
                                                                           {"u2", Scalar::uint16},
                                                                           {"i4", Scalar::int32},
                                                                           {"u4", Scalar::uint32}}};
    const std::string_view text = value_of("descr");
    if (text.size() > 4 && text[0] == '\'' && text[4] == '\'')
      for (const auto& [name, scalar] : types)
        if (text.substr(2, 2) == name) return {scalar, text[1] == '>'};
    refuse("its numbers are of another type than floats or integers of up to four bytes");
  }

  std::size_t count() const {
    const std::string_view shape = value_of("shape");
    std::size_t count = 0, at = 1;
    while (at < shape.size() && at < 12 && shape[at] >= '0' && shape[at] <= '9')
      count = 10 * count + static_cast<std::size_t>(shape[at++] - '0');
    if (!shape.starts_with('(') || at == 1 || !shape.substr(at).starts_with(",)"))
      refuse("its array does not have one dimension");
    return count;
  }

  [[noreturn]] void refuse(const std::string& problem) const {
    throw Error(ErrorKind::input, Place{file_}, problem,
                "save one number for each vertex, as numpy.save(file, weights.astype('f4'))");
  }

  std::string_view bytes_, header_;
  std::string file_;
};

}  // namespace

bool is_number_file(std::string_view name) { return name.ends_with(".csv") || name.ends_with(".npy"); }

std::vector<double> read_numbers_from(std::string_view bytes, const std::string& file) {
  return file.ends_with(".npy") ? NpyReader(bytes, file).read() : read_csv(bytes, file);
}

std::vector<double> read_numbers(const std::filesystem::path& path) {
  constexpr std::uint64_t most_bytes = std::uint64_t{1} << 32;
  return read_numbers_from(read_file(path, most_bytes), path.string());
}

}  // namespace muslin
