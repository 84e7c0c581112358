// Loaded before the system's library: reading a file at a place (pread) fails, as on a disk that is
// broken, from byte DELRAY_FAIL_FROM on to byte DELRAY_FAIL_TO.
#include <dlfcn.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>

extern "C" ssize_t pread(int file, void* bytes, size_t size, off_t offset) {
  using Read = ssize_t (*)(int, void*, size_t, off_t);
  static const auto next = reinterpret_cast<Read>(::dlsym(RTLD_NEXT, "pread"));
  const char* const from = std::getenv("DELRAY_FAIL_FROM");
  const char* const to = std::getenv("DELRAY_FAIL_TO");
  if (from != nullptr && to != nullptr && offset >= std::atoll(from) && offset < std::atoll(to)) {
    errno = EIO;
    return -1;
  }
  return next(file, bytes, size, offset);
}
