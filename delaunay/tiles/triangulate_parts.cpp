// Counts points, cuts them into tiles, distributes them to these, and settles tile after tile. With
// a journal on disk, a later run goes on from the last tile that was finished.
#include "delaunay/triangulate_parts.h"

#include <sys/stat.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <unordered_map>
#include <utility>

#include "comm/agree_on_failure.h"
#include "comm/collectives.h"
#include "delaunay/mesh/arguments.h"
#include "delaunay/methods.h"
#include "delaunay/tiles/journal.h"
#include "delaunay/tiles/memory_plan.h"
#include "delaunay/tiles/read_parts.h"
#include "delaunay/tiles/settle_ranks.h"
#include "delaunay/tiles/tally.h"
#include "files/error.h"
#include "files/memory_budget.h"
#include "loadbalance/partition.h"

namespace delray::delaunay {
namespace {

// Rests are put together when there is as much of them as of half a tile.
constexpr std::uint64_t kRestsPerTile = 2;

class PartsRun {
 public:
  PartsRun(comm::Communicator& communicator, const PointParts& parts, const PartsOptions& options,
           TileSink* sink)
      : communicator_(communicator),
        parts_(parts),
        options_(options),
        sink_(sink),
        dim_(options.tiles.triangulate.dim),
        progress_(options.tiles.triangulate.progress) {}

  PartsResult run() {
    comm::all_or_none(communicator_, comm::Phase::other, [&] { check(); });
    start_progress(most_rows());
    try {
      if (!resume()) {
        count_and_cut();
        distribute();
      }
      settle();
    } catch (...) {
      if (options_.can_resume && journal_ && journal_->is_worth_keeping() && !damaged_) {
        journal_->keep();
        if (options_.on_keep) options_.on_keep();
      }
      throw;
    }
    return result();
  }

 private:
  void check() const {
    internal::check_dim(dim_);
    resolve(options_.tiles.triangulate);
    if (loadbalance::find_partitioner(options_.tiles.partition) == nullptr) {
      throw std::invalid_argument("'" + options_.tiles.partition + "' is no partition");
    }
    if (options_.tiles.tiles < 0) {
      throw std::invalid_argument("there cannot be " + std::to_string(options_.tiles.tiles) +
                                  " tiles");
    }
  }

  std::uint64_t most_rows() const {
    std::uint64_t rows = 0;
    for (std::size_t part = 0; part < parts_.parts(); ++part) rows += parts_.most_rows(part);
    return rows;
  }

  // Each point is counted, distributed and triangulated.
  void start_progress(std::uint64_t points) const {
    constexpr std::uint64_t kPasses = 3;
    if (progress_ != nullptr) progress_->start(kPasses * points);
  }
  void expect_points(std::uint64_t points) const {
    constexpr std::uint64_t kPasses = 3;
    if (progress_ != nullptr) progress_->expect(kPasses * points);
  }
  void skip(std::uint64_t steps) const {
    if (progress_ != nullptr) progress_->advance(steps);
  }

  void say(const std::string& what) const {
    if (communicator_.rank() == 0 && options_.say) options_.say(what);
  }

  Task task(std::uint64_t points) const {
    return {points,
            dim_,
            communicator_.size(),
            options_.tiles.triangulate.threads,
            options_.tiles.tiles,
            options_.memory};
  }

  std::size_t first_own() const {
    return static_cast<std::size_t>(
        first_tile(communicator_.rank(), communicator_.size(), plan_.tiles));
  }
  std::size_t own_tiles() const {
    return static_cast<std::size_t>(
               first_tile(communicator_.rank() + 1, communicator_.size(), plan_.tiles)) -
           first_own();
  }

  void open_journal() {
    if (journal_ || options_.scratch.empty()) return;
    journal_.emplace(options_.scratch, options_.identity, communicator_.rank(),
                     communicator_.size());
  }

  // Whether all ranks can go on from what an earlier run has left.
  bool resume() {
    if (!options_.resume) return false;
    const std::optional<CutRecord> cut = comm::all_or_none(communicator_, comm::Phase::other, [&] {
      open_journal();
      return journal_ ? journal_->load() : std::nullopt;
    });
    const std::uint64_t missing = cut && cut->dim == static_cast<std::uint64_t>(dim_) ? 0 : 1;
    if (comm::all_reduce_value(communicator_, missing, std::plus<>()) > 0) {
      say("nothing to resume: starting from the first point");
      tell_finished([](std::uint64_t) { return false; });
      return false;
    }
    plan_ = comm::all_or_none(communicator_, comm::Phase::other, [&] {
      Task again = task(cut->points);
      again.tiles = static_cast<int>(cut->tiles);
      return plan_memory(again);
    });
    format_.with_z = cut->with_z != 0;
    points_ = cut->points;
    has_z_ = format_.with_z;
    own_ = cut->own;
    own_points_ = cut->own_points;
    scratch_bytes_ = cut->bytes;
    expect_points(points_);
    std::uint64_t own = 0;
    for (const std::uint64_t each : own_points_) own += each;
    skip(2 * own);
    use_scratch();
    tell_finished([&](std::uint64_t region) { return journal_->finished(region) != nullptr; });
    return true;
  }

  void tell_finished(const std::function<bool(std::uint64_t)>& finished) const {
    comm::all_or_none(communicator_, comm::Phase::other, [&] {
      if (options_.on_resume) options_.on_resume(finished);
    });
  }

  void use_scratch() {
    auto store = std::make_unique<ScratchStore>(format_, journal_->folder());
    store->expect(own_points_, first_own());
    store_ = std::move(store);
  }

  void count_and_cut() {
    const Task guess = task(most_rows());
    std::uint64_t sample = comm::all_or_none(communicator_, comm::Phase::other,
                                             [&] { return plan_memory(guess).sample; });
    sample = comm::all_reduce_value(
        communicator_, sample, [](std::uint64_t a, std::uint64_t b) { return std::min(a, b); });
    communicator_.mark(comm::Phase::redistribute, 0);
    counts_.emplace(
        count_parts(communicator_, parts_, {dim_, sample, options_.first_row}, progress_));
    points_ = counts_->points;
    has_z_ = counts_->has_z;
    attributes_ = counts_->attributes;
    rows_ = {counts_->first_part, counts_->first_rows};
    format_.with_z = dim_ == 3 || has_z_;
    expect_points(points_);
    comm::all_or_none(communicator_, comm::Phase::other, [&] {
      if (dim_ == 3 && !has_z_ && points_ > 0) throw std::invalid_argument("points have no z");
      if (options_.on_counted && points_ > 0) {
        options_.on_counted({points_, has_z_, counts_->box, attributes_, rows_});
      }
    });
    plan_ = comm::all_or_none(communicator_, comm::Phase::other,
                              [&] { return plan_memory(task(points_)); });
    agree_on_plan();
    const std::vector<glm::dvec3> sampled = std::move(counts_->sample).gather(communicator_);
    comm::all_or_none(communicator_, comm::Phase::other, [&] {
      if (communicator_.rank() == 0 && plan_.tiles > 1) cut(sampled);
    });
    plan_.tiles = comm::all_reduce_value(communicator_, plan_.tiles,
                                         [](int a, int b) { return std::max(a, b); });
    cut_ = share_cut(communicator_, cut_);
    own_.assign(own_tiles(), {});
    own_points_.assign(own_tiles(), 0);
  }

  // Ranks may have different memories: the most tiles serve all, and all go to disk if one does.
  void agree_on_plan() {
    std::uint64_t most[] = {static_cast<std::uint64_t>(plan_.tiles), plan_.on_disk ? 1U : 0U,
                            ~plan_.tile_points};
    comm::all_reduce(communicator_, std::span<std::uint64_t>(most),
                     [](std::uint64_t a, std::uint64_t b) { return std::max(a, b); });
    plan_.tiles = static_cast<int>(most[0]);
    plan_.on_disk = most[1] != 0;
    plan_.tile_points = ~most[2];
  }

  // Of rank 0: tiles that memory allows for, by a sample.
  void cut(const std::vector<glm::dvec3>& sampled) {
    const auto& partitioner = *loadbalance::find_partitioner(options_.tiles.partition);
    const double each = sampled.empty() ? 0 : double(points_) / static_cast<double>(sampled.size());
    for (;;) {
      // A rank by itself makes tiles as large as memory allows.
      cut_ = cut_places(
          sampled, dim_, plan_.tiles, partitioner,
          communicator_.size() > 1 ? points_per_place(dim_, points_, sampled.size()) : 0);
      if (plan_.tile_points == ~std::uint64_t{0}) return;
      const auto counts = cut_.count(sampled, plan_.tiles);
      const auto most = static_cast<double>(*std::ranges::max_element(counts));
      // A tile of which so many points are in the sample hardly has more than that.
      const double chance = each > 1 ? 3 * std::sqrt(most) : 0;
      const auto largest = static_cast<std::uint64_t>(each * (most + chance));
      if (largest <= plan_.tile_points) return;
      grow_tiles(largest, points_ / static_cast<std::uint64_t>(plan_.tiles));
    }
  }
  void grow_tiles(std::uint64_t largest, std::uint64_t mean) {
    constexpr int kMostTiles = 1 << 20;
    constexpr double kGrowth = 1.25;
    if (options_.tiles.tiles > 0 || plan_.tiles >= kMostTiles || mean < plan_.tile_points / 64) {
      throw files::FileError(files::Cause::memory, "--memory", "",
                             std::to_string(largest) + " of " + std::to_string(points_) +
                                 " points lie in one tile, of which memory allows " +
                                 std::to_string(plan_.tile_points) +
                                 (options_.tiles.tiles > 0 ? ": more --tiles would do" : ""));
    }
    plan_.tiles = static_cast<int>(kGrowth * plan_.tiles) + 1;
  }

  void distribute() {
    communicator_.mark(comm::Phase::redistribute, 1);
    const bool to_disk = !options_.scratch.empty() && (plan_.on_disk || options_.to_disk);
    comm::all_or_none(communicator_, comm::Phase::other, [&] {
      if (plan_.on_disk && options_.scratch.empty()) {
        throw files::FileError(files::Cause::memory, "--memory", "",
                               std::to_string(points_) +
                                   " points do not fit, and there is no folder for what does not");
      }
      if (to_disk) {
        open_journal();
        journal_->clear();
        require_disk();
        use_scratch();
      } else {
        store_ = std::make_unique<MemoryStore>(format_, first_own(), own_tiles());
      }
    });
    distribute_parts(communicator_, parts_, *counts_,
                     {cut_, dim_, plan_.tiles, format_, *store_, own_, own_points_}, plan_,
                     progress_);
    counts_.reset();
    cut_ = {};
    if (!to_disk) return;
    comm::all_or_none(communicator_, comm::Phase::other, [&] {
      scratch_bytes_ = store_->bytes_on_disk();
      use_scratch();
      CutRecord cut;
      cut.dim = static_cast<std::uint64_t>(dim_);
      cut.with_z = format_.with_z ? 1 : 0;
      cut.tiles = static_cast<std::uint64_t>(plan_.tiles);
      cut.points = points_;
      cut.bytes = scratch_bytes_;
      cut.own_points = own_points_;
      cut.own = own_;
      journal_->begin(cut);
    });
  }

  void require_disk() const {
    // Ranks of one machine share its disk; what tiles leave comes besides, and is less.
    const std::uint64_t needed = points_ * format_.bytes() + points_ * format_.bytes() / 8;
    const std::uint64_t result = points_ * options_.sink.result_bytes;
    const auto space = std::filesystem::space(journal_->folder());
    say(std::to_string(points_) + " points, " + std::to_string(plan_.tiles) +
        " tiles: " + files::bytes_text(needed) + " of the " + files::bytes_text(space.available) +
        " that are free go to " + options_.scratch.string() +
        (result > 0 ? ", and about " + files::bytes_text(result) + " to the output" : ""));
    require_free(options_.scratch, needed);
    if (result == 0) return;
    // A tile's points go as its simplices come.
    const std::uint64_t waiting = points_ * options_.sink.scratch_bytes;
    const bool is_one_disk = device_of(options_.sink.folder) == device_of(options_.scratch);
    require_free(options_.sink.folder, result + (is_one_disk ? waiting : 0));
    if (!is_one_disk) require_free(options_.scratch, waiting);
  }

  static dev_t device_of(const std::filesystem::path& folder) {
    struct stat status {};
    return ::stat(folder.c_str(), &status) == 0 ? status.st_dev : 0;
  }
  static void require_free(const std::filesystem::path& folder, std::uint64_t bytes) {
    const std::uint64_t available = std::filesystem::space(folder).available;
    if (bytes <= available) return;
    throw files::FileError(
        files::Cause::device, folder.string(), "",
        files::bytes_text(bytes) + " are needed, " + files::bytes_text(available) + " are free");
  }

  Region points_of(std::size_t tile) {
    std::vector<RowPoint> points;
    try {
      points = store_->read(tile);
    } catch (const files::FileError&) {
      damaged_ = true;
      throw;
    }
    if (dim_ == 2 && has_z_) {
      const DuplicatesCount merged = merge_heights(points);
      const std::lock_guard lock(mutex_);
      if (merged.places > 0) duplicates_[tile] = merged;
    }
    const std::size_t size = points.size();
    return {std::move(points), size, {}};
  }

  // Points in one place are in one tile.
  DuplicatesCount merge_heights(std::vector<RowPoint>& points) const {
    PointCloud cloud;
    cloud.has_z = true;
    cloud.positions.reserve(points.size());
    for (const RowPoint& point : points) cloud.positions.push_back(point.position);
    const DuplicatesCount merged = merge_duplicates(cloud, options_.duplicates);
    if (merged.places == 0) return merged;
    std::vector<RowPoint> changed;
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (points[i].position.z == cloud.positions[i].z) continue;
      points[i].position.z = cloud.positions[i].z;
      changed.push_back(points[i]);
    }
    if (sink_ != nullptr && !changed.empty()) sink_->take_heights(changed);
    return merged;
  }

  void take(std::size_t region, Settled& settled) {
    RegionRecord record;
    record.count = count_of(region, settled);
    if (sink_ != nullptr && record.count.own_simplices > 0) {
      // What is not journaled has numbers of its own, which no later run takes for finished.
      const auto tiles = static_cast<std::uint64_t>(plan_.tiles);
      sink_->take({dim_,
                   settled.is_last ? 2 * tiles + region : region,
                   {settled.finals.points.data(), settled.finals.points.size()},
                   {settled.finals.simplices.data(), settled.finals.simplices.size()},
                   record.count.hash});
    }
    settled.finals = {};
    {
      const std::lock_guard lock(mutex_);
      if (const auto at = duplicates_.find(region); at != duplicates_.end()) {
        record.places = at->second.places;
        record.rows = at->second.rows;
        duplicates_.erase(at);  // a tile of several ranks is settled again
      }
    }
    if (journal_ && !settled.is_last) journal_->finish(record, settled.rest);
    add(record);
    if (region < static_cast<std::size_t>(plan_.tiles) && !settled.is_last) store_->drop(region);
  }

  void add(const RegionRecord& record) {
    tally_->add(record.count);
    const std::lock_guard lock(mutex_);
    merged_.places += record.places;
    merged_.rows += record.rows;
  }

  bool restore(std::size_t region, Region& rest) {
    const RegionRecord* record = journal_->finished(region);
    if (record == nullptr) return false;
    rest = journal_->read_rest(*record);
    add(*record);
    if (region < static_cast<std::size_t>(plan_.tiles)) {
      ++resumed_;
      store_->drop(region);
      skip(record->count.points);
    }
    return true;
  }

  void settle() {
    communicator_.mark(comm::Phase::other, 0);
    tally_.emplace(first_own(), own_tiles(), static_cast<std::size_t>(plan_.tiles));
    const std::vector<TileSummary> summaries = share_summaries(communicator_, own_);
    if (options_.on_points) {
      PointsFound found{points_, has_z_, {}, attributes_, rows_};
      for (const TileSummary& summary : summaries) found.box.include(summary.box);
      options_.on_points(communicator_, found);
    }
    SettleOptions how;
    how.triangulate = options_.tiles.triangulate;
    how.triangulate.threads = plan_.threads;
    how.workers = plan_.workers;
    how.finals.simplices = sink_ != nullptr;
    how.put_together = plan_.tile_points / kRestsPerTile;
    how.require = [&](std::uint64_t points) {
      require_memory_for_rest(points, dim_, options_.memory);
    };
    TileWork work;
    work.points = [&](std::size_t tile) { return points_of(tile); };
    work.take = [&](std::size_t region, Settled& settled) { take(region, settled); };
    if (journal_) {
      work.restore = [&](std::size_t region, Region& rest) { return restore(region, rest); };
    }
    exchanges_ = settle_ranks(communicator_, summaries, how, work);
  }

  PartsResult result() {
    PartsResult result;
    result.dim = dim_;
    result.has_z = has_z_;
    result.points = points_;
    result.rounds = exchanges_.rounds;
    TileStatistics& told = exchanges_.of_tile ? tally_->tiles.front() : tally_->shared;
    told.halo = exchanges_.halo;
    told.sent = exchanges_.sent;
    const TileStatistics& shared = tally_->shared;
    std::uint64_t sums[] = {tally_->distinct, tally_->simplices,   tally_->hull_facets,
                            scratch_bytes_,   resumed_.load(),     merged_.places,
                            merged_.rows,     shared.halo,         shared.sent,
                            shared.simplices, shared.own_simplices};
    comm::all_reduce(communicator_, std::span<std::uint64_t>(sums), std::plus<>());
    result.distinct = sums[0];
    result.simplices = sums[1];
    result.hull_facets = sums[2];
    result.scratch = sums[3];
    result.resumed = sums[4];
    result.duplicates = {sums[5], sums[6]};
    result.shared = {0, sums[7], sums[8], sums[9], sums[10]};
    result.hash = comm::all_reduce_value(communicator_, tally_->hash, std::plus<>());
    const std::span<const TileStatistics> own = tally_->tiles;
    for (const comm::Buffer& tiles : comm::all_gather(communicator_, comm::Buffer::of(own))) {
      const auto received = tiles.as<TileStatistics>();
      result.tiles.insert(result.tiles.end(), received.begin(), received.end());
    }
    return result;
  }

  comm::Communicator& communicator_;
  const PointParts& parts_;
  const PartsOptions& options_;
  TileSink* sink_;
  int dim_;
  parallel::Progress* progress_;
  MemoryPlan plan_;
  RecordFormat format_;
  bool has_z_ = false;
  PointAttributes attributes_;
  PartRows rows_;
  std::uint64_t points_ = 0, scratch_bytes_ = 0;
  std::optional<PartCounts> counts_;
  TileCut cut_;
  std::optional<Journal> journal_;
  std::unique_ptr<TileStore> store_;
  std::vector<TileSummary> own_;
  std::vector<std::uint64_t> own_points_;
  std::optional<Tally> tally_;
  Exchanges exchanges_;
  std::mutex mutex_;
  std::unordered_map<std::size_t, DuplicatesCount> duplicates_;  // of tiles
  DuplicatesCount merged_;
  std::atomic<std::uint64_t> resumed_{0};
  std::atomic<bool> damaged_{false};
};

}  // namespace

PartsResult triangulate_parts(comm::Communicator& communicator, const PointParts& parts,
                              const PartsOptions& options, TileSink* sink) {
  return PartsRun(communicator, parts, options, sink).run();
}

}  // namespace delray::delaunay
