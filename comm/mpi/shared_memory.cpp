// Shared memory without a name (memfd_create), reached by others through /proc. A random token at
// its beginning tells whether the file is the one that was meant.
//
// A message is handed over by setting a flag in front of its block, which the receiver clears.
// Waiting processes sleep on a futex over a count of rings. Constant time per message, besides
// mapping the memory of a process once.
//
// Degenerate: where address space is scarce the message is copied through the file; where the
// system forbids any of this there is no shared memory and MPI copies.
#include "comm/mpi/shared_memory.h"

#include <fcntl.h>
#include <linux/futex.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdio>
#include <cstring>
#include <ctime>
#include <map>
#include <mutex>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "comm/transport/block_pool.h"

namespace delray::comm::internal {
namespace {

// Of which only what was written to takes memory.
constexpr std::size_t kBytes = std::size_t{1} << 28;
// In front of the blocks.
struct Beginning {
  std::uint64_t token = 0;
  alignas(64) std::atomic<std::uint32_t> rings{0};
  std::atomic<bool> is_asleep{false};
  std::atomic<Phase> phase{Phase::other};
  std::atomic<std::int32_t> waits_for{kWaitsForNobody};
};
constexpr std::size_t kBeginningBytes = 4096;
static_assert(sizeof(Beginning) <= kBeginningBytes);
static_assert(std::atomic<Phase>::is_always_lock_free);
static_assert(sizeof(std::atomic<std::uint32_t>) == 4);  // a futex

Beginning& beginning_of(std::byte* memory) { return *reinterpret_cast<Beginning*>(memory); }

// Of processes, not of threads.
long futex(std::atomic<std::uint32_t>& word, int operation, std::uint32_t value,
           const timespec* longest) {
  return syscall(SYS_futex, reinterpret_cast<std::uint32_t*>(&word), operation, value, longest,
                 nullptr, 0);
}

// Null where the system does not allow it.
std::byte* map(int file, std::size_t bytes) {
  void* const memory = mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_SHARED, file, 0);
  if (memory == MAP_FAILED) return nullptr;
  if (bytes == kBytes) {
    madvise(memory, bytes, MADV_HUGEPAGE);  // fewer page faults, where the system allows it
  }
  return static_cast<std::byte*>(memory);
}

// Whether another mapping of kBytes leaves this process enough of its address space for its work.
bool has_address_space() {
  constexpr std::size_t kLeft = 4 * kBytes;
  rlimit limit{};
  if (getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) return true;
  std::size_t pages = 0;
  FILE* const file = std::fopen("/proc/self/statm", "r");
  if (file == nullptr) return false;
  const bool is_known = std::fscanf(file, "%zu", &pages) == 1;
  std::fclose(file);
  const std::size_t used = pages * static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
  return is_known && used + kLeft <= limit.rlim_cur;
}

// Whether a file may become as large: the system sends SIGXFSZ where not.
bool may_be_as_large() {
  rlimit limit{};
  return getrlimit(RLIMIT_FSIZE, &limit) == 0 && limit.rlim_cur >= kBytes;
}

struct Own {
  SharedMemory where;
  std::byte* memory = nullptr;
};

Own make() {
#ifdef DELRAY_ASAN
  return {};  // it knows nothing of such blocks
#endif
  if (!has_address_space() || !may_be_as_large()) return {};
  const int file = memfd_create("delray", MFD_CLOEXEC);
  if (file < 0) return {};
  std::byte* const memory = ftruncate(file, kBytes) == 0 ? map(file, kBytes) : nullptr;
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
  std::byte* beginning = nullptr;  // kBeginningBytes; null: out of reach
  std::byte* memory = nullptr;     // all of it; null: not yet, or too little address space
  bool is_too_large = false;       // to be mapped
  std::vector<bool> is_mapped;     // by unit of kUnit bytes
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

// The file of another process's memory; closed with it.
class OpenMemory {
 public:
  explicit OpenMemory(const SharedMemory& other) {
    if (other.file < 0) return;
    const std::string path =
        "/proc/" + std::to_string(other.process) + "/fd/" + std::to_string(other.file);
    file_ = open(path.c_str(), O_RDWR | O_CLOEXEC);
    std::uint64_t token = 0;
    // The same number may be another process's to this one.
    if (file_ < 0 || (read(0, &token, sizeof token) && token == other.token)) return;
    close(file_);
    file_ = -1;
  }
  ~OpenMemory() {
    if (file_ >= 0) close(file_);
  }
  OpenMemory(const OpenMemory&) = delete;
  OpenMemory& operator=(const OpenMemory&) = delete;

  int file() const { return file_; }
  bool read(std::size_t offset, void* to, std::size_t bytes) const {
    for (auto* next = static_cast<std::byte*>(to); bytes > 0;) {
      const ssize_t done = pread(file_, next, bytes, static_cast<off_t>(offset));
      if (done <= 0) return false;
      next += done;
      offset += static_cast<std::size_t>(done);
      bytes -= static_cast<std::size_t>(done);
    }
    return true;
  }

 private:
  int file_ = -1;
};

// All processes that were ever asked for, kept to the end, since buffers in their memory may be.
struct Known {
  std::mutex mutex;
  std::map<std::pair<std::int64_t, std::uint64_t>, Reached> memories;

  // REQUIRES: the caller holds the mutex.
  Reached& operator[](const SharedMemory& other) {
    const auto [at, is_new] = memories.try_emplace({other.process, other.token});
    if (is_new) {
      const OpenMemory memory(other);
      if (memory.file() >= 0) at->second.beginning = map(memory.file(), kBeginningBytes);
    }
    return at->second;
  }
};
Known& known() {
  static Known& all = *new Known;
  return all;
}

Beginning* beginning_of(const SharedMemory& other) {
  const std::scoped_lock lock(known().mutex);
  return reinterpret_cast<Beginning*>(known()[other].beginning);
}

// The bytes [begin, end) of another's memory, in this process's page table; null where it is out of
// reach or cannot be mapped.
std::byte* mapped(const SharedMemory& other, std::size_t begin, std::size_t end) {
  const std::scoped_lock lock(known().mutex);
  Reached& reached = known()[other];
  if (reached.memory == nullptr && reached.beginning != nullptr && !reached.is_too_large) {
    const OpenMemory memory(other);
    if (memory.file() >= 0 && has_address_space()) reached.memory = map(memory.file(), kBytes);
    reached.is_too_large = reached.memory == nullptr;
    if (!reached.is_too_large) reached.is_mapped.resize(kBytes / kUnit);
  }
  if (reached.memory == nullptr) return nullptr;
  touch(reached, begin, end);
  return reached.memory + begin;
}

// What a message in another's memory says of itself.
bool is_lent(const SharedMemory& other, const Block& block, std::size_t bytes) {
  return block.process == other.process && block.lent.load(std::memory_order_acquire) &&
         block_holds(block.index, bytes);
}

// Through the file, byte by byte: nothing of the other's memory is mapped.
std::optional<Buffer> copy_of(const SharedMemory& other, std::size_t begin, std::size_t bytes) {
  const OpenMemory memory(other);
  alignas(Block) std::array<std::byte, sizeof(Block)> header;
  if (memory.file() < 0 || !memory.read(begin, header.data(), header.size()) ||
      !is_lent(other, *reinterpret_cast<const Block*>(header.data()), bytes)) {
    return std::nullopt;
  }
  Buffer copy(bytes);
  if (!memory.read(begin + sizeof(Block), copy.data(), bytes)) return std::nullopt;
  constexpr char kNoMore = 0;
  const auto lent = static_cast<off_t>(begin + offsetof(Block, lent));
  if (pwrite(memory.file(), &kNoMore, 1, lent) != 1) return std::nullopt;
  return copy;
}

}  // namespace

SharedMemory share_memory() { return own().where; }

bool can_reach(const SharedMemory& other) { return beginning_of(other) != nullptr; }

std::optional<std::uint64_t> lend(Buffer& message) {
  if (!Buffer::is_pooled(message.size())) return std::nullopt;
  Block* const block = Block::of(message.data());
  if (!block_pool().is_shared(*block)) return std::nullopt;
  message.release();
  return block_pool().lend(block);
}

std::optional<Buffer> borrow(const SharedMemory& other, std::uint64_t offset, std::size_t bytes) {
  constexpr std::size_t kForBlocks = kBytes - kBeginningBytes - sizeof(Block);
  if (offset % alignof(Block) != 0 || offset > kForBlocks || bytes > kForBlocks - offset ||
      !Buffer::is_pooled(bytes)) {
    return std::nullopt;
  }
  const std::size_t begin = kBeginningBytes + offset;
  std::byte* const memory = mapped(other, begin, begin + sizeof(Block) + bytes);
  if (memory == nullptr) return copy_of(other, begin, bytes);
  auto* const block = reinterpret_cast<Block*>(memory);
  if (!is_lent(other, *block, bytes)) return std::nullopt;
  return Buffer::of_memory(block->memory(), bytes);
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
  Beginning* const theirs = beginning_of(other);
  if (theirs == nullptr) return;
  ++theirs->rings;
  if (theirs->is_asleep.load()) futex(theirs->rings, FUTEX_WAKE, 1, nullptr);
}

void publish_phase(Phase phase) {
  beginning_of(own().memory).phase.store(phase, std::memory_order_relaxed);
}

void publish_waiting(std::int32_t for_rank) {
  beginning_of(own().memory).waits_for.store(for_rank, std::memory_order_relaxed);
}

std::optional<Doing> doing(const SharedMemory& other) {
  const Beginning* const theirs = beginning_of(other);
  if (theirs == nullptr) return std::nullopt;
  return Doing{theirs->phase.load(), theirs->waits_for.load()};
}

}  // namespace delray::comm::internal
