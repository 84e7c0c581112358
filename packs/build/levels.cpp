// Levels of detail of a surface as a hierarchy of groups: neighbouring pages are simplified
// together with their outer border locked, and cut into pages anew; on the next level other pages
// are neighbours (Ponchio 2008; Karis, Stubbe and Wihlidal 2021). A cut that takes, of each group,
// all pages or all that they were made into has no cracks, since borders of groups are the same on
// both sides.
//
// A group's error is what simplifying it cost, measured in both directions, besides the largest
// error of the groups below it: by the triangle inequality no less than the distance to the finest
// level. Spheres hold those below them. So errors on the screen ascend from level to level wherever
// the eye is.
//
// Degenerate: groups of which hardly anything can be left out stay as they are, and end there.
#include "packs/build/levels.h"

#include <algorithm>
#include <cmath>

#include "packs/build/cut_pages.h"
#include "packs/build/page_groups.h"
#include "packs/build/simplify.h"
#include "parallel/arena.h"
#include "parallel/parallel_for.h"

namespace delray::packs::internal {
namespace {

constexpr double kWorthIt = 0.85;  // of the triangles may be left at most
constexpr int kMostLevels = 30;
constexpr std::size_t kGroupsPerThread = 4;

struct MadeGroup {
  std::vector<EncodedPage> pages;  // none: not worth it
  Group group;
};

// Around the pages, and around the spheres that what they were made of is in.
Group bounds_of(std::span<const std::uint32_t> members, std::span<const PageRow> pages,
                std::span<const Group> groups) {
  Group group;
  geometry::Box3 box;
  for (const std::uint32_t page : members) box.include(pages[page].box);
  group.centre = box.centre();
  double radius = 0;
  for (const std::uint32_t page : members) {
    const glm::dvec3 far =
        glm::max(glm::abs(glm::dvec3(pages[page].box.high) - glm::dvec3(group.centre)),
                 glm::abs(glm::dvec3(group.centre) - glm::dvec3(pages[page].box.low)));
    radius = std::max(radius, glm::length(far));
    if (pages[page].made_of == kNoGroup) continue;
    const Group& below = groups[pages[page].made_of];
    radius = std::max(radius, glm::distance(glm::dvec3(group.centre), glm::dvec3(below.centre)) +
                                  static_cast<double>(below.radius));
    group.error = std::max(group.error, below.error);
  }
  constexpr double kRounding = 1e-5;
  group.radius = static_cast<float>(radius * (1 + kRounding));
  return group;
}

MadeGroup make_group(const LevelBuilder& builder, std::span<const std::uint32_t> members,
                     std::span<const PageRow> rows, std::span<const Group> groups) {
  MadeGroup made;
  std::vector<Page> pages;
  for (const std::uint32_t page : members) pages.push_back(builder.read(page));
  const scenes::Mesh mesh = merge(pages);
  Simplified simplified = simplify(mesh);
  const auto before = static_cast<double>(mesh.triangles.size());
  const std::size_t left = simplified.mesh.triangles.size();
  if (left == 0 || static_cast<double>(left) > kWorthIt * before) return made;
  made.group = bounds_of(members, rows, groups);
  made.group.error += simplified.error;
  if (!std::isfinite(made.group.error + made.group.radius)) return made;
  for (const Page& page : cut_pages(simplified.mesh, 0, static_cast<std::uint32_t>(left)))
    made.pages.push_back(encode_page(page, {}));
  return made;
}

}  // namespace

void build_levels(const LevelBuilder& builder, std::vector<PageRow>& pages,
                  std::vector<Group>& groups, MeshRow& mesh) {
  const std::size_t wave = kGroupsPerThread * static_cast<std::size_t>(parallel::arena_threads());
  for (int level = 1; level < kMostLevels && mesh.levels.back().count > 1; ++level) {
    const std::vector<std::vector<std::uint32_t>> members =
        page_groups(pages, mesh.levels.back(), level);
    PageRange made_range{static_cast<std::uint32_t>(pages.size()), 0};
    std::uint32_t first = 0;
    std::vector<MadeGroup> made(std::min(wave, members.size()));
    for (std::size_t begin = 0; begin < members.size(); begin += wave) {
      const std::size_t count = std::min(wave, members.size() - begin);
      parallel::parallel_for(0, count, 1, [&](std::size_t i) {
        made[i] = make_group(builder, members[begin + i], pages, groups);
      });
      for (std::size_t i = 0; i < count; ++i) {
        if (made[i].pages.empty()) continue;
        const auto number = static_cast<std::uint32_t>(groups.size());
        groups.push_back(made[i].group);
        for (const std::uint32_t page : members[begin + i]) pages[page].simplified_in = number;
        for (EncodedPage& page : made[i].pages) {
          page.row.first = first;
          page.row.level = static_cast<std::uint8_t>(level);
          page.row.made_of = number;
          first += page.row.triangles;
        }
        builder.append(std::move(made[i].pages));
        made[i] = {};
      }
    }
    made_range.count = static_cast<std::uint32_t>(pages.size()) - made_range.first;
    if (made_range.count == 0) return;
    mesh.levels.push_back(made_range);
  }
}

}  // namespace delray::packs::internal
