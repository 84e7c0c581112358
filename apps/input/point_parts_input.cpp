// Opens files of points and pictures of elevations as one input.
#include "apps/input/point_parts_input.h"

#include <span>
#include <string_view>
#include <utility>

#include "apps/input/elevations.h"
#include "delaunay/open_points.h"
#include "files/format.h"
#include "files/read_file.h"
#include "image/io.h"

namespace delray::apps {
namespace {

void drop_outside(const delaunay::PointFilter& filter, delaunay::PointCloud& points) {
  if (!filter.bounds) return;
  const geometry::Box3d& box = *filter.bounds;
  std::erase_if(points.positions, [&](const glm::dvec3& p) {
    return glm::any(glm::lessThan(p, box.low)) || glm::any(glm::greaterThan(p, box.high));
  });
}

// All of a picture is one part.
class ElevationParts : public delaunay::PointParts {
 public:
  ElevationParts(std::filesystem::path path, const ElevationOptions& options,
                 const delaunay::PointFilter& filter, const files::MemoryBudget& memory)
      : path_(std::move(path)), options_(options), filter_(filter), memory_(memory) {
    const image::PictureInfo info = image::read_info(path_, memory_);
    pixels_ = static_cast<std::uint64_t>(info.width) * static_cast<std::uint64_t>(info.height);
  }
  std::size_t parts() const override { return 1; }
  std::optional<bool> has_z() const override { return true; }
  std::uint64_t most_rows(std::size_t) const override { return pixels_; }
  void read(std::size_t, delaunay::PointCloud& points) const override {
    points = read_elevations(path_, options_, memory_);
    drop_outside(filter_, points);
  }

 private:
  std::filesystem::path path_;
  ElevationOptions options_;
  delaunay::PointFilter filter_;
  files::MemoryBudget memory_;
  std::uint64_t pixels_ = 0;
};

}  // namespace

InputFiles find_input_files(const PointInput& input) {
  InputFiles files;
  files.paths = delaunay::expand_inputs(named_files(input));
  for (const std::filesystem::path& path : files.paths) {
    files.pictures.push_back(is_picture_file(path, input.limits.budget()));
    files.any_picture = files.any_picture || files.pictures.back();
  }
  if (!files.any_picture && (input.terrain_rgb || input.cell_size > 0)) {
    throw UsageError("--terrain-rgb and --cell-size are for elevation pictures");
  }
  const PointChoice& choice = input.choice;
  if (files.any_picture &&
      (!choice.classes.empty() || !choice.returns.empty() || choice.resolution > 0)) {
    throw UsageError("--class, --returns and --resolution are not for elevation pictures");
  }
  return files;
}

std::unique_ptr<delaunay::PointParts> open_parts(const PointInput& input, bool whole_ranges) {
  const InputFiles files = find_input_files(input);
  const delaunay::PointFilter filter = filter_of(input.choice);
  const files::MemoryBudget memory = input.limits.budget();
  const delaunay::ReadOptions options = {.memory = memory, .whole_ranges = whole_ranges};
  if (!files.any_picture) return delaunay::open_points(files.paths, filter, options);
  std::vector<std::unique_ptr<delaunay::PointParts>> parts;
  for (std::size_t i = 0; i < files.paths.size(); ++i) {
    if (files.pictures[i]) {
      parts.push_back(std::make_unique<ElevationParts>(
          files.paths[i], ElevationOptions{input.terrain_rgb, input.cell_size}, filter, memory));
    } else {
      parts.push_back(delaunay::open_points(std::span(&files.paths[i], 1), filter, options));
    }
  }
  return delaunay::join_parts(std::move(parts));
}

}  // namespace delray::apps
