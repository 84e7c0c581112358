// Several files behind each other, in parts or whole.
#include "delaunay/open_points.h"

#include <algorithm>
#include <mutex>
#include <utility>

#include "delaunay/files/parts/file_parts.h"
#include "files/error.h"
#include "parallel/arena.h"
#include "parallel/parallel_for.h"

namespace delray::delaunay {
namespace {

std::vector<std::unique_ptr<FileParts>> open_files(std::span<const std::filesystem::path> inputs,
                                                   const PointFilter& filter,
                                                   const ReadOptions& options) {
  std::vector<std::unique_ptr<FileParts>> files;
  for (const std::filesystem::path& path : expand_inputs(inputs)) {
    files.push_back(open_file_parts(path, filter, options));
  }
  return files;
}

// Where each of several runs of parts begins.
class Begins {
 public:
  template <class Runs>
  explicit Begins(const Runs& runs) {
    for (const auto& run : runs) begins_.push_back(begins_.back() + run->parts());
  }
  std::size_t parts() const { return begins_.back(); }
  // The run that a part is in, and its number there.
  std::pair<std::size_t, std::size_t> find(std::size_t part) const {
    const auto next = std::upper_bound(begins_.begin(), begins_.end(), part);
    const auto run = static_cast<std::size_t>(next - begins_.begin()) - 1;
    return {run, part - begins_[run]};
  }

 private:
  std::vector<std::size_t> begins_ = {0};
};

class JoinedParts : public PointParts {
 public:
  explicit JoinedParts(std::vector<std::unique_ptr<PointParts>> inputs)
      : inputs_(std::move(inputs)), begins_(inputs_) {}
  std::size_t parts() const override { return begins_.parts(); }
  std::optional<bool> has_z() const override {
    bool known = true;
    for (const auto& input : inputs_) {
      const std::optional<bool> one = input->has_z();
      if (one.value_or(false)) return true;
      known = known && one.has_value();
    }
    return known ? std::optional(false) : std::nullopt;
  }
  std::uint64_t most_rows(std::size_t part) const override {
    const auto [input, own] = begins_.find(part);
    return inputs_[input]->most_rows(own);
  }
  void read(std::size_t part, PointCloud& points) const override {
    const auto [input, own] = begins_.find(part);
    inputs_[input]->read(own, points);
  }

 private:
  std::vector<std::unique_ptr<PointParts>> inputs_;
  Begins begins_;
};

class FilesInParts : public PointParts {
 public:
  FilesInParts(std::vector<std::unique_ptr<FileParts>> files, const PointFilter& filter)
      : files_(std::move(files)), begins_(files_), ranges_(files_.size()), filter_(filter) {}

  // Reads all parts of files whose ranges they tell.
  void find_ranges() {
    const auto at_a_time = static_cast<std::size_t>(parallel::arena_threads());
    for (std::size_t number = 0; number < files_.size(); ++number) {
      const FileParts& file = *files_[number];
      if (!file.facts().has_ranges) continue;
      AttributeRanges whole;
      for (std::size_t first = 0; first < file.parts(); first += at_a_time) {
        std::vector<AttributeRanges> ranges(std::min(at_a_time, file.parts() - first));
        parallel::parallel_for(0, ranges.size(), 1, [&](std::size_t i) {
          PartPoints read;
          file.read(first + i, read);
          apply_filter(filter_, read);
          ranges[i].include(read);
        });
        for (const AttributeRanges& range : ranges) whole.include(range);
      }
      std::call_once(ranges_[number].once, [&] { ranges_[number].value = whole; });
    }
  }

  std::size_t parts() const override { return begins_.parts(); }
  std::optional<bool> has_z() const override {
    return std::ranges::any_of(files_, [](const auto& file) { return file->facts().has_z; });
  }

  std::uint64_t most_rows(std::size_t part) const override {
    const auto [file, own] = begins_.find(part);
    return files_[file]->most_rows(own);
  }

  void read(std::size_t part, PointCloud& points) const override {
    const auto [number, own] = begins_.find(part);
    const FileParts& file = *files_[number];
    PartPoints read;
    file.read(own, read);
    const AttributeRanges ranges = ranges_of(number, own == 0 ? &read : nullptr);
    apply_filter(filter_, read);
    finish_points(file.facts(), ranges, read);
    read.cloud.has_z = file.facts().has_z;
    if (own == 0) {
      for (const std::string& warning : file.facts().warnings) {
        read.cloud.warnings.push_back(files_.size() == 1 ? warning
                                                         : file.facts().told.file + ": " + warning);
      }
    }
    points = std::move(read.cloud);
  }

 private:
  struct Ranges {
    std::once_flag once;
    AttributeRanges value;
  };

  // Those of the first part, which the caller may have.
  AttributeRanges ranges_of(std::size_t number, const PartPoints* first) const {
    const FileParts& file = *files_[number];
    if (!file.facts().has_ranges) return {};
    Ranges& ranges = ranges_[number];
    std::call_once(ranges.once, [&] {
      PartPoints read;
      if (first == nullptr) file.read(0, read);
      ranges.value.include(first == nullptr ? read : *first);
    });
    return ranges.value;
  }

  std::vector<std::unique_ptr<FileParts>> files_;
  Begins begins_;
  mutable std::vector<Ranges> ranges_;
  PointFilter filter_;
};

// Appends the values of a file to those of the files before, `rows` of them, if all have them.
template <class T>
void join_values(std::vector<T>& all, const std::vector<T>& file, std::size_t rows) {
  if (rows > 0 && all.empty()) return;
  if (file.empty()) {
    all = {};
  } else {
    all.insert(all.end(), file.begin(), file.end());
  }
}

void join_clouds(PointCloud& all, PointCloud&& file) {
  if (file.size() == 0) return;
  if (all.size() == 0) {
    all = std::move(file);
    return;
  }
  const std::size_t rows = all.size();
  join_values(all.colours, file.colours, rows);
  join_values(all.intensity, file.intensity, rows);
  join_values(all.classification, file.classification, rows);
  join_values(all.returns, file.returns, rows);
  join_values(all.positions, file.positions, 0);
  all.has_z = all.has_z || file.has_z;
  if (all.intensity_unit != file.intensity_unit) all.intensity_unit = 1;
  if (all.geographic != file.geographic) {
    const std::string mixed = "some files are in degrees and others are not";
    if (std::ranges::find(all.warnings, mixed) == all.warnings.end()) {
      all.warnings.push_back(mixed);
    }
    all.geographic = false;
  }
}

}  // namespace

std::unique_ptr<PointParts> join_parts(std::vector<std::unique_ptr<PointParts>> inputs) {
  return std::make_unique<JoinedParts>(std::move(inputs));
}

std::unique_ptr<PointParts> open_points(std::span<const std::filesystem::path> inputs,
                                        const PointFilter& filter, const ReadOptions& options) {
  auto parts = std::make_unique<FilesInParts>(open_files(inputs, filter, options), filter);
  if (options.whole_ranges) parts->find_ranges();
  return parts;
}

PointCloud read_points(const PointParts& parts, const ReadOptions& options) {
  constexpr std::uint64_t kBytesPerPoint = 40;  // with everything
  const auto at_a_time = static_cast<std::size_t>(4 * parallel::arena_threads());
  PointCloud all;
  std::vector<std::string> warnings;
  for (std::size_t first = 0; first < parts.parts(); first += at_a_time) {
    std::vector<PointCloud> clouds(std::min(at_a_time, parts.parts() - first));
    std::uint64_t rows = 0;
    for (std::size_t i = 0; i < clouds.size(); ++i) rows += parts.most_rows(first + i);
    options.memory.require(rows * kBytesPerPoint, "points");
    parallel::parallel_for(0, clouds.size(), 1,
                           [&](std::size_t i) { parts.read(first + i, clouds[i]); });
    for (PointCloud& cloud : clouds) {
      warnings.insert(warnings.end(), cloud.warnings.begin(), cloud.warnings.end());
      cloud.warnings.clear();
      join_clouds(all, std::move(cloud));
    }
  }
  if (all.size() == 0) {
    throw files::FileError(files::Cause::input, "points", "", "there are none");
  }
  all.warnings.insert(all.warnings.begin(), warnings.begin(), warnings.end());
  return all;
}

PointCloud read_points(std::span<const std::filesystem::path> inputs, const PointFilter& filter,
                       const ReadOptions& options) {
  const auto files = open_files(inputs, filter, options);
  PointCloud all;
  std::vector<std::string> warnings;
  for (const auto& file : files) {
    PointCloud cloud = read_all(*file, filter, options.memory);
    for (const std::string& warning : cloud.warnings) {
      warnings.push_back(files.size() == 1 ? warning : file->facts().told.file + ": " + warning);
    }
    cloud.warnings.clear();
    join_clouds(all, std::move(cloud));
  }
  all.warnings.insert(all.warnings.begin(), warnings.begin(), warnings.end());
  if (all.size() > 0) return all;
  std::vector<PointFileFacts> told;
  for (const auto& file : files) told.push_back(file->facts().told);
  refuse_no_points(told, filter);
}

}  // namespace delray::delaunay
