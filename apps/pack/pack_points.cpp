// Passes over the parts: how many points there are, their box and attributes; a sample of them, by
// which their scale, the usual range of values and places along the curve are found; and all of
// them into buckets on disk, each a run of the curve. Then buckets are sorted one after the other.
#include "apps/pack/pack_points.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <bit>
#include <filesystem>
#include <limits>
#include <memory>
#include <mutex>
#include <optional>

#include "apps/input/colour_by.h"
#include "apps/input/point_colours.h"
#include "apps/input/point_parts_input.h"
#include "apps/input/relief.h"
#include "apps/pack/placement.h"
#include "apps/pack/point_buckets.h"
#include "files/error.h"
#include "parallel/arena.h"
#include "parallel/parallel_for.h"
#include "scenes/point_order.h"
#include "scenes/points.h"

namespace delray::apps {
namespace {

// Of a point while its part is read and becomes one of buckets; while its bucket becomes pages.
constexpr std::uint64_t kBytesInPart = 120, kBytesInBucket = 200;
constexpr std::uint64_t kMostInBucket = 1 << 20, kLeastInBucket = 1 << 15;

// What the points are made of.
struct Attributes {
  bool colours = true, intensity = true, classification = true, returns = true;

  void include(const delaunay::PointCloud& points) {
    colours = colours && !points.colours.empty();
    intensity = intensity && !points.intensity.empty();
    classification = classification && !points.classification.empty();
    returns = returns && !points.returns.empty();
  }
  // Leaves out of some points what not all have.
  void keep_common(delaunay::PointCloud& points) const {
    if (!colours) points.colours.clear();
    if (!intensity) points.intensity.clear();
    if (!classification) points.classification.clear();
    if (!returns) points.returns.clear();
  }
};

template <class T>
void copy_value(const std::vector<T>& from, std::size_t i, std::vector<T>& to, std::size_t k,
                std::size_t size) {
  if (from.empty()) return;
  to.resize(size);
  to[k] = from[i];
}

// The attribute of a point as 32 bits, and back, as a cloud that has nothing else.
std::uint32_t value_of(const PointAttribute* attribute, const delaunay::PointCloud& points,
                       std::size_t i) {
  if (attribute == nullptr) return 0;
  if (attribute->number != nullptr)
    return std::bit_cast<std::uint32_t>(attribute->number(points, i));
  if (attribute->code != nullptr) return attribute->code(points, i);
  return std::bit_cast<std::uint32_t>(points.colours[i]);
}

delaunay::PointCloud of_values(std::span<const BucketPoint> points) {
  delaunay::PointCloud cloud;
  for (const BucketPoint& point : points) {
    cloud.colours.push_back(std::bit_cast<glm::u8vec4>(point.value));
    cloud.intensity.push_back(std::bit_cast<float>(point.value));
    cloud.classification.push_back(static_cast<std::uint8_t>(point.value));
    cloud.returns.push_back(static_cast<std::uint8_t>(point.value));
  }
  return cloud;
}

class PointsPacker {
 public:
  PointsPacker(const SceneInput& input, const std::string& output, parallel::Progress* progress)
      : input_(input),
        how_(*asked_to_show(input)),
        memory_(input.file.limits.budget()),
        folder_(std::filesystem::absolute(output).parent_path()),
        parts_(open_parts(input.file, true)),
        progress_(progress) {
    std::uint64_t largest = 1;
    for (std::size_t part = 0; part < parts_->parts(); ++part)
      largest = std::max(largest, parts_->most_rows(part) * kBytesInPart);
    memory_.require(largest, input.file.path, "its largest part");
    at_once_ = std::clamp<std::size_t>(memory_.left() / (2 * largest), 1,
                                       static_cast<std::size_t>(parallel::arena_threads()));
    if (progress_ != nullptr) progress_->start(3 * parts_->parts());
  }

  void pack(packs::PackWriter& writer) {
    count();
    take_sample();
    placement_ = place_points(input_, sample_, box_, rows_.back(),
                              [&](const glm::dvec3& scale, const geometry::Box3d& limits) {
                                return look_for_inliers(scale, limits);
                              });
    choose_colours();
    write(*fill_buckets(), writer);
  }

 private:
  // f(number, points): any thread, several parts at a time.
  template <class F>
  void for_each_part(F&& f) const {
    std::vector<delaunay::PointCloud> points(at_once_);
    for (std::size_t first = 0; first < parts_->parts(); first += at_once_) {
      const std::size_t parts = std::min(at_once_, parts_->parts() - first);
      parallel::parallel_for(0, parts, 1, [&](std::size_t i) {
        parts_->read(first + i, points[i]);
        f(first + i, points[i]);
        if (progress_ != nullptr) progress_->advance();
      });
    }
  }

  void count() {
    std::vector<std::uint64_t> sizes(parts_->parts());
    std::vector<std::vector<std::string>> warnings(parts_->parts());
    std::mutex mutex;
    bool in_degrees = true, any_in_degrees = false;
    for_each_part([&](std::size_t part, const delaunay::PointCloud& points) {
      geometry::Box3d box;
      for (const glm::dvec3& p : points.positions) box.include(p);
      sizes[part] = points.size();
      warnings[part] = points.warnings;
      const std::lock_guard lock(mutex);
      if (points.size() == 0) return;
      if (box_.empty())
        sample_.intensity_unit = points.intensity_unit;
      else if (sample_.intensity_unit != points.intensity_unit)
        sample_.intensity_unit = 1;
      box_.include(box);
      attributes_.include(points);
      sample_.has_z = sample_.has_z || points.has_z;
      in_degrees = in_degrees && points.geographic;
      any_in_degrees = any_in_degrees || points.geographic;
    });
    for (const std::vector<std::string>& some : warnings)
      for (const std::string& warning : some) spdlog::warn("{}: {}", input_.file.path, warning);
    if (any_in_degrees && !in_degrees)
      spdlog::warn("{}: some files are in degrees and others are not", input_.file.path);
    sample_.geographic = in_degrees && any_in_degrees;
    for (const std::uint64_t size : sizes) rows_.push_back(rows_.back() + size);
    if (rows_.back() == 0)
      throw files::FileError(files::Cause::input, input_.file.path, "", "there are no points");
    if (rows_.back() >= std::numeric_limits<std::uint32_t>::max()) {
      throw files::FileError(files::Cause::input, input_.file.path, "",
                             fmt::format("{} points are more than a pack holds, 2^32 - 2: pack "
                                         "parts of them (--bounds)",
                                         rows_.back()));
    }
  }

  // As usual_range takes values, and codes of all.
  void take_sample() {
    const std::uint64_t step = std::max<std::uint64_t>(1, rows_.back() / kSampledValues);
    const std::size_t size = (rows_.back() + step - 1) / step;
    sample_.positions.resize(size);
    std::mutex mutex;
    for_each_part([&](std::size_t part, delaunay::PointCloud& points) {
      attributes_.keep_common(points);
      std::array<std::array<bool, 256>, 2> occurs{};
      for (const std::uint8_t code : points.classification) occurs[0][code] = true;
      for (const std::uint8_t code : points.returns) occurs[1][code] = true;
      const std::lock_guard lock(mutex);
      for (std::size_t code = 0; code < occurs[0].size(); ++code) {
        classes_[code] = classes_[code] || occurs[0][code];
        returns_[code] = returns_[code] || occurs[1][code];
      }
      for (std::uint64_t k = (rows_[part] + step - 1) / step; k * step < rows_[part + 1]; ++k) {
        const std::size_t i = k * step - rows_[part];
        sample_.positions[k] = points.positions[i];
        copy_value(points.colours, i, sample_.colours, k, size);
        copy_value(points.intensity, i, sample_.intensity, k, size);
        copy_value(points.classification, i, sample_.classification, k, size);
        copy_value(points.returns, i, sample_.returns, k, size);
      }
    });
  }

  Inliers look_for_inliers(const glm::dvec3& scale, const geometry::Box3d& limits) const {
    Inliers inliers;
    std::mutex mutex;
    for_each_part([&](std::size_t, const delaunay::PointCloud& points) {
      Inliers own;
      for (const glm::dvec3& point : points.positions) {
        const glm::dvec3 p = point * scale;
        if (is_within(p, limits))
          own.box.include(p);
        else
          ++own.outside;
      }
      const std::lock_guard lock(mutex);
      inliers.box.include(own.box);
      inliers.outside += own.outside;
    });
    return inliers;
  }

  void choose_colours() {
    scenes::Scene& scene = placement_.scene;
    scene.materials.front().unlit = !how_.lit;
    colouring_ = colouring(input_, sample_, true);
    if (colouring_ == "material") return;
    whiten(scene);
    if (colouring_ == "z") {
      const int up = placement_.up();
      heights_ = usual_range(sample_.size(), [&](std::size_t i) {
        return in_relief(sample_.positions[i], scene.origin, input_.exaggeration)[up];
      });
      scene.colour_scale = height_scale(heights_, scene.origin[up], input_.exaggeration);
      return;
    }
    attribute_ = find_point_attribute(colouring_);
    if (!attribute_->exists(sample_))
      throw UsageError(fmt::format("--color-by: there are no points with {}", attribute_->what));
    values_ = attribute_values(*attribute_, sample_);
    if (attribute_->code != nullptr)
      values_.occurs = attribute_->name == "returns" ? returns_ : classes_;
    scene.colour_scale = attribute_->scale(values_);
  }

  scenes::PointOrder order() const {
    if (!placement_.scene.framed.empty()) return scenes::PointOrder(placement_.scene.framed);
    geometry::Box3 box;  // as rounded as points are
    box.include(in_relief(placement_.box.low, placement_.scene.origin, input_.exaggeration));
    box.include(in_relief(placement_.box.high, placement_.scene.origin, input_.exaggeration));
    return scenes::PointOrder(box);
  }

  std::unique_ptr<PointBuckets> fill_buckets() {
    const scenes::PointOrder order = this->order();
    std::vector<std::uint64_t> places;
    for (const glm::dvec3& p : sample_.positions) {
      places.push_back(order.place(in_relief(p, placement_.scene.origin, input_.exaggeration)));
    }
    sample_ = {};
    std::sort(places.begin(), places.end());
    const std::uint64_t most =
        std::clamp(memory_.left() / (2 * kBytesInBucket), kLeastInBucket, kMostInBucket);
    auto buckets = std::make_unique<PointBuckets>(
        folder_, scenes::equal_runs(places, (rows_.back() + most - 1) / most));
    for_each_part([&](std::size_t part, delaunay::PointCloud& points) {
      attributes_.keep_common(points);
      std::vector<BucketPoint> own;
      std::vector<std::uint64_t> own_places;
      for (std::size_t i = 0; i < points.size(); ++i) {
        own.push_back({placement_(points.positions[i]), static_cast<std::uint32_t>(rows_[part] + i),
                       value_of(attribute_, points, i)});
        own_places.push_back(order.place(own.back().position));
      }
      buckets->add(own, own_places);
    });
    return buckets;
  }

  // The points of a bucket in their order.
  static std::vector<BucketPoint> in_order(std::vector<BucketPoint>&& points,
                                           const scenes::PointOrder& order) {
    std::vector<glm::vec3> positions;
    positions.reserve(points.size());
    for (const BucketPoint& point : points) positions.push_back(point.position);
    const std::vector<scenes::PointPlace> places = scenes::order_points(positions, order);
    std::vector<BucketPoint> sorted;
    sorted.reserve(points.size());
    for (std::size_t i = 0; i < places.size();) {
      const std::uint64_t place = places[i].place;
      const auto first = static_cast<std::ptrdiff_t>(i);
      for (; i < places.size() && places[i].place == place; ++i)
        sorted.push_back(points[places[i].point]);
      std::ranges::sort(sorted.begin() + first, sorted.end(), {}, &BucketPoint::row);
    }
    return sorted;
  }

  void append_to(scenes::Mesh& mesh, std::span<const BucketPoint> points) const {
    for (const BucketPoint& point : points) {
      mesh.triangles.emplace_back(static_cast<std::uint32_t>(mesh.positions.size()));
      mesh.positions.push_back(point.position);
    }
    if (colouring_ == "z") {
      const int up = placement_.up();
      std::vector<float> heights;
      for (const BucketPoint& point : points) heights.push_back(point.position[up]);
      const std::vector<glm::vec4> colours = height_colours(heights, heights_);
      mesh.colours.insert(mesh.colours.end(), colours.begin(), colours.end());
    } else if (attribute_ != nullptr) {
      const delaunay::PointCloud values = of_values(points);
      for (std::size_t i = 0; i < points.size(); ++i)
        mesh.colours.push_back(attribute_->colour(values, i, values_));
    }
  }

  // Appends the first points of a mesh to the pack, and keeps the others.
  static void give(std::size_t count, scenes::Mesh& mesh, packs::PackWriter& writer) {
    if (count == 0) return;
    scenes::Mesh rest;
    rest.shape = mesh.shape;
    const auto split = [count](auto& from, auto& to) {
      if (from.empty()) return;
      to.assign(from.begin() + static_cast<std::ptrdiff_t>(count), from.end());
      from.resize(count);
    };
    split(mesh.positions, rest.positions);
    split(mesh.colours, rest.colours);
    split(mesh.triangles, rest.triangles);
    for (glm::uvec3& point : rest.triangles) point -= static_cast<std::uint32_t>(count);
    writer.append_part(mesh);
    mesh = std::move(rest);
  }

  void write(const PointBuckets& buckets, packs::PackWriter& writer) const {
    const scenes::PointOrder order = this->order();
    scenes::PointSpacing spacing(rows_.back());
    scenes::Mesh mesh;
    mesh.shape = {how_.kind, true, 0};
    for (std::size_t i = 0; i < buckets.size(); ++i) {
      memory_.require(buckets.points(i) * kBytesInBucket, input_.file.path,
                      fmt::format("{} points that are close together", buckets.points(i)));
      append_to(mesh, in_order(buckets.read(i), order));
      const std::size_t blocks = mesh.positions.size() / packs::PackWriter::kBlockTriangles;
      const std::size_t count = i + 1 == buckets.size()
                                    ? mesh.positions.size()
                                    : blocks * packs::PackWriter::kBlockTriangles;
      spacing.add(std::span(mesh.positions).first(count));
      give(count, mesh, writer);
    }
    writer.end_mesh(kReliefName, 0, rows_.back(),
                    shape_of(how_, size_of(input_), [&] { return spacing.spacing(); }));
    writer.commit(placement_.scene, false);
  }

  const SceneInput& input_;
  const ShowAs& how_;
  const files::MemoryBudget memory_;
  const std::filesystem::path folder_;
  const std::unique_ptr<delaunay::PointParts> parts_;
  parallel::Progress* const progress_;
  std::size_t at_once_ = 1;  // parts in memory

  std::vector<std::uint64_t> rows_ = {0};  // before each part, and all
  geometry::Box3d box_;                    // of all points
  Attributes attributes_;
  delaunay::PointCloud sample_;                  // scaled once points are placed
  std::array<bool, 256> classes_{}, returns_{};  // that there are
  Placement placement_;
  std::string colouring_;
  std::pair<float, float> heights_;            // that colours run between
  const PointAttribute* attribute_ = nullptr;  // that colours tell; null: height or nothing
  AttributeValues values_;
};

}  // namespace

bool is_cloud(const SceneInput& input) {
  if (input_kind_of(input) != InputKind::points) return false;
  const ShowAs* const asked = asked_to_show(input);
  return asked != nullptr && asked->is_points();
}

void pack_points(const SceneInput& input, const std::string& output,
                 const packs::WriteOptions& options, parallel::Progress* progress) {
  refuse_outside(input.file.path, input.file.limits);
  tell_left_out(input.file);
  PointsPacker packer(input, output, progress);
  packs::PackWriter writer(output, options);
  packer.pack(writer);
}

}  // namespace delray::apps
