// What a run has finished, on disk, so that another can go on from there.
#pragma once

#include <cstdint>
#include <filesystem>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <unordered_map>
#include <vector>

#include "delaunay/duplicates.h"
#include "delaunay/tiles/region.h"
#include "delaunay/tiles/tally.h"
#include "delaunay/tiles/tile_boxes.h"

namespace delray::delaunay {

// How points were cut into tiles and written to disk.
struct CutRecord {
  std::uint64_t dim = 2, with_z = 0, tiles = 0, points = 0;  // of all ranks
  std::uint64_t bytes = 0;                                   // of the rank's files
  std::vector<std::uint64_t> own_points;                     // of each tile of the rank
  std::vector<TileSummary> own;
};

// A finished region.
struct RegionRecord {
  RegionCount count;
  std::uint64_t rest_points = 0, rest_walls = 0;  // that it left, in a file of its own
  std::uint64_t places = 0, rows = 0;             // that were duplicates
};

// A folder of a rank's scratch files. The folder is locked while this lives, is removed by
// remove(), and otherwise stays for a later run. Records have check sums: what a run that was
// killed wrote half is as if it had not been written. All throw FileError (device).
class Journal {
 public:
  // Makes the folder DIR/delray-IDENTITY-RANK unless it is there. Throws if another run has it.
  Journal(const std::filesystem::path& scratch, const std::string& identity, int rank, int ranks);
  ~Journal();
  Journal(const Journal&) = delete;
  Journal& operator=(const Journal&) = delete;

  const std::filesystem::path& folder() const { return folder_; }

  // The cut of an earlier run and what it finished since, if it came that far.
  std::optional<CutRecord> load();
  // Forgets all of an earlier run.
  void clear();
  // From here on a later run can go on.
  void begin(const CutRecord& cut);
  // Any thread.
  void finish(RegionRecord record, const Region& rest);
  // Any thread. Null if the region was not finished by the earlier run.
  const RegionRecord* finished(std::uint64_t region) const;
  Region read_rest(const RegionRecord& record) const;

  // Whether a later run could go on from what is there.
  bool is_worth_keeping() const { return begun_ && !damaged_; }
  void keep() { keep_ = true; }

 private:
  [[noreturn]] void fail_damaged(const std::filesystem::path& path) const;
  std::filesystem::path rest_path(std::uint64_t region) const;

  std::filesystem::path folder_;
  int lock_ = -1;
  bool keep_ = false, begun_ = false;
  mutable bool damaged_ = false;
  std::mutex mutex_;
  std::unordered_map<std::uint64_t, RegionRecord> finished_;
};

}  // namespace delray::delaunay
