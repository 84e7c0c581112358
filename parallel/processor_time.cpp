// Processor time by clock_gettime, waiting for cores by Linux's statistics of the scheduler. The
// quick form adds the time that has passed since the system was asked last to what it said then,
// and never goes back.
#include "parallel/processor_time.h"

#include <fcntl.h>
#include <time.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <charconv>

namespace delray::parallel {
namespace {

constexpr std::int64_t kUnasked = 200'000;  // ns

std::int64_t nanoseconds(clockid_t clock) {
  timespec time{};
  clock_gettime(clock, &time);
  return std::int64_t{time.tv_sec} * 1'000'000'000 + time.tv_nsec;
}

// When the system was asked, and what it said.
struct Asked {
  std::int64_t when = -kUnasked, answer = 0, last = 0;
};

}  // namespace

std::int64_t processor_nanoseconds() { return nanoseconds(CLOCK_THREAD_CPUTIME_ID); }

std::optional<std::int64_t> core_wait_nanoseconds() {
  // Of the thread that opens it: time on a core, time waiting for one, number of turns.
  struct Opened {
    int file = open("/proc/thread-self/schedstat", O_RDONLY | O_CLOEXEC);
    ~Opened() {
      if (file >= 0) close(file);
    }
  };
  thread_local const Opened opened;
  std::array<char, 96> text{};
  const ssize_t size = opened.file < 0 ? -1 : pread(opened.file, text.data(), text.size(), 0);
  if (size <= 0) return std::nullopt;
  const char* const end = text.data() + size;
  const char* const second = std::find(text.data(), text.data() + size, ' ') + 1;
  std::int64_t result = 0;
  if (second >= end || std::from_chars(second, end, result).ec != std::errc()) return std::nullopt;
  return result;
}

std::int64_t quick_processor_nanoseconds() {
  thread_local Asked asked;
  const std::int64_t now = nanoseconds(CLOCK_MONOTONIC);
  if (now - asked.when >= kUnasked) {
    asked.when = now;
    asked.answer = processor_nanoseconds();
  }
  asked.last = std::max(asked.last, asked.answer + (now - asked.when));
  return asked.last;
}

}  // namespace delray::parallel
