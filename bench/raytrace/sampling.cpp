// Nanoseconds for the random numbers of ray tracing.
#include <benchmark/benchmark.h>

#include "raytrace/sampling/sampler.h"

namespace {

using namespace delray::raytrace;

void pixel_keys(benchmark::State& state) {
  int x = 0;
  for (auto step : state) benchmark::DoNotOptimize(pixel_key(1, ++x, 7));
}
BENCHMARK(pixel_keys);

template <class F>
void numbers(benchmark::State& state, F f) {
  const std::uint64_t pixel = pixel_key(1, 2, 3);
  std::uint32_t sample = 0;
  for (auto step : state) {
    benchmark::DoNotOptimize(f(pixel, sample, sample & 15));
    ++sample;
  }
}
BENCHMARK_CAPTURE(numbers, sobol, sobol);
BENCHMARK_CAPTURE(numbers, sobol_pair, sobol_pair);
BENCHMARK_CAPTURE(numbers, independent_pair, independent_pair);

}  // namespace

BENCHMARK_MAIN();
