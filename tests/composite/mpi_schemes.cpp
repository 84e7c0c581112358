// Every scheme and codec over MPI: the bytes that ranks of one process get, and a ledger that says
// what MPI itself counts (through its profiling interface). Run it under mpirun with any number of
// processes; `if-full` as an argument: nothing unless DELRAY_FULL_TESTS is set.
#define OMPI_SKIP_MPICXX 1
#define MPICH_SKIP_MPICXX 1
#include <mpi.h>

#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <functional>
#include <random>
#include <string>
#include <vector>

#include "comm/collectives.h"
#include "comm/ledger.h"
#include "comm/mpi.h"
#include "comm/mpi/shared_message.h"
#include "comm/recording.h"
#include "comm/threads.h"
#include "composite/codec.h"
#include "composite/scheme.h"

namespace {

struct Sent {
  std::uint64_t messages = 0, bytes = 0;
};
Sent sent_by_mpi;

void count(int values, MPI_Datatype type) {
  int size = 0;
  PMPI_Type_size(type, &size);
  sent_by_mpi.messages += 1;
  sent_by_mpi.bytes += static_cast<std::uint64_t>(values) * static_cast<std::uint64_t>(size);
}

}  // namespace

// All calls of MPI that send from one process to another, as the linker finds them.
extern "C" {
int MPI_Send(const void* data, int values, MPI_Datatype type, int to, int tag, MPI_Comm all) {
  count(values, type);
  return PMPI_Send(data, values, type, to, tag, all);
}
int MPI_Ssend(const void* data, int values, MPI_Datatype type, int to, int tag, MPI_Comm all) {
  count(values, type);
  return PMPI_Ssend(data, values, type, to, tag, all);
}
int MPI_Isend(const void* data, int values, MPI_Datatype type, int to, int tag, MPI_Comm all,
              MPI_Request* request) {
  if (tag == delray::comm::internal::kTagShared) {
    delray::comm::internal::SharedMessage message{};
    std::memcpy(&message, data, sizeof message);
    sent_by_mpi.messages += 1;
    sent_by_mpi.bytes += message.bytes;
  } else {
    count(values, type);
  }
  return PMPI_Isend(data, values, type, to, tag, all, request);
}
int MPI_Issend(const void* data, int values, MPI_Datatype type, int to, int tag, MPI_Comm all,
               MPI_Request* request) {
  count(values, type);
  return PMPI_Issend(data, values, type, to, tag, all, request);
}
}

namespace {

using namespace delray;
using image::Image8;
using image::Rgba8;

constexpr int kSkipped = 77;

// Depths of few values, so that ranks tie; rank 2 has nothing.
Image8 partial_image(int rank, int width, int height) {
  Image8 image(width, height);
  clear(image);
  std::minstd_rand random(static_cast<unsigned>(rank + 1));
  for (std::size_t i = 0; i < image.pixels(); ++i) {
    const auto value = static_cast<std::uint32_t>(random());
    if (value % 3 == 0 || rank == 2) continue;
    const auto alpha = static_cast<std::uint8_t>(value % 5 == 0 ? 255 : 100);
    image.colour[i] = {static_cast<std::uint8_t>(value % 100), static_cast<std::uint8_t>(rank), 7,
                       alpha};
    image.depth[i] = static_cast<float>(value / 4 % 3);
  }
  return image;
}

struct Case {
  const composite::Scheme& scheme;
  const composite::Codec& codec;
  composite::Operator how;
  int width, height;
  bool interlace;
};

Image8 composed(comm::Communicator& communicator, const Case& c) {
  auto layer = c.codec.make(partial_image(communicator.rank(), c.width, c.height), c.how);
  composite::OwnedPixels part =
      composite::compose(communicator, std::move(layer), c.scheme.name, {.interlace = c.interlace});
  return composite::take_image<Rgba8>(
      composite::gather(communicator, std::move(part), communicator.size() / 2));
}

int wrong(comm::Communicator& communicator, const Case& c) {
  std::vector<comm::Event> events;
  comm::Recording recording(communicator, events);
  const Sent before = sent_by_mpi;
  const Image8 image = composed(recording, c);
  const std::uint64_t messages = sent_by_mpi.messages - before.messages;
  const std::uint64_t bytes = sent_by_mpi.bytes - before.bytes;
  const comm::Totals totals = comm::totals(events, communicator.rank());
  int failures = 0;
  const auto fail = [&](const char* what) {
    ++failures;
    std::printf("rank %d of %d: %s: %s, %s, %d x %d\n", communicator.rank(), communicator.size(),
                what, c.scheme.name, c.codec.name, c.width, c.height);
  };
  if (totals.messages_sent != messages || totals.bytes_sent != bytes) fail("another count");
  if (communicator.rank() != communicator.size() / 2) return failures;
  Image8 expected;
  comm::run_threads(communicator.size(), 1, [&](comm::Communicator& thread) {
    Image8 result = composed(thread, c);
    if (thread.rank() == thread.size() / 2) expected = std::move(result);
  });
  const bool same =
      std::memcmp(image.colour.data(), expected.colour.data(), image.pixels() * sizeof(Rgba8)) == 0;
  if (!same) fail("another picture");
  return failures;
}

int wrong_ones(comm::Communicator& communicator, bool full) {
  struct Size {
    int width, height;
  };
  int failures = 0, turn = 0;
  for (const composite::Scheme& scheme : composite::schemes()) {
    for (const composite::Codec& codec : composite::codecs()) {
      for (const composite::Operator how :
           {composite::Operator::nearest, composite::Operator::over}) {
        for (const Size size : {Size{1, 1}, {7, 3}, {1919, 1079}}) {
          if (!full && size.width > 7 && ++turn % 23 != 0) continue;
          failures +=
              wrong(communicator, {scheme, codec, how, size.width, size.height, turn % 3 == 0});
        }
      }
    }
  }
  if (communicator.size() > 1 && sent_by_mpi.messages == 0) {
    ++failures;
    std::printf("MPI's messages are not counted\n");
  }
  return failures;
}

}  // namespace

int main(int argc, char** argv) {
  const bool full = std::getenv("DELRAY_FULL_TESTS") != nullptr;
  if (!full && argc > 1 && std::strcmp(argv[1], "if-full") == 0) return kSkipped;
  int failures = 0;
  comm::run_mpi(&argc, &argv, [&](comm::Communicator& communicator) {
    failures = comm::all_reduce_value(communicator, wrong_ones(communicator, full), std::plus<>());
  });
  return failures == 0 ? 0 : 1;
}
