// Lines with words are counted in ranges of the text at the same time; lists are passed over one
// after the other by their lengths alone.
#include "scenes/files/ply_blocks.h"

#include <algorithm>
#include <cmath>

#include "files/line_ranges.h"
#include "scenes/files/for_each_block.h"

namespace delray::scenes::internal {
namespace {

// Below a block has fewer bytes than this, and a row or more: less than a millisecond of reading,
// and its bytes stay in the cache.
constexpr std::uint64_t kBlockBytes = std::uint64_t{1} << 18;
constexpr std::uint64_t kTextRange = std::uint64_t{1} << 20;

// Bytes of a row whose lists are all empty.
std::uint64_t smallest_row(const PlyElement& element) {
  std::uint64_t bytes = 0;
  for (const PlyProperty& p : element.properties) {
    bytes += size_of(p.is_list() ? p.length : p.value);
  }
  return bytes;
}

bool has_lists(const PlyElement& element) {
  return std::ranges::any_of(element.properties, &PlyProperty::is_list);
}

// Blocks of rows that take `stride` bytes each, from byte `begin` on.
std::vector<PlyBlock> cut_evenly(std::uint64_t begin, std::uint64_t stride, std::uint64_t count) {
  std::vector<PlyBlock> blocks;
  const std::uint64_t most = std::max<std::uint64_t>(kBlockBytes / stride, 1);
  for (std::uint64_t first = 0; first < count; first += most) {
    const std::uint64_t rows = std::min(most, count - first);
    blocks.push_back({begin + first * stride, rows * stride, first, rows});
  }
  return blocks;
}

// Passes over rows by the lengths of their lists.
class RowWalk {
 public:
  RowWalk(const PlyFile& file, std::uint64_t begin) : file_(file), at_(begin), swap_(file.swap()) {}

  std::uint64_t at() const { return at_; }
  // False, and stays before the row, where the file ends or a list is too long.
  bool pass(const PlyElement& element) {
    const std::uint64_t size = file_.bytes.size();
    std::uint64_t at = at_;
    for (const PlyProperty& property : element.properties) {
      const std::uint64_t bytes = size_of(property.is_list() ? property.length : property.value);
      if (size - at < bytes) return false;
      if (!property.is_list()) {
        at += bytes;
        continue;
      }
      const double length = ply_value(look(at, bytes), property.length, swap_);
      at += bytes;
      const std::uint64_t each = size_of(property.value);
      if (!(length >= 0) || length > static_cast<double>((size - at) / each)) return false;
      at += static_cast<std::uint64_t>(length) * each;
    }
    at_ = at;
    return true;
  }

 private:
  const char* look(std::uint64_t at, std::uint64_t bytes) {
    if (at < window_begin_ || at + bytes > window_begin_ + window_.size()) {
      window_begin_ = at;
      window_ = file_.bytes.read(at, std::min(kWindow, file_.bytes.size() - at), buffer_);
    }
    return window_.data() + (at - window_begin_);
  }

  static constexpr std::uint64_t kWindow = std::uint64_t{1} << 18;
  const PlyFile& file_;
  std::uint64_t at_;
  bool swap_;
  std::string buffer_;
  std::string_view window_;
  std::uint64_t window_begin_ = 0;
};

}  // namespace

PlyBlocks::PlyBlocks(const PlyFile& file) : file_(file), at_(file.header.size) {
  if (!file.is_text()) return;
  const files::LineRanges ranges(file.bytes, file.header.size, kTextRange);
  std::vector<TextRange> counts(ranges.ranges());
  for_each_block(counts.size(), [&](std::size_t i) {
    std::string buffer;
    std::string_view line;
    Lines lines(ranges.read(i, buffer));
    while (lines.next_with_words(line, '\0')) ++counts[i].rows;
    counts[i].lines = lines.number();
  });
  rows_before_ = {0};
  lines_before_ = {file.header.lines};
  for (std::size_t i = 0; i < counts.size(); ++i) {
    range_begins_.push_back(ranges.begin(i));
    rows_before_.push_back(rows_before_.back() + counts[i].rows);
    lines_before_.push_back(lines_before_.back() + counts[i].lines);
  }
  range_begins_.push_back(file.bytes.size());
}

std::vector<PlyBlock> PlyBlocks::next(const PlyElement& element) {
  if (file_.is_text()) return next_of_text(element);
  if (has_lists(element)) return next_with_lists(element);
  const std::uint64_t stride = smallest_row(element), left = file_.bytes.size() - at_;
  const std::uint64_t whole = std::min(element.count, left / stride);
  std::vector<PlyBlock> blocks = cut_evenly(at_, stride, whole);
  at_ += whole * stride;
  if (whole < element.count) {
    blocks.push_back({at_, file_.bytes.size() - at_, whole, element.count - whole});
    at_ = file_.bytes.size();
  }
  return blocks;
}

std::vector<PlyBlock> PlyBlocks::even(const PlyElement& element) const {
  RowWalk walk(file_, at_);
  if (file_.is_text() || !walk.pass(element)) return {};
  const std::uint64_t stride = walk.at() - at_;
  if (element.count > (file_.bytes.size() - at_) / stride) return {};
  return cut_evenly(at_, stride, element.count);
}

std::vector<PlyBlock> PlyBlocks::next_with_lists(const PlyElement& element) {
  std::vector<PlyBlock> blocks;
  RowWalk walk(file_, at_);
  std::uint64_t row = 0;
  bool whole = true;
  while (whole && row < element.count) {
    PlyBlock block{walk.at(), 0, row, 0};
    while (whole && row < element.count && walk.at() - block.begin < kBlockBytes) {
      whole = walk.pass(element);
      if (whole) ++row;
    }
    const std::uint64_t end = whole ? walk.at() : file_.bytes.size();
    block.bytes = end - block.begin;
    block.rows = (whole ? row : element.count) - block.first;
    blocks.push_back(block);
  }
  at_ = whole ? walk.at() : file_.bytes.size();
  return blocks;
}

std::vector<PlyBlock> PlyBlocks::next_of_text(const PlyElement& element) {
  std::vector<PlyBlock> blocks;
  const std::uint64_t end = row_ + element.count;
  for (std::size_t i = 0; i + 1 < range_begins_.size(); ++i) {
    const std::uint64_t first = std::max(row_, rows_before_[i]);
    const std::uint64_t last = std::min(end, rows_before_[i + 1]);
    if (first >= last) continue;
    blocks.push_back({range_begins_[i], range_begins_[i + 1] - range_begins_[i], first - row_,
                      last - first, lines_before_[i] + 1, first - rows_before_[i]});
  }
  if (end > rows_before_.back()) {  // the rows that are not there
    const std::uint64_t size = file_.bytes.size(), first = std::max(row_, rows_before_.back());
    blocks.push_back({size, 0, first - row_, end - first, lines_before_.back() + 1, 0});
  }
  row_ = end;
  return blocks;
}

void PlyBlocks::require_end() const {
  if (!file_.is_text() || rows_before_.back() <= row_) return;
  const auto after = std::ranges::upper_bound(rows_before_, row_);
  const auto range = static_cast<std::size_t>(after - rows_before_.begin()) - 1;
  std::string buffer;
  std::string_view line;
  Lines lines(file_.bytes.read(range_begins_[range],
                               range_begins_[range + 1] - range_begins_[range], buffer),
              lines_before_[range]);
  for (std::uint64_t row = rows_before_[range]; row <= row_; ++row) {
    lines.next_with_words(line, '\0');
  }
  file_.source.fail(lines.place(), "the file has more rows than its header says");
}

}  // namespace delray::scenes::internal
