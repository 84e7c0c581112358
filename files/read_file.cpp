// Streams are read through a table of those that are open, so that their first bytes can be looked
// at, more than once, before they are read.
#include "files/read_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <utility>

#include "files/error.h"

namespace delray::files {
namespace {

constexpr std::size_t kReadChunk = std::size_t{1}
                                   << 20;  // one read; large enough to amortise the call
constexpr std::size_t kEverything = static_cast<std::size_t>(-1);

struct Close {
  void operator()(std::FILE* file) const {
    if (file != stdin) std::fclose(file);
  }
};
using Handle = std::unique_ptr<std::FILE, Close>;

std::string name_of(const std::filesystem::path& path) {
  return path == "-" ? "standard input" : path.string();
}

Handle open(const std::filesystem::path& path) {
  std::error_code ignored;
  if (path != "-" && std::filesystem::is_directory(path, ignored)) {
    throw FileError(Cause::input, path.string(), "", "is a folder, not a file");
  }
  Handle file(path == "-" ? stdin : std::fopen(path.c_str(), "rb"));
  if (!file) throw FileError(Cause::input, path.string(), "", std::strerror(errno));
  return file;
}

// Reads on until `content` has `limit` bytes or the file ends; false if it has ended. Memory was
// asked for `granted` bytes already.
bool read_on(std::FILE* file, const std::string& name, std::size_t limit, std::size_t granted,
             const MemoryBudget& memory, std::string& content) {
  while (content.size() < limit) {
    const std::size_t old = content.size(), room = content.capacity() - old;
    const std::size_t step = std::min({kReadChunk, limit - old, room > 0 ? room : kReadChunk});
    // Where the string moves there are two of it for a while.
    if (old + step > granted && memory.left() < step + (room > 0 ? 0 : old)) {
      throw FileError(Cause::input, name, "",
                      "does not end within the " + bytes_text(memory.limit()) +
                          " of memory that the program may have (--memory)");
    }
    content.resize(old + step);
    const std::size_t got = std::fread(content.data() + old, 1, step, file);
    content.resize(old + got);
    if (std::ferror(file)) {
      throw FileError(Cause::device, name, "byte " + std::to_string(content.size()),
                      std::strerror(errno));
    }
    if (got == 0) return false;
  }
  return true;
}

struct Stream {
  Handle file;
  std::string start;  // what was read
  bool ended = false;

  void read_to(std::size_t limit, const std::string& name, const MemoryBudget& memory) {
    if (!ended) ended = !read_on(file.get(), name, limit, 0, memory, start);
  }
};

// The streams that somebody has looked at and nobody has read.
class OpenStreams {
 public:
  std::string start(const std::filesystem::path& path, std::size_t limit,
                    const MemoryBudget& memory) {
    const std::scoped_lock lock(mutex_);
    Stream& stream = find(path);
    stream.read_to(limit, name_of(path), memory);
    return stream.start.substr(0, limit);
  }
  std::string take(const std::filesystem::path& path, const MemoryBudget& memory) {
    const std::scoped_lock lock(mutex_);
    find(path).read_to(kEverything, name_of(path), memory);
    return std::move(streams_.extract(path).mapped().start);
  }

 private:
  Stream& find(const std::filesystem::path& path) {
    const auto found = streams_.find(path);
    if (found != streams_.end()) return found->second;
    return streams_.emplace(path, Stream{open(path), {}, false}).first->second;
  }

  std::mutex mutex_;
  std::map<std::filesystem::path, Stream> streams_;
};

OpenStreams& open_streams() {
  static OpenStreams streams;
  return streams;
}

std::string read_regular(const std::filesystem::path& path, std::size_t limit,
                         const MemoryBudget& memory) {
  const Handle file = open(path);
  std::string content;
  std::error_code error;
  const std::uintmax_t size = std::filesystem::file_size(path, error);
  const std::size_t expected = error ? 0 : std::min<std::uintmax_t>(size, limit);
  memory.require(expected, path.string());
  content.reserve(expected + 1);  // one for the read that finds the end
  read_on(file.get(), path.string(), limit, expected + 1, memory, content);
  return content;
}

}  // namespace

bool is_stream(const std::filesystem::path& path) {
  if (path == "-") return true;
  std::error_code error;
  const std::filesystem::file_status status = std::filesystem::status(path, error);
  return !error && !std::filesystem::is_regular_file(status) &&
         !std::filesystem::is_directory(status) && std::filesystem::exists(status);
}

std::string read_file(const std::filesystem::path& path, const MemoryBudget& memory) {
  return is_stream(path) ? open_streams().take(path, memory)
                         : read_regular(path, kEverything, memory);
}

void read_range(const std::filesystem::path& path, std::uint64_t begin, std::span<char> bytes) {
  const auto fail = [&](std::uint64_t byte, const char* what) {
    throw FileError(Cause::input, path.string(), "byte " + std::to_string(byte), what);
  };
  const int file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (file < 0) throw FileError(Cause::input, path.string(), "", std::strerror(errno));
  std::size_t read = 0;
  int error = 0;
  while (read < bytes.size() && error == 0) {
    const ssize_t got =
        ::pread(file, bytes.data() + read, bytes.size() - read, static_cast<off_t>(begin + read));
    if (got == 0) break;
    if (got > 0) read += static_cast<std::size_t>(got);
    if (got < 0 && errno != EINTR) error = errno;
  }
  ::close(file);
  if (error != 0) fail(begin + read, std::strerror(error));
  if (read < bytes.size()) fail(begin + read, "the file ends here, though it was longer before");
}

std::string read_start(const std::filesystem::path& path, std::size_t limit,
                       const MemoryBudget& memory) {
  return is_stream(path) ? open_streams().start(path, limit, memory)
                         : read_regular(path, limit, memory);
}

}  // namespace delray::files
