// A program over MPI in which rank RANK fails:
// comm_failing_rank throw|file|agreed|abort|stall|kill|... RANK
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <new>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "comm/agree_on_failure.h"
#include "comm/collectives.h"
#include "comm/mpi.h"
#include "files/error.h"

namespace {

using namespace delray;

// Leaves this process so much more address space than it has now.
void limit_address_space(std::size_t more) {
  std::size_t pages = 0;
  FILE* const file = std::fopen("/proc/self/statm", "r");
  if (file == nullptr || std::fscanf(file, "%zu", &pages) != 1) std::abort();
  std::fclose(file);
  rlimit limit{};
  getrlimit(RLIMIT_AS, &limit);
  limit.rlim_cur = pages * static_cast<std::size_t>(sysconf(_SC_PAGESIZE)) + more;
  if (setrlimit(RLIMIT_AS, &limit) != 0) std::abort();
}

// Large messages from each to each, all of them right.
void exchange(comm::Communicator& communicator) {
  constexpr std::size_t kValues = 1 << 18;
  const int n = communicator.size();
  for (int round = 0; round < 3; ++round) {
    for (int to = 0; to < n; ++to) {
      const std::vector<int> values(kValues, communicator.rank() * n + to);
      communicator.send(to, 3, comm::Buffer::of(std::span<const int>(values)));
    }
    for (int from = 0; from < n; ++from) {
      const comm::Buffer message = communicator.receive(from, 3);
      const auto values = message.as<int>();
      const auto right = [&](int value) { return value == from * n + communicator.rank(); };
      if (values.size() != kValues || !std::all_of(values.begin(), values.end(), right)) {
        communicator.abort("wrong message");
      }
    }
  }
}

void fail(comm::Communicator& communicator, const std::string& how, int failing) {
  communicator.mark(comm::Phase::compose, 0);
  // Something large is always under way.
  communicator.send((communicator.rank() + 1) % communicator.size(), 1, comm::Buffer(1 << 22));
  comm::barrier(communicator);
  const bool is_failing = communicator.rank() == failing;
  const files::FileError error(files::Cause::input, "broken.ply", "line 7", "not a number");
  if (how == "throw" && is_failing) throw std::runtime_error("the disk is on fire");
  if (how == "file" && is_failing) throw error;
  if (how == "kill" && is_failing) std::raise(SIGKILL);
  if (how == "stop" && is_failing) std::raise(SIGSTOP);
  if (how == "memory" && is_failing) throw std::bad_alloc();
  if (how == "argument" && is_failing) throw std::invalid_argument("a layer of another size");
  if (how == "less" && is_failing) limit_address_space(std::size_t{1} << 27);
  if (how == "less" || how == "little") return exchange(communicator);
  if (how == "abort" && is_failing) communicator.abort("nothing left to do");
  if (how == "agreed") {
    const auto part = communicator.split(0, 0);
    part->send((part->rank() + 1) % part->size(), 1, comm::Buffer(1 << 22));
    comm::all_or_none(communicator, comm::Phase::load, [&] {
      if (is_failing) throw error;
    });
  }
  if (how != "none") communicator.receive(failing, 2);
}

}  // namespace

int main(int argc, char** argv) {
  const std::string how = argc > 1 ? argv[1] : "none";
  const int failing = argc > 2 ? std::atoi(argv[2]) : 0;
  comm::MpiOptions options;
  if (how == "little" && comm::launched_rank() == failing) {
    limit_address_space(std::size_t{3} << 28);
  }
  if (how == "stop") options.timeout = std::chrono::seconds(1);
  if (how == "stall") options.timeout = std::chrono::milliseconds(300);
  try {
    comm::run_mpi(
        &argc, &argv, [&](comm::Communicator& c) { fail(c, how, failing); }, options);
  } catch (const files::FileError& caught) {
    if (comm::launched_rank() != 0) return 0;
    std::fprintf(stderr, "all agree: %s\n", caught.what());
    return 3;
  }
  return 0;
}
