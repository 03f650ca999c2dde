// Checks the form of XML.
#pragma once

#include <algorithm>
#include <string>
#include <vector>

namespace muslin::test {

/// True if tags open and close in order, and attributes and text hold no bare markup.
inline bool is_well_formed(const std::string& xml) {
  std::vector<std::string> open;
  std::size_t at = xml.find("?>");
  if (at == std::string::npos) return false;
  while ((at = xml.find('<', at)) != std::string::npos) {
    const std::size_t end = xml.find('>', at);
    if (end == std::string::npos || xml.find('<', at + 1) < end) return false;
    const std::string tag = xml.substr(at + 1, end - at - 1);
    if (std::count(tag.begin(), tag.end(), '"') % 2 != 0) return false;
    if (tag.front() == '/') {
      if (open.empty() || open.back() != tag.substr(1)) return false;
      open.pop_back();
    } else if (tag.back() != '/') {
      open.push_back(tag.substr(0, tag.find_first_of(" \n")));
    }
    at = end;
  }
  for (at = 0; (at = xml.find('&', at)) != std::string::npos; ++at)
    if (xml.find(';', at) > at + 5) return false;
  return open.empty();
}

}  // namespace muslin::test
