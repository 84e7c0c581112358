// Reads files part by part and adds up boxes and counts; parts are read in parallel, and each
// thread holds one.
#include "delaunay/summarize_points.h"

#include <mutex>

#include "delaunay/files/parts/file_parts.h"
#include "delaunay/open_points.h"
#include "parallel/parallel_for.h"

namespace delray::delaunay {
namespace {

using Classes = std::array<std::uint64_t, 256>;
using Returns = std::array<std::array<std::uint64_t, 16>, 16>;

// What is known of the parts so far.
struct Tally {
  std::uint64_t points = 0, left_out = 0;
  geometry::Box3d box;
  AttributeRanges ranges;
  bool colours = true, intensity = true, has_classes = true, has_returns = true;
  Classes classes{};
  Returns returns{};

  void include(const PartPoints& part) {
    left_out += part.left_out;
    if (part.size() == 0) return;
    points += part.size();
    for (const glm::dvec3& p : part.cloud.positions) box.include(p);
    ranges.include(part);
    colours = colours && !(part.colours.empty() && part.cloud.colours.empty());
    intensity = intensity && !part.cloud.intensity.empty();
    has_classes = has_classes && !part.cloud.classification.empty();
    has_returns = has_returns && !part.cloud.returns.empty();
    for (const std::uint8_t value : part.cloud.classification) ++classes[value];
    for (const std::uint8_t value : part.cloud.returns) ++returns[value & 15][value >> 4];
  }
  void include(const Tally& other) {
    points += other.points;
    left_out += other.left_out;
    box.include(other.box);
    colours = colours && other.colours && other.ranges.whole_colours;
    intensity = intensity && other.intensity;
    has_classes = has_classes && other.has_classes;
    has_returns = has_returns && other.has_returns;
    for (std::size_t i = 0; i < classes.size(); ++i) classes[i] += other.classes[i];
    for (std::size_t i = 0; i < returns.size(); ++i) {
      for (std::size_t j = 0; j < returns[i].size(); ++j) returns[i][j] += other.returns[i][j];
    }
  }
};

Tally tally_of(const FileParts& file, const PointFilter& filter) {
  Tally tally;
  std::mutex mutex;
  parallel::parallel_for(0, file.parts(), 1, [&](std::size_t part) {
    PartPoints points;
    file.read(part, points);
    apply_filter(filter, points);
    Tally own;
    own.include(points);
    const std::scoped_lock lock(mutex);
    tally.ranges.include(own.ranges);
    tally.include(own);
  });
  return tally;
}

}  // namespace

PointSummary summarize_points(std::span<const std::filesystem::path> inputs,
                              const PointFilter& filter, const ReadOptions& options) {
  PointSummary summary;
  Tally all;
  const auto paths = expand_inputs(inputs);
  summary.geographic = true;
  for (const std::filesystem::path& path : paths) {
    const std::unique_ptr<FileParts> file = open_file_parts(path, filter, options);
    const FileFacts& facts = file->facts();
    const Tally tally = tally_of(*file, filter);
    all.include(tally);
    summary.files.push_back(facts.told);
    summary.file_points.push_back(tally.points);
    summary.has_z = summary.has_z || facts.has_z;
    summary.geographic =
        summary.geographic &&
        (facts.geographic || (facts.degrees_if_within && tally.ranges.within_degrees));
    std::vector<std::string> warnings = facts.warnings;
    if (tally.left_out > 0) warnings.push_back(points_left_out(tally.left_out));
    for (const std::string& warning : warnings) {
      summary.warnings.push_back(paths.size() == 1 ? warning : path.string() + ": " + warning);
    }
  }
  if (all.points == 0) refuse_no_points(summary.files, filter);
  summary.points = all.points;
  summary.box = all.box;
  summary.colours = all.colours;
  summary.intensity = all.intensity;
  if (all.has_classes) summary.classes = all.classes;
  if (all.has_returns) summary.returns = all.returns;
  return summary;
}

}  // namespace delray::delaunay
