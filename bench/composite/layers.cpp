// How long cutting and merging of layers takes, over a plain loop that reads and writes the same
// planes without comparing anything: one table line for each codec, shape and share of covered
// pixels. All take turns; medians.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <functional>
#include <random>
#include <string>

#include "bench/measure.h"
#include "bench/ratio.h"
#include "composite/codec.h"
#include "composite/deep.h"
#include "image/image.h"
#include "parallel/arena.h"

namespace delray::bench {
namespace {

using image::Image8;

struct Options {
  int width = 1920, height = 1080, threads = 1, repeats = 21;
};

// A disc in the middle, or pixels at random, that cover this share of the image.
Image8 picture(const Options& options, bool random, double share, unsigned seed) {
  Image8 image(options.width, options.height);
  clear(image);
  std::mt19937 numbers(seed);
  std::uniform_real_distribution<double> uniform;
  const double pi = 3.14159265358979;
  const double radius2 = share * options.width * options.height / pi;
  for (std::size_t i = 0; i < image.pixels(); ++i) {
    const auto width = static_cast<std::size_t>(options.width);
    const double x = static_cast<double>(i % width) - options.width / 2.0;
    const double y = static_cast<double>(i / width) - options.height / 2.0;
    const bool inside = share >= 1 || x * x + y * y < radius2;
    if (random ? uniform(numbers) >= share : !inside) continue;
    image.colour[i] = {static_cast<std::uint8_t>(i), 1, 2, 255};
    image.depth[i] = static_cast<float>(uniform(numbers));
  }
  return image;
}

composite::DeepImage<image::RgbaF> deep(const Image8& flat, std::uint32_t primitive) {
  composite::DeepImage<image::RgbaF> result(flat.width, flat.height);
  for (std::size_t i = 0; i < flat.pixels(); ++i) {
    if (flat.depth[i] == image::kEmptyDepth) continue;
    composite::Fragment fragment{{0.1F, 0.1F, 0.1F, 1}, flat.depth[i], primitive, 0};
    result.set(i, {&fragment, 1});
  }
  return result;
}

// The reads and writes of a dense merge: both planes of two images read, those of one written.
void merge_without_comparing(Image8& image, const comm::Buffer& other) {
  const std::size_t pixels = image.pixels();
  const auto* colour = reinterpret_cast<const std::uint32_t*>(other.data());
  const auto* depth = reinterpret_cast<const float*>(colour + pixels);
  auto* own = reinterpret_cast<std::uint32_t*>(image.colour.data());
  for (std::size_t i = 0; i < pixels; ++i) {
    own[i] += colour[i];
    image.depth[i] += depth[i];
  }
}

struct Row {
  std::string name;
  std::unique_ptr<composite::Layer> layer, sender;
  comm::Buffer before;  // all of the layer before it is merged
  std::size_t bytes = 0;
  std::vector<double> cut, merge;
};

Row row(std::string name, std::unique_ptr<composite::Layer> layer,
        std::unique_ptr<composite::Layer> sender) {
  Row result;
  result.name = std::move(name);
  result.layer = std::move(layer);
  result.sender = std::move(sender);
  return result;
}

void print(const Options& options) {
  std::vector<Row> rows;
  for (const bool random : {false, true}) {
    for (const double share : {0.0, 0.1, 0.3, 0.5, 1.0}) {
      if (random && (share == 0 || share == 1)) continue;
      const std::string name = fmt::format("{:.0f} % {}", 100 * share, random ? "random" : "disc");
      const auto make = [&](unsigned seed) { return picture(options, random, share, seed); };
      for (const composite::Codec& codec : composite::codecs()) {
        rows.push_back(row(codec.name + (" " + name), codec.make(make(1)), codec.make(make(2))));
      }
      rows.push_back(row("deep " + name, composite::make_deep(deep(make(1), 1)),
                         composite::make_deep(deep(make(2), 2))));
    }
  }
  Image8 plain_image = picture(options, false, 1, 1);
  const auto plain_sender = composite::find_codec("dense")->make(picture(options, false, 1, 2));
  const composite::PixelRange all{0, plain_image.pixels()};
  std::vector<double> plain;
  const KeepMemory kept;
  for (Row& row : rows) row.before = row.layer->encode(all);
  for (int repeat = 0; repeat < options.repeats; ++repeat) {
    for (Row& row : rows) {
      // Just written, as what is merged: caches are in the same state.
      const comm::Buffer plain_other = plain_sender->encode(all);
      plain.push_back(seconds_of([&] {
        merge_without_comparing(plain_image, plain_other);
        return 0;
      }));
      comm::Buffer message;
      row.cut.push_back(seconds_of([&] {
        message = row.sender->encode(all);
        return 0;
      }));
      row.bytes = message.size();
      row.merge.push_back(
          seconds_of([&] { return row.layer->merge(all, message, composite::Side::higher); }));
      row.layer->replace(all, row.before);
    }
  }
  const double base = median(plain);
  fmt::print("{} x {}, {} threads; plain loop: {:.2f} ms, {:.1f} GB/s\n", options.width,
             options.height, options.threads, 1e3 * base,
             static_cast<double>(all.size()) * 24 / base / 1e9);
  fmt::print("{:24} {:>10} {:>9} {:>9} {:>12}\n", "layer", "MB", "cut ms", "merge ms",
             "merge/plain");
  for (const Row& row : rows) {
    fmt::print("{:24} {:10.3f} {:9.2f} {:9.2f} {:12.2f}\n", row.name,
               static_cast<double>(row.bytes) / 1e6, 1e3 * median(row.cut), 1e3 * median(row.merge),
               median(row.merge) / base);
    report_ratio("merge of " + row.name, median(row.merge) / base);
  }
}

}  // namespace
}  // namespace delray::bench

int main(int argc, char** argv) {
  delray::bench::Options options;
  CLI::App app("Times of cutting and merging layers");
  app.add_option("--width", options.width)->check(CLI::PositiveNumber);
  app.add_option("--height", options.height)->check(CLI::PositiveNumber);
  app.add_option("--threads", options.threads)->check(CLI::PositiveNumber);
  app.add_option("--repeats", options.repeats)->check(CLI::PositiveNumber);
  CLI11_PARSE(app, argc, argv);
  delray::parallel::Arena(options.threads).execute([&] { delray::bench::print(options); });
}
