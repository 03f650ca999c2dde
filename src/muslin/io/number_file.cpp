#include "muslin/io/number_file.hpp"

#include <cstdint>
#include <utility>

#include "muslin/core/input_file.hpp"
#include "muslin/io/npy_file.hpp"
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

std::vector<double> read_npy(std::string_view bytes, const std::string& file) {
  const NpyArray array(bytes, file,
                       "save one number for each vertex, as numpy.save(file, weights.astype('f4'))");
  if (array.shape().size() != 1) array.refuse("its array does not have one dimension");
  std::vector<double> numbers(array.size());
  for (std::size_t i = 0; i < numbers.size(); ++i) numbers[i] = array[i];
  return numbers;
}

}  // namespace

bool is_number_file(std::string_view name) { return name.ends_with(".csv") || name.ends_with(".npy"); }

std::vector<double> read_numbers_from(std::string_view bytes, const std::string& file) {
  return file.ends_with(".npy") ? read_npy(bytes, file) : read_csv(bytes, file);
}

std::vector<double> read_numbers(const std::filesystem::path& path) {
  constexpr std::uint64_t most_bytes = std::uint64_t{1} << 32;
  return read_numbers_from(read_file(path, most_bytes), path.string());
}

}  // namespace muslin
