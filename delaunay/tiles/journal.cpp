// Binary records that end with a check sum, appended by one call each; what a region left is in a
// file that is complete before its record is written, and its points go only after that.
#include "delaunay/tiles/journal.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>
#include <xxhash.h>

#include <array>
#include <cstdio>
#include <cstring>
#include <system_error>

#include "delaunay/tiles/scratch_file.h"
#include "files/error.h"

namespace delray::delaunay {
namespace {

constexpr std::uint64_t kCutMark = 0x3174756379617264, kRecordMark = 0x31646e6579617264,
                        kRestMark = 0x3174736579617264;

std::string hex(const std::string& text) {
  const XXH128_hash_t hash = XXH3_128bits(text.data(), text.size());
  std::array<char, 17> digits;
  std::snprintf(digits.data(), digits.size(), "%016llx",
                static_cast<unsigned long long>(hash.low64 ^ hash.high64));
  return digits.data();
}

template <class T>
void put(std::vector<std::byte>& to, std::span<const T> values) {
  const auto bytes = std::as_bytes(values);
  to.insert(to.end(), bytes.begin(), bytes.end());
}
template <class T>
void put(std::vector<std::byte>& to, const T& value) {
  put(to, std::span<const T>(&value, 1));
}

// Takes values off the front; false when there are not so many.
template <class T>
bool get(std::span<const std::byte>& from, std::span<T> values) {
  if (from.size() < values.size_bytes()) return false;
  if (!values.empty()) std::memcpy(values.data(), from.data(), values.size_bytes());
  from = from.subspan(values.size_bytes());
  return true;
}
template <class T>
bool get(std::span<const std::byte>& from, T& value) {
  return get(from, std::span<T>(&value, 1));
}

void add_check(std::vector<std::byte>& bytes) { put(bytes, check_sum(bytes)); }

// All of a file but its check sum, or nothing if that is wrong.
std::vector<std::byte> read_checked(const std::filesystem::path& path) {
  const ScratchFile file(path, ScratchFile::Mode::read);
  std::vector<std::byte> bytes(file.size());
  if (bytes.size() < sizeof(std::uint64_t) || !file.read(0, bytes)) return {};
  std::uint64_t check = 0;
  const std::size_t size = bytes.size() - sizeof check;
  std::memcpy(&check, bytes.data() + size, sizeof check);
  if (check_sum(std::span(bytes).first(size)) != check) return {};
  bytes.resize(size);
  return bytes;
}

struct StoredRecord {
  std::uint64_t mark = kRecordMark;
  RegionRecord record;
  std::uint64_t check = 0;

  std::uint64_t right_check() const {
    return check_sum(std::as_bytes(std::span(this, 1)).first(sizeof *this - sizeof check));
  }
};
static_assert(std::is_trivially_copyable_v<StoredRecord>);

}  // namespace

Journal::Journal(const std::filesystem::path& scratch, const std::string& identity, int rank,
                 int ranks) {
  folder_ = scratch /
            ("delray-" + hex(identity + "|" + std::to_string(ranks)) + "-" + std::to_string(rank));
  std::error_code error;
  std::filesystem::create_directories(folder_, error);
  if (error) {
    throw files::FileError(files::Cause::device, folder_.string(), "",
                           "cannot be made: " + error.message());
  }
  std::filesystem::permissions(folder_, std::filesystem::perms::owner_all, error);
  constexpr mode_t kOwnerOnly = 0600;
  lock_ = ::open((folder_ / "lock").c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, kOwnerOnly);
  if (lock_ < 0 || ::flock(lock_, LOCK_EX | LOCK_NB) != 0) {
    const bool opened = lock_ >= 0;
    if (opened) ::close(lock_);
    throw files::FileError(files::Cause::device, folder_.string(), "",
                           opened ? "another run uses it" : "cannot be locked");
  }
}

Journal::~Journal() {
  if (!keep_) {
    std::error_code ignored;
    std::filesystem::remove_all(folder_, ignored);
  }
  ::close(lock_);
}

void Journal::fail_damaged(const std::filesystem::path& path) const {
  damaged_ = true;
  throw files::FileError(files::Cause::device, path.string(), "",
                         "is not as it was written: start again without --resume");
}

std::filesystem::path Journal::rest_path(std::uint64_t region) const {
  return folder_ / ("rest-" + std::to_string(region));
}

std::optional<CutRecord> Journal::load() {
  std::error_code ignored;
  if (!std::filesystem::exists(folder_ / "cut", ignored)) return {};
  begun_ = true;
  const std::vector<std::byte> bytes = read_checked(folder_ / "cut");
  std::span<const std::byte> from = bytes;
  CutRecord cut;
  std::uint64_t mark = 0, own = 0;
  if (!get(from, mark) || mark != kCutMark || !get(from, cut.dim) || !get(from, cut.with_z) ||
      !get(from, cut.tiles) || !get(from, cut.points) || !get(from, cut.bytes) || !get(from, own) ||
      own > from.size()) {
    fail_damaged(folder_ / "cut");
  }
  cut.own_points.resize(own);
  cut.own.resize(own);
  if (!get(from, std::span(cut.own_points)) || !get(from, std::span(cut.own))) {
    fail_damaged(folder_ / "cut");
  }
  if (std::filesystem::exists(folder_ / "journal", ignored)) {
    const ScratchFile file(folder_ / "journal", ScratchFile::Mode::read);
    StoredRecord stored;
    for (std::uint64_t at = 0; file.read(at, std::as_writable_bytes(std::span(&stored, 1)));
         at += sizeof stored) {
      if (stored.mark != kRecordMark || stored.check != stored.right_check()) {
        fail_damaged(folder_ / "journal");
      }
      finished_[stored.record.count.region] = stored.record;
    }
    // A record that was written half must not stand before those to come.
    std::filesystem::resize_file(folder_ / "journal", finished_.size() * sizeof stored, ignored);
  }
  return cut;
}

void Journal::clear() {
  finished_.clear();
  begun_ = false;
  std::error_code ignored;
  for (const auto& entry : std::filesystem::directory_iterator(folder_, ignored)) {
    if (entry.path().filename() != "lock") std::filesystem::remove_all(entry.path(), ignored);
  }
}

void Journal::begin(const CutRecord& cut) {
  std::vector<std::byte> bytes;
  for (const std::uint64_t value : {kCutMark, cut.dim, cut.with_z, cut.tiles, cut.points, cut.bytes,
                                    std::uint64_t{cut.own.size()}}) {
    put(bytes, value);
  }
  put(bytes, std::span<const std::uint64_t>(cut.own_points));
  put(bytes, std::span<const TileSummary>(cut.own));
  add_check(bytes);
  ScratchFile(folder_ / "cut.part", ScratchFile::Mode::replace).write(bytes);
  std::filesystem::rename(folder_ / "cut.part", folder_ / "cut");
  begun_ = true;
}

void Journal::finish(RegionRecord record, const Region& rest) {
  record.rest_points = rest.points.size();
  record.rest_walls = rest.walls.size();
  std::vector<std::byte> bytes;
  bytes.reserve(rest.points.size() * sizeof(RowPoint) + rest.walls.size() * sizeof(std::uint32_t) +
                2 * sizeof(std::uint64_t));
  put(bytes, kRestMark);
  put(bytes, std::span<const RowPoint>(rest.points));
  put(bytes, std::span<const std::uint32_t>(rest.walls));
  add_check(bytes);
  ScratchFile(rest_path(record.count.region), ScratchFile::Mode::replace).write(bytes);
  StoredRecord stored;
  stored.record = record;
  stored.check = stored.right_check();
  const std::lock_guard lock(mutex_);
  ScratchFile(folder_ / "journal", ScratchFile::Mode::append)
      .write(std::as_bytes(std::span(&stored, 1)));
}

const RegionRecord* Journal::finished(std::uint64_t region) const {
  const auto at = finished_.find(region);
  return at == finished_.end() ? nullptr : &at->second;
}

Region Journal::read_rest(const RegionRecord& record) const {
  const std::filesystem::path path = rest_path(record.count.region);
  const std::vector<std::byte> bytes = read_checked(path);
  std::span<const std::byte> from = bytes;
  Region rest;
  std::uint64_t mark = 0;
  const std::uint64_t size = sizeof mark + record.rest_points * sizeof(RowPoint) +
                             record.rest_walls * sizeof(std::uint32_t);
  bool good = bytes.size() == size;
  if (good) {
    rest.points.resize(record.rest_points);
    rest.walls.resize(record.rest_walls);
    good = get(from, mark) && mark == kRestMark && get(from, std::span(rest.points)) &&
           get(from, std::span(rest.walls));
  }
  if (!good) fail_damaged(path);
  rest.own = rest.points.size();
  return rest;
}

}  // namespace delray::delaunay
