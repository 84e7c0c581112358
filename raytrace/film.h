// Samples of a picture as they add up: colours, how much they vary, what they cost.
//
// Samples of a pixel come in chunks, whose sizes depend on nothing but the number of their first
// sample. Chunks are summed up in ascending order, so that the sums are the same bits wherever a
// rendering was interrupted. How much the means of chunks vary tells how much noise is left; as
// samples of a chunk are stratified, it tells more than the samples themselves would.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "geometry/rect.h"
#include "image/image.h"

namespace delray::raytrace {

// A cell is a square of so many pixels a side. Whether more samples are taken is decided for a cell
// as a whole, and costs are kept by cell.
inline constexpr int kCellSide = 16;

// How many samples the chunk has that begins with sample `first`, and how many chunks so many
// samples are; the last may be cut short. Chunks are powers of two at multiples of their size, as
// Sobol's sequence likes it: small ones first, for a first look.
int chunk_size(int first);
int chunks(int samples);

// The sum of a pixel's samples.
struct PixelSum {
  image::RgbaF colour;               // linear, premultiplied
  float squares = 0.0F;              // of the luminances of chunks' means, times their samples
  float depth = image::kEmptyDepth;  // the least
};

// The luminance of linear light (Rec. 709).
inline float luminance(const image::RgbaF& c) {
  return 0.2126F * c.r + 0.7152F * c.g + 0.0722F * c.b;
}

// Adds the next chunk of a pixel, of so many samples, by its mean.
void add_chunk(const image::RgbaF& mean, float depth, int samples, PixelSum& sum);

// The cost of a cell's samples so far, per pixel of it.
struct CellCost {
  float rays = 0.0F, seconds = 0.0F;
};

// The sums of a window of pixels, whose left and upper sides are multiples of kCellSide.
class Film {
 public:
  Film() = default;
  explicit Film(const geometry::Rect& window);

  const geometry::Rect& window() const { return window_; }
  int columns() const { return columns_; }  // of cells
  int rows() const { return rows_; }
  geometry::Rect cell(std::size_t i) const;  // its pixels; cells go row by row

  // Element i is of pixel or cell i of the window, row by row.
  std::span<PixelSum> pixels() { return pixels_; }
  std::span<const PixelSum> pixels() const { return pixels_; }
  std::span<CellCost> costs() { return costs_; }
  std::span<const CellCost> costs() const { return costs_; }
  std::span<std::uint32_t> samples() { return samples_; }  // of each pixel of a cell
  std::span<const std::uint32_t> samples() const { return samples_; }

  std::size_t pixel(int x, int y) const {  // of the frame
    return static_cast<std::size_t>(y - window_.y0) * static_cast<std::size_t>(window_.width()) +
           static_cast<std::size_t>(x - window_.x0);
  }
  std::size_t cell_of(int x, int y) const {
    return static_cast<std::size_t>((y - window_.y0) / kCellSide) *
               static_cast<std::size_t>(columns_) +
           static_cast<std::size_t>((x - window_.x0) / kCellSide);
  }

  // Adds the next chunk of the cells in `cells` (one element each, 1: yes): means of so many
  // samples, a picture of the window. Parallel.
  void add(const image::ImageF& means, int samples, std::span<const std::uint8_t> cells);

  std::uint64_t total_samples() const;  // of all pixels

 private:
  geometry::Rect window_;
  int columns_ = 0, rows_ = 0;
  std::vector<PixelSum> pixels_;
  std::vector<CellCost> costs_;
  std::vector<std::uint32_t> samples_;
};

// The picture so far; pixels without samples are empty. Parallel.
image::ImageF mean(const Film& film);

// The variance of the mean of each pixel's luminance: what is left of the noise, squared. 0 with
// less than two chunks. Parallel.
std::vector<float> variance(const Film& film);

// How far values on the screen are off, as a standard deviation, 1 being white: the root of the
// variance over twice the root of the luminance, which is about what coding to sRGB makes of it.
// The luminance is the pixel's or, where that is less, that of the pixels around it. For each cell
// the root mean square over the noisiest quarter of it, or that of a cell beside it where it is
// larger: noise is a poor witness of itself. Infinite with less than kLeastChunks chunks. Parallel.
inline constexpr int kLeastChunks = 4;
std::vector<float> noise(const Film& film);

// By cell, 1 if it still gets samples: it has less than `most`, and its noise is above the
// threshold (<= 0: noise counts for nothing). 0 otherwise.
std::vector<std::uint8_t> unfinished(const Film& film, int most, float threshold);

// How many samples the pixels of the cells in `cells` (one element each, 1: yes) will still get
// together, by `most` and the threshold as above: a variance falls with the number of samples. All
// that they may get where the noise is not known yet.
std::uint64_t samples_left(const Film& film, std::span<const std::uint8_t> cells, int most,
                           float threshold);

}  // namespace delray::raytrace
