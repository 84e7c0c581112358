// Compositing beside IceT: the same pictures, the same processes, collected on rank 0; all take
// turns, medians. Run it under mpirun with any number of processes on one machine.
#include <fmt/format.h>
#include <mpi.h>
#include <sched.h>
#include <time.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <memory>
#include <random>
#include <span>
#include <string>
#include <thread>

#include "bench/measure.h"
#include "bench/peers/icet.h"
#include "bench/ratio.h"
#include "comm/collectives.h"
#include "comm/mpi.h"
#include "comm/threads.h"
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
  double seconds = 0;    // from the moment the first rank is ready until the last is done
  double processor = 0;  // of all ranks together
};

// Until all processes have come here; who waits looks so seldom that it takes no time from those
// that are to come.
void meet() {
  MPI_Request all = MPI_REQUEST_NULL;
  MPI_Ibarrier(MPI_COMM_WORLD, &all);
  for (int done = 0; !done;) {
    MPI_Test(&all, &done, MPI_STATUS_IGNORE);
    if (!done) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
}

constexpr double kUntilAllAreReady = 12e-3;

double seconds(clockid_t clock) {
  timespec now{};
  clock_gettime(clock, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}
// The same in all processes, which MPI_Wtime is not.
double now() { return seconds(CLOCK_MONOTONIC); }

// Asleep, so that ranks without a core of their own leave the others alone. Where each has one it
// is awake some time before: a virtual machine's core that has slept comes back milliseconds late.
void wait_until(double start, int ranks) {
  constexpr double kAwake = 8e-3;
  const double awake = ranks <= sysconf(_SC_NPROCESSORS_ONLN) ? kAwake : 0;
  std::this_thread::sleep_for(std::chrono::duration<double>(start - awake - now()));
  while (now() < start) continue;
}

// When one rank did its part.
struct Span {
  double begin = 0, end = 0, processor = 0;
};

// REQUIRES: the calling thread does all the work.
Span span_of(auto&& work) {
  Span span{now(), 0, seconds(CLOCK_THREAD_CPUTIME_ID)};
  work();
  span.end = now();
  span.processor = seconds(CLOCK_THREAD_CPUTIME_ID) - span.processor;
  return span;
}

// Of MPI processes, which share a machine; the result is rank 0's.
Times times_of(int ranks, auto&& work) {
  meet();
  double start = now() + kUntilAllAreReady;
  MPI_Bcast(&start, 1, MPI_DOUBLE, 0, MPI_COMM_WORLD);
  wait_until(start, ranks);
  const Span mine = span_of(work);
  meet();
  double first = 0, last = 0;
  Times all;
  MPI_Reduce(&mine.begin, &first, 1, MPI_DOUBLE, MPI_MIN, 0, MPI_COMM_WORLD);
  MPI_Reduce(&mine.end, &last, 1, MPI_DOUBLE, MPI_MAX, 0, MPI_COMM_WORLD);
  MPI_Reduce(&mine.processor, &all.processor, 1, MPI_DOUBLE, MPI_SUM, 0, MPI_COMM_WORLD);
  all.seconds = last - first;
  return all;
}

// Of ranks that are threads of this process: prepare(communicator), which is not timed, gives what
// work(communicator, prepared) gets.
Times times_of_threads(int ranks, auto&& prepare, auto&& work) {
  std::vector<Span> spans(static_cast<std::size_t>(ranks));
  comm::run_threads(ranks, 1, [&](comm::Communicator& communicator) {
    auto prepared = prepare(communicator);
    comm::barrier(communicator);
    const comm::Buffer start =
        comm::broadcast(communicator, 0, comm::Buffer::of_value(now() + kUntilAllAreReady));
    wait_until(start.as<double>()[0], ranks);
    spans[static_cast<std::size_t>(communicator.rank())] =
        span_of([&] { work(communicator, std::move(prepared)); });
  });
  Times all;
  double first = spans[0].begin, last = spans[0].end;
  for (const Span& span : spans) {
    first = std::min(first, span.begin);
    last = std::max(last, span.end);
    all.processor += span.processor;
  }
  all.seconds = last - first;
  return all;
}

// While it lives the threads that are started may use all cores: mpirun binds two processes to a
// core each.
class AllCores {
 public:
  AllCores() {
    sched_getaffinity(0, sizeof bound_, &bound_);
    cpu_set_t all;
    CPU_ZERO(&all);
    for (int i = 0; i < CPU_SETSIZE; ++i) CPU_SET(i, &all);
    sched_setaffinity(0, sizeof all, &all);
  }
  ~AllCores() { sched_setaffinity(0, sizeof bound_, &bound_); }
  AllCores(const AllCores&) = delete;
  AllCores& operator=(const AllCores&) = delete;

 private:
  cpu_set_t bound_;
};

// Ours: processes that hand over messages in memory that they share, as on one machine; processes
// whose messages all travel through MPI, as between machines; threads of one process.
enum class Side { icet, shared, mpi, in_process };

struct Row {
  Side side;
  std::string method, codec;  // a strategy or scheme
  std::vector<double> seconds, processor;
  double error = 0;  // of the first picture
  void add(const Times& times) {
    seconds.push_back(times.seconds);
    processor.push_back(times.processor);
  }
  std::string name() const {
    if (side == Side::icet) return "IceT " + method;
    return method + " " + codec +
           (side == Side::shared ? ", shared memory"
            : side == Side::mpi  ? ", MPI"
                                 : ", threads");
  }
};

// All rows: IceT's, ours of processes, and ours of threads of rank 0 while the others sleep.
std::vector<Row> rows_of(const Options& options, IcetKind kind) {
  std::vector<Row> rows;
  const auto add = [&](Side side, const std::string& method, const std::string& codec) {
    const bool wanted = options.only.empty() || std::find(options.only.begin(), options.only.end(),
                                                          method) != options.only.end();
    if (wanted) rows.push_back({side, method, codec, {}, {}});
  };
  for (const std::string& strategy : Icet::strategies(kind)) add(Side::icet, strategy, "");
  for (const Side side : {Side::shared, Side::mpi, Side::in_process}) {
    for (const composite::Scheme& scheme : composite::schemes()) {
      for (const composite::Codec& codec : composite::codecs()) {
        if (options.all || std::strcmp(codec.name, "active") == 0) {
          add(side, scheme.name, codec.name);
        }
      }
    }
  }
  return rows;
}

std::unique_ptr<composite::Layer> layer_of(const Row& row, const Image8& image, bool blended) {
  return composite::find_codec(row.codec)->make(
      copy(image), blended ? composite::Operator::over : composite::Operator::nearest);
}

composite::OwnedPixels compose(comm::Communicator& communicator, const Row& row,
                               std::unique_ptr<composite::Layer> layer) {
  composite::OwnedPixels part = composite::compose(communicator, std::move(layer), row.method);
  composite::forget_depth<image::Rgba8>(part);  // which IceT does not collect either
  return composite::gather(communicator, std::move(part), 0);
}

// Over the same processes.
struct Communicators {
  comm::Communicator& shared;  // messages in memory that processes share
  comm::Communicator& mpi;     // all through MPI
};

// Colours of the picture, on rank 0. `pictures` are those of all ranks there, else of this one.
Image8 run(const Communicators& communicators, const std::string& kind, Icet& icet,
           std::span<const Image8> pictures, Row& row) {
  const bool blended = kind == "blended";
  const int rank = communicators.mpi.rank(), ranks = communicators.mpi.size();
  const Image8& mine = pictures[static_cast<std::size_t>(rank)];
  if (row.side == Side::icet) {
    Image8 image = copy(mine);
    for (std::size_t i = 0; i < image.pixels(); ++i) {
      if (image.depth[i] == image::kEmptyDepth) image.depth[i] = 1;
    }
    icet.choose(row.method);
    const image::Rgba8* result = nullptr;
    row.add(times_of(ranks, [&] {
      result = icet.compose(image.colour.data(), blended ? nullptr : image.depth.data());
    }));
    if (rank == 0) std::memcpy(image.colour.data(), result, image.pixels() * sizeof *result);
    return image;
  }
  composite::OwnedPixels part;
  if (row.side == Side::shared || row.side == Side::mpi) {
    comm::Communicator& communicator =
        row.side == Side::mpi ? communicators.mpi : communicators.shared;
    auto layer = layer_of(row, mine, blended);
    row.add(times_of(ranks, [&] { part = compose(communicator, row, std::move(layer)); }));
  } else if (rank == 0) {
    const AllCores unbound;
    row.add(times_of_threads(
        ranks,
        [&](comm::Communicator& thread) {
          return layer_of(row, pictures[static_cast<std::size_t>(thread.rank())], blended);
        },
        [&](comm::Communicator& thread, std::unique_ptr<composite::Layer> layer) {
          auto result = compose(thread, row, std::move(layer));
          if (thread.rank() == 0) part = std::move(result);
        }));
  }
  if (row.side == Side::in_process) meet();
  return rank == 0 ? composite::take_image<image::Rgba8>(std::move(part)) : Image8();
}

using Exact = std::vector<std::array<double, 4>>;  // 0 to 255 each

// The picture that all make: the nearest pixel, or layers in order, blended in double precision.
Exact exact_picture(std::span<const Image8> layers, const std::string& kind) {
  Exact result(layers[0].pixels());
  std::vector<float> nearest(layers[0].pixels(), image::kEmptyDepth);
  for (const Image8& layer : layers) {
    for (std::size_t i = 0; i < layer.pixels(); ++i) {
      const image::Rgba8 c = layer.colour[i];
      const double channels[] = {double(c.r), double(c.g), double(c.b), double(c.a)};
      double seen = 1 - result[i][3] / 255;
      if (kind != "blended") {
        seen = layer.depth[i] < nearest[i] ? 1 : 0;
        if (seen > 0) result[i] = {};
        nearest[i] = std::min(nearest[i], layer.depth[i]);
      }
      for (std::size_t k = 0; k < 4; ++k) result[i][k] += seen * channels[k];
    }
  }
  return result;
}

// By how many of 255 codes the worst channel is off.
double largest_error(const Image8& image, const Exact& exact) {
  double largest = 0;
  for (std::size_t i = 0; i < exact.size(); ++i) {
    const image::Rgba8 c = image.colour[i];
    const double channels[] = {double(c.r), double(c.g), double(c.b), double(c.a)};
    for (std::size_t k = 0; k < 4; ++k) {
      largest = std::max(largest, std::abs(channels[k] - exact[i][k]));
    }
  }
  return largest;
}

// What docs/compositing.md promises of ours.
double error_promised(const std::string& kind, int ranks) {
  return kind == "blended" && ranks > 1 ? ranks - 1.5 : 0;
}

// `label` begins the names of the ratios that are kept.
void print(const std::vector<Row>& rows, const std::string& label) {
  const auto best_of = [&](Side side) {
    double best = 1e9;
    for (const Row& row : rows) {
      if (row.side == side) best = std::min(best, median(row.seconds));
    }
    return best;
  };
  const double best = best_of(Side::icet);
  // IceT's seconds for the same algorithm; 0 where it has none.
  const auto same = [&](const std::string& scheme) {
    const std::string strategy = scheme.starts_with("binary-swap") ? "bswap"
                                 : scheme == "radix-k"             ? "radixk"
                                 : scheme == "direct-send"         ? "direct"
                                                                   : scheme;
    for (const Row& row : rows) {
      if (row.side == Side::icet && row.method == strategy) return median(row.seconds);
    }
    return 0.0;
  };
  fmt::print("{:38} {:>8} {:>12} {:>10} {:>10} {:>10}\n", "", "ms", "processor ms", "of best",
             "of same", "codes off");
  for (const Row& row : rows) {
    const double seconds = median(row.seconds), other = same(row.method);
    fmt::print("{:38} {:8.2f} {:12.2f} {:10.2f} {:>10} {:10.1f}\n", row.name(), 1e3 * seconds,
               1e3 * median(row.processor), seconds / best,
               other > 0 && row.side != Side::icet ? fmt::format("{:.2f}", seconds / other) : "",
               row.error);
    if (other > 0 && row.side == Side::shared) {
      report_ratio(label + ", " + row.method + " " + row.codec, seconds / other);
    }
  }
  fmt::print("best of ours / IceT's best: {:.2f} shared memory, {:.2f} MPI, {:.2f} threads\n",
             best_of(Side::shared) / best, best_of(Side::mpi) / best,
             best_of(Side::in_process) / best);
  report_ratio(label + ", best, shared memory", best_of(Side::shared) / best);
  report_ratio(label + ", best, MPI", best_of(Side::mpi) / best);
  report_ratio(label + ", best, threads", best_of(Side::in_process) / best);
}

void measure(const Communicators& communicators, const Options& options, const std::string& kind) {
  const comm::Communicator& communicator = communicators.mpi;
  std::vector<Image8> pictures(static_cast<std::size_t>(communicator.size()));
  for (int rank = 0; rank < communicator.size(); ++rank) {
    if (communicator.rank() != 0 && communicator.rank() != rank) continue;
    pictures[static_cast<std::size_t>(rank)] = picture(options, kind, rank, communicator.size());
  }
  const IcetKind icet_kind = kind == "blended" ? IcetKind::ordered : IcetKind::nearest;
  Icet icet(options.width, options.height, icet_kind);
  std::vector<Row> rows = rows_of(options, icet_kind);
  const Exact exact = communicator.rank() == 0 ? exact_picture(pictures, kind) : Exact();
  for (int repeat = 0; repeat < options.repeats; ++repeat) {
    for (Row& row : rows) {
      const Image8 image = run(communicators, kind, icet, pictures, row);
      if (repeat == 0) row.error = largest_error(image, exact);
    }
  }
  if (communicator.rank() != 0) return;
  const auto is_wrong = [&](const Row& row) {
    return row.side != Side::icet && row.error > error_promised(kind, communicator.size());
  };
  const auto wrong = std::count_if(rows.begin(), rows.end(), is_wrong);
  fmt::print("\n{}: {} ranks, {} x {}{}\n", kind, communicator.size(), options.width,
             options.height, wrong > 0 ? fmt::format("; {} of ours are WRONG", wrong) : "");
  print(rows, kind + ", " + std::to_string(communicator.size()) + " ranks");
}

}  // namespace
}  // namespace delray::bench

int main(int argc, char** argv) {
  delray::bench::Options options;
  CLI::App app("Times of compositing beside IceT");
  app.add_option("--width", options.width)->check(CLI::PositiveNumber);
  app.add_option("--height", options.height)->check(CLI::PositiveNumber);
  app.add_option("--repeats", options.repeats)->check(CLI::PositiveNumber);
  app.add_option("--pictures", options.pictures)->delimiter(',');
  app.add_option("--only", options.only, "strategies and schemes")->delimiter(',');
  app.add_flag("--all", options.all, "all codecs");
  CLI11_PARSE(app, argc, argv);
  const delray::bench::KeepMemory kept;
  const delray::parallel::AllowThreads allowed(64);
  delray::comm::run_mpi(&argc, &argv, [&](delray::comm::Communicator& communicator) {
    const MPI_Comm world = MPI_COMM_WORLD;
    const auto mpi = delray::comm::make_mpi_communicator(&world, {.share_memory = false});
    delray::parallel::Arena(1).execute([&] {
      for (const std::string& kind : options.pictures) {
        delray::bench::measure({communicator, *mpi}, options, kind);
      }
    });
  });
}
