#include "comm/internal/shared_memory.h"

#include <fcntl.h>
#include <linux/futex.h>
#include <sys/mman.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <atomic>
#include <ctime>
#include <map>
#include <mutex>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "comm/internal/block_pool.h"

namespace delray::comm::internal {
namespace {

// Of which only what was written to takes memory.
constexpr std::size_t kBytes = std::size_t{1} << 28;
// In front of the blocks.
struct Beginning {
  std::uint64_t token = 0;
  alignas(64) std::atomic<std::uint32_t> rings{0};
  std::atomic<bool> is_asleep{false};
};
constexpr std::size_t kBeginningBytes = 4096;
static_assert(sizeof(Beginning) <= kBeginningBytes);
static_assert(sizeof(std::atomic<std::uint32_t>) == 4);  // a futex

Beginning& beginning_of(std::byte* memory) { return *reinterpret_cast<Beginning*>(memory); }

// Of processes, not of threads.
long futex(std::atomic<std::uint32_t>& word, int operation, std::uint32_t value,
           const timespec* longest) {
  return syscall(SYS_futex, reinterpret_cast<std::uint32_t*>(&word), operation, value, longest,
                 nullptr, 0);
}

std::byte* map(int file) {
  void* const memory = mmap(nullptr, kBytes, PROT_READ | PROT_WRITE, MAP_SHARED, file, 0);
  if (memory == MAP_FAILED) return nullptr;
  madvise(memory, kBytes, MADV_HUGEPAGE);  // fewer page faults, where the system allows it
  return static_cast<std::byte*>(memory);
}

struct Own {
  SharedMemory where;
  std::byte* memory = nullptr;
};

Own make() {
#if defined(__SANITIZE_ADDRESS__)
  return {};  // it knows nothing of such blocks
#endif
  const int file = memfd_create("delray", MFD_CLOEXEC);
  if (file < 0) return {};
  std::byte* const memory = ftruncate(file, kBytes) == 0 ? map(file) : nullptr;
  if (memory == nullptr) {
    close(file);
    return {};
  }
  std::random_device random;
  const SharedMemory mine{getpid(), file, 0, std::uint64_t{random()} << 32 | random()};
  new (memory) Beginning{mine.token};
  block_pool().share(mine.process, {memory + kBeginningBytes, kBytes - kBeginningBytes});
  return {mine, memory};
}

const Own& own() {
  static const Own mine = make();
  return mine;
}

// Another process's memory where this one sees it.
struct Reached {
  std::byte* memory = nullptr;  // null: out of reach
  std::vector<bool> is_mapped;  // by unit of kUnit bytes
};
constexpr std::size_t kPage = 4096, kUnit = 16 * kPage;

// Has pages come into this process's page table. Vector loops that read only what they select must
// not meet one that is not there: the processor then skips the bytes, slowly, and the page stays
// out.
void touch(Reached& reached, std::size_t begin, std::size_t end) {
  for (std::size_t unit = begin / kUnit; unit * kUnit < end; ++unit) {
    if (reached.is_mapped[unit]) continue;
    reached.is_mapped[unit] = true;
    for (std::size_t at = unit * kUnit; at < (unit + 1) * kUnit; at += kPage) {
      static_cast<void>(*static_cast<const volatile std::byte*>(reached.memory + at));
    }
  }
}

Reached reach_now(const SharedMemory& other) {
  if (other.file < 0) return {};
  const std::string path =
      "/proc/" + std::to_string(other.process) + "/fd/" + std::to_string(other.file);
  const int file = open(path.c_str(), O_RDWR | O_CLOEXEC);
  if (file < 0) return {};
  Reached reached;
  std::uint64_t token = 0;
  // The same number may be another process's to this one.
  if (pread(file, &token, sizeof token, 0) == sizeof token && token == other.token) {
    reached = {map(file), std::vector<bool>(kBytes / kUnit)};
  }
  close(file);
  return reached;
}

// Of all processes that were ever asked for, kept to the end, since buffers in it may be. With the
// bytes [begin, end) of it in the page table.
std::byte* reach(const SharedMemory& other, std::size_t begin = 0, std::size_t end = 0) {
  struct Known {
    std::mutex mutex;
    std::map<std::pair<std::int64_t, std::uint64_t>, Reached> memories;
  };
  static Known& known = *new Known;
  const std::scoped_lock lock(known.mutex);
  const auto [at, is_new] = known.memories.try_emplace({other.process, other.token});
  if (is_new) at->second = reach_now(other);
  if (at->second.memory != nullptr) touch(at->second, begin, end);
  return at->second.memory;
}

}  // namespace

SharedMemory share_memory() { return own().where; }

bool can_reach(const SharedMemory& other) { return reach(other) != nullptr; }

std::optional<std::uint64_t> lend(Buffer& message) {
  if (!Buffer::is_pooled(message.size())) return std::nullopt;
  Block* const block = Block::of(message.data());
  if (!block_pool().is_shared(*block)) return std::nullopt;
  message.release();
  return block_pool().lend(block);
}

Buffer borrow(const SharedMemory& other, std::uint64_t offset, std::size_t bytes) {
  const std::size_t begin = kBeginningBytes + offset;
  std::byte* const memory = reach(other, begin, begin + sizeof(Block) + bytes);
  assert(memory != nullptr);
  return Buffer::of_memory(reinterpret_cast<Block*>(memory + begin)->memory(), bytes);
}

std::uint32_t rings() { return beginning_of(own().memory).rings.load(); }

void sleep_until_rung(std::uint32_t rings_seen, std::chrono::microseconds longest) {
  Beginning& mine = beginning_of(own().memory);
  mine.is_asleep = true;
  const timespec time{longest.count() / 1'000'000, longest.count() % 1'000'000 * 1000};
  if (mine.rings.load() == rings_seen) futex(mine.rings, FUTEX_WAIT, rings_seen, &time);
  mine.is_asleep = false;
}

void ring(const SharedMemory& other) {
  std::byte* const memory = reach(other);
  if (memory == nullptr) return;
  Beginning& theirs = beginning_of(memory);
  ++theirs.rings;
  if (theirs.is_asleep.load()) futex(theirs.rings, FUTEX_WAKE, 1, nullptr);
}

}  // namespace delray::comm::internal
