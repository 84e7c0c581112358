// Devices for a test alone.
#pragma once

#include <fcntl.h>
#include <sys/stat.h>
#include <sys/sysmacros.h>
#include <unistd.h>

#include <filesystem>

namespace delray::tests {

// Minor numbers of memory devices (Linux: major number 1).
inline constexpr unsigned kNull = 3, kFull = 7;

// Makes a node that leads to the device; false, with nothing made, where that is not allowed: only
// root may, and folders may be mounted so that no devices can be opened there.
inline bool make_device(const std::filesystem::path& path, unsigned minor_number) {
  if (::mknod(path.c_str(), S_IFCHR | 0666, makedev(1, minor_number)) != 0) return false;
  const int descriptor = ::open(path.c_str(), O_WRONLY | O_CLOEXEC);
  if (descriptor >= 0) {
    ::close(descriptor);
    return true;
  }
  std::filesystem::remove(path);
  return false;
}

}  // namespace delray::tests
