// Renders pass by pass: rank 0 chooses the cells that get another chunk of samples, tells the
// others, and adds what comes back to the film.
//
// The expected time of a pass is that of the last one, by pixels and samples; it does not begin if
// it would end too late. Features are rendered before the first pass by integrators of their own.
//
// Degenerate: a picture of one small chunk, of which no film is asked for, is a single call of the
// renderer; an interruption hands out the film as it is.
#include "raytrace/progressive.h"

#include <algorithm>
#include <bit>
#include <chrono>
#include <cmath>
#include <cstring>
#include <limits>
#include <utility>

#include "comm/collectives.h"
#include "raytrace/distributed/collect_tiles.h"

namespace delray::raytrace {
namespace {

using geometry::Rect;
using Clock = std::chrono::steady_clock;

// Samples of features: as many as smooth their edges; more where a lens blurs them.
constexpr int kFeatureSamples = 16, kLensSamples = 16;

// A pass in parts begins with such a part of it, as nobody knows how long it will take.
constexpr double kFirstParts = 64;

// A pass, which rank 0 decides on and broadcasts. No samples: stop.
struct Pass {
  int first = 0, samples = 0;
  std::vector<std::uint8_t> cells;
};

Pass broadcast(comm::Communicator& communicator, Pass&& pass) {
  comm::Buffer message;
  if (communicator.rank() == 0) {
    message = comm::Buffer(2 * sizeof(int) + pass.cells.size());
    std::memcpy(message.data(), &pass.first, sizeof(int));
    std::memcpy(message.data() + sizeof(int), &pass.samples, sizeof(int));
    if (!pass.cells.empty()) {
      std::memcpy(message.data() + 2 * sizeof(int), pass.cells.data(), pass.cells.size());
    }
  }
  message = comm::broadcast(communicator, 0, std::move(message));
  Pass result;
  std::memcpy(&result.first, message.data(), sizeof(int));
  std::memcpy(&result.samples, message.data() + sizeof(int), sizeof(int));
  const auto* cells = reinterpret_cast<const std::uint8_t*>(message.data()) + 2 * sizeof(int);
  result.cells.assign(cells, cells + message.size() - 2 * sizeof(int));
  return result;
}

// The next chunk of all cells that are not done. Those that were done once stay so, as all cells of
// a pass get the same samples.
Pass next_pass(const Film& film, const ProgressiveOptions& options) {
  Pass pass;
  std::uint32_t first = 0;
  for (const std::uint32_t samples : film.samples()) first = std::max(first, samples);
  pass.first = static_cast<int>(first);
  pass.cells = unfinished(film, options.frame.samples, options.noise);
  bool any = false;
  for (std::size_t c = 0; c < pass.cells.size(); ++c) {
    if (film.samples()[c] != first) pass.cells[c] = 0;
    any = any || pass.cells[c] != 0;
  }
  if (any) pass.samples = std::min(chunk_size(pass.first), options.frame.samples - pass.first);
  return pass;
}

bool has_cells(const std::vector<std::uint8_t>& cells) {
  return std::ranges::find(cells, 1) != cells.end();
}

// What is left of a pass, whose cells have as many samples as each other.
Pass rest_of_pass(const Film& film, const ProgressiveOptions& options,
                  const std::vector<std::uint8_t>& cells_left) {
  Pass pass;
  pass.cells = cells_left;
  const auto cell = std::ranges::find(cells_left, 1) - cells_left.begin();
  pass.first = static_cast<int>(film.samples()[static_cast<std::size_t>(cell)]);
  pass.samples = std::min(chunk_size(pass.first), options.frame.samples - pass.first);
  return pass;
}

// Leaves the first cells of a pass, of about so many samples in all but at least one cell.
void shorten(const Film& film, double samples, Pass& pass) {
  double taken = 0;
  for (std::size_t c = 0; c < pass.cells.size(); ++c) {
    if (pass.cells[c] == 0) continue;
    if (taken > 0 && taken >= samples) pass.cells[c] = 0;
    taken += static_cast<double>(film.cell(c).area()) * pass.samples;
  }
}

std::uint64_t work(const Film& film, const Pass& pass) {
  std::uint64_t pixels = 0;
  for (std::size_t c = 0; c < pass.cells.size(); ++c) {
    if (pass.cells[c] != 0) pixels += static_cast<std::uint64_t>(film.cell(c).area());
  }
  return pixels * static_cast<std::uint64_t>(pass.samples);
}

// Samples of pixels until nothing is left to do or time is up, the pass among them.
double work_left(const Film& film, const Pass& pass, const ProgressiveOptions& options,
                 double work_in_time) {
  const auto left =
      static_cast<double>(samples_left(film, pass.cells, options.frame.samples, options.noise));
  return std::max(static_cast<double>(work(film, pass)), std::min(left, work_in_time));
}

static_assert(kCellSide == kTaskSide);

// Adds the costs of a pass's tiles, spread evenly over the cells that it was about.
void add_costs(std::span<const TileCost> costs, const loadbalance::Blocks& tiles, const Pass& pass,
               Film& film) {
  std::vector<std::size_t> cells;
  for (const TileCost& cost : costs) {
    if (cost.pixels == 0) continue;
    const Rect tile = tiles.block(cost.tile);
    cells.clear();
    std::int64_t pixels = 0;
    for (int y = tile.y0; y < tile.y1; y += kCellSide) {
      for (int x = tile.x0; x < tile.x1; x += kCellSide) {
        const std::size_t c = film.cell_of(x, y);
        if (pass.cells[c] == 0) continue;
        cells.push_back(c);
        pixels += film.cell(c).area();
      }
    }
    for (const std::size_t c : cells) {
      film.costs()[c].rays += static_cast<float>(cost.rays) / static_cast<float>(pixels);
      film.costs()[c].seconds += static_cast<float>(cost.seconds) / static_cast<float>(pixels);
    }
  }
}

Features trace_features(comm::Communicator& communicator, Renderer& renderer,
                        const scenes::Camera& camera, const RenderOptions& frame,
                        const Rect& window, Statistics& statistics) {
  RenderOptions options = frame;
  options.part.samples = std::min(frame.samples, kFeatureSamples);
  const auto picture = [&](const char* integrator) {
    options.integrator = integrator;
    Result result = renderer.render(communicator, camera, options);
    statistics += std::move(result.statistics);
    return cut(std::move(result.image), options.part.window, window);
  };
  const bool root = communicator.rank() == 0;
  const image::ImageF albedo = picture("albedo");
  const image::ImageF normal = picture("normal");
  options.part.samples = 1;
  const image::ImageF identity = picture("identity");
  if (!root) return {};
  Features features(albedo.pixels());
  for (std::size_t i = 0; i < albedo.pixels(); ++i) {
    const image::RgbaF &a = albedo.colour[i], &n = normal.colour[i], &id = identity.colour[i];
    features.albedo[i] = {a.r, a.g, a.b};
    const glm::vec3 mean(n.r, n.g, n.b);
    const float length2 = glm::dot(mean, mean);
    if (length2 > 0.0F) features.normal[i] = mean * (1.0F / std::sqrt(length2));
    if (id.r > 0.0F) {
      features.instance[i] = static_cast<std::uint32_t>(id.r) - 1;
      features.material[i] = static_cast<std::uint32_t>(id.g) - 1;
    }
  }
  return features;
}

// How long the last pass took, by which others are foretold.
struct PassTime {
  double seconds = 0.0;
  std::uint64_t work = 0;  // 0: there was none

  double seconds_for(std::uint64_t more) const {
    return work == 0 ? 0.0 : seconds * static_cast<double>(more) / static_cast<double>(work);
  }
  double work_in(double left) const {
    return work == 0 ? std::numeric_limits<double>::infinity()
                     : left / seconds * static_cast<double>(work);
  }
};

// The next pass, or part of one, on rank 0; without samples where there is to be none.
Pass choose_pass(const ProgressiveOptions& options, double elapsed, const PassTime& last,
                 ProgressiveResult& result) {
  const Film& film = result.film;
  const bool is_rest = has_cells(result.cells_left);
  Pass pass = is_rest ? rest_of_pass(film, options, result.cells_left) : next_pass(film, options);
  if (pass.samples == 0) return pass;
  result.out_of_time =
      last.work > 0 && elapsed + last.seconds_for(work(film, pass)) > options.seconds;
  result.stopped = !result.out_of_time && options.goes_on && !options.goes_on();
  if (result.out_of_time || result.stopped) {
    pass.samples = 0;
    return pass;
  }
  if (std::isfinite(options.part_seconds)) {
    if (!is_rest) result.cells_left = pass.cells;
    const double samples = last.work > 0 ? last.work_in(options.part_seconds)
                                         : static_cast<double>(work(film, pass)) / kFirstParts;
    shorten(film, samples, pass);
  }
  return pass;
}

// Shows how much of a rendering in several passes is done. `left`: the work from this pass on.
void show_progress(const Film& film, bool first_pass, double left, parallel::Progress& whole) {
  if (first_pass) {
    whole.start(0);
    whole.advance(film.total_samples());
  }
  whole.expect(film.total_samples() + static_cast<std::uint64_t>(left));
}

// Sends a picture that is whole on rank 0 to displays.
std::vector<image::ImageF> show(comm::Communicator& communicator, const Rect& window,
                                image::ImageF&& picture, const RenderOptions& options) {
  TilePixels all;
  all.rect = window;
  all.pixels = static_cast<std::uint32_t>(picture.pixels());
  all.colour = picture.colour.data();
  all.depth = picture.depth.data();
  all.stride = static_cast<std::size_t>(picture.width);
  return deliver_tiles(communicator, {&all, 1}, options.displays);
}

// Whether the picture of the first pass is that of its film, bit for bit: sums of powers of two are
// exact.
bool one_pass_does(const ProgressiveOptions& options) {
  const int samples = options.frame.samples;
  return samples <= chunk_size(0) && std::has_single_bit(static_cast<unsigned>(samples)) &&
         !(options.noise > 0.0F) && !options.film && !options.features && !options.resume &&
         !options.after_pass && !options.on_interruption && !options.goes_on;
}

}  // namespace

Rect grown(const Rect& window, const Rect& frame) {
  const auto up = [](int x) { return (x + kCellSide - 1) / kCellSide * kCellSide; };
  return geometry::intersection(
      frame, {window.x0 - window.x0 % kCellSide, window.y0 - window.y0 % kCellSide, up(window.x1),
              up(window.y1)});
}

image::ImageF cut(image::ImageF&& picture, const Rect& of, const Rect& window) {
  if (of == window || picture.pixels() == 0) return std::move(picture);
  image::ImageF result(window.width(), window.height());
  const auto width = static_cast<std::size_t>(window.width());
  for (int y = window.y0; y < window.y1; ++y) {
    const std::size_t from = static_cast<std::size_t>(y - of.y0) * picture.width +
                             static_cast<std::size_t>(window.x0 - of.x0);
    const std::size_t to = static_cast<std::size_t>(y - window.y0) * width;
    std::copy_n(picture.colour.data() + from, width, result.colour.data() + to);
    std::copy_n(picture.depth.data() + from, width, result.depth.data() + to);
  }
  return result;
}

ProgressiveResult render_progressively(comm::Communicator& communicator, Renderer& renderer,
                                       const scenes::Camera& camera,
                                       const ProgressiveOptions& options) {
  const auto start = Clock::now();
  const auto elapsed = [&] { return std::chrono::duration<double>(Clock::now() - start).count(); };
  const bool root = communicator.rank() == 0;
  const Rect frame{0, 0, options.frame.width, options.frame.height};
  const Rect window = options.window.empty() ? frame : options.window;
  const Rect film_window = grown(window, frame);

  ProgressiveResult result;
  RenderOptions pass_options = options.frame;
  const int side = tile_side(pass_options);
  pass_options.part.window = film_window;
  check_displays(options.frame.displays, window, communicator.size());
  if (!one_pass_does(options)) pass_options.displays.clear();
  pass_options.scattered = options.noise > 0.0F || std::isfinite(options.seconds);
  if (one_pass_does(options)) {
    Result traced = renderer.render(communicator, camera, pass_options);
    if (root && options.frame.displays.empty())
      result.image = cut(std::move(traced.image), film_window, window);
    result.shown = std::move(traced.shown);
    result.statistics = std::move(traced.statistics);
    result.passes = 1;
    return result;
  }
  if (root) {
    result.film = options.resume != nullptr ? *options.resume : Film(film_window);
    result.cells_left.assign(options.resume_cells.begin(), options.resume_cells.end());
  }
  Film& film = result.film;
  parallel::Progress* const whole = options.frame.progress;
  parallel::Progress part(whole);
  try {
    if (options.features) {
      result.features =
          trace_features(communicator, renderer, camera, pass_options, window, result.statistics);
    }
    PassTime last;
    while (true) {
      Pass pass;
      if (root) {
        pass = choose_pass(options, elapsed(), last, result);
      }
      pass = broadcast(communicator, std::move(pass));
      if (pass.samples == 0) {
        if (root && whole != nullptr) whole->expect(whole->done());
        break;
      }
      // A single pass shows by itself how far it is.
      const bool several = whole != nullptr && pass.samples < options.frame.samples;
      if (several) pass_options.progress = &part;
      if (several && root) {
        const double in_time = last.work_in(options.seconds - elapsed());
        show_progress(film, result.passes == 0, work_left(film, pass, options, in_time), *whole);
      }
      const double before = elapsed();
      pass_options.part.first_sample = pass.first;
      pass_options.part.samples = pass.samples;
      pass_options.part.squares = pass.cells;
      Result traced = renderer.render(communicator, camera, pass_options);
      ++result.passes;
      if (root) {
        last.work = work(film, pass);
        film.add(traced.image, pass.samples, pass.cells);
        renderer.recycle(std::move(traced.image));
        add_costs(traced.tile_costs, {film_window, side, side}, pass, film);
        for (std::size_t c = 0; c < result.cells_left.size(); ++c)
          if (pass.cells[c] != 0) result.cells_left[c] = 0;
        if (!has_cells(result.cells_left) && options.after_pass) options.after_pass(film);
        last.seconds = elapsed() - before;
        if (several) whole->advance(last.work);
      }
      result.statistics += std::move(traced.statistics);
    }
  } catch (...) {  // of this rank, or of another that ended this one
    if (root && options.on_interruption) options.on_interruption(film);
    throw;
  }
  if (root) result.image = cut(mean(film), film_window, window);
  if (!options.frame.displays.empty())
    result.shown = show(communicator, window, std::exchange(result.image, {}), options.frame);
  return result;
}

}  // namespace delray::raytrace
