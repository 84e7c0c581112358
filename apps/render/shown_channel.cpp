// The table of what --show can show, the channels that it reads, and the colours for each kind:
// directions, colours, numbers of things, amounts.
#include "apps/render/shown_channel.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include "apps/options/list.h"
#include "scenes/colour_map.h"

namespace delray::apps {
namespace {

using geometry::Rect;
using raytrace::ProgressiveResult;

// A channel, and how it is shown: of three numbers or of one.
struct ShownChannel {
  const char* name;
  const char* description;
  enum class Kind { direction, colour, id, number, square } kind;  // of a square, its root is shown
  const char* channel;                                             // the first of its channels
};

constexpr ShownChannel kShown[] = {
    {"normal", "normals of surfaces", ShownChannel::Kind::direction, "normal.X"},
    {"albedo", "base colours", ShownChannel::Kind::colour, "albedo.R"},
    {"instance", "instances, each in a colour of its own", ShownChannel::Kind::id, "id.instance"},
    {"material", "materials, each in a colour of its own", ShownChannel::Kind::id, "id.material"},
    {"depth", "distance along the view", ShownChannel::Kind::number, "Z"},
    {"variance", "of pixels: what is left of the noise", ShownChannel::Kind::square, "variance"},
    {"samples", "of each pixel", ShownChannel::Kind::number, "samples"},
    {"rays", "that each pixel took", ShownChannel::Kind::number, "cost.rays"},
    {"seconds", "that each pixel took", ShownChannel::Kind::number, "cost.seconds"},
};

template <class F>
image::Channel channel(const char* name, const Rect& window, F&& value) {
  image::Channel result{name, {}};
  result.values.reserve(static_cast<std::size_t>(window.area()));
  for (int y = window.y0; y < window.y1; ++y) {
    for (int x = window.x0; x < window.x1; ++x) {
      result.values.push_back(static_cast<float>(value(x, y, result.values.size())));
    }
  }
  return result;
}

double id_of(std::uint32_t id) { return id == raytrace::kMiss ? -1.0 : static_cast<double>(id); }

// Colours of ids that follow each other differ as much as they can: hues by the golden ratio.
glm::vec3 colour_of_id(float id) {
  const double turn = (static_cast<double>(id) + 1.0) * 0.61803398874989485;
  const auto hue = static_cast<float>(turn - std::floor(turn));
  const auto part = [hue](float offset) {
    const float h = hue + offset - std::floor(hue + offset);
    return std::clamp(std::abs(h * 6.0F - 3.0F) - 1.0F, 0.0F, 1.0F);
  };
  const float value = 0.35F + 0.4F * static_cast<float>(static_cast<int>(id) % 3) * 0.5F;
  return (glm::vec3(part(0.0F), part(2.0F / 3), part(1.0F / 3)) * 0.8F + 0.2F) * value;
}

// Nearly the greatest of the finite values, which alone may be many times all others; 0 if none is
// positive.
float top_of(std::vector<float> values) {
  std::erase_if(values, [](float v) { return !std::isfinite(v) || !(v > 0.0F); });
  if (values.empty()) return 0.0F;
  const auto top = values.begin() + static_cast<std::ptrdiff_t>(values.size() * 99 / 100);
  std::nth_element(values.begin(), top, values.end());
  return *top;
}

}  // namespace

std::vector<std::string> shown_names() {
  std::vector<std::string> names = names_in(kShown);
  names.insert(names.begin(), "colour");
  return names;
}

bool shows_features(const std::string& name) {
  return name == "normal" || name == "albedo" || name == "instance" || name == "material";
}

std::vector<image::Channel> channels_of(const ProgressiveResult& result, const Rect& window) {
  std::vector<image::Channel> channels;
  const raytrace::Features& f = result.features;
  const raytrace::Film& film = result.film;
  if (!f.normal.empty()) {
    const char* const normals[] = {"normal.X", "normal.Y", "normal.Z"};
    const char* const albedos[] = {"albedo.R", "albedo.G", "albedo.B"};
    for (int k = 0; k < 3; ++k) {
      channels.push_back(
          channel(normals[k], window, [&](int, int, std::size_t i) { return f.normal[i][k]; }));
    }
    for (int k = 0; k < 3; ++k) {
      channels.push_back(
          channel(albedos[k], window, [&](int, int, std::size_t i) { return f.albedo[i][k]; }));
    }
    channels.push_back(channel("id.instance", window,
                               [&](int, int, std::size_t i) { return id_of(f.instance[i]); }));
    channels.push_back(channel("id.material", window,
                               [&](int, int, std::size_t i) { return id_of(f.material[i]); }));
  }
  const std::vector<float> spread = raytrace::variance(film);
  channels.push_back(channel("variance", window,
                             [&](int x, int y, std::size_t) { return spread[film.pixel(x, y)]; }));
  channels.push_back(channel("samples", window, [&](int x, int y, std::size_t) {
    return film.samples()[film.cell_of(x, y)];
  }));
  channels.push_back(channel("cost.rays", window, [&](int x, int y, std::size_t) {
    return film.costs()[film.cell_of(x, y)].rays;
  }));
  channels.push_back(channel("cost.seconds", window, [&](int x, int y, std::size_t) {
    return film.costs()[film.cell_of(x, y)].seconds;
  }));
  return channels;
}

double show(const std::string& name, const ProgressiveResult& result, const Rect& window,
            image::ImageF& picture) {
  const ShownChannel& shown = find_entry(kShown, name, "--show");
  std::vector<image::Channel> channels = channels_of(result, window);
  channels.push_back({"Z", {picture.depth.data(), picture.depth.data() + picture.pixels()}});
  const auto first = std::find_if(channels.begin(), channels.end(),
                                  [&](const auto& c) { return c.name == shown.channel; });
  std::vector<float>& values = first->values;
  if (shown.kind == ShownChannel::Kind::square) {
    for (float& v : values) v = std::sqrt(v);
  }
  const float top = top_of(values);
  const auto& map = scenes::colour_map("turbo");
  for (std::size_t i = 0; i < picture.pixels(); ++i) {
    glm::vec3 colour(0.0F);
    bool covered = picture.depth[i] != image::kEmptyDepth;
    switch (shown.kind) {
      case ShownChannel::Kind::direction:
        colour =
            glm::vec3(first[0].values[i], first[1].values[i], first[2].values[i]) * 0.5F + 0.5F;
        break;
      case ShownChannel::Kind::colour:
        colour = {first[0].values[i], first[1].values[i], first[2].values[i]};
        break;
      case ShownChannel::Kind::id:
        covered = values[i] >= 0.0F;
        colour = colour_of_id(values[i]);
        break;
      case ShownChannel::Kind::number:
      case ShownChannel::Kind::square:
        covered = std::isfinite(values[i]);
        colour = map.colour(top > 0.0F ? std::min(values[i] / top, 1.0F) : 0.0F);
        break;
    }
    picture.colour[i] = covered ? image::RgbaF{colour.x, colour.y, colour.z, 1.0F} : image::RgbaF{};
  }
  return shown.kind == ShownChannel::Kind::number || shown.kind == ShownChannel::Kind::square ? top
                                                                                              : 0.0;
}

}  // namespace delray::apps
