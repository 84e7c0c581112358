// A legend of whole pixels, enlarged by a whole number, so that it is the same on every machine.
#include "apps/render/legend.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>
#include <vector>

#include "apps/render/font.h"
#include "image/srgb.h"

namespace delray::apps {
namespace {

constexpr int kRowsPerSize = 700;  // letters are larger in pictures of twice as many
constexpr int kMargin = 8, kPadding = 6, kLine = kGlyphHeight + 3;
constexpr int kBarWidth = 16, kBarHeight = 8 * kLine, kTicks = 5, kGap = 6;
constexpr int kSwatch = 11;

constexpr image::RgbaF kPaper{0.9F, 0.9F, 0.9F, 1}, kInk{0.01F, 0.01F, 0.01F, 1};

image::RgbaF ink_of(const glm::vec3& c) { return {c.x, c.y, c.z, 1}; }

// Numbers as short as their range allows.
std::vector<std::string> tick_texts(float low, float high) {
  const double step = (double{high} - low) / (kTicks - 1);
  const int digits =
      step > 0 ? std::clamp(1 - static_cast<int>(std::floor(std::log10(step))), 0, 6) : 2;
  std::vector<std::string> result(kTicks);
  for (int k = 0; k < kTicks; ++k) {
    result[static_cast<std::size_t>(k)] = fmt::format("{:.{}f}", low + k * step, digits);
  }
  return result;
}

// Pixels of the legend's own, each several of the picture.
template <class Colour>
class Canvas {
 public:
  Canvas(image::BasicImage<Colour>& picture, int width, int height)
      : picture_(picture),
        size_(std::max(1, picture.height / kRowsPerSize)),
        x0_(kMargin * size_),
        y0_(picture.height - (kMargin + height) * size_),
        fits_(x0_ + width * size_ <= picture.width && y0_ >= 0) {}

  bool fits() const { return fits_; }
  void fill(int x, int y, int width, int height, const image::RgbaF& colour) {
    for (int j = y * size_; j < (y + height) * size_; ++j) {
      for (int i = x * size_; i < (x + width) * size_; ++i) set(x0_ + i, y0_ + j, colour);
    }
  }
  void write(int x, int y, std::string_view text) {
    for (const char letter : text) {
      const Glyph& rows = glyph(letter);
      for (int j = 0; j < kGlyphHeight; ++j) {
        for (int i = 0; i < kGlyphWidth; ++i) {
          const bool inked = (rows[static_cast<std::size_t>(j)] >> (7 - i) & 1) != 0;
          if (inked) fill(x + i, y + j, 1, 1, kInk);
        }
      }
      x += kGlyphWidth;
    }
  }

 private:
  void set(int x, int y, const image::RgbaF& colour) {
    Colour& pixel =
        picture_.colour[static_cast<std::size_t>(y) * static_cast<std::size_t>(picture_.width) +
                        static_cast<std::size_t>(x)];
    if constexpr (std::is_same_v<Colour, image::RgbaF>) {
      pixel = colour;
    } else {
      pixel = image::to_8bit(colour);
    }
  }

  image::BasicImage<Colour>& picture_;
  int size_, x0_, y0_;
  bool fits_;
};

int width_of(const std::vector<std::string>& texts) {
  std::size_t longest = 0;
  for (const std::string& text : texts) longest = std::max(longest, text.size());
  return static_cast<int>(longest) * kGlyphWidth;
}

// Each draws nothing where there is no room for it, and says so.
template <class Colour>
bool draw_bar(const scenes::ColourScale& scale, image::BasicImage<Colour>& picture) {
  const std::vector<std::string> texts = tick_texts(scale.low, scale.high);
  const int width =
      2 * kPadding + std::max(width_of({scale.title}), kBarWidth + kGap + width_of(texts));
  const int top = kPadding + kLine + kGlyphHeight / 2;
  const int height = top + kBarHeight + kGlyphHeight / 2 + kPadding;
  Canvas<Colour> canvas(picture, width, height);
  if (!canvas.fits()) return false;
  canvas.fill(0, 0, width, height, kPaper);
  canvas.write(kPadding, kPadding, scale.title);
  for (int j = 0; j < kBarHeight; ++j) {
    const float t = 1 - static_cast<float>(j) / static_cast<float>(kBarHeight - 1);
    canvas.fill(kPadding, top + j, kBarWidth, 1, ink_of(scale.colour(t)));
  }
  for (int k = 0; k < kTicks; ++k) {
    const int y = top + (kBarHeight - 1) * (kTicks - 1 - k) / (kTicks - 1);
    canvas.fill(kPadding + kBarWidth, y, 3, 1, kInk);
    canvas.write(kPadding + kBarWidth + kGap, y - kGlyphHeight / 2,
                 texts[static_cast<std::size_t>(k)]);
  }
  return true;
}

template <class Colour>
bool draw_classes(const scenes::ColourScale& scale, image::BasicImage<Colour>& picture) {
  const int size = std::max(1, picture.height / kRowsPerSize);
  const int room = (picture.height / size - 2 * kMargin - 2 * kPadding) / kLine - 1;
  std::vector<std::string> texts;
  for (const auto& c : scale.classes) texts.push_back(c.name);
  if (room < 2) return false;
  std::size_t shown = texts.size();
  if (shown > static_cast<std::size_t>(room)) {
    shown = static_cast<std::size_t>(room) - 1;
    texts.resize(shown);
    texts.push_back(fmt::format("{} more", scale.classes.size() - shown));
  }
  const int width =
      2 * kPadding + std::max(width_of({scale.title}), kSwatch + kGap + width_of(texts));
  const int height = 2 * kPadding + kLine * (static_cast<int>(texts.size()) + 1);
  Canvas<Colour> canvas(picture, width, height);
  if (!canvas.fits()) return false;
  canvas.fill(0, 0, width, height, kPaper);
  canvas.write(kPadding, kPadding, scale.title);
  for (std::size_t i = 0; i < texts.size(); ++i) {
    const int y = kPadding + kLine * (static_cast<int>(i) + 1);
    if (i < shown) {
      canvas.fill(kPadding, y + 1, kSwatch, kSwatch, ink_of(scale.classes[i].colour));
    }
    canvas.write(kPadding + kSwatch + kGap, y, texts[i]);
  }
  return true;
}

// A number that is everywhere the same has one colour.
scenes::ColourScale as_class(const scenes::ColourScale& scale) {
  scenes::ColourScale one;
  one.title = scale.title;
  one.classes.push_back({fmt::format("{:.7g}", scale.low), scale.colour(0)});
  return one;
}

template <class Colour>
bool draw(const scenes::ColourScale& scale, image::BasicImage<Colour>& picture) {
  if (scale.colour == nullptr) return draw_classes(scale, picture);
  return scale.high > scale.low ? draw_bar(scale, picture) : draw_classes(as_class(scale), picture);
}

}  // namespace

bool draw_legend(const scenes::ColourScale& scale, image::Image8& picture) {
  return draw(scale, picture);
}
bool draw_legend(const scenes::ColourScale& scale, image::ImageF& picture) {
  return draw(scale, picture);
}

}  // namespace delray::apps
