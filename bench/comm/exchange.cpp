// How long ranks take to exchange messages by a Communicator over MPI, over MPI_Isend and MPI_Irecv
// into buffers that are there already: mpirun -n 2 bench/comm_exchange. Each of a pair writes a
// message, sends it, and reads what comes; both ways take turns; medians. With --threads N the
// Communicator of in-process ranks stands in, and there is nothing to compare with.
#include <fmt/format.h>
#include <mpi.h>

#include <CLI/CLI.hpp>
#include <cstring>
#include <numeric>
#include <vector>

#include "bench/measure.h"
#include "bench/ratio.h"
#include "comm/collectives.h"
#include "comm/mpi.h"
#include "comm/threads.h"

namespace delray::bench {
namespace {

constexpr std::size_t kSizes[] = {std::size_t{1} << 10, std::size_t{1} << 14, std::size_t{1} << 17,
                                  std::size_t{1} << 20, std::size_t{1} << 23, std::size_t{1} << 24};

// As compositing does: every byte is written before and read afterwards.
std::uint64_t read_all(const std::byte* bytes, std::size_t size) {
  std::uint64_t sum = 0;
  for (std::size_t i = 0; i + 8 <= size; i += 8) {
    std::uint64_t value = 0;
    std::memcpy(&value, bytes + i, 8);
    sum += value;
  }
  return sum;
}

std::uint64_t exchange(comm::Communicator& communicator, std::size_t size, int round) {
  const int partner = communicator.rank() ^ 1;
  comm::Buffer message(size);
  std::memset(message.data(), round, size);
  communicator.send(partner, 1, std::move(message));
  const comm::Buffer received = communicator.receive(partner, 1);
  return read_all(received.data(), received.size());
}

class Raw {
 public:
  explicit Raw(std::size_t size) : out_(size), in_(size) {}
  std::uint64_t exchange(int rank, int round) {
    std::memset(out_.data(), round, out_.size());
    MPI_Request requests[2];
    const auto count = static_cast<int>(in_.size());
    MPI_Irecv(in_.data(), count, MPI_BYTE, rank ^ 1, 7, MPI_COMM_WORLD, &requests[0]);
    MPI_Isend(out_.data(), count, MPI_BYTE, rank ^ 1, 7, MPI_COMM_WORLD, &requests[1]);
    MPI_Waitall(2, requests, MPI_STATUSES_IGNORE);
    return read_all(in_.data(), in_.size());
  }

 private:
  std::vector<std::byte> out_, in_;
};

void compare(comm::Communicator& communicator, bool over_mpi, int repeats) {
  if (communicator.rank() == 0) {
    fmt::print("{:>10} {:>14} {:>12} {:>7}\n", "bytes", "Communicator us", "raw MPI us", "ratio");
  }
  for (const std::size_t size : kSizes) {
    Raw raw(over_mpi ? size : 0);
    std::vector<double> ours, theirs;
    std::uint64_t sum = 0;
    for (int round = 0; round < repeats; ++round) {
      comm::barrier(communicator);
      const double seconds = seconds_of([&] { return sum += exchange(communicator, size, round); });
      if (round > 0) ours.push_back(seconds);
      if (!over_mpi) continue;
      MPI_Barrier(MPI_COMM_WORLD);
      const double raw_seconds =
          seconds_of([&] { return sum -= raw.exchange(communicator.rank(), round); });
      if (round > 0) theirs.push_back(raw_seconds);
    }
    if (over_mpi && sum != 0) communicator.abort("the bytes differ");
    if (communicator.rank() != 0) continue;
    const double mine = median(ours), other = over_mpi ? median(theirs) : 0;
    fmt::print("{:10} {:14.1f} {:12.1f} {:7.2f}\n", size, mine * 1e6, other * 1e6,
               over_mpi ? mine / other : 0);
    if (over_mpi) report_ratio(std::to_string(size) + " bytes", mine / other);
  }
}

}  // namespace
}  // namespace delray::bench

int main(int argc, char** argv) {
  int repeats = 101, threads = 0;
  CLI::App program("Messages over MPI against raw MPI");
  program.add_option("--repeats", repeats)->check(CLI::Range(2, 1000000));
  program.add_option("--threads", threads, "so many in-process ranks rather than MPI");
  CLI11_PARSE(program, argc, argv);
  if (threads > 0) {
    delray::comm::run_threads(threads, 1, [&](delray::comm::Communicator& communicator) {
      delray::bench::compare(communicator, false, repeats);
    });
  } else {
    delray::comm::run_mpi(&argc, &argv, [&](delray::comm::Communicator& communicator) {
      delray::bench::compare(communicator, true, repeats);
    });
  }
  return 0;
}
