// A program over MPI in which rank RANK fails:
// comm_failing_rank throw|file|agreed|abort|stall|kill RANK
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <stdexcept>
#include <string>

#include "comm/agree_on_failure.h"
#include "comm/collectives.h"
#include "comm/mpi.h"
#include "files/error.h"

namespace {

using namespace delray;

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
