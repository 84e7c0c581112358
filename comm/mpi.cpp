#include "comm/mpi.h"

#include <sched.h>
#include <unistd.h>

#include <algorithm>
#include <cassert>
#include <cstdint>
#include <deque>
#include <exception>
#include <numeric>
#include <optional>
#include <thread>
#include <unordered_map>
#include <utility>
#include <vector>

#include "comm/collectives.h"
#include "comm/internal/first_failure.h"
#include "comm/internal/message_queue.h"
#include "comm/internal/mpi_end.h"
#include "comm/internal/mpi_header.h"
#include "comm/internal/shared_memory.h"
#include "comm/internal/shared_message.h"

namespace delray::comm {
namespace {

using Clock = std::chrono::steady_clock;

// Tags of MPI messages beyond those of the interface. Every MPI allows tags to 32767.
constexpr int kTagLong = 32000;   // announces a message that travels in pieces
constexpr int kTagPiece = 32001;  // a piece of the announced message
using internal::kTagShared;
static_assert(kEndOfReservedTags <= kTagLong);

struct LongMessage {
  std::int64_t tag;
  std::uint64_t bytes;
};

// A message that MPI may still be reading or writing.
struct Transfer {
  Buffer buffer;
  std::vector<MPI_Request> requests;
};

bool completed(std::vector<MPI_Request>& requests) {
  if (requests.empty()) return true;
  int done = 0;
  MPI_Testall(static_cast<int>(requests.size()), requests.data(), &done, MPI_STATUSES_IGNORE);
  if (done) requests.clear();
  return done != 0;
}

// What the communicators that come from one MPI communicator share.
struct Engine {
  MpiOptions options;
  MPI_Comm root = MPI_COMM_NULL;
  int root_rank = 0;
  bool cores_are_scarce = false;
  Clock::time_point start = Clock::now();
  Phase phase = Phase::other;
  // What was sent, and what came but was never received. Front to back in the order of the calls.
  std::deque<Transfer> unfinished;
  std::size_t next_sweep = 64;
  // Communicators destroyed by an exception: others may still send into them.
  struct Retired {
    MPI_Comm communicator;
    std::vector<int> world_ranks;
  };
  std::vector<Retired> retired;
  // By rank in `root`: processes of this machine that share memory.
  std::unordered_map<int, internal::SharedMemory> neighbours;
  bool all_are_neighbours = false;

  void finish_some() {
    std::erase_if(unfinished, [](Transfer& transfer) { return completed(transfer.requests); });
  }

  // Lets go of the buffers of finished sends. O(1) per message in total.
  void reap() {
    while (!unfinished.empty() && completed(unfinished.front().requests)) unfinished.pop_front();
    // One slow receiver must not keep the buffers for all others alive.
    if (unfinished.size() < next_sweep) return;
    finish_some();
    next_sweep = std::max<std::size_t>(64, 2 * unfinished.size());
  }

  [[noreturn]] void end(const std::string& why) const {
    internal::end_all_ranks(root, root_rank, phase, why, internal::kExitRankLost);
  }
};

// Waits between two looks at MPI: at first not at all, so that an answer is taken at once; then it
// lets others run; at last it sleeps, so that ranks without a core of their own do not take turns
// at finding nothing. While messages are on their way, which large ones are only as long as both
// ends look, it takes long to sleep.
class Patience {
 public:
  explicit Patience(const Engine& engine)
      : engine_(engine), looks_(engine.cores_are_scarce ? kSpins : 0) {}

  // How often others have rung for this process. To be read before one looks.
  std::uint32_t rings() const { return engine_.neighbours.empty() ? 0 : internal::rings(); }

  void pause(bool on_their_way = false, std::optional<std::uint32_t> rings_seen = std::nullopt) {
    ++looks_;
    if (looks_ <= kSpins) return;
    if (rings_seen && !on_their_way && !engine_.neighbours.empty()) {
      if (looks_ <= kSpins + kYieldsBeforeSleep) {
        sched_yield();
      } else {
        internal::sleep_until_rung(*rings_seen,
                                   engine_.all_are_neighbours ? kLongSleep : kShortSleep);
      }
      return;
    }
    const int rest = looks_ - kSpins - (on_their_way ? kYieldsOnTheWay : kYields);
    if (rest <= 0) {
      sched_yield();
      return;
    }
    std::this_thread::sleep_for(std::chrono::microseconds(std::min(rest, 200)));
    looks_ = std::min(looks_, kSpins + kYieldsOnTheWay + 1000);
  }

 private:
  // A look and a yield take about a microsecond where nobody else wants the core.
  static constexpr int kSpins = 1000, kYields = 1000, kYieldsOnTheWay = 100000;
  // Where those who send ring: for all messages, or but for those from other machines.
  static constexpr int kYieldsBeforeSleep = 4;
  static constexpr std::chrono::microseconds kLongSleep{1000}, kShortSleep{50};
  const Engine& engine_;
  int looks_;
};

// MPI's own matching is not used: whatever has come is moved into a queue, so that waiting for one
// message makes room for all others, and sends of any size complete.
class MpiCommunicator final : public Communicator {
 public:
  // Takes over `communicator`; `world_ranks` is indexed by rank in it.
  MpiCommunicator(std::shared_ptr<Engine> engine, MPI_Comm communicator,
                  std::vector<int> world_ranks)
      : engine_(std::move(engine)),
        communicator_(communicator),
        world_ranks_(std::move(world_ranks)) {
    MPI_Comm_rank(communicator_, &rank_);
  }

  ~MpiCommunicator() override {
    const bool unwinding = std::uncaught_exceptions() > 0;
    keep_unreceived();
    if (communicator_ == engine_->root) {
      if (!unwinding) {
        drain();
      } else {
        // An exception of this rank alone: the others would be waited for in vain, and MPI still
        // uses the buffers. The process is about to end.
        [[maybe_unused]] auto* leaked = new std::shared_ptr<Engine>(engine_);
      }
    } else if (unwinding) {
      engine_->retired.push_back({communicator_, std::move(world_ranks_)});
    } else {
      MPI_Comm_free(&communicator_);
    }
  }

  int rank() const override { return rank_; }
  int size() const override { return static_cast<int>(world_ranks_.size()); }
  int world_rank(int rank) const override { return world_ranks_[rank]; }
  double seconds() const override {
    return std::chrono::duration<double>(Clock::now() - engine_->start).count();
  }

  void send(int to, Tag tag, Buffer&& message) override {
    assert(0 <= to && to < size() && 0 <= tag && tag < kTagLong);
    if (to == rank_) {
      queue_.push(rank_, tag, 0, {std::move(message), {}});
      return;
    }
    engine_->reap();
    const std::size_t piece = engine_->options.piece_bytes;
    if (message.size() < piece && engine_->neighbours.count(world_ranks_[to]) > 0) {
      const std::size_t bytes = message.size();
      if (const auto place = internal::lend(message)) {
        const internal::SharedMessage announcement{tag, *place, bytes};
        start_send(to, kTagShared, Buffer::of_value(announcement), sizeof announcement);
        return;
      }
    }
    if (message.size() < piece) {
      start_send(to, tag, std::move(message), piece);
      return;
    }
    const LongMessage announcement{tag, message.size()};
    start_send(to, kTagLong, Buffer::of_value(announcement), sizeof announcement);
    start_send(to, kTagPiece, std::move(message), piece);
  }

  Buffer receive(int from_or_any, Tag tag_or_any) override {
    Message* message = wait(from_or_any, tag_or_any, Deadline::never(), /*whole=*/false);
    Transfer incoming = queue_.take(message);
    Patience patience(*engine_);
    while (!completed(incoming.requests)) patience.pause(/*on_their_way=*/true);
    return std::move(incoming.buffer);
  }

  std::optional<Envelope> probe(int from_or_any, Tag tag_or_any, Deadline deadline) override {
    const Message* message = wait(from_or_any, tag_or_any, deadline, /*whole=*/true);
    if (!message) return std::nullopt;
    return Envelope{message->source, message->tag, message->payload.buffer.size()};
  }

  std::unique_ptr<Communicator> split(int color, int key) override {
    // MPI wants colours that are not negative, so the colours are numbered.
    struct Choice {
      int color, key;
    };
    std::vector<Choice> choices;
    for (const Buffer& buffer : all_gather(*this, Buffer::of_value(Choice{color, key}))) {
      choices.push_back(buffer.as<Choice>()[0]);
    }
    std::vector<int> members, colors;
    for (int rank = 0; rank < size(); ++rank) {
      colors.push_back(choices[rank].color);
      if (choices[rank].color == color) members.push_back(rank);
    }
    std::sort(colors.begin(), colors.end());
    const auto number = std::lower_bound(colors.begin(), colors.end(), color) - colors.begin();
    std::stable_sort(members.begin(), members.end(),
                     [&](int a, int b) { return choices[a].key < choices[b].key; });
    for (int& member : members) member = world_ranks_[member];
    MPI_Comm part = MPI_COMM_NULL;
    MPI_Comm_split(communicator_, static_cast<int>(number), key, &part);
    return std::make_unique<MpiCommunicator>(engine_, part, std::move(members));
  }

  void mark(Phase phase, int) override {
    engine_->phase = phase;
    internal::note_phase(phase);
  }
  void work(Work, std::uint64_t) override {}

  void abort(std::string why) override { engine_->end(why); }

 private:
  using Message = internal::MessageQueue<Transfer>::Message;

  // REQUIRES: piece >= 1. An empty message is one piece.
  void start_send(int to, int mpi_tag, Buffer&& message, std::size_t piece) {
    Transfer& outgoing = engine_->unfinished.emplace_back();
    outgoing.buffer = std::move(message);
    std::size_t begin = 0;
    do {
      const std::size_t count = std::min(piece, outgoing.buffer.size() - begin);
      MPI_Isend(outgoing.buffer.data() + begin, static_cast<int>(count), MPI_BYTE, to, mpi_tag,
                communicator_, &outgoing.requests.emplace_back());
      begin += count;
    } while (begin < outgoing.buffer.size());
    const auto neighbour = engine_->neighbours.find(world_ranks_[to]);
    if (neighbour != engine_->neighbours.end()) internal::ring(neighbour->second);
  }

  // Moves everything that has come into the queue. Order per source is kept: MPI does not let a
  // message overtake another of the same source that a wildcard probe would match.
  void pull() {
    for (;;) {
      int found = 0;
      MPI_Message handle;
      MPI_Status status;
      MPI_Improbe(MPI_ANY_SOURCE, MPI_ANY_TAG, communicator_, &found, &handle, &status);
      if (!found) return;
      if (status.MPI_TAG == kTagLong) {
        pull_long(handle, status.MPI_SOURCE);
      } else if (status.MPI_TAG == kTagShared) {
        pull_shared(handle, status.MPI_SOURCE);
      } else {
        int bytes = 0;
        MPI_Get_count(&status, MPI_BYTE, &bytes);
        Transfer incoming{Buffer(static_cast<std::size_t>(bytes)), {}};
        if (bytes <= kSurelyHere) {
          MPI_Mrecv(incoming.buffer.data(), bytes, MPI_BYTE, &handle, MPI_STATUS_IGNORE);
        } else {
          MPI_Imrecv(incoming.buffer.data(), bytes, MPI_BYTE, &handle,
                     &incoming.requests.emplace_back());
        }
        queue_.push(status.MPI_SOURCE, status.MPI_TAG, 0, std::move(incoming));
      }
    }
  }

  void pull_shared(MPI_Message& handle, int source) {
    internal::SharedMessage announcement{};
    MPI_Mrecv(&announcement, sizeof announcement, MPI_BYTE, &handle, MPI_STATUS_IGNORE);
    const internal::SharedMemory& neighbour = engine_->neighbours.at(world_ranks_[source]);
    if (!internal::can_reach(neighbour)) engine_->end("the memory of a neighbour is out of reach");
    Transfer incoming{internal::borrow(neighbour, announcement.place, announcement.bytes), {}};
    queue_.push(source, static_cast<Tag>(announcement.tag), 0, std::move(incoming));
  }

  void pull_long(MPI_Message& handle, int source) {
    LongMessage announcement{};
    MPI_Mrecv(&announcement, sizeof announcement, MPI_BYTE, &handle, MPI_STATUS_IGNORE);
    Transfer incoming{Buffer(announcement.bytes), {}};
    const std::size_t piece = engine_->options.piece_bytes;
    for (std::size_t begin = 0; begin < announcement.bytes; begin += piece) {
      const std::size_t count = std::min<std::size_t>(piece, announcement.bytes - begin);
      MPI_Irecv(incoming.buffer.data() + begin, static_cast<int>(count), MPI_BYTE, source,
                kTagPiece, communicator_, &incoming.requests.emplace_back());
    }
    queue_.push(source, static_cast<Tag>(announcement.tag), 0, std::move(incoming));
  }

  // The first message that matches; with `whole` when all of it has come.
  Message* find(int from, Tag tag, bool whole) {
    Message* message = queue_.find(from, tag);
    return !whole || message == nullptr || completed(message->payload.requests) ? message : nullptr;
  }

  Message* wait(int from, Tag tag, Deadline deadline, bool whole) {
    constexpr auto kNever = std::chrono::nanoseconds::max();
    if (Message* message = find(from, tag, whole)) return message;
    const auto longest = std::min(deadline.wait, engine_->options.timeout);
    Clock::time_point begin{};
    Patience patience(*engine_);
    for (bool first = true;; first = false) {
      const std::uint32_t rings_seen = patience.rings();
      pull();
      if (Message* message = find(from, tag, whole)) return message;
      if (engine_->options.progress != nullptr && engine_->options.progress->stop_requested()) {
        throw parallel::Interrupted{};
      }
      if (deadline.wait <= std::chrono::nanoseconds{0}) return nullptr;
      engine_->reap();
      if (first) {
        if (longest != kNever) begin = Clock::now();
      } else if (longest != kNever && Clock::now() - begin >= longest) {
        if (longest == deadline.wait) return nullptr;
        engine_->end("stalled: waited " +
                     std::to_string(std::chrono::duration<double>(longest).count()) +
                     " s for a message from " + internal::describe_pattern(from, tag));
      }
      const bool is_coming = queue_.find(from, tag) != nullptr;
      patience.pause(is_coming || !engine_->unfinished.empty(), rings_seen);
    }
  }

  // MPI may still be writing messages that nobody asked for.
  void keep_unreceived() {
    for (Transfer& transfer : queue_.take_all()) {
      if (!completed(transfer.requests)) engine_->unfinished.push_back(std::move(transfer));
    }
  }

  // Collective: returns once the sends of all ranks are complete. Every rank keeps taking messages
  // until all have said that theirs are out (the idea of NBX: Hoefler, Siebert and Lumsdaine 2010).
  void drain() {
    std::vector<std::unique_ptr<MpiCommunicator>> retired;
    for (auto& [communicator, world_ranks] : std::exchange(engine_->retired, {})) {
      retired.push_back(
          std::make_unique<MpiCommunicator>(engine_, communicator, std::move(world_ranks)));
    }
    MPI_Request everybody = MPI_REQUEST_NULL;
    bool finished_mine = false;
    int finished_all = 0;
    for (Patience patience(*engine_); !finished_all; patience.pause(!finished_mine)) {
      pull();
      for (const auto& communicator : retired) communicator->pull();
      engine_->finish_some();
      if (!finished_mine && engine_->unfinished.empty()) {
        finished_mine = true;
        MPI_Ibarrier(communicator_, &everybody);
      }
      if (finished_mine) MPI_Test(&everybody, &finished_all, MPI_STATUS_IGNORE);
    }
    // What the others have sent by now is complete on their side, but perhaps not on this one.
    keep_unreceived();
    retired.clear();
    for (Patience patience(*engine_); !engine_->unfinished.empty(); patience.pause()) {
      engine_->finish_some();
    }
    MPI_Comm_free(&communicator_);
  }

  // Up to this size every transport sends the bytes along with the envelope.
  static constexpr int kSurelyHere = 256;

  std::shared_ptr<Engine> engine_;
  MPI_Comm communicator_;
  int rank_ = 0;
  std::vector<int> world_ranks_;
  internal::MessageQueue<Transfer> queue_;
};

// Shares memory with the processes of this machine, `local`, if each can reach that of the next.
void share_memory(Engine& engine, MPI_Comm local, int processes) {
  struct Neighbour {
    std::int64_t rank;
    internal::SharedMemory memory;
  };
  const Neighbour mine{engine.root_rank, internal::share_memory()};
  std::vector<Neighbour> neighbours(static_cast<std::size_t>(processes));
  MPI_Allgather(&mine, sizeof mine, MPI_BYTE, neighbours.data(), sizeof mine, MPI_BYTE, local);
  int rank = 0;
  MPI_Comm_rank(local, &rank);
  int reached =
      internal::can_reach(neighbours[static_cast<std::size_t>((rank + 1) % processes)].memory);
  MPI_Allreduce(MPI_IN_PLACE, &reached, 1, MPI_INT, MPI_MIN, local);
  if (!reached) return;
  for (const Neighbour& neighbour : neighbours) {
    if (neighbour.rank != engine.root_rank) {
      engine.neighbours.emplace(static_cast<int>(neighbour.rank), neighbour.memory);
    }
  }
  int all = 1;
  MPI_Comm_size(engine.root, &all);
  engine.all_are_neighbours = processes == all;
}

void look_at_this_machine(Engine& engine) {
  MPI_Comm local = MPI_COMM_NULL;
  MPI_Comm_split_type(engine.root, MPI_COMM_TYPE_SHARED, 0, MPI_INFO_NULL, &local);
  int processes = 1;
  MPI_Comm_size(local, &processes);
  engine.cores_are_scarce = processes > sysconf(_SC_NPROCESSORS_ONLN);  // bound to some or not
  if (processes > 1 && engine.options.share_memory) share_memory(engine, local, processes);
  MPI_Comm_free(&local);
}

}  // namespace

std::unique_ptr<Communicator> make_mpi_communicator(const void* mpi_communicator,
                                                    const MpiOptions& options) {
  assert(options.piece_bytes >= 1 && options.piece_bytes < (std::size_t{1} << 31));
  const auto engine = std::make_shared<Engine>();
  engine->options = options;
  MPI_Comm_dup(*static_cast<const MPI_Comm*>(mpi_communicator), &engine->root);
  MPI_Comm_rank(engine->root, &engine->root_rank);
  look_at_this_machine(*engine);
  int size = 0;
  MPI_Comm_size(engine->root, &size);
  std::vector<int> world_ranks(size);
  std::iota(world_ranks.begin(), world_ranks.end(), 0);
  return std::make_unique<MpiCommunicator>(engine, engine->root, std::move(world_ranks));
}

}  // namespace delray::comm
