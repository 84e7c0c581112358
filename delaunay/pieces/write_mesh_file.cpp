// The counts of buckets say where each byte of the file lies. Ranks write the points of their parts
// and take turns with buckets, which they sort; to a stream the first rank writes all in order.
#include "delaunay/pieces/write_mesh_file.h"

#include <algorithm>
#include <functional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "comm/agree_on_failure.h"
#include "comm/collectives.h"
#include "delaunay/files/mesh_layout.h"
#include "delaunay/pieces/sort_simplices.h"
#include "files/error.h"
#include "files/memory_budget.h"
#include "parallel/parallel_for.h"

namespace delray::delaunay::internal {
namespace {

constexpr std::size_t kRunRows = std::size_t{1} << 15;  // rows that are formatted at a time

template <class Record>
std::vector<Record> read_records(const RowBuckets& buckets, std::size_t bucket) {
  std::vector<Record> records(buckets.bytes(bucket) / sizeof(Record));
  buckets.read(bucket, std::as_writable_bytes(std::span(records)));
  return records;
}

// One collective run of write().
class MeshFileRun {
 public:
  MeshFileRun(comm::Communicator& communicator, MeshFileState& state,
              const MeshFileWriter::Source& source)
      : communicator_(communicator),
        options_(state.options),
        of_(state),
        source_(source),
        corners_(static_cast<std::size_t>(state.options.dim) + 1) {
    is_stream_ = of_.target.is_stream();
    writers_ = is_stream_ ? 1 : communicator.size();
    std::uint64_t threads = static_cast<std::uint64_t>(std::max(1, options_.threads));
    threads_ = static_cast<std::size_t>(comm::all_reduce_value(
        communicator, threads, [](std::uint64_t a, std::uint64_t b) { return std::max(a, b); }));
  }

  void run() {
    count();
    lay_out();
    prepare();
    if (is_stream_) {
      stream_points();
    } else {
      write_points();
      comm::barrier(communicator_);  // heights are written over what points have
      all_or_none([&] { write_heights(); });
    }
    write_simplices();
    all_or_none([&] {
      if (is_stream_ && is_first()) of_.target.write(0, layout_.end);
      if (has_own_records()) of_.target.complete();
    });
  }

 private:
  bool is_first() const { return communicator_.rank() == 0; }
  bool has_own_records() const { return !source_.is_shared || is_first(); }
  template <class F>
  void all_or_none(F&& f) {
    comm::all_or_none(communicator_, comm::Phase::other, std::forward<F>(f));
  }

  void stop_if_asked() const {
    if (options_.progress != nullptr) options_.progress->advance(0);
  }

  // The first simplex of each bucket, over all ranks.
  void count() {
    firsts_.assign(of_.simplices.size() + 1, 0);
    for (std::size_t bucket = 0; has_own_records() && bucket < of_.simplices.size(); ++bucket) {
      firsts_[bucket] = of_.simplices.bytes(bucket) / (corners_ * sizeof(std::uint32_t));
    }
    comm::all_reduce(communicator_, std::span<std::uint64_t>(firsts_), std::plus<>());
    std::uint64_t sum = 0;
    for (std::uint64_t& first : firsts_) sum += std::exchange(first, sum);
  }

  void lay_out() {
    MeshShape shape;
    shape.points = options_.points;
    shape.simplices = firsts_.back();
    shape.corners = static_cast<int>(corners_);
    shape.has_z = options_.has_z;
    shape.colours = options_.attributes.colours;
    shape.intensity = options_.attributes.intensity;
    shape.classification = options_.attributes.classification;
    layout_ = of_.writer.layout(shape);
    std::uint64_t at = layout_.header.size();
    for (const MeshArray& array : layout_.arrays) {
      at += array.before.size();
      begins_.push_back(at);
      at += array.row_bytes * (array.of_points ? shape.points : shape.simplices);
    }
    end_ = at;
  }

  // Makes the file and what is in it besides rows.
  void prepare() {
    std::string name;
    all_or_none([&] {
      if (!is_first()) return;
      name = of_.target.prepare(end_ + layout_.end.size());
      of_.target.write(0, layout_.header);
      for (std::size_t i = 0; !is_stream_ && i < begins_.size(); ++i) {
        const std::string& before = layout_.arrays[i].before;
        of_.target.write(begins_[i] - before.size(), before);
      }
      if (!is_stream_) of_.target.write(end_, layout_.end);
    });
    const comm::Buffer told = comm::broadcast(
        communicator_, 0,
        is_first() ? comm::Buffer::of(std::span<const char>(name)) : comm::Buffer());
    const auto text = told.as<char>();
    all_or_none([&] {
      if (!source_.is_shared) of_.target.open({text.begin(), text.end()});
    });
  }

  // Rows of points [first, last) of a cloud, of which the first one is `row`, to their arrays.
  void write_rows(const PointCloud& points, std::uint64_t row) {
    std::string text;
    for (std::size_t i = 0; i < begins_.size(); ++i) {
      const MeshArray& array = layout_.arrays[i];
      if (!array.of_points) continue;
      for (std::size_t first = 0; first < points.size(); first += kRunRows) {
        text.clear();
        array.of_points(points, first, std::min(points.size(), first + kRunRows), text);
        of_.target.write(begins_[i] + (row + first) * array.row_bytes, text);
      }
    }
  }

  void write_points() {
    all_or_none([&] {
      const std::vector<std::uint64_t>& rows = source_.rows.first_rows;
      const std::size_t parts = rows.empty() ? 0 : rows.size() - 1;
      parallel::parallel_for(0, parts, 1, [&](std::size_t part) {
        stop_if_asked();
        PointCloud points;
        source_.parts.read(source_.rows.first + part, points);
        check_unchanged(points, rows[part + 1] - rows[part], source_.rows.first + part);
        write_rows(points, rows[part]);
      });
    });
  }

  static void check_unchanged(const PointCloud& points, std::uint64_t wanted, std::size_t part) {
    if (points.size() == wanted) return;
    throw files::FileError(files::Cause::device, "points", "part " + std::to_string(part),
                           "has changed while it was read");
  }

  void write_heights() {
    if (!options_.has_z || !has_own_records()) return;
    for (std::size_t i = 0; i < begins_.size(); ++i) {
      const MeshArray& array = layout_.arrays[i];
      if (!array.of_points || array.row_bytes < sizeof(glm::dvec3)) continue;
      // Positions are what a row begins with.
      parallel::parallel_for(0, of_.heights.size(), 1, [&](std::size_t bucket) {
        for (const RowHeight& height : read_records<RowHeight>(of_.heights, bucket)) {
          of_.target.write(begins_[i] + height.row * array.row_bytes + 2 * sizeof(double),
                           {reinterpret_cast<const char*>(&height.z), sizeof height.z});
        }
      });
    }
  }

  // What all ranks know of heights, on the first one, by ascending rows.
  std::vector<RowHeight> gather_heights() {
    std::vector<RowHeight> mine, all;
    all_or_none([&] {
      for (std::size_t bucket = 0; has_own_records() && bucket < of_.heights.size(); ++bucket) {
        const auto some = read_records<RowHeight>(of_.heights, bucket);
        mine.insert(mine.end(), some.begin(), some.end());
      }
    });
    for (const comm::Buffer& message :
         comm::gather(communicator_, 0, comm::Buffer::of(std::span<const RowHeight>(mine)))) {
      const auto some = message.as<RowHeight>();
      all.insert(all.end(), some.begin(), some.end());
    }
    std::ranges::sort(all, {}, &RowHeight::row);
    return all;
  }

  void stream_points() {
    const std::vector<RowHeight> heights = gather_heights();
    all_or_none([&] {
      if (!is_first()) return;
      std::uint64_t row = 0;
      auto height = heights.begin();
      const std::size_t parts = source_.parts.parts();
      std::vector<PointCloud> clouds(threads_);
      for (std::size_t first = 0; first < parts; first += threads_) {
        stop_if_asked();
        const std::size_t n = std::min(threads_, parts - first);
        parallel::parallel_for(0, n, 1,
                               [&](std::size_t i) { source_.parts.read(first + i, clouds[i]); });
        for (std::size_t i = 0; i < n; ++i) {
          const std::uint64_t next = row + clouds[i].size();
          for (; height != heights.end() && height->row < next; ++height) {
            clouds[i].positions[height->row - row].z = height->z;
          }
          write_rows(clouds[i], row);
          row = next;
        }
      }
      if (row != options_.points) check_unchanged({}, row, 0);
    });
  }

  // A round of buckets, as many for each writer as it has threads.
  std::size_t bucket_of(std::size_t round, int writer, std::size_t thread) const {
    return (round * static_cast<std::size_t>(writers_) + static_cast<std::size_t>(writer)) *
               threads_ +
           thread;
  }

  void write_simplices() {
    const std::size_t a_round = threads_ * static_cast<std::size_t>(writers_);
    for (std::size_t round = 0; round * a_round < of_.simplices.size(); ++round) {
      auto buckets = collect(round);
      if (!is_stream_) {
        all_or_none([&] {
          parallel::parallel_for(0, buckets.size(), 1, [&](std::size_t thread) {
            write_bucket(bucket_of(round, communicator_.rank(), thread),
                         std::move(buckets[thread]));
          });
        });
        continue;
      }
      all_or_none([&] {
        parallel::parallel_for(0, buckets.size(), 1, [&](std::size_t thread) {
          buckets[thread] = sorted(bucket_of(round, 0, thread), std::move(buckets[thread]));
        });
        for (std::size_t thread = 0; thread < buckets.size(); ++thread) {
          write_sorted(bucket_of(round, 0, thread), buckets[thread]);
        }
      });
    }
  }

  // The simplices of the buckets that this rank writes in a round, in any order.
  std::vector<std::vector<std::uint32_t>> collect(std::size_t round) {
    std::vector<std::vector<std::uint32_t>> buckets;
    const bool writes = communicator_.rank() < writers_;
    if (writes) buckets.resize(threads_);
    std::vector<comm::Parcel> parcels;
    all_or_none([&] {
      stop_if_asked();
      std::uint64_t most = 0;
      for (std::size_t thread = 0; thread < buckets.size(); ++thread) {
        const std::size_t bucket = bucket_of(round, communicator_.rank(), thread);
        if (bucket < of_.simplices.size()) most += firsts_[bucket + 1] - firsts_[bucket];
      }
      constexpr std::uint64_t kCopies = 3;
      files::MemoryBudget(options_.memory)
          .require(kCopies * most * corners_ * sizeof(std::uint32_t), "--memory",
                   "simplices of a run of rows");
      if (source_.is_shared) {
        for (std::size_t thread = 0; thread < buckets.size(); ++thread) {
          const std::size_t bucket = bucket_of(round, communicator_.rank(), thread);
          if (bucket >= of_.simplices.size()) continue;
          buckets[thread] = read_records<std::uint32_t>(of_.simplices, bucket);
        }
        return;
      }
      for (int writer = 0; writer < writers_; ++writer) {
        for (std::size_t thread = 0; thread < threads_; ++thread) {
          const std::size_t bucket = bucket_of(round, writer, thread);
          comm::Buffer message(bucket < of_.simplices.size() ? of_.simplices.bytes(bucket) : 0);
          if (!message.empty()) of_.simplices.read(bucket, message.as<std::byte>());
          parcels.push_back({writer, std::move(message)});
        }
      }
    });
    if (source_.is_shared) return buckets;
    const std::vector<comm::Parcel> received = comm::exchange(communicator_, std::move(parcels));
    for (std::size_t i = 0; i < received.size(); ++i) {
      const auto rows = received[i].message.as<std::uint32_t>();
      std::vector<std::uint32_t>& bucket = buckets[i % threads_];
      bucket.insert(bucket.end(), rows.begin(), rows.end());
    }
    return buckets;
  }

  std::vector<std::uint32_t> sorted(std::size_t bucket, std::vector<std::uint32_t>&& rows) const {
    const std::vector<std::uint32_t> given = std::move(rows);
    return sort_simplices(given, static_cast<int>(corners_), bucket * of_.bucket_rows,
                          of_.bucket_rows);
  }
  void write_bucket(std::size_t bucket, std::vector<std::uint32_t>&& rows) {
    if (!rows.empty()) write_sorted(bucket, sorted(bucket, std::move(rows)));
  }

  void write_sorted(std::size_t bucket, std::span<const std::uint32_t> rows) {
    if (rows.empty()) return;
    std::string text;
    for (std::size_t i = 0; i < begins_.size(); ++i) {
      const MeshArray& array = layout_.arrays[i];
      if (!array.of_simplices) continue;
      for (std::size_t at = 0; at < rows.size(); at += kRunRows * corners_) {
        const std::size_t n = std::min(kRunRows * corners_, rows.size() - at);
        const std::uint64_t first = firsts_[bucket] + at / corners_;
        text.clear();
        array.of_simplices({first, rows.subspan(at, n)}, text);
        of_.target.write(begins_[i] + first * array.row_bytes, text);
      }
    }
  }

  comm::Communicator& communicator_;
  const MeshFileOptions& options_;
  MeshFileState& of_;
  const MeshFileWriter::Source& source_;
  std::size_t corners_, threads_ = 1;
  bool is_stream_ = false;
  int writers_ = 1;
  std::vector<std::uint64_t> firsts_;  // simplices before each bucket, and all
  MeshLayout layout_;
  std::vector<std::uint64_t> begins_;  // of the rows of each array
  std::uint64_t end_ = 0;              // of the last array
};

}  // namespace

void write_mesh_file(comm::Communicator& communicator, MeshFileState& state,
                     const MeshFileWriter::Source& source) {
  MeshFileRun(communicator, state, source).run();
}

}  // namespace delray::delaunay::internal
