#include "muslin/core/system_error.hpp"

#include <cerrno>
#include <system_error>

namespace muslin {
namespace {

const char* remedy_for(int code) {
  switch (code) {
    case ENOENT:
      return "check the path";
    case EACCES:
    case EPERM:
    case EROFS:
      return "choose a place you may use, or change its permissions";
    case ENOSPC:
    case EDQUOT:
    case EFBIG:
      return "free some space or choose another place";
    case ENOTDIR:
    case EISDIR:
    case EEXIST:
    case ELOOP:
    case ENAMETOOLONG:
      return "choose another path";
    default:
      return "check the path and the disk";
  }
}

}  // namespace

Error system_error(const std::filesystem::path& path, const std::string& action, int code) {
  return {ErrorKind::file,
          {path.string()},
          "cannot " + action + ": " + std::generic_category().message(code),
          remedy_for(code)};
}

}  // namespace muslin
