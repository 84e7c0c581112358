// A race that is there on purpose: two threads count what they trace without a lock. With
// ThreadSanitizer it has to be reported, or something hides races of this library.
#include <atomic>
#include <cstdint>
#include <cstdio>
#include <thread>

#include "parallel/arena.h"
#include "parallel/parallel_for.h"
#include "raytrace/tracer.h"
#include "scenes/generate.h"

int main() {
  using namespace delray;
  const parallel::AllowThreads allowed(2);
  const scenes::Scene scene = scenes::generate("gen:spheres:2000");
  std::uint64_t rays = 0;
  parallel::Arena(2).execute([&] {
    const raytrace::Tracer tracer = raytrace::make_tracer(scene);
    std::atomic<int> begun = 0;  // relaxed: orders nothing
    parallel::parallel_for(0, 2, 1, [&](std::size_t i) {
      begun.fetch_add(1, std::memory_order_relaxed);
      while (begun.load(std::memory_order_relaxed) < 2) std::this_thread::yield();
      raytrace::Ray ray{};
      ray.origin_x = static_cast<float>(i);
      ray.origin_y = 50.0F;
      ray.direction_y = -1.0F;
      tracer.embree.intersect(ray);
      ++rays;
    });
  });
  std::printf("%llu rays\n", static_cast<unsigned long long>(rays));
  return 0;
}
