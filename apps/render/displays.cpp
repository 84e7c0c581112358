// Writes this rank's displays and tells rank 0 their hashes, 33 bytes for each.
#include "apps/render/displays.h"

#include <cstring>

#include "apps/render/write_picture.h"
#include "comm/agree_on_failure.h"
#include "comm/collectives.h"
#include "image/hash.h"

namespace delray::apps {
namespace {

constexpr std::size_t kDigits = 32;
struct Told {
  char hash[kDigits];
  bool is_empty;
};

}  // namespace

std::vector<ShownDisplay> write_displays(comm::Communicator& communicator, const Prepared& prepared,
                                         const RenderRequest& request, const Session& session,
                                         std::vector<Picture>&& shown) {
  const loadbalance::Wall& wall = *request.layout.wall;
  const std::vector<loadbalance::Region> displays =
      loadbalance::displays_of(wall, communicator.size());
  const auto path_of = [&](std::size_t i) {
    const auto columns = static_cast<std::size_t>(wall.columns);
    return display_path(request.output, static_cast<int>(i % columns),
                        static_cast<int>(i / columns));
  };
  std::vector<Told> told;
  comm::all_or_none(communicator, comm::Phase::other, [&] {
    for (std::size_t i = 0, own = 0; i < displays.size(); ++i) {
      if (displays[i].owner != communicator.rank()) continue;
      Picture& picture = shown[own++];
      Told& display = told.emplace_back();
      display.is_empty = shows_nothing(request, picture);
      put_background_behind(request, prepared, prepared.camera, displays[i].rect, picture);
      const std::string hash = write_picture(session, path_of(i), picture);
      std::memcpy(display.hash, hash.data(), kDigits);
      picture = {};
    }
  });
  const std::vector<comm::Buffer> all =
      comm::gather(communicator, 0, comm::Buffer::of(std::span<const Told>(told)));
  std::vector<ShownDisplay> result;
  if (communicator.rank() != 0) return result;
  // Displays are dealt in order.
  std::vector<std::size_t> next(all.size());
  for (std::size_t i = 0; i < displays.size(); ++i) {
    const auto rank = static_cast<std::size_t>(displays[i].owner);
    const Told& of = all[rank].as<Told>()[next[rank]++];
    const int number = static_cast<int>(i);
    result.push_back({number % wall.columns, number / wall.columns, displays[i].owner, path_of(i),
                      std::string(of.hash, kDigits), of.is_empty});
  }
  return result;
}

std::string hash_of(const std::vector<ShownDisplay>& displays) {
  std::string hashes;
  for (const ShownDisplay& display : displays) hashes += display.hash;
  image::Image8 digits(static_cast<int>(hashes.size() / sizeof(image::Rgba8)), 1);
  std::memcpy(digits.colour.data(), hashes.data(), hashes.size());
  return image::hash(digits);
}

Json wall_statistics(const RenderRequest& request, const std::vector<ShownDisplay>& displays) {
  const loadbalance::Wall& wall = *request.layout.wall;
  Json rows = Json::array();
  for (const ShownDisplay& display : displays) {
    rows.push_back({{"column", display.column},
                    {"row", display.row},
                    {"rank", display.rank},
                    {"file", display.path},
                    {"hash", display.hash}});
  }
  return {{"columns", wall.columns},
          {"rows", wall.rows},
          {"display", {{"width", wall.width}, {"height", wall.height}}},
          {"bezel", {{"width", wall.bezel_x}, {"height", wall.bezel_y}}},
          {"displays", rows}};
}

}  // namespace delray::apps
