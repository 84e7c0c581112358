// PCD 0.5 to 0.7 (Point Cloud Library): ascii, binary and binary_compressed.
#include "delaunay/files/parts/pcd_parts.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

#include "delaunay/files/parts/lzf.h"

namespace delray::delaunay {
namespace {

constexpr std::size_t kPcdPartRows = 65536;
constexpr std::uint64_t kMostPcdHeader = std::uint64_t{1} << 20;

PcdHeader read_pcd_header(const ByteSource& source) {
  std::string buffer;
  return parse_pcd_header(
      source.input(source.read(0, std::min(source.size(), kMostPcdHeader), buffer)));
}

// A float whose bytes are a colour, or a whole number.
std::uint32_t colour_bits(const PcdField& field, double number) {
  if (field.type == 'F') return std::bit_cast<std::uint32_t>(static_cast<float>(number));
  return number >= 0 && number < 0x1p32 ? static_cast<std::uint32_t>(number) : 0;
}

}  // namespace

struct PcdParts::Rows {
  explicit Rows(const PcdHeader& header) : header_(header) { points.cloud.has_z = header.has(kZ); }

  void set(const PcdField& field, double number) {
    if (field.packed_colour) colour_ = colour_bits(field, number);
    values_[field.quantity] = number;
  }
  // Ends a row. Of points without coordinates nothing is kept.
  void next() {
    if (!std::isfinite(values_[kX]) || !std::isfinite(values_[kY]) || !std::isfinite(values_[kZ])) {
      ++points.left_out;
      return;
    }
    PointCloud& cloud = points.cloud;
    cloud.positions.emplace_back(values_[kX], values_[kY], values_[kZ]);
    if (header_.has(kRed)) {
      cloud.colours.emplace_back(colour_ >> 16 & 255, colour_ >> 8 & 255, colour_ & 255, 255);
    }
    if (header_.has(kIntensity)) {
      const auto intensity = static_cast<float>(values_[kIntensity]);
      cloud.intensity.push_back(std::isfinite(intensity) ? std::max(intensity, 0.0F) : 0.0F);
    }
    if (header_.has(kClass)) {
      const double value = values_[kClass];
      cloud.classification.push_back(value > 0 ? static_cast<std::uint8_t>(std::min(value, 255.0))
                                               : std::uint8_t{0});
    }
  }

  PartPoints points;

 private:
  const PcdHeader& header_;
  std::array<double, kQuantities + 1> values_{};  // and what is skipped
  std::uint32_t colour_ = 0;
};

PcdParts::PcdParts(ByteSource source)
    : source_(std::move(source)), header_(read_pcd_header(source_)) {
  if (header_.encoding == PcdEncoding::ascii) {
    if (header_.body.byte < source_.size()) lines_.emplace(source_, header_.body);
    check_lines();
  } else {
    check_size();
  }
  facts_.told.file = source_.name();
  facts_.has_z = header_.has(kZ);
  facts_.has_classes = header_.has(kClass);
  facts_.has_ranges = header_.has(kIntensity);
}

void PcdParts::check_size() const {
  const std::uint64_t left = source_.size() - header_.body.byte;
  std::uint64_t room = left;
  if (header_.encoding == PcdEncoding::compressed) {
    constexpr std::uint64_t kSizes = 8;
    room = left < kSizes ? 0 : most_lzf_bytes(left - kSizes);
  }
  if (header_.points <= room / header_.record_size) return;
  fail(source_.input(), at_byte(header_.body.byte),
       "the header announces " + std::to_string(header_.points) +
           " points, more than the file holds");
}

// Empty lines count, so that what is cut short by as many goes unnoticed.
void PcdParts::check_lines() const {
  std::uint64_t lines = 0;
  for (std::size_t range = 0; range < parts(); ++range) lines += lines_->lines(range);
  if (lines >= header_.points) return;
  fail(source_.input(), at_byte(source_.size()),
       "the header announces " + std::to_string(header_.points) + " points, the file has " +
           std::to_string(lines) + " lines of them");
}

std::size_t PcdParts::parts() const {
  switch (header_.encoding) {
    case PcdEncoding::ascii:
      return lines_ ? lines_->ranges() : 0;
    case PcdEncoding::binary:
      return (header_.points + kPcdPartRows - 1) / kPcdPartRows;
    default:
      return header_.points > 0 ? 1 : 0;
  }
}

std::uint64_t PcdParts::most_rows(std::size_t part) const {
  switch (header_.encoding) {
    case PcdEncoding::ascii:
      return lines_->lines(part);
    case PcdEncoding::binary:
      return std::min<std::uint64_t>(kPcdPartRows, header_.points - part * kPcdPartRows);
    default:
      return header_.points;
  }
}

std::uint64_t PcdParts::row_bound(std::size_t part) const {
  if (header_.encoding != PcdEncoding::ascii) return most_rows(part);
  return lines_->bytes(part) / 4 + 1;  // two digits and two ends
}

void PcdParts::read_lines(std::size_t range, Rows& rows) const {
  for_each_row(*lines_, range, Separator::comma, [&](Fields& fields) {
    for (const PcdField& field : header_.fields) {
      for (std::size_t i = 0; i < field.count; ++i) {
        std::string_view text;
        if (!fields.next(text)) fields.fail("the line ends too early");
        double number = 0;
        const NumberError error = parse_number(text, number);
        if (error == NumberError::not_a_number) fields.fail("not a number");
        if (error == NumberError::not_finite) number = std::nan("");
        if (field.quantity != kSkipped) rows.set(field, number);
      }
    }
    rows.next();
  });
}

void PcdParts::read_records(std::size_t part, Rows& rows) const {
  const std::uint64_t first = part * kPcdPartRows, count = most_rows(part);
  std::string buffer;
  const std::string_view bytes = source_.read(header_.body.byte + first * header_.record_size,
                                              count * header_.record_size, buffer);
  for (std::uint64_t i = 0; i < count; ++i) {
    const char* record = bytes.data() + i * header_.record_size;
    for (const PcdField& field : header_.fields) {
      if (field.quantity != kSkipped) rows.set(field, pcd_number(field, record + field.offset));
    }
    rows.next();
  }
}

void PcdParts::read_compressed(Rows& rows) const {
  std::string buffer;
  const std::uint64_t at = header_.body.byte;
  std::array<std::uint32_t, 2> sizes;  // packed, unpacked
  std::memcpy(sizes.data(), source_.read(at, sizeof sizes, buffer).data(), sizeof sizes);
  const std::uint64_t wanted = header_.points * header_.record_size;
  if (sizes[0] > source_.size() - at - sizeof sizes || sizes[1] != wanted) {
    fail(source_.input(), at_byte(at),
         "the sizes of the compressed points are not those of the file and its header");
  }
  if (wanted > most_lzf_bytes(sizes[0])) {
    fail(source_.input(), at_byte(at), "so few bytes cannot hold so many points");
  }
  constexpr std::uint64_t kBytesPerPoint = 40;  // a PointCloud with everything
  source_.memory().require(wanted + sizes[0] + header_.points * kBytesPerPoint, source_.name());
  rows.points.cloud.positions.reserve(header_.points);
  std::string unpacked(wanted, '\0');
  if (!unpack_lzf(source_.read(at + sizeof sizes, sizes[0], buffer), unpacked)) {
    fail(source_.input(), at_byte(at + sizeof sizes), "the compressed points are damaged");
  }
  // All values of a field follow each other.
  for (std::uint64_t i = 0; i < header_.points; ++i) {
    for (const PcdField& field : header_.fields) {
      if (field.quantity == kSkipped) continue;
      rows.set(field,
               pcd_number(field, unpacked.data() + field.offset * header_.points + i * field.size));
    }
    rows.next();
  }
}

void PcdParts::read(std::size_t part, PartPoints& points) const {
  Rows rows(header_);
  switch (header_.encoding) {
    case PcdEncoding::ascii:
      read_lines(part, rows);
      break;
    case PcdEncoding::binary:
      read_records(part, rows);
      break;
    default:
      read_compressed(rows);
  }
  points = std::move(rows.points);
}

}  // namespace delray::delaunay
