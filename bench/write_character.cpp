// Writes one character: bench/write_character INDEX FOLDER
#include <cstdio>
#include <cstdlib>

#include "character.hpp"

#include "muslin/core/error.hpp"

int main(int count, char** words) {
  if (count != 3) {
    std::fprintf(stderr, "usage: write_character INDEX FOLDER\n");
    return 2;
  }
  try {
    std::printf("%s\n", muslin::bench::write_character(words[2], std::atoi(words[1])).c_str());
  } catch (const muslin::Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
  return 0;
}
