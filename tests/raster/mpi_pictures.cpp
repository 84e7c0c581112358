// One picture over MPI, however the work is shared out; ends with 1 at the first that is another.
// Run it under mpirun with any number of processes. A part of the product, with DELRAY_FULL_TESTS
// all of it. Arguments: `if-full`, nothing without that; `I/N`, the I-th (from 1) of N slices.
#include <chrono>
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

// Of all pictures, numbered from 1, those whose number is a multiple of `step`; of these every
// `slices`-th.
struct PartialImage {
  int step = 1, slice = 0, slices = 1;
  bool has(int number) const { return number % step == 0 && number / step % slices == slice; }
};

// Tells on stderr how far a long run is.
class Progress {
 public:
  void count(const raster::KindOfPicture& kind) {
    ++pictures_;
    const auto now = std::chrono::steady_clock::now();
    if (now - told_ < std::chrono::seconds(20)) return;
    told_ = now;
    std::fprintf(stderr, "%d pictures in %.0f s: %s\n", pictures_,
                 std::chrono::duration<double>(now - start_).count(), kind.name.c_str());
  }
  int pictures() const { return pictures_; }

 private:
  const std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  std::chrono::steady_clock::time_point told_ = start_;
  int pictures_ = 0;
};

int wrong_pictures(comm::Communicator& communicator, const PartialImage& share) {
  int number = 0, wrong = 0;
  Progress progress;
  for (const raster::KindOfPicture& kind : raster::kinds_of_picture(53, 39)) {
    raster::Picture expected;
    comm::run_threads(1, 1, [&](comm::Communicator& alone) {
      expected =
          raster::render(alone, kind.scene, raster::random_scene_camera(), kind.options).picture;
    });
    for (const raster::RenderOptions& options : raster::combinations(kind.options)) {
      for (int threads = 1; threads <= 3; ++threads) {
        if (!share.has(++number)) continue;
        parallel::Arena arena(threads);
        const raster::Picture picture = arena.execute([&] {
          return raster::render(communicator, kind.scene, raster::random_scene_camera(), options)
              .picture;
        });
        if (communicator.rank() != 0) continue;
        progress.count(kind);
        if (raster::same_bytes(picture, expected)) continue;
        ++wrong;
        std::printf("%s: %s, %d ranks x %d\n", kind.name.c_str(), raster::name_of(options).c_str(),
                    communicator.size(), threads);
      }
    }
  }
  if (communicator.rank() == 0) {
    std::printf("%d ranks: %d pictures, %d wrong\n", communicator.size(), progress.pictures(),
                wrong);
  }
  return wrong;
}

}  // namespace

int main(int argc, char** argv) {
  PartialImage share;
  if (std::getenv("DELRAY_FULL_TESTS") == nullptr) share.step = 41;
  for (int i = 1; i < argc; ++i) {
    if (std::strcmp(argv[i], "if-full") == 0) {
      if (share.step > 1) return kSkipped;
    } else if (std::sscanf(argv[i], "%d/%d", &share.slice, &share.slices) != 2 || share.slice < 1 ||
               share.slice > share.slices) {
      std::fprintf(stderr, "usage: %s [if-full] [I/N]\n", argv[0]);
      return 2;
    }
  }
  share.slice %= share.slices;
  const parallel::AllowThreads allow(3);
  int wrong = 0;
  comm::run_mpi(&argc, &argv, [&](comm::Communicator& communicator) {
    wrong =
        comm::all_reduce_value(communicator, wrong_pictures(communicator, share), std::plus<>());
  });
  return wrong == 0 ? 0 : 1;
}
