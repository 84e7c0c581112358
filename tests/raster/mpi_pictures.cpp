// One picture over MPI, however the work is shared out; ends with 1 at the first that is another.
// Run it under mpirun with any number of processes. A part of the product, with DELRAY_FULL_TESTS
// all of it; `if-full` as an argument: nothing without that.
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include "comm/collectives.h"
#include "comm/mpi.h"
#include "comm/threads.h"
#include "parallel/arena.h"
#include "raster/combinations.h"
#include "tests/raster/kinds_of_picture.h"

using namespace delray;

namespace {

constexpr int kSkipped = 77;

int wrong_pictures(comm::Communicator& communicator, bool full) {
  const int step = full ? 1 : 41;
  int turn = 0, wrong = 0;
  for (const raster::KindOfPicture& kind : raster::kinds_of_picture(53, 39)) {
    raster::Picture expected;
    comm::run_threads(1, 1, [&](comm::Communicator& alone) {
      expected =
          raster::render(alone, kind.scene, raster::random_scene_camera(), kind.options).picture;
    });
    for (const raster::RenderOptions& options : raster::combinations(kind.options))
      for (int threads = 1; threads <= 3; ++threads) {
        if (++turn % step != 0) continue;
        parallel::Arena arena(threads);
        const raster::Picture picture = arena.execute([&] {
          return raster::render(communicator, kind.scene, raster::random_scene_camera(), options)
              .picture;
        });
        if (communicator.rank() != 0 || raster::same_bytes(picture, expected)) continue;
        ++wrong;
        std::printf("%s: %s, %d ranks x %d\n", kind.name.c_str(), raster::name_of(options).c_str(),
                    communicator.size(), threads);
      }
  }
  return wrong;
}

}  // namespace

int main(int argc, char** argv) {
  const bool full = std::getenv("DELRAY_FULL_TESTS") != nullptr;
  if (!full && argc > 1 && std::strcmp(argv[1], "if-full") == 0) return kSkipped;
  const parallel::AllowThreads allow(3);
  int wrong = 0;
  comm::run_mpi(&argc, &argv, [&](comm::Communicator& communicator) {
    wrong = comm::all_reduce_value(communicator, wrong_pictures(communicator, full), std::plus<>());
  });
  return wrong == 0 ? 0 : 1;
}
