// Records in partitions by a hash, in memory or on disk: what ranks exchange of the borders of
// pieces, a partition at a time (the GRACE hash join, Kitsuregawa, Tanaka and Moto-oka 1983).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

#include "comm/agree_on_failure.h"
#include "comm/collectives.h"
#include "files/unnamed_file.h"

namespace delray::delaunay::internal {

// How much of them is in memory, and where the rest goes.
struct RecordsPlace {
  std::uint64_t memory = 0;       // bytes
  std::filesystem::path scratch;  // empty: the system's folder
};

// A file behind them that ends with the process, where they are more than memory may have.
template <class T>
class BorderRecords {
 public:
  static_assert(std::is_trivially_copyable_v<T>);
  static constexpr std::size_t kPartitions = 64;

  explicit BorderRecords(const RecordsPlace& place) : place_(place) {}

  // Equal keys are in one partition. REQUIRES: keys are hashes.
  void add(std::uint64_t key, const T& record) {
    partitions_[key >> 58].records.push_back(record);
    bytes_ += sizeof(T);
    if (bytes_ > place_.memory) write_out();
  }

  // Collective: calls f(records) for each partition on one rank, with the records that all ranks
  // have added to it, those of lower ranks first, in the order in which they were added. `between`
  // is called by all ranks after each round of as many partitions as there are ranks.
  template <class F, class Between>
  void exchange(comm::Communicator& communicator, F&& f, Between&& between) {
    const auto ranks = static_cast<std::size_t>(communicator.size());
    for (std::size_t first = 0; first < kPartitions; first += ranks) {
      std::vector<comm::Parcel> parcels = comm::all_or_none(communicator, comm::Phase::other, [&] {
        std::vector<comm::Parcel> mine;
        for (std::size_t p = first; p < std::min(first + ranks, kPartitions); ++p) {
          const std::vector<T> records = take(p);
          if (records.empty()) continue;
          mine.push_back({static_cast<int>(p - first), comm::Buffer::of(std::span(records))});
        }
        return mine;
      });
      parcels = comm::exchange(communicator, std::move(parcels));
      comm::all_or_none(communicator, comm::Phase::other, [&] {
        std::vector<T> records;
        for (comm::Parcel& parcel : parcels) {
          const auto received = std::as_const(parcel.message).template as<T>();
          records.insert(records.end(), received.begin(), received.end());
          parcel.message = {};
        }
        if (!records.empty()) f(std::span<T>(records));
      });
      between();
    }
  }

 private:
  struct Extent {
    std::uint64_t offset, records;
  };
  struct Partition {
    std::vector<T> records;
    std::vector<Extent> on_disk;  // come before the others
  };

  void write_out() {
    if (!file_) file_.emplace(place_.scratch, "borders of pieces");
    for (Partition& each : partitions_) {
      if (each.records.empty()) continue;
      file_->write(end_, std::as_bytes(std::span(each.records)));
      each.on_disk.push_back({end_, each.records.size()});
      end_ += each.records.size() * sizeof(T);
      each.records = {};
    }
    bytes_ = 0;
  }

  // All of a partition, which is forgotten.
  std::vector<T> take(std::size_t partition) {
    Partition each = std::exchange(partitions_[partition], {});
    if (each.on_disk.empty()) return std::move(each.records);
    std::vector<T> all;
    for (const Extent& extent : each.on_disk) {
      const std::size_t before = all.size();
      all.resize(before + extent.records);
      file_->read(extent.offset, std::as_writable_bytes(std::span(all).subspan(before)));
    }
    all.insert(all.end(), each.records.begin(), each.records.end());
    return all;
  }

  RecordsPlace place_;
  std::array<Partition, kPartitions> partitions_;
  std::optional<files::UnnamedFile> file_;
  std::uint64_t bytes_ = 0, end_ = 0;
};

}  // namespace delray::delaunay::internal
