// Loaded before the system's library: reading a file at a place (pread, preadv2) fails, as on a
// disk that is broken, from byte DELRAY_FAIL_FROM on to byte DELRAY_FAIL_TO.
#include <dlfcn.h>
#include <sys/uio.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>

namespace {

bool fails(off_t offset) {
  const char* const from = std::getenv("DELRAY_FAIL_FROM");
  const char* const to = std::getenv("DELRAY_FAIL_TO");
  if (from == nullptr || to == nullptr || offset < std::atoll(from) || offset >= std::atoll(to))
    return false;
  errno = EIO;
  return true;
}

}  // namespace

extern "C" ssize_t pread(int file, void* bytes, size_t size, off_t offset) {
  using Read = ssize_t (*)(int, void*, size_t, off_t);
  static const auto next = reinterpret_cast<Read>(::dlsym(RTLD_NEXT, "pread"));
  return fails(offset) ? -1 : next(file, bytes, size, offset);
}

extern "C" ssize_t preadv2(int file, const iovec* parts, int count, off_t offset, int flags) {
  using Read = ssize_t (*)(int, const iovec*, int, off_t, int);
  static const auto next = reinterpret_cast<Read>(::dlsym(RTLD_NEXT, "preadv2"));
  return fails(offset) ? -1 : next(file, parts, count, offset, flags);
}
