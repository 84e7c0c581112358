// Levels of detail of a surface as a hierarchy of groups: neighbouring pages are simplified
// together with their outer border locked, and cut into pages anew; on the next level other pages
// are neighbours (Ponchio 2008; Karis, Stubbe and Wihlidal 2021). A cut that takes, of each group,
// all pages or all that they were made into has no cracks, since borders of groups are the same on
// both sides.
//
// A group's error is what simplifying it cost, measured in both directions, with the errors of what
// lies beneath added triangle by triangle: by the triangle inequality no less than the distance to
// the finest level, and no less than the error of any group below. Spheres hold those below them.
// So errors on the screen ascend from level to level wherever the eye is. Triangles' errors are
// kept as a byte each, rounded up, of the level at hand and the one before.
//
// Points have no borders that need be the same: of them some are left out (thin_points.h).
//
// Degenerate: groups of which hardly anything can be left out stay as they are, and end there.
#include "packs/build/levels.h"

#include <algorithm>
#include <cmath>

#include "packs/build/cut_pages.h"
#include "packs/build/page_groups.h"
#include "packs/build/simplify.h"
#include "packs/build/thin_points.h"
#include "parallel/arena.h"
#include "parallel/parallel_for.h"

namespace delray::packs::internal {
namespace {

constexpr double kWorthIt = 0.85;  // of the triangles may be left at most
constexpr int kMostLevels = 30;
constexpr std::size_t kGroupsPerThread = 4;

// How far the triangles of a page are from the finest level, in parts of the largest of their
// group.
using PageErrors = std::vector<std::uint8_t>;
constexpr float kErrorSteps = 255;

struct MadeGroup {
  std::vector<EncodedPage> pages;  // none: not worth it
  std::vector<PageErrors> errors;  // of them
  Group group;
};

// What is there when a level is made of the one before.
struct Below {
  std::span<const PageRow> pages;
  std::span<const Group> groups;
  std::uint32_t first = 0;             // page of the level before
  std::span<const PageErrors> errors;  // of its pages; none of the finest level

  void append_errors(std::uint32_t page, std::vector<float>& to) const {
    if (errors.empty()) {
      to.insert(to.end(), pages[page].triangles, 0.0F);
      return;
    }
    const float step = groups[pages[page].made_of].error / kErrorSteps;
    for (const std::uint8_t error : errors[page - first])
      to.push_back(static_cast<float>(error) * step);
  }
};

// Rounded up, so that nothing is closer than said.
PageErrors in_steps(std::span<const float> errors, float largest) {
  PageErrors result;
  for (const float error : errors) {
    const float steps = largest > 0 ? std::ceil(error / largest * kErrorSteps) : 0;
    result.push_back(static_cast<std::uint8_t>(std::clamp(steps + 1, 0.0F, kErrorSteps)));
  }
  return result;
}

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
                     const Below& below) {
  MadeGroup made;
  std::vector<Page> pages;
  std::vector<float> before;
  for (const std::uint32_t page : members) {
    pages.push_back(builder.read(page));
    below.append_errors(page, before);
  }
  const scenes::Mesh mesh = merge(pages);
  const Simplified simplified =
      mesh.has_triangles() ? simplify(mesh, before) : thin_points(mesh, before);
  const auto all = static_cast<double>(mesh.triangles.size());
  const std::size_t left = simplified.mesh.triangles.size();
  if (left == 0 || static_cast<double>(left) > kWorthIt * all) return made;
  made.group = bounds_of(members, below.pages, below.groups);
  made.group.error = std::max(made.group.error, simplified.errors.largest);
  if (!std::isfinite(made.group.error + made.group.radius)) return made;
  std::span<const float> errors = simplified.errors.triangles;
  for (const Page& page : cut_pages(simplified.mesh, 0, static_cast<std::uint32_t>(left))) {
    made.pages.push_back(encode_page(page, {}));
    const std::size_t count = page.mesh.triangles.size();
    made.errors.push_back(in_steps(errors.first(count), made.group.error));
    errors = errors.subspan(count);
  }
  return made;
}

}  // namespace

void build_levels(const LevelBuilder& builder, std::vector<PageRow>& pages,
                  std::vector<Group>& groups, MeshRow& mesh) {
  const std::size_t wave = kGroupsPerThread * static_cast<std::size_t>(parallel::arena_threads());
  std::vector<PageErrors> errors;  // of the last level's pages
  for (int level = 1; level < kMostLevels && mesh.levels.back().count > 1; ++level) {
    const std::vector<std::vector<std::uint32_t>> members =
        page_groups(pages, mesh.levels.back(), level);
    PageRange made_range{static_cast<std::uint32_t>(pages.size()), 0};
    std::uint32_t first = 0;
    std::vector<PageErrors> made_errors;
    std::vector<MadeGroup> made(std::min(wave, members.size()));
    for (std::size_t begin = 0; begin < members.size(); begin += wave) {
      const std::size_t count = std::min(wave, members.size() - begin);
      parallel::parallel_for(0, count, 1, [&](std::size_t i) {
        made[i] = make_group(builder, members[begin + i],
                             {pages, groups, mesh.levels.back().first, errors});
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
        std::ranges::move(made[i].errors, std::back_inserter(made_errors));
        builder.append(std::move(made[i].pages));
        made[i] = {};
      }
    }
    made_range.count = static_cast<std::uint32_t>(pages.size()) - made_range.first;
    if (made_range.count == 0) return;
    mesh.levels.push_back(made_range);
    errors = std::move(made_errors);
  }
}

}  // namespace delray::packs::internal
