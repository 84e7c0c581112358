// Compositing over MPI beside IceT: the same pictures, the same processes, collected on rank 0; all
// take turns, medians. Run it under mpirun with any number of processes.
#include <fmt/format.h>
#include <mpi.h>
#include <time.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <cstring>
#include <random>
#include <string>
#include <thread>

#include "bench/measure.h"
#include "bench/peers/icet.h"
#include "comm/mpi.h"
#include "composite/codec.h"
#include "composite/scheme.h"
#include "parallel/arena.h"

namespace delray::bench {
namespace {

using image::Image8;

struct Options {
  int width = 1920, height = 1080, repeats = 21;
  std::vector<std::string> pictures = {"discs", "random", "full", "blended"};
  std::vector<std::string> only;
  bool all = false;
};

// What a rank has drawn: a disc of 30 % of the image, pixels at random of that share, or
// everything. Colours are premultiplied.
Image8 picture(const Options& options, const std::string& kind, int rank, int ranks) {
  Image8 image(options.width, options.height);
  clear(image);
  std::mt19937 numbers(static_cast<unsigned>(rank + 1));
  constexpr double kPi = 3.14159265358979, kShare = 0.3;
  const double radius2 = kShare * options.width * options.height / kPi;
  const double angle = 2 * kPi * rank / ranks;
  const double cx = options.width * (0.5 + 0.15 * std::cos(angle));
  const double cy = options.height * (0.5 + 0.05 * std::sin(angle));
  for (std::size_t i = 0; i < image.pixels(); ++i) {
    const auto width = static_cast<std::size_t>(options.width);
    const double x = static_cast<double>(i % width) - cx, y = static_cast<double>(i / width) - cy;
    const bool covered = kind == "full"     ? true
                         : kind == "random" ? numbers() % 1000 < 300
                                            : x * x + y * y < radius2;
    if (!covered) continue;
    const auto alpha = static_cast<std::uint8_t>(kind == "blended" ? 100 + i % 50 : 255);
    image.colour[i] = {static_cast<std::uint8_t>(i % 100),
                       static_cast<std::uint8_t>(rank * 20 % 100),
                       static_cast<std::uint8_t>(i / 1920 % 100), alpha};
    // A tilted plane with some relief; ranks never tie.
    const double depth = 0.5 + (x * std::cos(angle) + y * std::sin(angle)) / 4000;
    image.depth[i] = std::ldexp(static_cast<float>(std::floor(depth * 0x1p12) * 256 +
                                                   static_cast<double>(numbers() % 256)) *
                                        16 +
                                    static_cast<float>(rank % 16),
                                -24);
  }
  return image;
}

Image8 copy(const Image8& image) {
  Image8 result(image.width, image.height);
  std::memcpy(result.colour.data(), image.colour.data(), image.pixels() * sizeof(image::Rgba8));
  std::memcpy(result.depth.data(), image.depth.data(), image.pixels() * sizeof(float));
  return result;
}

struct Times {
  double seconds = 0;    // from the moment the first process is ready until the last is done
  double processor = 0;  // of all processes together
};

// Until all processes have come here; without looking all the time, which would take the processor
// from those that are to come.
void meet() {
  MPI_Request all = MPI_REQUEST_NULL;
  MPI_Ibarrier(MPI_COMM_WORLD, &all);
  for (int done = 0; !done;) {
    MPI_Test(&all, &done, MPI_STATUS_IGNORE);
    if (!done) std::this_thread::sleep_for(std::chrono::microseconds(20));
  }
}

// On rank 0.
Times times_of(auto&& work) {
  const auto used = [] {
    timespec now{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
  };
  meet();
  double begin = MPI_Wtime(), processor = used();
  work();
  double end = MPI_Wtime(), first = 0, last = 0;
  processor = used() - processor;
  meet();
  Times all;
  MPI_Reduce(&begin, &first, 1, MPI_DOUBLE, MPI_MIN, 0, MPI_COMM_WORLD);
  MPI_Reduce(&end, &last, 1, MPI_DOUBLE, MPI_MAX, 0, MPI_COMM_WORLD);
  MPI_Reduce(&processor, &all.processor, 1, MPI_DOUBLE, MPI_SUM, 0, MPI_COMM_WORLD);
  all.seconds = last - first;
  return all;
}

struct Row {
  std::string name;
  bool icet = false;
  std::vector<double> seconds, processor;
  void add(const Times& times) {
    seconds.push_back(times.seconds);
    processor.push_back(times.processor);
  }
};

void measure(comm::Communicator& communicator, const Options& options, const std::string& kind) {
  const bool blended = kind == "blended";
  const int rank = communicator.rank();
  const Image8 mine = picture(options, kind, rank, communicator.size());
  Image8 for_icet = copy(mine);  // whose empty depth is 1
  for (std::size_t i = 0; i < mine.pixels(); ++i) {
    if (mine.depth[i] == image::kEmptyDepth) for_icet.depth[i] = 1;
  }
  const IcetKind icet_kind = blended ? IcetKind::ordered : IcetKind::nearest;
  Icet icet(options.width, options.height, icet_kind);
  std::vector<Row> rows;
  for (const std::string& strategy : Icet::strategies(icet_kind)) {
    rows.push_back({strategy, true, {}, {}});
  }
  for (const composite::Scheme& scheme : composite::schemes()) {
    for (const composite::Codec& codec : composite::codecs()) {
      if (!options.all && std::strcmp(codec.name, "active") != 0) continue;
      rows.push_back({scheme.name + (" " + std::string(codec.name)), false, {}, {}});
    }
  }
  if (!options.only.empty()) {
    std::erase_if(rows, [&](const Row& row) {
      return std::find(options.only.begin(), options.only.end(),
                       row.name.substr(0, row.name.find(' '))) == options.only.end();
    });
  }
  Image8 expected;
  std::size_t wrong = 0;
  for (int repeat = 0; repeat < options.repeats; ++repeat) {
    for (Row& row : rows) {
      const Image8 touched = copy(row.icet ? for_icet : mine);
      if (row.icet) {
        icet.choose(row.name);
        const image::Rgba8* result = nullptr;
        row.add(times_of([&] {
          result = icet.compose(touched.colour.data(), blended ? nullptr : touched.depth.data());
        }));
        if (rank == 0 && expected.pixels() == 0) {
          expected = Image8(options.width, options.height);
          std::memcpy(expected.colour.data(), result, mine.pixels() * sizeof *result);
        }
        continue;
      }
      const std::size_t space = row.name.find(' ');
      auto layer = composite::find_codec(row.name.substr(space + 1))
                       ->make(copy(mine),
                              blended ? composite::Operator::over : composite::Operator::nearest);
      composite::Part part;
      row.add(times_of([&] {
        part = composite::compose(communicator, std::move(layer), row.name.substr(0, space));
        composite::forget_depth<image::Rgba8>(part);  // which IceT does not collect either
        part = composite::gather(communicator, std::move(part), 0);
      }));
      if (rank != 0) continue;
      const Image8 image = composite::take_image<image::Rgba8>(std::move(part));
      for (std::size_t i = 0; i < image.pixels() && repeat == 0 && expected.pixels() > 0; ++i) {
        const auto far = [](int a, int b) { return std::abs(a - b) > 4; };
        const image::Rgba8 a = image.colour[i], b = expected.colour[i];
        wrong += far(a.r, b.r) || far(a.g, b.g) || far(a.b, b.b) || far(a.a, b.a);
      }
    }
  }
  if (rank != 0) return;
  fmt::print("\n{}: {} ranks, {} x {}, ms{}\n", kind, communicator.size(), options.width,
             options.height, wrong > 0 ? fmt::format("; {} WRONG PIXELS", wrong) : "");
  double best_icet = 1e9;
  for (const Row& row : rows) {
    if (row.icet) best_icet = std::min(best_icet, median(row.seconds));
  }
  for (const Row& row : rows) {
    const double seconds = median(row.seconds);
    fmt::print("{:32} {:8.2f} ms {:8.2f} of IceT's best {:8.2f} ms of processors\n",
               (row.icet ? "IceT " : "") + row.name, 1e3 * seconds, seconds / best_icet,
               1e3 * median(row.processor));
  }
}

}  // namespace
}  // namespace delray::bench

int main(int argc, char** argv) {
  delray::bench::Options options;
  CLI::App app("Times of compositing beside IceT");
  app.add_option("--width", options.width);
  app.add_option("--height", options.height);
  app.add_option("--repeats", options.repeats);
  app.add_option("--pictures", options.pictures)->delimiter(',');
  app.add_option("--only", options.only, "strategies and schemes")->delimiter(',');
  app.add_flag("--all", options.all, "all codecs");
  CLI11_PARSE(app, argc, argv);
  const delray::bench::KeepMemory kept;
  delray::comm::run_mpi(&argc, &argv, [&](delray::comm::Communicator& communicator) {
    delray::parallel::Arena(1).execute([&] {
      for (const std::string& kind : options.pictures) {
        delray::bench::measure(communicator, options, kind);
      }
    });
  });
}
