// One ray-traced picture over MPI, however the work is shared out; ends with 1 at the first that is
// another. Run it under mpirun with any number of processes. A part of the product, with
// DELRAY_FULL_TESTS all of it; `if-full` as an argument: nothing without that.
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>

#include "comm/collectives.h"
#include "comm/mpi.h"
#include "comm/threads.h"
#include "loadbalance/schedule.h"
#include "parallel/arena.h"
#include "raytrace/render.h"
#include "scenes/generate.h"

using namespace delray;

namespace {

constexpr int kSkipped = 77;

int wrong_pictures(comm::Communicator& communicator, bool full) {
  scenes::Scene scene = scenes::generate("gen:corner:4000");
  const scenes::Camera camera = scene.cameras[0];
  scenes::complete(scene, camera);
  const raytrace::Tracer tracer = raytrace::make_tracer(scene);
  raytrace::RenderOptions options;
  options.width = 75;
  options.height = 50;
  options.tile = 16;
  options.trace.depth = 3;
  raytrace::Result expected;
  comm::run_threads(1, 1, [&](comm::Communicator& alone) {
    expected = raytrace::render(alone, tracer, camera, options);
  });
  int turn = 0, wrong = 0;
  const auto look_at = [&](const raytrace::Result& result, const std::string& what) {
    const std::size_t pixels = expected.image.pixels();
    if (communicator.rank() != 0 ||
        (result.image.pixels() == pixels &&
         std::memcmp(result.image.colour.data(), expected.image.colour.data(),
                     pixels * sizeof(image::RgbaF)) == 0))
      return;
    ++wrong;
    std::printf("%s, %d ranks\n", what.c_str(), communicator.size());
  };
  for (const loadbalance::Schedule& schedule : loadbalance::schedules()) {
    for (int threads = 1; threads <= 2; ++threads) {
      for (const raytrace::Distribution& distribution : raytrace::distributions()) {
        const bool moves_rays = schedule.divides && distribution.replicated;
        if (++turn % 7 != 0 && !full && !moves_rays) continue;
        options.schedule = schedule.name;
        parallel::Arena arena(threads);
        look_at(arena.execute([&] {
          if (distribution.replicated)
            return raytrace::render(communicator, tracer, camera, options);
          raytrace::SharedScene shared = raytrace::SharedScene::make(
              communicator, scene, raytrace::share_options(distribution));
          return raytrace::Renderer(shared, distribution).render(communicator, camera, options);
        }),
                std::string(schedule.name) + ", " + distribution.name + ", " +
                    std::to_string(threads) + " threads");
      }
    }
  }
  return wrong;
}

}  // namespace

int main(int argc, char** argv) {
  const bool full = std::getenv("DELRAY_FULL_TESTS") != nullptr;
  if (!full && argc > 1 && std::strcmp(argv[1], "if-full") == 0) return kSkipped;
  const parallel::AllowThreads allow(2);
  int wrong = 0;
  comm::run_mpi(&argc, &argv, [&](comm::Communicator& communicator) {
    wrong = comm::all_reduce_value(communicator, wrong_pictures(communicator, full), std::plus<>());
  });
  return wrong == 0 ? 0 : 1;
}
