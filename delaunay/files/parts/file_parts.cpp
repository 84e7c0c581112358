// Filters points, scales attributes by what all of a file tells, and puts a file together from its
// parts, a few at a time, so that there is never much more in memory than the points.
#include "delaunay/files/parts/file_parts.h"

#include <algorithm>
#include <cmath>
#include <exception>
#include <functional>

#include "files/error.h"
#include "parallel/arena.h"
#include "parallel/parallel_for.h"

namespace delray::delaunay {
namespace {

template <class T>
void keep_rows_of(std::vector<T>& values, const std::vector<std::uint32_t>& rows) {
  if (values.empty()) return;
  for (std::size_t i = 0; i < rows.size(); ++i) values[i] = values[rows[i]];
  values.resize(rows.size());
}

bool contains(const geometry::Box3d& box, const glm::dvec3& p) {
  return glm::all(glm::lessThanEqual(box.low, p)) && glm::all(glm::lessThanEqual(p, box.high));
}

// Appends the values of `part`, of which there are as many as `rows` or none.
template <class T>
void append_values(std::vector<T>& all, const std::vector<T>& part, std::size_t first) {
  if (!part.empty())
    std::copy(part.begin(), part.end(), all.begin() + static_cast<std::ptrdiff_t>(first));
}

template <class T>
void resize_like(std::vector<T>& all, const std::vector<T>& part, std::size_t size) {
  if (!part.empty()) all.resize(size);
}

// How many rows parts have at most: a bound that costs nothing where there is memory for so many,
// and else, as that of text is far off, counted.
std::uint64_t rows_at_most(const FileParts& file, std::size_t first, std::size_t last,
                           std::uint64_t fitting) {
  std::uint64_t rows = 0;
  for (std::size_t part = first; part < last; ++part) rows += file.row_bound(part);
  if (rows <= fitting) return rows;
  return parallel::parallel_reduce(
      first, last, 1, std::uint64_t{0},
      [&](std::size_t begin, std::size_t end) {
        std::uint64_t counted = 0;
        for (std::size_t part = begin; part < end; ++part) counted += file.most_rows(part);
        return counted;
      },
      std::plus<>());
}

// Reads parts in order, some at a time, and puts their points behind each other.
class Assembler {
 public:
  Assembler(const FileParts& file, const PointFilter& filter) : file_(file), filter_(filter) {}

  void read(std::size_t first, std::size_t last) {
    std::vector<PartPoints> parts(last - first);
    std::vector<std::exception_ptr> errors(last - first);
    parallel::parallel_for(first, last, 1, [&](std::size_t part) {
      try {
        file_.read(part, parts[part - first]);
        apply_filter(filter_, parts[part - first]);
      } catch (...) {
        errors[part - first] = std::current_exception();
      }
    });
    for (const std::exception_ptr& error : errors) {
      if (error) std::rethrow_exception(error);
    }
    append(parts);
  }

  PartPoints all;
  AttributeRanges ranges;

 private:
  void append(std::vector<PartPoints>& parts) {
    if (all.size() == 0 && parts.size() == 1) {
      ranges.include(parts[0]);
      parts[0].left_out += all.left_out;
      all = std::move(parts[0]);
      return;
    }
    std::vector<std::size_t> begin = {all.size()};
    for (const PartPoints& part : parts) {
      ranges.include(part);
      all.left_out += part.left_out;
      begin.push_back(begin.back() + part.size());
    }
    all.cloud.has_z = parts[0].cloud.has_z;
    all.cloud.intensity_unit = parts[0].cloud.intensity_unit;
    for (const PartPoints& part : parts) {
      if (part.size() == 0) continue;
      all.cloud.positions.resize(begin.back());
      resize_like(all.cloud.colours, part.cloud.colours, begin.back());
      resize_like(all.cloud.intensity, part.cloud.intensity, begin.back());
      resize_like(all.cloud.classification, part.cloud.classification, begin.back());
      resize_like(all.cloud.returns, part.cloud.returns, begin.back());
      resize_like(all.colours, part.colours, begin.back());
      break;
    }
    parallel::parallel_for(0, parts.size(), 1, [&](std::size_t i) {
      const PartPoints& part = parts[i];
      append_values(all.cloud.positions, part.cloud.positions, begin[i]);
      append_values(all.cloud.colours, part.cloud.colours, begin[i]);
      append_values(all.cloud.intensity, part.cloud.intensity, begin[i]);
      append_values(all.cloud.classification, part.cloud.classification, begin[i]);
      append_values(all.cloud.returns, part.cloud.returns, begin[i]);
      append_values(all.colours, part.colours, begin[i]);
    });
  }

  const FileParts& file_;
  const PointFilter& filter_;
};

}  // namespace

void AttributeRanges::include(const PartPoints& points) {
  for (const glm::u16vec3& c : points.colours) colour = std::max({colour, c.r, c.g, c.b});
  for (const float value : points.cloud.intensity) intensity = std::max(intensity, value);
  whole_colours = whole_colours && points.whole_colours;
  within_degrees =
      within_degrees && std::ranges::all_of(points.cloud.positions, [](const glm::dvec3& p) {
        return std::abs(p.x) <= 180 && std::abs(p.y) <= 90;
      });
}

void AttributeRanges::include(const AttributeRanges& other) {
  colour = std::max(colour, other.colour);
  intensity = std::max(intensity, other.intensity);
  whole_colours = whole_colours && other.whole_colours;
  within_degrees = within_degrees && other.within_degrees;
}

void apply_filter(const PointFilter& filter, PartPoints& points) {
  if (!filter.classes && !filter.returns && !filter.bounds) return;
  std::vector<std::uint32_t> rows;
  const auto size = static_cast<std::uint32_t>(points.size());
  for (std::uint32_t i = 0; i < size; ++i) {
    if (filter.classes && !(*filter.classes)[points.cloud.classification[i]]) continue;
    if (filter.returns) {
      const int returns = points.cloud.returns[i];
      if (!filter.returns->wants(returns & 15, returns >> 4)) continue;
    }
    if (filter.bounds && !contains(*filter.bounds, points.cloud.positions[i])) continue;
    rows.push_back(i);
  }
  if (rows.size() == size) return;
  keep_rows_of(points.cloud.positions, rows);
  keep_rows_of(points.cloud.colours, rows);
  keep_rows_of(points.cloud.intensity, rows);
  keep_rows_of(points.cloud.classification, rows);
  keep_rows_of(points.colours, rows);
  keep_rows_of(points.cloud.returns, rows);
}

void finish_points(const FileFacts& facts, const AttributeRanges& ranges, PartPoints& points) {
  PointCloud& cloud = points.cloud;
  if (!points.colours.empty()) {
    // Channels have 16 bits, but many files hold 8-bit values there.
    const std::uint16_t divisor = ranges.colour > 255 ? 257 : 1;
    cloud.colours.resize(points.colours.size());
    for (std::size_t i = 0; i < points.colours.size(); ++i) {
      const glm::uvec3 rounded =
          (glm::uvec3(points.colours[i]) + glm::uvec3(divisor / 2)) / glm::uvec3(divisor);
      cloud.colours[i] = glm::u8vec4(glm::u8vec3(glm::min(rounded, glm::uvec3(255))), 255);
    }
    points.colours = {};
  }
  if (!ranges.whole_colours) cloud.colours.clear();  // normals, or something else
  if (ranges.intensity > 1) {
    for (float& value : cloud.intensity) value = std::clamp(value / ranges.intensity, 0.0F, 1.0F);
    cloud.intensity_unit *= ranges.intensity;
  }
  cloud.geographic = facts.geographic || (facts.degrees_if_within && ranges.within_degrees);
}

std::string points_left_out(std::size_t points) {
  return std::to_string(points) + (points == 1 ? " point" : " points") +
         " without coordinates left out";
}

void refuse_no_points(std::span<const PointFileFacts> files, const PointFilter& filter) {
  throw files::FileError(
      files::Cause::input,
      files.size() == 1 ? files[0].file : std::to_string(files.size()) + " files", "",
      filter.keeps_all() ? "no points" : "no points of the classes, returns and bounds asked for");
}

PointCloud read_all(const FileParts& file, const PointFilter& filter,
                    const files::MemoryBudget& memory) {
  constexpr std::uint64_t kBytesPerPoint = 48;  // with everything, while it is read
  const std::size_t parts = file.parts();
  const auto at_a_time = static_cast<std::size_t>(4 * parallel::arena_threads());
  Assembler assembler(file, filter);
  for (std::size_t first = 0; first < parts; first += at_a_time) {
    const std::size_t last = std::min(parts, first + at_a_time);
    const std::uint64_t rows = rows_at_most(file, first, last, memory.left() / kBytesPerPoint);
    memory.require(rows * kBytesPerPoint, file.facts().told.file);
    assembler.read(first, last);
    // Parts have about as many points as those before, so that the points need not move.
    if (first == 0 && last < parts) {
      const std::size_t expected = assembler.all.size() / last * parts;
      memory.require((expected - std::min(expected, assembler.all.size())) * kBytesPerPoint,
                     file.facts().told.file);
      assembler.all.cloud.positions.reserve(expected + expected / 64);
    }
  }
  PartPoints& all = assembler.all;
  all.cloud.has_z = file.facts().has_z;
  finish_points(file.facts(), assembler.ranges, all);
  std::vector<std::string>& warnings = all.cloud.warnings;
  warnings.insert(warnings.begin(), file.facts().warnings.begin(), file.facts().warnings.end());
  if (all.left_out > 0) warnings.push_back(points_left_out(all.left_out));
  return std::move(all.cloud);
}

}  // namespace delray::delaunay
