// Collectives, written down as messages of the algorithms that are named beside each, whatever the
// MPI of the recorded run used: a ledger has messages only, and another network's MPI would choose
// for itself. All blocking collectives of communicators within one group; others are not recorded.
#include <algorithm>
#include <numeric>

#include "comm/mpi_record/journal.h"

namespace delray::comm::mpi_record {
namespace {

constexpr int kTag = kReservedTags;

// The messages of one collective, as this rank sends and receives them. Nothing where it is not
// recorded.
class Messages {
 public:
  Messages(MPI_Comm all, double begin) : all_(all), begin_(begin), lock_(journal().mutex()) {
    int is_inter = 0;
    PMPI_Comm_test_inter(all, &is_inter);
    is_recorded_ = journal().is_running() && is_inter == 0;
    PMPI_Comm_rank(all, &rank);
    PMPI_Comm_size(all, &size);
  }
  void send(int to, std::uint64_t bytes) {
    if (is_recorded_) journal().send(to, kTag, bytes, all_, begin_);
  }
  void receive(int from, std::uint64_t bytes) {
    if (is_recorded_) journal().receive(from, kTag, bytes, all_, begin_);
  }

  // In round i each rank hears of the one 2^i before it (dissemination: Hensgen, Finkel and Manber
  // 1988).
  void disseminate(std::uint64_t bytes) {
    for (int step = 1; step < size; step *= 2) {
      send((rank + step) % size, bytes);
      receive((rank - step + size) % size, bytes);
    }
  }
  // Along a binomial tree from the root, the farthest first.
  void broadcast(int root, std::uint64_t bytes) {
    const int me = (rank - root + size) % size;
    int step = 1;
    for (; step < size; step *= 2) {
      if ((me & step) == 0) continue;
      receive((me - step + root) % size, bytes);
      break;
    }
    for (step /= 2; step > 0; step /= 2)
      if (me + step < size) send((me + step + root) % size, bytes);
  }
  // The same tree towards the root, the nearest first.
  void reduce(int root, std::uint64_t bytes) {
    const int me = (rank - root + size) % size;
    for (int step = 1; step < size; step *= 2) {
      if ((me & step) != 0) return send((me - step + root) % size, bytes);
      if (me + step < size) receive((me + step + root) % size, bytes);
    }
  }
  // Each part straight to the root, or from it. `bytes` of a rank are asked for at the root alone.
  template <class Bytes>
  void gather(int root, std::uint64_t own, Bytes&& bytes) {
    if (rank != root) return send(root, own);
    for (int from = 0; from < size; ++from)
      if (from != root) receive(from, bytes(from));
  }
  template <class Bytes>
  void scatter(int root, std::uint64_t own, Bytes&& bytes) {
    if (rank != root) return receive(root, own);
    for (int to = 0; to < size; ++to)
      if (to != root) send(to, bytes(to));
  }
  // Parts go round in a ring: in step s a rank passes on that of the s-th before it.
  template <class Bytes>
  void gather_all(Bytes&& bytes) {
    for (int step = 0; step + 1 < size; ++step) {
      send((rank + 1) % size, bytes((rank - step + size) % size));
      receive((rank + size - 1) % size, bytes((rank - step - 1 + size) % size));
    }
  }
  // In step s to the s-th after it, from the s-th before.
  template <class To, class From>
  void exchange(To&& to, From&& from) {
    for (int step = 1; step < size; ++step) {
      const int next = (rank + step) % size, before = (rank - step + size) % size;
      send(next, to(next));
      receive(before, from(before));
    }
  }
  // One after the other.
  void chain(std::uint64_t bytes) {
    if (rank > 0) receive(rank - 1, bytes);
    if (rank + 1 < size) send(rank + 1, bytes);
  }

  int rank = 0, size = 1;

 private:
  MPI_Comm all_;
  double begin_;
  bool is_recorded_ = false;
  std::lock_guard<std::mutex> lock_;
};

std::uint64_t at(const int counts[], int rank, MPI_Datatype type) {
  return bytes_of(counts[rank], type);
}

}  // namespace
}  // namespace delray::comm::mpi_record

using namespace delray::comm::mpi_record;

extern "C" {

int MPI_Barrier(MPI_Comm all) {
  const Call call;
  const int result = PMPI_Barrier(all);
  Messages(all, call.begin).disseminate(0);
  return result;
}
int MPI_Bcast(void* data, int count, MPI_Datatype type, int root, MPI_Comm all) {
  const Call call;
  const int result = PMPI_Bcast(data, count, type, root, all);
  Messages(all, call.begin).broadcast(root, bytes_of(count, type));
  return result;
}
int MPI_Reduce(const void* data, void* into, int count, MPI_Datatype type, MPI_Op op, int root,
               MPI_Comm all) {
  const Call call;
  const int result = PMPI_Reduce(data, into, count, type, op, root, all);
  Messages(all, call.begin).reduce(root, bytes_of(count, type));
  return result;
}
int MPI_Allreduce(const void* data, void* into, int count, MPI_Datatype type, MPI_Op op,
                  MPI_Comm all) {
  const Call call;
  const int result = PMPI_Allreduce(data, into, count, type, op, all);
  Messages messages(all, call.begin);
  messages.reduce(0, bytes_of(count, type));
  messages.broadcast(0, bytes_of(count, type));
  return result;
}
int MPI_Gather(const void* data, int count, MPI_Datatype type, void* into, int into_count,
               MPI_Datatype into_type, int root, MPI_Comm all) {
  const Call call;
  const int result = PMPI_Gather(data, count, type, into, into_count, into_type, root, all);
  Messages messages(all, call.begin);
  const std::uint64_t own = messages.rank == root ? 0 : bytes_of(count, type);
  messages.gather(root, own, [&](int) { return bytes_of(into_count, into_type); });
  return result;
}
int MPI_Gatherv(const void* data, int count, MPI_Datatype type, void* into, const int counts[],
                const int starts[], MPI_Datatype into_type, int root, MPI_Comm all) {
  const Call call;
  const int result = PMPI_Gatherv(data, count, type, into, counts, starts, into_type, root, all);
  Messages messages(all, call.begin);
  const std::uint64_t own = messages.rank == root ? 0 : bytes_of(count, type);
  messages.gather(root, own, [&](int rank) { return at(counts, rank, into_type); });
  return result;
}
int MPI_Scatter(const void* data, int count, MPI_Datatype type, void* into, int into_count,
                MPI_Datatype into_type, int root, MPI_Comm all) {
  const Call call;
  const int result = PMPI_Scatter(data, count, type, into, into_count, into_type, root, all);
  Messages messages(all, call.begin);
  const std::uint64_t own = messages.rank == root ? 0 : bytes_of(into_count, into_type);
  messages.scatter(root, own, [&](int) { return bytes_of(count, type); });
  return result;
}
int MPI_Scatterv(const void* data, const int counts[], const int starts[], MPI_Datatype type,
                 void* into, int into_count, MPI_Datatype into_type, int root, MPI_Comm all) {
  const Call call;
  const int result =
      PMPI_Scatterv(data, counts, starts, type, into, into_count, into_type, root, all);
  Messages messages(all, call.begin);
  const std::uint64_t own = messages.rank == root ? 0 : bytes_of(into_count, into_type);
  messages.scatter(root, own, [&](int rank) { return at(counts, rank, type); });
  return result;
}
int MPI_Allgather(const void* data, int count, MPI_Datatype type, void* into, int into_count,
                  MPI_Datatype into_type, MPI_Comm all) {
  const Call call;
  const int result = PMPI_Allgather(data, count, type, into, into_count, into_type, all);
  Messages(all, call.begin).gather_all([&](int) { return bytes_of(into_count, into_type); });
  return result;
}
int MPI_Allgatherv(const void* data, int count, MPI_Datatype type, void* into, const int counts[],
                   const int starts[], MPI_Datatype into_type, MPI_Comm all) {
  const Call call;
  const int result = PMPI_Allgatherv(data, count, type, into, counts, starts, into_type, all);
  Messages(all, call.begin).gather_all([&](int rank) { return at(counts, rank, into_type); });
  return result;
}
int MPI_Alltoall(const void* data, int count, MPI_Datatype type, void* into, int into_count,
                 MPI_Datatype into_type, MPI_Comm all) {
  const Call call;
  const int result = PMPI_Alltoall(data, count, type, into, into_count, into_type, all);
  const auto bytes = [&](int) { return bytes_of(into_count, into_type); };
  Messages(all, call.begin).exchange(bytes, bytes);
  return result;
}
int MPI_Alltoallv(const void* data, const int counts[], const int starts[], MPI_Datatype type,
                  void* into, const int into_counts[], const int into_starts[],
                  MPI_Datatype into_type, MPI_Comm all) {
  const Call call;
  const int result =
      PMPI_Alltoallv(data, counts, starts, type, into, into_counts, into_starts, into_type, all);
  const bool in_place = data == MPI_IN_PLACE;
  Messages(all, call.begin)
      .exchange(
          [&](int to) { return in_place ? at(into_counts, to, into_type) : at(counts, to, type); },
          [&](int from) { return at(into_counts, from, into_type); });
  return result;
}
int MPI_Reduce_scatter(const void* data, void* into, const int counts[], MPI_Datatype type,
                       MPI_Op op, MPI_Comm all) {
  const Call call;
  const int result = PMPI_Reduce_scatter(data, into, counts, type, op, all);
  Messages messages(all, call.begin);
  const int values = std::accumulate(counts, counts + messages.size, 0);
  messages.reduce(0, bytes_of(values, type));
  messages.scatter(0, at(counts, messages.rank, type),
                   [&](int rank) { return at(counts, rank, type); });
  return result;
}
int MPI_Reduce_scatter_block(const void* data, void* into, int count, MPI_Datatype type, MPI_Op op,
                             MPI_Comm all) {
  const Call call;
  const int result = PMPI_Reduce_scatter_block(data, into, count, type, op, all);
  Messages messages(all, call.begin);
  const std::uint64_t part = bytes_of(count, type);
  messages.reduce(0, part * static_cast<std::uint64_t>(messages.size));
  messages.scatter(0, part, [&](int) { return part; });
  return result;
}
int MPI_Scan(const void* data, void* into, int count, MPI_Datatype type, MPI_Op op, MPI_Comm all) {
  const Call call;
  const int result = PMPI_Scan(data, into, count, type, op, all);
  Messages(all, call.begin).chain(bytes_of(count, type));
  return result;
}
int MPI_Exscan(const void* data, void* into, int count, MPI_Datatype type, MPI_Op op,
               MPI_Comm all) {
  const Call call;
  const int result = PMPI_Exscan(data, into, count, type, op, all);
  Messages(all, call.begin).chain(bytes_of(count, type));
  return result;
}

}  // extern "C"
