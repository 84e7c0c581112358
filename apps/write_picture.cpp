#include "apps/write_picture.h"

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

void put_background_behind(const RenderRequest& request, const Prepared& prepared,
                           const scenes::Camera& camera, Picture& picture) {
  const scenes::View view = scenes::make_view(camera, request.width, request.height);
  const Practice& practice = request.practice;
  if (practice.show != "colour") return;
  std::visit(
      [&](auto& pixels) {
        put_behind(pixels, prepared.background, prepared.shading(), view,
                   {practice.window.x0, practice.window.y0});
      },
      picture);
  if (practice.exposure == 0.0 && practice.tone == "linear") return;
  image::map_tones(std::get<image::ImageF>(picture),
                   shading::exp2(static_cast<float>(practice.exposure)),
                   image::tone_curve(practice.tone));
}

std::string write_picture(const Session& session, const std::string& path, const Picture& picture,
                          const Extras& extras) {
  std::vector<image::Attribute> attributes = {{"Software", "delray " DELRAY_VERSION},
                                              {"CommandLine", session.command_line}};
  if (extras.passes > 0) {
    attributes.push_back({"delray:samples", extras.samples});
    attributes.push_back({"delray:passes", static_cast<double>(extras.passes)});
  }
  image::WriteOptions options;
  options.channels = extras.channels;
  options.attributes = attributes;
  return std::visit(
      [&](const auto& pixels) {
        image::Image8 converted;
        const image::Image8& codes = as_8bit(pixels, converted);
        if (path.ends_with(".exr") || path.ends_with(".EXR")) {
          write_image(path, pixels, options);
        } else {
          write_image(path, codes, options);
        }
        return image::hash(codes);
      },
      picture);
}

}  // namespace delray::apps
