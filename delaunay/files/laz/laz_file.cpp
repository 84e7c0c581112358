// The two tables of a LAZ file: the items of its records, in a variable length record, and its
// chunks, whose sizes are coded arithmetically behind the last of them.
#include "delaunay/files/laz/laz_file.h"

#include <algorithm>
#include <limits>
#include <string>

namespace delray::delaunay::laz {
namespace {

// Ways of coding.
enum Compressor : std::uint16_t { pointwise = 1, pointwise_chunked = 2, layered_chunked = 3 };
// Types of items.
enum ItemType : std::uint16_t {
  extra_bytes = 0,
  point10 = 6,
  time11 = 7,
  colour12 = 8,
  wave_packet13 = 9,
  point14 = 10,
  colour14 = 11,
  colour_and_infrared14 = 12,
  wave_packet14 = 13,
  extra_bytes14 = 14,
};

constexpr std::uint32_t kVariable = std::numeric_limits<std::uint32_t>::max();

struct Description {
  std::uint16_t compressor = 0;
  std::uint32_t chunk_size = 0;  // in points
  std::variant<PointwiseItems, LayeredItems> items;
};

constexpr const char* kPlace = "the record on compression";

template <class Items>
void require_record_size(const Input& input, const LasHeader& header, const Items& items) {
  if (items.record_size() != header.record_size) {
    fail(input, kPlace,
         "describes points of " + std::to_string(items.record_size()) + " bytes, but the header " +
             std::to_string(header.record_size));
  }
}

void require_version(const Input& input, unsigned version, bool known) {
  if (known) return;
  fail(input, kPlace,
       "coding of version " + std::to_string(version) +
           " is not read; write the file anew with a LASzip of this decade");
}

Description parse_description(const Input& input, const LasHeader& header) {
  constexpr std::size_t kHead = 34, kItem = 6;
  const std::string_view record = find_las_record(header, "laszip encoded", 22204);
  if (record.size() < kHead) fail(input, "", "LAZ without its record on compression");
  Description description;
  description.compressor = load<std::uint16_t>(record.data());
  description.chunk_size = load<std::uint32_t>(record.data() + 12);
  const std::size_t count = load<std::uint16_t>(record.data() + 32);
  if (record.size() < kHead + count * kItem) fail(input, kPlace, "is cut off");
  if (description.compressor < pointwise || description.compressor > layered_chunked) {
    fail(input, kPlace, "unknown compressor " + std::to_string(description.compressor));
  }
  if (load<std::uint16_t>(record.data() + 2) != 0) fail(input, kPlace, "unknown entropy coder");

  const bool layered = description.compressor == layered_chunked;
  PointwiseItems pointwise_items;
  LayeredItems layered_items;
  for (std::size_t i = 0; i < count; ++i) {
    const char* item = record.data() + kHead + i * kItem;
    const auto type = load<std::uint16_t>(item), size = load<std::uint16_t>(item + 2),
               version = load<std::uint16_t>(item + 4);
    const bool first = type == (layered ? point14 : point10);
    if (first != (i == 0)) fail(input, kPlace, "points do not begin with their coordinates");
    require_version(input, version, layered ? version == 3 || version == 4 : version == 2);
    layered_items.version = version;
    if (first) continue;
    if (!layered && type == time11 && !pointwise_items.time && !pointwise_items.colour &&
        pointwise_items.extra_bytes == 0) {
      pointwise_items.time = true;
    } else if (!layered && type == colour12 && !pointwise_items.colour &&
               pointwise_items.extra_bytes == 0) {
      pointwise_items.colour = true;
    } else if (layered && (type == colour14 || type == colour_and_infrared14) &&
               !layered_items.colour && layered_items.extra_bytes == 0) {
      layered_items.colour = true;
      layered_items.near_infrared = type == colour_and_infrared14;
    } else if (type == (layered ? extra_bytes14 : extra_bytes)) {
      (layered ? layered_items.extra_bytes : pointwise_items.extra_bytes) += size;
    } else if (type == wave_packet13 || type == wave_packet14) {
      fail(input, kPlace,
           "wave packets (point format " + std::to_string(header.format_number) + ") are not read");
    } else {
      fail(input, kPlace, "items of type " + std::to_string(type) + " are not read there");
    }
  }
  if (count == 0) fail(input, kPlace, "has no items");
  if (layered) {
    require_record_size(input, header, layered_items);
    description.items = layered_items;
  } else {
    require_record_size(input, header, pointwise_items);
    description.items = pointwise_items;
  }
  return description;
}

// The numbers of points (0 where all chunks are of one size) and of bytes of the chunks.
struct Sizes {
  std::uint32_t points = 0, bytes = 0;
};

std::vector<Sizes> decode_chunk_sizes(const ByteSource& source, std::uint64_t table, bool variable,
                                      std::size_t most_chunks) {
  constexpr std::uint64_t kHead = 8;
  // Two integers, each of two symbols of 15 bits at most and 24 bits that are not modelled.
  constexpr std::uint64_t kMostBytesPerChunk = 14, kSlack = 16;
  const Input input = source.input();
  std::string buffer;
  const std::string_view head = source.read(table, kHead, buffer);
  const auto count = load<std::uint32_t>(head.data() + 4);
  if (load<std::uint32_t>(head.data()) != 0 || count > most_chunks) {
    fail(input, at_byte(table), "the table of chunks is damaged");
  }
  const std::uint64_t begin = table + kHead;
  const std::string_view content = source.read(
      begin, std::min(source.size() - begin, count * kMostBytesPerChunk + kSlack), buffer);
  input.require_memory(count * (sizeof(Sizes) + sizeof(Chunk)));
  std::vector<Sizes> sizes(count);
  ArithmeticDecoder decoder(content);
  IntegerDecoder integers(32, 2);
  Sizes last;
  for (Sizes& each : sizes) {
    if (variable) {
      last.points = static_cast<std::uint32_t>(
          integers.decode(decoder, static_cast<std::int32_t>(last.points), 0));
    }
    last.bytes = static_cast<std::uint32_t>(
        integers.decode(decoder, static_cast<std::int32_t>(last.bytes), 1));
    each = last;
  }
  if (decoder.overrun()) fail(input, at_byte(table), "the table of chunks is cut off");
  return sizes;
}

// Where the table of chunks begins. Writers that cannot go back leave that at the end of the file.
std::uint64_t find_chunk_table(const ByteSource& source, const LasHeader& header) {
  constexpr std::uint64_t kPosition = sizeof(std::int64_t), kHead = 8;
  const Input input = source.input();
  if (source.size() < header.points_begin + kPosition + kHead) {
    fail(input, at_byte(source.size()), "the file is cut off before its points");
  }
  std::string buffer;
  auto table = load<std::int64_t>(source.read(header.points_begin, kPosition, buffer).data());
  if (table == -1) {
    table = load<std::int64_t>(source.read(source.size() - kPosition, kPosition, buffer).data());
  }
  if (table < static_cast<std::int64_t>(header.points_begin + kPosition) ||
      static_cast<std::uint64_t>(table) > source.size() - kHead) {
    fail(input, at_byte(header.points_begin),
         "the table of chunks is not in the file, which may be cut off");
  }
  return static_cast<std::uint64_t>(table);
}

}  // namespace

LazFile parse_laz_file(const ByteSource& source, const LasHeader& header) {
  const Input input = source.input();
  const Description description = parse_description(input, header);
  LazFile file{description.items, {}};
  if (header.count == 0) return file;
  // No symbol takes less than some 2^-13 of a bit.
  constexpr std::size_t kMostPointsPerByte = 1U << 14;
  std::size_t number = 0;
  const auto add_chunk = [&](std::uint64_t begin, std::uint64_t size, std::size_t first,
                             std::size_t count) {
    if (size < count / kMostPointsPerByte) {
      fail(input, "chunk " + std::to_string(number),
           std::to_string(size) + " bytes cannot hold " + std::to_string(count) + " points");
    }
    if (count > 0) file.chunks.push_back({begin, size, first, count, number});
    ++number;
  };
  if (description.compressor == pointwise) {
    add_chunk(header.points_begin, source.size() - header.points_begin, 0, header.count);
    return file;
  }

  const std::uint64_t table = find_chunk_table(source, header);
  const bool variable = description.chunk_size == kVariable;
  if (description.chunk_size == 0) fail(input, kPlace, "chunks have no points");
  std::uint64_t begin = header.points_begin + sizeof(std::int64_t);
  std::size_t first = 0;
  for (const Sizes& sizes :
       decode_chunk_sizes(source, table, variable, (table - begin) / header.record_size)) {
    if (sizes.bytes > table - begin) {
      fail(input, "chunk " + std::to_string(number), "reaches beyond the points");
    }
    const std::size_t left = header.count - first;
    const std::size_t count =
        variable ? sizes.points : std::min<std::size_t>(description.chunk_size, left);
    if (count > left) fail(input, at_byte(table), "chunks have more points than the header says");
    add_chunk(begin, sizes.bytes, first, count);
    begin += sizes.bytes;
    first += count;
  }
  if (first != header.count) {
    fail(input, at_byte(table),
         "chunks have " + std::to_string(first) + " points, but the header announces " +
             std::to_string(header.count));
  }
  return file;
}

ChunkDecoder::ChunkDecoder(const LazFile& file)
    : decoder_(std::in_place_type<PointwiseDecoder>, PointwiseItems{}) {
  std::visit(
      [this](const auto& items) {
        record_size_ = items.record_size();
        if constexpr (std::is_same_v<std::decay_t<decltype(items)>, LayeredItems>) {
          decoder_.emplace<LayeredDecoder>(items);
        } else {
          decoder_.emplace<PointwiseDecoder>(items);
        }
      },
      file.items);
}

std::string_view ChunkDecoder::decode(std::string_view chunk, std::size_t count) {
  records_.resize(count * record_size_);
  const bool whole =
      std::visit([&](auto& decoder) { return decoder.decode(chunk, records_); }, decoder_);
  return whole ? std::string_view(records_.data(), records_.size()) : std::string_view();
}

}  // namespace delray::delaunay::laz
