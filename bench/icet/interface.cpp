// One program over the interface of IceT, once with IceT's libraries, once with libdelray_icet.so:
// the same calls, images and processes, taking turns. Run it under mpirun on one machine.
#include <dlfcn.h>
#include <fmt/format.h>
#include <time.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include "bench/measure.h"
#include "icet/mpi_interface.h"

namespace delray::bench {
namespace {

struct Options {
  int width = 1920, height = 1080, repeats = 21;
  std::vector<std::string> pictures = {"discs", "random", "full", "blended"};
  std::string icet = "/usr/lib/x86_64-linux-gnu/libvtkIceTMPI-pv5.11.so.1";
  std::string delray = DELRAY_ICET_LIBRARY;
  bool tiles = false;  // 2 x 2, shown by the first four processes
  bool draws = false;  // by a callback instead of images that are there
  bool interlaces = true;
  double skew = 0;  // milliseconds by which each process begins after the one before, computing
};

// Functions of one of the two, looked up by name.
class Library {
 public:
  explicit Library(const std::string& path) : handle_(dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL)) {
    if (handle_ == nullptr) throw std::runtime_error(dlerror());
  }
  template <class F>
  F* find(const char* name) const {
    void* const found = dlsym(handle_, name);
    if (found == nullptr) throw std::runtime_error(std::string("no function ") + name);
    return reinterpret_cast<F*>(found);
  }

 private:
  void* handle_;  // until the program ends
};
#define ICET(library, name) (library).find<decltype(name)>(#name)

struct Picture {
  std::vector<std::uint32_t> colour;
  std::vector<float> depth;
};

// What a rank has drawn: a disc of 30 % of the image, pixels at random of that share, or all.
Picture draw(const Options& options, const std::string& kind, int rank, int ranks) {
  const auto width = static_cast<std::size_t>(options.width);
  const std::size_t pixels = width * static_cast<std::size_t>(options.height);
  Picture picture{std::vector<std::uint32_t>(pixels), std::vector<float>(pixels, 1.0F)};
  std::mt19937 numbers(static_cast<unsigned>(rank + 1));
  constexpr double kPi = 3.14159265358979, kShare = 0.3;
  const double radius2 = kShare * static_cast<double>(pixels) / kPi;
  const double angle = 2 * kPi * rank / ranks;
  const double cx = options.width * (0.5 + 0.15 * std::cos(angle));
  const double cy = options.height * (0.5 + 0.05 * std::sin(angle));
  for (std::size_t i = 0; i < pixels; ++i) {
    const double x = static_cast<double>(i % width) - cx, y = static_cast<double>(i / width) - cy;
    const bool covered = kind == "full"     ? true
                         : kind == "random" ? numbers() % 1000 < 300
                                            : x * x + y * y < radius2;
    if (!covered) continue;
    const auto alpha = static_cast<std::uint32_t>(kind == "blended" ? 100 + i % 50 : 255);
    picture.colour[i] = alpha << 24 | static_cast<std::uint32_t>(i / width % 100) << 16 |
                        static_cast<std::uint32_t>(rank * 20 % 100) << 8 |
                        static_cast<std::uint32_t>(i % 100);
    // Ranks never tie.
    picture.depth[i] = static_cast<float>(
        0.25 + 0.5 * (0.5 + (x * std::cos(angle) + y * std::sin(angle)) / 8000) + 1e-6 * rank);
  }
  return picture;
}

// What the callback, which gets no argument of its own, copies.
struct Drawn {
  const Library* library = nullptr;
  const Picture* picture = nullptr;
};
Drawn& drawn() {
  static Drawn what;
  return what;
}
void copy_picture(const IceTDouble*, const IceTDouble*, const IceTFloat*, const IceTInt*,
                  IceTImage result) {
  const Drawn& what = drawn();
  std::memcpy(ICET(*what.library, icetImageGetColorub)(result), what.picture->colour.data(),
              what.picture->colour.size() * 4);
  if (ICET(*what.library, icetImageGetDepthFormat)(result) == ICET_IMAGE_DEPTH_NONE) return;
  std::memcpy(ICET(*what.library, icetImageGetDepthf)(result), what.picture->depth.data(),
              what.picture->depth.size() * 4);
}

double now() {
  timespec time{};
  clock_gettime(CLOCK_MONOTONIC, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

// Until all processes are here, asleep; then all begin at one moment, awake where each has a core.
double begin_together(int ranks) {
  MPI_Request all = MPI_REQUEST_NULL;
  MPI_Ibarrier(MPI_COMM_WORLD, &all);
  for (int done = 0; done == 0;) {
    MPI_Test(&all, &done, MPI_STATUS_IGNORE);
    if (done == 0) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  double start = now() + 12e-3;
  MPI_Bcast(&start, 1, MPI_DOUBLE, 0, MPI_COMM_WORLD);
  const double awake = ranks <= sysconf(_SC_NPROCESSORS_ONLN) ? 8e-3 : 0;
  std::this_thread::sleep_for(std::chrono::duration<double>(start - awake - now()));
  while (now() < start) continue;
  return start;
}

double greatest(double value) {
  double most = 0;
  MPI_Allreduce(&value, &most, 1, MPI_DOUBLE, MPI_MAX, MPI_COMM_WORLD);
  return most;
}

// One side: a context of a library, and what it took.
class Side {
 public:
  Side(const std::string& path, const Options& options, bool blended)
      : library_(path), options_(options), blended_(blended) {
    communicator_ = ICET(library_, icetCreateMPICommunicator)(MPI_COMM_WORLD);
    context_ = ICET(library_, icetCreateContext)(communicator_);
    MPI_Comm_size(MPI_COMM_WORLD, &ranks_);
    set_up();
  }
  ~Side() {
    ICET(library_, icetDestroyContext)(context_);
    ICET(library_, icetDestroyMPICommunicator)(communicator_);
  }
  Side(const Side&) = delete;
  Side& operator=(const Side&) = delete;

  // Seconds from the moment the last begins until the last is done; `composite` by the library's
  // clock.
  void run(const Picture& picture) {
    ICET(library_, icetSetContext)(context_);
    const IceTFloat background[4] = {0, 0, 0, 0};
    const IceTDouble identity[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    drawn() = {&library_, &picture};
    double begin = begin_together(ranks_);
    int rank = 0;
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    while (now() < begin + 1e-3 * options_.skew * rank) continue;
    begin += 1e-3 * options_.skew * (ranks_ - 1);
    image_ = options_.draws ? ICET(library_, icetDrawFrame)(identity, identity, background)
                            : ICET(library_, icetCompositeImage)(
                                  picture.colour.data(), blended_ ? nullptr : picture.depth.data(),
                                  nullptr, nullptr, nullptr, background);
    const double end = now();
    double composite = 0;
    ICET(library_, icetGetDoublev)(ICET_COMPOSITE_TIME, &composite);
    seconds.push_back(greatest(end) - begin);
    composite_seconds.push_back(greatest(composite));
  }
  // Pixels of this process's tile; none where it shows none.
  std::vector<std::uint32_t> pixels() const {
    std::vector<std::uint32_t> result;
    if (ICET(library_, icetImageIsNull)(image_) != 0) return result;
    const IceTUInt* const from = ICET(library_, icetImageGetColorcui)(image_);
    result.assign(from, from + ICET(library_, icetImageGetNumPixels)(image_));
    return result;
  }

  std::vector<double> seconds, composite_seconds;

 private:
  void set_up() {
    const int width = options_.width, height = options_.height;
    ICET(library_, icetResetTiles)();
    if (options_.tiles) {
      const int w = width / 2, h = height / 2;
      for (int i = 0; i < 4; ++i) {
        ICET(library_, icetAddTile)
        (i % 2 * w, i / 2 * h, i % 2 != 0 ? width - w : w, i / 2 != 0 ? height - h : h, i);
      }
      ICET(library_, icetPhysicalRenderSize)(width, height);
    } else {
      ICET(library_, icetAddTile)(0, 0, width, height, 0);
    }
    ICET(library_, icetStrategy)
    (options_.tiles ? ICET_STRATEGY_REDUCE : ICET_STRATEGY_SEQUENTIAL);
    if (!options_.interlaces) ICET(library_, icetDisable)(ICET_INTERLACE_IMAGES);
    ICET(library_, icetSetColorFormat)(ICET_IMAGE_COLOR_RGBA_UBYTE);
    ICET(library_, icetDrawCallback)(&copy_picture);
    ICET(library_, icetSetDepthFormat)
    (blended_ ? ICET_IMAGE_DEPTH_NONE : ICET_IMAGE_DEPTH_FLOAT);
    if (!blended_) return;
    ICET(library_, icetCompositeMode)(ICET_COMPOSITE_MODE_BLEND);
    ICET(library_, icetEnable)(ICET_ORDERED_COMPOSITE);
    std::vector<IceTInt> order;
    for (int i = 0; i < ranks_; ++i) order.push_back(i);
    ICET(library_, icetCompositeOrder)(order.data());
  }

  Library library_;
  const Options& options_;
  bool blended_;
  int ranks_ = 1;
  IceTCommunicator communicator_;
  IceTContext context_;
  IceTImage image_{};
};

// The largest difference of a channel between two pictures.
int difference(const std::vector<std::uint32_t>& a, const std::vector<std::uint32_t>& b) {
  if (a.size() != b.size()) return 256;
  int most = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    for (unsigned shift = 0; shift < 32; shift += 8) {
      most = std::max(most, std::abs(static_cast<int>(a[i] >> shift & 255) -
                                     static_cast<int>(b[i] >> shift & 255)));
    }
  }
  return most;
}

void compare(const Options& options, const std::string& kind) {
  int rank = 0, ranks = 1;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  MPI_Comm_size(MPI_COMM_WORLD, &ranks);
  const Picture picture = draw(options, kind, rank, ranks);
  const bool blended = kind == "blended";
  Side icet(options.icet, options, blended), delray(options.delray, options, blended);
  for (int i = 0; i < options.repeats + 1; ++i) {
    icet.run(picture);
    delray.run(picture);
  }
  const int worst = static_cast<int>(greatest(difference(icet.pixels(), delray.pixels())));
  for (Side* const side : {&icet, &delray}) {  // without the first
    side->seconds.erase(side->seconds.begin());
    side->composite_seconds.erase(side->composite_seconds.begin());
  }
  if (rank != 0) return;
  const double ratio = median(delray.seconds) / median(icet.seconds);
  const double composite = median(delray.composite_seconds) / median(icet.composite_seconds);
  fmt::print(
      "{:10} {} ranks: {:6.2f} ms for {:6.2f} ms of IceT, {:.2f}; ICET_COMPOSITE_TIME {:6.2f} for "
      "{:6.2f}, {:.2f}; pictures differ by {}\n",
      kind, ranks, 1e3 * median(delray.seconds), 1e3 * median(icet.seconds), ratio,
      1e3 * median(delray.composite_seconds), 1e3 * median(icet.composite_seconds), composite,
      worst);
}

}  // namespace
}  // namespace delray::bench

int main(int argc, char** argv) {
  using namespace delray::bench;
  Options options;
  CLI::App app("One program over IceT's interface, by IceT and by Delray");
  app.add_option("--width", options.width, "Pixels")->check(CLI::Range(2, 32768));
  app.add_option("--height", options.height, "Pixels")->check(CLI::Range(2, 32768));
  app.add_option("--repeats", options.repeats, "Frames of each")->check(CLI::PositiveNumber);
  app.add_option("--pictures", options.pictures, "Which pictures")
      ->check(CLI::IsMember(std::vector<std::string>(options.pictures)));
  app.add_option("--icet", options.icet, "IceT's library for MPI")->check(CLI::ExistingFile);
  app.add_option("--delray", options.delray, "libdelray_icet.so.1")->check(CLI::ExistingFile);
  app.add_option("--skew", options.skew, "Milliseconds from one process's beginning to the next's")
      ->check(CLI::NonNegativeNumber);
  app.add_flag("!--no-interlace", options.interlaces, "Without ICET_INTERLACE_IMAGES");
  app.add_flag("--tiles", options.tiles, "2 x 2 tiles, by four processes or more");
  app.add_flag("--draws", options.draws,
               "icetDrawFrame, with a callback, in place of icetCompositeImage");
  CLI11_PARSE(app, argc, argv);
  MPI_Init(&argc, &argv);
  int ranks = 1;
  MPI_Comm_size(MPI_COMM_WORLD, &ranks);
  if (options.tiles && ranks < 4) {
    fmt::print(stderr, "--tiles: four processes or more show them\n");
    MPI_Abort(MPI_COMM_WORLD, 2);
  }
  for (const std::string& kind : options.pictures) compare(options, kind);
  MPI_Finalize();
  return 0;
}
