// Parses ranges of lines by the layout that the first megabyte of the text tells.
#include "delaunay/files/parts/text_parts.h"

#include <algorithm>
#include <numeric>

#include "delaunay/files/text_layout.h"
#include "parallel/parallel_for.h"

namespace delray::delaunay {
namespace {

constexpr std::uint64_t kTextStart = std::uint64_t{1} << 20;  // tells the layout

class TextParts : public FileParts {
 public:
  TextParts(LineRanges lines, const TextLayout& layout)
      : lines_(std::move(lines)), separator_(layout.separator), parser_(layout) {
    constexpr std::uint64_t kDigitAndEnd = 2;
    least_row_ =
        kDigitAndEnd * static_cast<std::uint64_t>(layout.columns.size() -
                                                  std::ranges::count(layout.columns, kSkipped));
    facts_.told.file = lines_.source().name();
    facts_.has_z = parser_.has_z();
    facts_.has_classes = parser_.has_class();
    facts_.geographic = layout.geographic;
    facts_.has_ranges = parser_.has_colour() || parser_.has_intensity();
    if (!layout.warning.empty()) facts_.warnings.push_back(layout.warning);
  }

  std::size_t parts() const override { return lines_.ranges(); }
  std::uint64_t most_rows(std::size_t part) const override { return lines_.lines(part); }
  std::uint64_t row_bound(std::size_t part) const override {
    return lines_.bytes(part) / least_row_ + 1;
  }
  void read(std::size_t part, PartPoints& points) const override {
    points = {};
    std::size_t rows = 0, room = 0;
    for_each_row(lines_, part, separator_, [&](Fields& fields) {
      if (rows == room) {
        room = std::max<std::size_t>(1024, 2 * room);
        parser_.resize(points.cloud, room);
      }
      points.whole_colours &= parser_.parse(fields, rows, points.cloud);
      ++rows;
    });
    parser_.resize(points.cloud, rows);
  }

 private:
  LineRanges lines_;
  Separator separator_;
  TextRowParser parser_;
  std::uint64_t least_row_;
};

// Rows from `begin` on.
std::uint64_t count_rows(const LineRanges& lines) {
  return parallel::parallel_reduce(
      0, lines.ranges(), 1, std::uint64_t{0},
      [&](std::size_t first, std::size_t last) {
        std::uint64_t rows = 0;
        for (std::size_t range = first; range < last; ++range) {
          for_each_row(lines, range, Separator::comma, [&](Fields&) { ++rows; });
        }
        return rows;
      },
      std::plus<>());
}

}  // namespace

std::size_t LineRanges::first_line(std::size_t range) const {
  std::uint64_t line = first_line_;
  for (std::size_t i = 0; i < range; ++i) line += lines(i);
  return static_cast<std::size_t>(line);
}

std::unique_ptr<FileParts> open_text_parts(const ByteSource& source, std::uint64_t range_bytes) {
  std::string buffer;
  std::string_view text = source.read(0, std::min(source.size(), kTextStart), buffer);
  const std::size_t first_end = text.find_first_of("\r\n");
  if (first_end != text.npos && text[first_end] == '\r' &&
      (first_end + 1 == text.size() || text[first_end + 1] != '\n')) {
    return nullptr;
  }
  if (source.size() > kTextStart) {
    const std::size_t last_line = text.rfind('\n');
    if (last_line == text.npos) return nullptr;
    text = text.substr(0, last_line + 1);
  }
  const Input start = source.input(text);
  constexpr std::size_t kFirstRows = 2;  // a row of counts, and one of coordinates
  if (index_rows(start, {}, kFirstRows, is_data_row).count < kFirstRows) return nullptr;
  bool with_counts = false;
  if (const auto counts = announced_counts(start)) {
    TextPlace rest;
    if (text.starts_with("\xef\xbb\xbf")) rest.byte = 3;  // UTF-8 byte order mark
    rest = index_rows(start, rest, 1, is_data_row).end;
    // No row takes less than four bytes; of most points that are whole numbers this will do.
    const bool fits = counts->points <= source.size() / 4 && counts->edges <= source.size() / 4;
    const std::uint64_t rows = fits || counts->single ? count_rows({source, rest, range_bytes}) : 0;
    if (!counts->single && rows >= counts->points && counts->edges == rows - counts->points) {
      return nullptr;
    }
    if (counts->single && rows != counts->points) return nullptr;
    with_counts = counts->single;
  }
  const TextLayout layout = text_layout(start, with_counts);
  return std::make_unique<TextParts>(LineRanges(source, layout.begin, range_bytes), layout);
}

}  // namespace delray::delaunay
