#include "apps/write_picture.h"

#include "image/hash.h"
#include "image/io.h"
#include "image/srgb.h"

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
  std::visit(
      [&](auto& pixels) { put_behind(pixels, prepared.background, prepared.shading(), view); },
      picture);
}

std::string write_picture(const Session& session, const std::string& path, const Picture& picture) {
  const std::vector<image::Attribute> attributes = {{"Software", "delray " DELRAY_VERSION},
                                                    {"CommandLine", session.command_line}};
  image::WriteOptions options;
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
