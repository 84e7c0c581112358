// What libdelray_record.so writes down of one MPI process, and the ledger that it makes of it.
#pragma once

#define OMPI_SKIP_MPICXX 1
#define MPICH_SKIP_MPICXX 1
#include <mpi.h>

#include <cstdint>
#include <mutex>
#include <string>
#include <unordered_map>
#include <vector>

#include "comm/ledger.h"

namespace delray::comm::mpi_record {

// The events of this process. Several threads may call (MPI_THREAD_MULTIPLE): a lock orders what
// they do; time between messages is then that of the clock at whichever is next.
class Journal {
 public:
  // After MPI_Init: waits for all ranks. Collective.
  void start();
  bool is_running() const { return running_; }

  // The rank's work until now, then a call that begins now.
  double enter();
  // From now on the rank works.
  void leave();

  // REQUIRES for these and for enter and leave: the lock is held, and it is running. `begin` is
  // what enter gave. Ranks are the communicator's; a message to or from MPI_PROC_NULL is none.
  void send(int to, int tag, std::uint64_t bytes, MPI_Comm communicator, double begin);
  void receive(int from, int tag, std::uint64_t bytes, MPI_Comm communicator, double begin);

  // Before the communicator is freed, whose handle may stand for another one then.
  void forget(MPI_Comm communicator);

  // Gathers the events of all ranks; rank 0 writes them to `file`. Collective, before MPI_Finalize.
  void finish(const std::string& file);

  std::mutex& mutex() { return mutex_; }

 private:
  struct Group {
    std::vector<int> world_ranks;  // indexed by rank in the communicator
  };
  int world_rank(int rank, MPI_Comm communicator);
  void add(Event::Kind kind, int peer, int tag, std::uint64_t bytes, double begin);

  std::mutex mutex_;
  std::vector<Event> events_;
  std::unordered_map<std::uintptr_t, Group> groups_;  // by handle
  bool running_ = false, has_cores_ = true;
  double begun_ = 0, left_ = 0;
  std::int64_t processor_left_ = 0;
  int rank_ = 0, ranks_ = 1;
};

Journal& journal();

// A call of MPI that a program makes: what it did before is work.
class Call {
 public:
  Call() {
    const std::lock_guard lock(journal().mutex());
    if (journal().is_running()) begin = journal().enter();
  }
  ~Call() {
    const std::lock_guard lock(journal().mutex());
    if (journal().is_running()) journal().leave();
  }
  Call(const Call&) = delete;
  Call& operator=(const Call&) = delete;
  double begin = 0;
};

// Bytes of so many values.
std::uint64_t bytes_of(int count, MPI_Datatype type);

}  // namespace delray::comm::mpi_record
