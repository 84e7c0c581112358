// Time between two calls of MPI is recorded as work: the clock's where each process of this machine
// has a core, else the processor time of the thread that calls (parallel/processor_time.h).
#include "comm/mpi_record/journal.h"

#include <algorithm>
#include <cstdio>
#include <exception>
#include <thread>

#include "comm/ledger_file.h"
#include "files/atomic_file.h"
#include "files/read_file.h"
#include "parallel/processor_time.h"

namespace delray::comm::mpi_record {
namespace {

// The largest tag that a ledger has.
constexpr int kTagMask = (1 << 30) - 1;

std::string command_line() {
  std::string text;
  try {
    text = files::read_file("/proc/self/cmdline");
  } catch (const std::exception&) {
    return "an MPI program";
  }
  while (!text.empty() && text.back() == '\0') text.pop_back();
  std::ranges::replace(text, '\0', ' ');
  return text;
}

// The number of processes that share this machine.
int processes_here() {
  MPI_Comm here = MPI_COMM_NULL;
  int count = 1;
  PMPI_Comm_split_type(MPI_COMM_WORLD, MPI_COMM_TYPE_SHARED, 0, MPI_INFO_NULL, &here);
  PMPI_Comm_size(here, &count);
  PMPI_Comm_free(&here);
  return count;
}

int cores() { return static_cast<int>(std::max(1U, std::thread::hardware_concurrency())); }

}  // namespace

Journal& journal() {
  static Journal one;
  return one;
}

std::uint64_t bytes_of(int count, MPI_Datatype type) {
  int size = 0;
  PMPI_Type_size(type, &size);
  return static_cast<std::uint64_t>(std::max(0, count)) * static_cast<std::uint64_t>(size);
}

void Journal::start() {
  PMPI_Comm_rank(MPI_COMM_WORLD, &rank_);
  PMPI_Comm_size(MPI_COMM_WORLD, &ranks_);
  has_cores_ = processes_here() <= cores();
  PMPI_Barrier(MPI_COMM_WORLD);
  begun_ = left_ = PMPI_Wtime();
  processor_left_ = parallel::processor_nanoseconds();
  running_ = true;
}

double Journal::enter() {
  const double now = PMPI_Wtime();
  const std::int64_t passed = has_cores_
                                  ? static_cast<std::int64_t>((now - left_) * 1e9)
                                  : std::min(static_cast<std::int64_t>((now - left_) * 1e9) + 1000,
                                             parallel::processor_nanoseconds() - processor_left_);
  if (passed > 0) {
    Event event;
    event.kind = Event::Kind::work;
    event.amount = static_cast<std::uint64_t>(passed);
    event.begin = left_ - begun_;
    event.end = now - begun_;
    events_.push_back(event);
  }
  return now - begun_;
}

void Journal::leave() {
  left_ = PMPI_Wtime();
  processor_left_ = parallel::processor_nanoseconds();
}

int Journal::world_rank(int rank, MPI_Comm communicator) {
  if (communicator == MPI_COMM_WORLD) return rank;
  static_assert(sizeof(MPI_Comm) <= sizeof(std::uintptr_t));
  const auto key = (std::uintptr_t)communicator;
  Group& group = groups_[key];
  if (group.world_ranks.empty()) {
    int is_inter = 0, size = 0;
    PMPI_Comm_test_inter(communicator, &is_inter);
    MPI_Group members = MPI_GROUP_NULL, world = MPI_GROUP_NULL;
    if (is_inter != 0) {
      PMPI_Comm_remote_group(communicator, &members);
    } else {
      PMPI_Comm_group(communicator, &members);
    }
    PMPI_Comm_group(MPI_COMM_WORLD, &world);
    PMPI_Group_size(members, &size);
    std::vector<int> ranks(static_cast<std::size_t>(size));
    for (int i = 0; i < size; ++i) ranks[static_cast<std::size_t>(i)] = i;
    group.world_ranks.resize(ranks.size());
    PMPI_Group_translate_ranks(members, size, ranks.data(), world, group.world_ranks.data());
    PMPI_Group_free(&members);
    PMPI_Group_free(&world);
  }
  return group.world_ranks[static_cast<std::size_t>(rank)];
}

void Journal::forget(MPI_Comm communicator) { groups_.erase((std::uintptr_t)communicator); }

void Journal::add(Event::Kind kind, int peer, int tag, std::uint64_t bytes, double begin) {
  Event event;
  event.kind = kind;
  event.peer = peer;
  event.tag = tag & kTagMask;
  event.amount = bytes;
  event.begin = begin;
  event.end = PMPI_Wtime() - begun_;
  events_.push_back(event);
}

void Journal::send(int to, int tag, std::uint64_t bytes, MPI_Comm communicator, double begin) {
  if (to == MPI_PROC_NULL) return;
  const int peer = world_rank(to, communicator);
  if (peer >= 0) add(Event::Kind::send, peer, tag, bytes, begin);
}

void Journal::receive(int from, int tag, std::uint64_t bytes, MPI_Comm communicator, double begin) {
  if (from < 0) return;
  const int peer = world_rank(from, communicator);
  if (peer >= 0) add(Event::Kind::receive, peer, tag, bytes, begin);
}

void Journal::finish(const std::string& file) {
  if (!running_) return;
  enter();
  running_ = false;
  // In pieces that a count of MPI's can tell.
  constexpr std::size_t kPiece = std::size_t{1} << 20;
  RecordedRun run;
  if (rank_ == 0) run.ledger.ranks.push_back(std::move(events_));
  std::uint64_t count = events_.size();
  if (rank_ > 0) {
    PMPI_Send(&count, 1, MPI_UINT64_T, 0, 0, MPI_COMM_WORLD);
    for (std::size_t at = 0; at < count; at += kPiece) {
      const std::size_t end = std::min<std::size_t>(count, at + kPiece);
      PMPI_Send(events_.data() + at, static_cast<int>((end - at) * sizeof(Event)), MPI_BYTE, 0, 0,
                MPI_COMM_WORLD);
    }
    return;
  }
  for (int rank = 1; rank < ranks_; ++rank) {
    PMPI_Recv(&count, 1, MPI_UINT64_T, rank, 0, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
    std::vector<Event>& events = run.ledger.ranks.emplace_back(count);
    for (std::size_t at = 0; at < count; at += kPiece) {
      const std::size_t end = std::min<std::size_t>(count, at + kPiece);
      PMPI_Recv(events.data() + at, static_cast<int>((end - at) * sizeof(Event)), MPI_BYTE, rank, 0,
                MPI_COMM_WORLD, MPI_STATUS_IGNORE);
    }
  }
  for (const std::vector<Event>& events : run.ledger.ranks)
    for (const Event& event : events) run.seconds = std::max(run.seconds, event.end);
  run.program = command_line();
  run.machine = machine_of(run.ledger, cores());
  try {
    files::write_file(file, ledger_text(run));
  } catch (const std::exception& error) {
    std::fprintf(stderr, "libdelray_record: %s\n", error.what());
  }
}

}  // namespace delray::comm::mpi_record
