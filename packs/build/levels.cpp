// Levels of detail of a surface as a hierarchy of groups: neighbouring pages are simplified
// together with their outer border locked, and cut into pages anew, by the cells of space that the
// groups of the next level are in. So what is on either side of a border is in one group then, but
// where borders of both levels cross (Cignoni and others 2005; Ponchio 2008; Karis, Stubbe and
// Wihlidal 2021). A cut that takes, of each group, all pages or all that they were made into has no
// cracks, since borders of groups are the same on both sides.
//
// A group's error is measured against the finest level, or another that has 8 times its triangles,
// or 256 times its points, at most: errors of one level after the other rarely add up, and sums of
// them would make coarser levels seem far worse than they are. Pages know the triangles that they
// stand for there. Errors of these come on top, triangle by triangle: by the triangle inequality no
// less than the distance to the finest level. A group's error is no less than that of any group
// below, and bounds hold those below them, so errors on the screen ascend from level to level
// wherever the eye is. Errors of triangles are kept as a byte each, rounded up, of levels that
// others are measured against.
//
// Points have no borders that need be the same: of them some are left out (thin_points.h), and
// pages are full. Their cells are nested, so that bounds and errors of groups, which have those of
// all below them, do not reach beyond their own points: with cells cut elsewhere on every level
// two fifths more are drawn for a bound of error.
//
// A group of which hardly anything can be left out goes on to the next level all the same, a few
// times, as its pages have other borders there: left behind, it would lock those of their
// neighbours, too. Degenerate: of the finest level, of points, and of a level with a single group,
// such groups end where they are.
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
constexpr int kMostLevels = 60;
constexpr std::uint8_t kMostFailures = 3;  // levels in turn on which a page hardly gets smaller
constexpr std::size_t kGroupsPerThread = 4;
// Of points, by a level: half first, as fine levels are most of the file, then the root of a half,
// so that a seventh fewer are drawn for a bound of error.
constexpr int kHalvedPointLevels = 2;
constexpr double kKeptPoints = 0.70710678;
constexpr double kPageTriangles = kPageClusters * kClusterTriangles;
constexpr double kGroupTriangles = static_cast<double>(kGroupPages) * kPageTriangles;
// A level is measured against one of which so much is left at least. Less takes longer and more
// memory (60 MB a thread for points), as a level is then measured against so many times its
// triangles; but errors double on the level after a reference, as those of that come on top.
constexpr double kReferencePart = 1.0 / 8, kPointReferencePart = 1.0 / 256;
// Surfaces are farther apart between the places that are measured: by less than that, as exact
// pictures show.
constexpr float kBetweenPlaces = 1.05F;

// How far the triangles of a page are from the finest level, in parts of the largest of their
// group.
using PageErrors = std::vector<std::uint8_t>;
constexpr float kErrorSteps = 255;

struct MadeGroup {
  std::vector<EncodedPage> pages;    // none: not worth it
  std::vector<std::uint32_t> cells;  // of them, on the next level
  std::vector<PageErrors> errors;    // of them, where the next level is measured against it
  std::vector<std::vector<std::byte>> lists;  // otherwise: what they stand for
  Group group;
  std::uint8_t failures = 0;  // levels in turn, this one included, that were not worth it
  std::uint64_t work = 0;     // triangles that were looked at
};

// What is there when a level is made of the one before.
struct Below {
  std::span<const PageRow> pages;
  std::span<const Group> groups;
  std::uint32_t first = 0;                 // page of the level before
  std::uint32_t first_reference;           // page of the level that it is measured against
  std::span<const PageErrors> errors;      // of the pages of that; none of the finest level
  const ReferenceLists* lists;             // of the level before; null where that is the one
  const Cells& cells;                      // that pages are cut by for the next level
  std::span<const std::uint32_t> around;   // of points: the cells of pages on the next level
  std::span<const std::uint8_t> failures;  // of the pages of the level before; none: none may fail

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

std::span<const PageRow> rows_of(std::span<const PageRow> pages, PageRange range) {
  return pages.subspan(range.first, range.count);
}

// By page, where it is not cut by cells.
std::vector<std::uint32_t> cells_of_whole(std::span<const PageRow> pages, PageRange range,
                                          int level) {
  const Cells cells(pages, range, kGroupTriangles, level);
  std::vector<std::uint32_t> result;
  for (const PageRow& row : rows_of(pages, range))
    result.push_back(cells.cell_of(row.box.centre()));
  return result;
}

// What is to become of a mesh, level by level.
class Steps {
 public:
  explicit Steps(bool points) : points_(points) {}
  // Starts with level 1.
  void next() {
    ++level_;
    kept_ = points_ && level_ > kHalvedPointLevels ? kKeptPoints : kKept;
    if (is_reference()) of_reference_ = 1;
    if (fills_half_of_cells()) of_cells_ = 1;
    of_reference_ *= kept_;
    of_cells_ *= kept_;
  }
  double kept() const { return kept_; }  // of the triangles of the level before
  // Whether the levels that follow are measured against this one.
  bool is_reference() const {
    return of_reference_ <= (points_ ? kPointReferencePart : kReferencePart);
  }
  // Of points: whether what is left fills half of the cells, which are to be twice as large.
  bool fills_half_of_cells() const { return points_ && of_cells_ <= 0.5; }

  // How many triangles of the levels that others are measured against are looked at in all.
  static double work(double triangles, bool points) {
    double sum = 0, reference = triangles;
    Steps steps(points);
    for (int level = 1; level < kMostLevels && triangles > kPageTriangles; ++level) {
      steps.next();
      sum += reference;
      triangles *= steps.kept();
      if (steps.is_reference()) reference = triangles;
    }
    return sum;
  }

 private:
  bool points_;
  int level_ = 0;
  double kept_ = 1, of_reference_ = 1, of_cells_ = 1;
};

// How many of so many points are to stay: about as many as is said, and such that they fill pages,
// where that is near.
std::size_t points_to_keep(std::size_t points, double kept) {
  constexpr double kNear = 1.0 / 8, kMost = 0.8;
  const double all = static_cast<double>(points), wanted = kept * all;
  const double full = std::round(wanted / kPageTriangles) * kPageTriangles;
  const bool is_near = std::abs(full - wanted) <= kNear * wanted && full <= kMost * all;
  return static_cast<std::size_t>(is_near ? full : wanted + 1);
}

// Makes the groups of one level.
class LevelMaker {
 public:
  LevelMaker(const LevelBuilder& builder, const Below& below, const Steps& steps)
      : builder_(builder), below_(below), steps_(steps) {}

  MadeGroup make(std::span<const std::uint32_t> members) const {
    std::vector<Page> pages;
    pages.reserve(members.size());
    for (const std::uint32_t page : members) pages.push_back(builder_.read(page));
    scenes::Mesh mesh = merge(pages);
    MadeGroup made;
    if (!mesh.has_triangles()) {
      const ReferenceSurface all = surface_below(members, pages, scenes::Mesh(mesh));
      made.work = all.triangles.size();
      const std::size_t most = points_to_keep(mesh.triangles.size(), steps_.kept());
      const float before = bounds_of(members, below_.pages, below_.groups).error;
      ThinnedPoints thinned = thin_points({all.mesh, below_.errors_of(all.triangles), {}}, most,
                                          before / static_cast<float>(std::sqrt(steps_.kept())));
      if (is_worth_it(mesh.triangles.size(), thinned.mesh.triangles.size()))
        finish(members, thinned.mesh, all, thinned.errors, made);
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
    made.work = surface.triangles.size();
    SurfaceErrors errors = surface_errors(
        {surface.mesh, below_.errors_of(surface.triangles), surface.measured}, simplified, scale);
    errors.largest *= kBetweenPlaces;
    for (float& error : errors.triangles) error *= kBetweenPlaces;
    finish(members, simplified, surface, errors, made);
    return made;
  }

 private:
  ReferenceSurface surface_below(std::span<const std::uint32_t> members,
                                 std::span<const Page> pages, scenes::Mesh&& mesh) const {
    if (below_.lists == nullptr) return whole_pages(members, pages, std::move(mesh));
    std::vector<Reference> triangles;
    for (const std::uint32_t page : members) below_.lists->read(page - below_.first, triangles);
    return surface_of(std::move(triangles), builder_.read);
  }

  // Cuts pages of what is left of the group, which has these errors against the surface.
  void finish(std::span<const std::uint32_t> members, scenes::Mesh& mesh,
              const ReferenceSurface& surface, SurfaceErrors& errors, MadeGroup& made) const {
    made.group = bounds_of(members, below_.pages, below_.groups);
    made.group.error = std::max(made.group.error, errors.largest);
    if (!std::isfinite(made.group.error)) return;
    std::vector<std::uint32_t> ends;
    std::uint32_t end = 0;
    for (const CellRun& run : order_by_cell(below_.cells, mesh, errors)) {
      for (const Page& page : cut_pages(mesh, end, run.end)) {
        const std::size_t triangles = page.mesh.triangles.size();
        made.pages.push_back(encode_page(page, {}));
        made.cells.push_back(below_.around.empty() ? run.cell
                                                   : below_.around[members[0] - below_.first]);
        if (steps_.is_reference()) {
          made.errors.push_back(
              in_steps(std::span(errors.triangles).subspan(end, triangles), made.group.error));
        }
        end += static_cast<std::uint32_t>(triangles);
        ends.push_back(end);
      }
    }
    if (steps_.is_reference()) return;
    for (const std::vector<Reference>& list : share_out(surface, errors, ends))
      made.lists.push_back(encode(list));
  }

  const LevelBuilder& builder_;
  const Below& below_;
  const Steps& steps_;
};

// What the next level needs of the one before.
struct LastLevel {
  std::uint32_t first_reference = 0;  // page of the level that it is measured against
  std::vector<PageErrors> errors;     // of the pages of that
  std::unique_ptr<ReferenceLists> lists;
  std::vector<std::uint8_t> failures;  // of the pages of the level
  std::vector<std::uint32_t> cells;    // of them
  double triangles = 0;                // of the level
  double of_reference = 0;             // of the level that it is measured against
};

// For a point that others are measured against; measured.
constexpr double kBytesPerPoint = 80;

// How many groups may be made before all wait for the file: as few at once as there is memory for
// what they are measured against, of which some have half as much again as others.
std::size_t groups_at_once(const files::MemoryBudget& memory, double triangles_of_a_group) {
  const auto threads = static_cast<std::size_t>(parallel::arena_threads());
  const double fit =
      static_cast<double>(memory.left()) / (1.5 * kBytesPerPoint * triangles_of_a_group + 1);
  if (fit >= static_cast<double>(threads)) return kGroupsPerThread * threads;
  return std::max(std::size_t{1}, static_cast<std::size_t>(fit));
}

}  // namespace

void build_levels(const LevelBuilder& builder, std::vector<PageRow>& pages,
                  std::vector<Group>& groups, MeshRow& mesh) {
  const bool points = mesh.shape.kind != scenes::Shape::Kind::triangle;
  LastLevel last;
  last.first_reference = mesh.levels.front().first;
  for (const PageRow& row : rows_of(pages, mesh.levels.front())) last.triangles += row.triangles;
  last.of_reference = last.triangles;
  parallel::Progress* const progress = builder.progress;
  if (progress != nullptr)
    progress->start(static_cast<std::uint64_t>(Steps::work(last.triangles, points)));
  last.cells = points ? nested_cells(pages, mesh.levels.front())
                      : cells_of_whole(pages, mesh.levels.front(), 1);
  if (points) {
    const double cells = 1.0 + *std::ranges::max_element(last.cells);
    const double largest = std::min(last.triangles, last.triangles / cells / kPointReferencePart);
    builder.memory.require(static_cast<std::uint64_t>(kBytesPerPoint * largest), builder.name,
                           "its levels");
  }
  Steps steps(points);
  double left = kKept;  // of the triangles, by a level
  Cells cells;          // one: points have no borders
  for (int level = 1; level < kMostLevels && mesh.levels.back().count > 1; ++level) {
    const std::vector<std::vector<std::uint32_t>> members =
        page_groups(mesh.levels.back().first, last.cells);
    if (!points) cells = Cells(pages, mesh.levels.back(), kGroupTriangles / left, level + 1);
    const bool has_neighbours = members.size() > 1;
    steps.next();
    std::vector<std::uint32_t> around = points ? last.cells : std::vector<std::uint32_t>();
    if (steps.fills_half_of_cells())
      for (std::uint32_t& cell : around) cell /= 2;
    LastLevel next;
    if (!steps.is_reference()) next.lists = std::make_unique<ReferenceLists>(builder.scratch);
    PageRange range{static_cast<std::uint32_t>(pages.size()), 0};
    std::uint32_t first = 0;
    const std::size_t wave =
        groups_at_once(builder.memory, last.of_reference / static_cast<double>(members.size()));
    std::vector<MadeGroup> made(std::min(wave, members.size()));
    for (std::size_t begin = 0; begin < members.size(); begin += wave) {
      const std::size_t count = std::min(wave, members.size() - begin);
      const Below below{pages,
                        groups,
                        mesh.levels.back().first,
                        last.first_reference,
                        last.errors,
                        last.lists.get(),
                        cells,
                        around,
                        has_neighbours ? std::span<const std::uint8_t>(last.failures)
                                       : std::span<const std::uint8_t>{}};
      const LevelMaker maker(builder, below, steps);
      parallel::parallel_for(0, count, 1,
                             [&](std::size_t i) { made[i] = maker.make(members[begin + i]); });
      for (std::size_t i = 0; i < count; ++i) {
        if (progress != nullptr) progress->advance(made[i].work);
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
        next.cells.insert(next.cells.end(), made[i].cells.begin(), made[i].cells.end());
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
    next.triangles = first;
    left = std::min(next.triangles / last.triangles, 1.0);
    if (steps.is_reference()) {
      next.first_reference = range.first;
      next.of_reference = next.triangles;
    } else {
      next.first_reference = last.first_reference;
      next.of_reference = last.of_reference;
      next.errors = std::move(last.errors);
    }
    last = std::move(next);
  }
}

}  // namespace delray::packs::internal
