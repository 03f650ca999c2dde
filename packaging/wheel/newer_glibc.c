// Functions of newer versions of glibc that the headers and the libstdc++ of this system call, by means of those of
// glibc 2.28. Linked into every library and program of the wheel.
#define _GNU_SOURCE
#include <errno.h>
#include <stdint.h>
#include <stdlib.h>
#include <sys/random.h>
#include <sys/stat.h>

enum { stat_version = 1 };
int __xstat(int version, const char* path, struct stat* out);
int __lxstat(int version, const char* path, struct stat* out);
int __fxstat(int version, int file, struct stat* out);
int __fxstatat(int version, int folder, const char* path, struct stat* out, int flags);

#pragma GCC visibility push(hidden)

// glibc 2.32. Always "maybe not": libstdc++ then counts references with atomic operations.
char __libc_single_threaded = 0;

// glibc 2.33. In older versions these are inline functions of the headers, which call those above.
int stat(const char* path, struct stat* out) { return __xstat(stat_version, path, out); }
int lstat(const char* path, struct stat* out) { return __lxstat(stat_version, path, out); }
int fstat(int file, struct stat* out) { return __fxstat(stat_version, file, out); }
int fstatat(int folder, const char* path, struct stat* out, int flags) {
  return __fxstatat(stat_version, folder, path, out, flags);
}
int stat64(const char* path, struct stat64* out) { return stat(path, (struct stat*)out); }
int lstat64(const char* path, struct stat64* out) { return lstat(path, (struct stat*)out); }
int fstat64(int file, struct stat64* out) { return fstat(file, (struct stat*)out); }
int fstatat64(int folder, const char* path, struct stat64* out, int flags) {
  return fstatat(folder, path, (struct stat*)out, flags);
}

// glibc 2.36. Used by std::random_device.
uint32_t arc4random(void) {
  uint32_t value;
  while (getrandom(&value, sizeof value, 0) != sizeof value)
    if (errno != EINTR && errno != EAGAIN) abort();
  return value;
}

#pragma GCC visibility pop
