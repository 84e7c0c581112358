// Pictures in files: what equal pictures have in common, and no more unless --metadata is given.
#include "apps/render/write_picture.h"

#include <spdlog/spdlog.h>
#include <CLI/CLI.hpp>

#include <algorithm>

#include "apps/options/help.h"
#include "apps/render/legend.h"
#include "image/hash.h"
#include "image/io.h"
#include "image/srgb.h"
#include "image/tone.h"
#include "shading/arithmetic.h"

namespace delray::apps {
namespace {

const image::Image8& as_8bit(const image::Image8& picture, image::Image8&) { return picture; }
const image::Image8& as_8bit(const image::ImageF& picture, image::Image8& converted) {
  converted = image::to_8bit(picture);
  return converted;
}

}  // namespace

void add_metadata_option(CLI::App& command, Session& session) {
  command
      .add_flag("--metadata", session.metadata,
                "Write the command line, with its paths, and the number of samples into the "
                "picture (default: only what equal pictures have in common)")
      ->group(group::kOutput);
}

bool shows_nothing(const RenderRequest& request, const Picture& picture) {
  if (request.sampling.show != "colour") return false;
  return std::visit(
      [](const auto& pixels) {
        return std::ranges::all_of(pixels.colour.span(), [](const auto& c) { return c.a == 0; });
      },
      picture);
}

void put_background_behind(const RenderRequest& request, const Prepared& prepared,
                           const scenes::Camera& camera, const geometry::Rect& window,
                           Picture& picture) {
  const scenes::View view = scenes::make_view(camera, request.width, request.height);
  const SamplingOptions& sampling = request.sampling;
  if (sampling.show != "colour") return;
  std::visit(
      [&](auto& pixels) {
        put_behind(pixels, prepared.background, prepared.shading(), view, {window.x0, window.y0});
      },
      picture);
  if (sampling.exposure != 0.0 || sampling.tone != "linear") {
    image::map_tones(std::get<image::ImageF>(picture),
                     shading::exp2(static_cast<float>(sampling.exposure)),
                     image::tone_curve(sampling.tone));
  }
  if (request.legend) {
    std::visit(
        [&](auto& pixels) {
          if (draw_legend(*prepared.scene.colour_scale, pixels)) return;
          spdlog::warn("{}: {} x {} pixels are too few for the legend, which is left out",
                       request.output, pixels.width, pixels.height);
        },
        picture);
  }
}

// A file must not tell where it was made, or how, unless its maker wants it.
std::vector<image::Attribute> picture_attributes(const Session& session, const std::string& path,
                                                 const Extras& extras) {
  std::vector<image::Attribute> attributes = {{"Software", "delray " DELRAY_VERSION}};
  if (!session.metadata) return attributes;
  const std::string suffix = image::picture_suffix(path);
  const bool has_free_names = suffix == ".png" || suffix == ".exr";
  attributes.push_back({has_free_names ? "CommandLine" : "ImageDescription", session.command_line});
  if (extras.passes > 0) {
    attributes.push_back({"delray:samples", extras.samples});
    attributes.push_back({"delray:passes", static_cast<double>(extras.passes)});
  }
  return attributes;
}

std::string write_picture(const Session& session, const std::string& path, const Picture& picture,
                          const Extras& extras) {
  const std::vector<image::Attribute> attributes = picture_attributes(session, path, extras);
  image::WriteOptions options;
  options.channels = extras.channels;
  options.attributes = attributes;
  return std::visit(
      [&](const auto& pixels) {
        image::Image8 converted;
        const image::Image8& codes = as_8bit(pixels, converted);
        if (image::picture_suffix(path) == ".exr") {
          write_image(path, pixels, options);
        } else {
          write_image(path, codes, options);
        }
        return image::hash(codes);
      },
      picture);
}

}  // namespace delray::apps
