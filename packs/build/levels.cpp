// Levels of detail of a surface as a hierarchy of groups: neighbouring pages are simplified
// together with their outer border locked, and cut into pages anew; on the next level other pages
// are neighbours (Ponchio 2008; Karis, Stubbe and Wihlidal 2021). A cut that takes, of each group,
// all pages or all that they were made into has no cracks, since borders of groups are the same on
// both sides.
//
// A group's error is measured against the finest level, or another that is kReferenceLevels finer
// at most: errors of one level after the other rarely add up, and sums of them would make coarser
// levels seem far worse than they are. Pages know the triangles that they stand for there. Errors
// of these come on top, triangle by triangle: by the triangle inequality no less than the distance
// to the finest level. A group's error is no less than that of any group below, and bounds hold
// those below them, so errors on the screen ascend from level to level wherever the eye is. Errors
// of triangles are kept as a byte each, rounded up, of levels that others are measured against.
//
// Points have no borders that need be the same: of them some are left out (thin_points.h).
//
// A group of which hardly anything can be left out goes on to the next level all the same, a few
// times, as its pages have other neighbours and other borders there: left behind, it would lock the
// borders of theirs, too. Degenerate: of the finest level, and of points, such groups end where
// they are.
#include "packs/build/levels.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include "packs/build/cut_pages.h"
#include "packs/build/page_groups.h"
#include "packs/build/reference_surface.h"
#include "packs/build/simplify.h"
#include "packs/build/surface_error.h"
#include "packs/build/thin_points.h"
#include "parallel/arena.h"
#include "parallel/parallel_for.h"

namespace delray::packs::internal {
namespace {

constexpr double kWorthIt = 0.85;  // of the triangles may be left at most
constexpr int kMostLevels = 30;
constexpr std::uint8_t kMostFailures = 3;  // levels in turn on which a page hardly gets smaller
constexpr std::size_t kGroupsPerThread = 4;
// A level is measured against one so much finer at most. More take longer, as a level is then
// measured against 2^(n - 1) times its triangles.
constexpr int kReferenceLevels = 3;
// Surfaces are farther apart between the places that are measured: by less than that, as exact
// pictures show.
constexpr float kBetweenPlaces = 1.1F;

// How far the triangles of a page are from the finest level, in parts of the largest of their
// group.
using PageErrors = std::vector<std::uint8_t>;
constexpr float kErrorSteps = 255;

struct MadeGroup {
  std::vector<EncodedPage> pages;  // none: not worth it
  std::vector<PageErrors> errors;  // of them, where the next level is measured against it
  std::vector<std::vector<std::byte>> lists;  // otherwise: what they stand for
  Group group;
  std::uint8_t failures = 0;  // levels in turn, this one included, that were not worth it
};

// What is there when a level is made of the one before.
struct Below {
  std::span<const PageRow> pages;
  std::span<const Group> groups;
  std::uint32_t first = 0;                 // page of the level before
  std::uint32_t first_reference;           // page of the level that it is measured against
  std::span<const PageErrors> errors;      // of the pages of that; none of the finest level
  const ReferenceLists* lists;             // of the level before; null where that is the one
  std::span<const std::uint8_t> failures;  // of the pages of the level before; none of the finest

  float error_of(std::uint32_t page, std::size_t triangle) const {
    if (errors.empty()) return 0;
    const float step = groups[pages[page].made_of].error / kErrorSteps;
    return static_cast<float>(errors[page - first_reference][triangle]) * step;
  }
  std::uint8_t failures_of(std::span<const std::uint32_t> members) const {
    std::uint8_t fewest = kMostFailures;
    if (failures.empty()) return fewest;
    for (const std::uint32_t page : members) fewest = std::min(fewest, failures[page - first]);
    return fewest;
  }
  std::vector<float> errors_of(std::span<const Reference> triangles) const {
    std::vector<float> result;
    result.reserve(triangles.size());
    for (const Reference& t : triangles) result.push_back(error_of(t.page, t.triangle));
    return result;
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

bool is_worth_it(std::uint64_t before, std::uint64_t after) {
  return after > 0 && static_cast<double>(after) <= kWorthIt * static_cast<double>(before);
}

// Around the pages and the bounds of the groups that they were made of.
Group bounds_of(std::span<const std::uint32_t> members, std::span<const PageRow> pages,
                std::span<const Group> groups) {
  Group group;
  for (const std::uint32_t page : members) {
    group.bounds.include(pages[page].box);
    if (pages[page].made_of == kNoGroup) continue;
    const Group& below = groups[pages[page].made_of];
    group.bounds.include(below.bounds);
    group.error = std::max(group.error, below.error);
  }
  return group;
}

// Makes the groups of one level.
class LevelMaker {
 public:
  LevelMaker(const LevelBuilder& builder, const Below& below, bool is_reference)
      : builder_(builder), below_(below), is_reference_(is_reference) {}

  MadeGroup make(std::span<const std::uint32_t> members) const {
    std::vector<Page> pages;
    pages.reserve(members.size());
    for (const std::uint32_t page : members) pages.push_back(builder_.read(page));
    scenes::Mesh mesh = merge(pages);
    MadeGroup made;
    if (!mesh.has_triangles()) {
      make_points(members, pages, std::move(mesh), made);
      return made;
    }
    scenes::Mesh simplified = simplify(mesh);
    if (!is_worth_it(mesh.triangles.size(), simplified.triangles.size())) {
      const std::uint8_t failures = below_.failures_of(members);
      if (failures == kMostFailures) return made;
      made.failures = static_cast<std::uint8_t>(failures + 1);
      if (simplified.triangles.empty()) simplified = mesh;
    }
    const float scale = attribute_scale(mesh);
    const ReferenceSurface surface = surface_below(members, pages, std::move(mesh));
    SurfaceErrors errors = surface_errors(
        {surface.mesh, below_.errors_of(surface.triangles), surface.measured}, simplified, scale);
    errors.largest *= kBetweenPlaces;
    for (float& error : errors.triangles) error *= kBetweenPlaces;
    finish(members, simplified, errors.largest, errors.triangles, made);
    if (is_reference_ || made.pages.empty()) return made;
    std::vector<std::uint32_t> ends;
    std::uint32_t end = 0;
    for (const EncodedPage& page : made.pages) ends.push_back(end += page.row.triangles);
    for (const std::vector<Reference>& list : share_out(surface, errors, ends))
      made.lists.push_back(encode(list));
    return made;
  }

 private:
  void make_points(std::span<const std::uint32_t> members, std::span<const Page> pages,
                   scenes::Mesh&& mesh, MadeGroup& made) const {
    const ReferenceSurface all = whole_pages(members, pages, std::move(mesh));
    const Simplified thinned = thin_points(all.mesh, below_.errors_of(all.triangles));
    if (is_worth_it(all.mesh.triangles.size(), thinned.mesh.triangles.size()))
      finish(members, thinned.mesh, thinned.largest_error, thinned.errors, made);
  }

  ReferenceSurface surface_below(std::span<const std::uint32_t> members,
                                 std::span<const Page> pages, scenes::Mesh&& mesh) const {
    if (below_.lists == nullptr) return whole_pages(members, pages, std::move(mesh));
    std::vector<Reference> triangles;
    for (const std::uint32_t page : members) below_.lists->read(page - below_.first, triangles);
    return surface_of(std::move(triangles), builder_.read);
  }

  void finish(std::span<const std::uint32_t> members, const scenes::Mesh& mesh, float largest,
              std::span<const float> errors, MadeGroup& made) const {
    made.group = bounds_of(members, below_.pages, below_.groups);
    made.group.error = std::max(made.group.error, largest);
    if (!std::isfinite(made.group.error)) return;
    const auto count = static_cast<std::uint32_t>(mesh.triangles.size());
    for (const Page& page : cut_pages(mesh, 0, count)) {
      made.pages.push_back(encode_page(page, {}));
      if (!is_reference_) continue;
      const std::size_t triangles = page.mesh.triangles.size();
      made.errors.push_back(in_steps(errors.first(triangles), made.group.error));
      errors = errors.subspan(triangles);
    }
  }

  const LevelBuilder& builder_;
  const Below& below_;
  const bool is_reference_;  // whether the next level is measured against this one
};

// What the next level needs of the one before.
struct LastLevel {
  std::uint32_t first_reference = 0;  // page of the level that it is measured against
  std::vector<PageErrors> errors;     // of the pages of that
  std::unique_ptr<ReferenceLists> lists;
  std::vector<std::uint8_t> failures;  // of the pages of the level
};

}  // namespace

void build_levels(const LevelBuilder& builder, std::vector<PageRow>& pages,
                  std::vector<Group>& groups, MeshRow& mesh) {
  const std::size_t wave = kGroupsPerThread * static_cast<std::size_t>(parallel::arena_threads());
  const bool points = mesh.shape.kind != scenes::Shape::Kind::triangle;
  const int interval = points ? 1 : kReferenceLevels;
  LastLevel last;
  last.first_reference = mesh.levels.front().first;
  for (int level = 1; level < kMostLevels && mesh.levels.back().count > 1; ++level) {
    const std::vector<std::vector<std::uint32_t>> members =
        page_groups(pages, mesh.levels.back(), level);
    const bool is_reference = level % interval == 0;
    LastLevel next;
    if (!is_reference) next.lists = std::make_unique<ReferenceLists>(builder.scratch);
    PageRange range{static_cast<std::uint32_t>(pages.size()), 0};
    std::uint32_t first = 0;
    std::vector<MadeGroup> made(std::min(wave, members.size()));
    for (std::size_t begin = 0; begin < members.size(); begin += wave) {
      const std::size_t count = std::min(wave, members.size() - begin);
      const Below below{pages,
                        groups,
                        mesh.levels.back().first,
                        last.first_reference,
                        last.errors,
                        last.lists.get(),
                        last.failures};
      const LevelMaker maker(builder, below, is_reference);
      parallel::parallel_for(0, count, 1,
                             [&](std::size_t i) { made[i] = maker.make(members[begin + i]); });
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
        next.failures.insert(next.failures.end(), made[i].pages.size(), made[i].failures);
        std::ranges::move(made[i].errors, std::back_inserter(next.errors));
        for (const std::vector<std::byte>& list : made[i].lists) next.lists->append(list);
        builder.append(std::move(made[i].pages));
        made[i] = {};
      }
    }
    range.count = static_cast<std::uint32_t>(pages.size()) - range.first;
    if (range.count == 0) return;
    mesh.levels.push_back(range);
    if (is_reference) {
      next.first_reference = range.first;
    } else {
      next.first_reference = last.first_reference;
      next.errors = std::move(last.errors);
    }
    last = std::move(next);
  }
}

}  // namespace delray::packs::internal
