// Encodes LAZ as Isenburg's paper (LASzip, 2013) and the specification of its extension for LAS 1.4
// (2014) say, written for readability: a model for every context, made when it is first used.
#include "tests/delaunay/files/laz/laz_encoder.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <map>
#include <optional>

#include "delaunay/files/laz/laz_items.h"
#include "tests/delaunay/files/laz/arithmetic_encoder.h"

namespace delray::tests {
namespace {

using delaunay::laz::load;
using delaunay::laz::StreamingMedian;
using delaunay::laz::SymbolModel;

constexpr std::array<std::size_t, 11> kRecordSizes = {20, 28, 26, 34, 57, 63, 30, 36, 38, 59, 67};

template <class T>
void put(std::string& bytes, T value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}
template <class T>
void put_at(std::string& bytes, std::size_t at, T value) {
  std::memcpy(bytes.data() + at, &value, sizeof value);
}

// Models by name and context.
class Models {
 public:
  void encode(ArithmeticEncoder& encoder, char name, unsigned context, unsigned symbols,
              unsigned symbol) {
    SymbolModel& model = models_[{name, context}];
    if (!model.ready()) model.reset(symbols);
    encoder.encode(model, symbol);
  }

 private:
  std::map<std::pair<char, unsigned>, SymbolModel> models_;
};

// Contexts by the returns of a pulse: the tables of the specification, in words where they have
// any.
unsigned return_map_of_8(unsigned count, unsigned number) {
  static constexpr unsigned kMap[8][8] = {
      {15, 14, 13, 12, 11, 10, 9, 8},  {14, 0, 1, 3, 6, 10, 10, 9},
      {13, 1, 2, 4, 7, 11, 11, 10},    {12, 3, 4, 5, 8, 12, 12, 11},
      {11, 6, 7, 8, 9, 13, 13, 12},    {10, 10, 11, 12, 13, 14, 14, 13},
      {9, 10, 11, 12, 13, 14, 15, 14}, {8, 9, 10, 11, 12, 13, 14, 15}};
  return kMap[count][number];
}
// The specification's table as a rule, for numbers of returns that pulses have (up to five).
unsigned return_map_of_16(unsigned count, unsigned number) {
  if (count == 1 && number == 1) return 0;
  if (count <= 2) return number == 1 ? 1 : 2;
  return number == 1 ? 3 : number == count ? 5 : 4;
}

void encode_coordinates(ArithmeticEncoder& plane, ArithmeticEncoder& heights, const char* last,
                        const char* now, IntegerEncoder& x, IntegerEncoder& y, IntegerEncoder& z,
                        StreamingMedian& x_steps, StreamingMedian& y_steps, std::int32_t& last_z,
                        unsigned single) {
  using delaunay::laz::even_context;
  const auto step = [&](std::size_t at) {
    return static_cast<std::int32_t>(load<std::uint32_t>(now + at) -
                                     load<std::uint32_t>(last + at));
  };
  x.encode(plane, x_steps.get(), step(0), single);
  x_steps.add(step(0));
  y.encode(plane, y_steps.get(), step(4), single + even_context(x.magnitude(), 20));
  y_steps.add(step(4));
  const unsigned magnitude = (x.magnitude() + y.magnitude()) / 2;
  z.encode(heights, last_z, load<std::int32_t>(now + 8), single + even_context(magnitude, 18));
  last_z = load<std::int32_t>(now + 8);
}

void encode_colour(ArithmeticEncoder& encoder, Models& models, const char* last, const char* now) {
  const auto byte = [](const char* colour, int channel, int b) {
    return static_cast<int>(static_cast<unsigned char>(colour[2 * channel + b]));
  };
  unsigned changes = 0;
  for (int i = 0; i < 6; ++i) changes |= now[i] != last[i] ? 1U << i : 0;
  const bool grey = std::memcmp(now, now + 2, 2) == 0 && std::memcmp(now, now + 4, 2) == 0;
  if (!grey) changes |= 64;
  if (grey) changes &= 3;
  models.encode(encoder, 'u', 0, 128, changes);
  const auto encode_byte = [&](int channel, int b, int predicted) {
    if ((changes >> (2 * channel + b) & 1) == 0) return;
    models.encode(encoder, 'c', static_cast<unsigned>(2 * channel + b), 256,
                  static_cast<unsigned>(byte(now, channel, b) - predicted) & 255U);
  };
  for (int b = 0; b < 2; ++b) encode_byte(0, b, byte(last, 0, b));
  for (int b = 0; b < 2 && !grey; ++b) {
    const int red = byte(now, 0, b) - byte(last, 0, b), green = byte(now, 1, b) - byte(last, 1, b);
    encode_byte(1, b, std::clamp(byte(last, 1, b) + red, 0, 255));
    encode_byte(2, b, std::clamp(byte(last, 2, b) + (red + green) / 2, 0, 255));
  }
}

class TimeEncoder {
 public:
  explicit TimeEncoder(std::int64_t first) { times_[0] = first; }

  void encode(ArithmeticEncoder& encoder, Models& models, std::int64_t time) {
    const std::int64_t step = steps_[current_];
    // Wraps as the decoder's sum does.
    const auto distance = static_cast<std::int64_t>(static_cast<std::uint64_t>(time) -
                                                    static_cast<std::uint64_t>(times_[current_]));
    const bool near = fits(time, current_);
    const auto symbol = [&](unsigned without_step, unsigned with_step) {
      models.encode(encoder, step == 0 ? '0' : 't', 0, step == 0 ? 6 : 516,
                    step == 0 ? without_step : with_step);
    };
    if (distance == 0) return symbol(0, 511);
    const auto difference = static_cast<std::int32_t>(distance);
    if (near && step == 0) {
      symbol(1, 0);
      integers_.encode(encoder, 0, difference, 0);
      steps_[current_] = difference;
      extremes_[current_] = 0;
    } else if (near) {
      encode_multiple(encoder, models, difference);
    } else {
      for (unsigned i = 1; i < 4; ++i) {
        if (!fits(time, (current_ + i) % 4)) continue;
        symbol(2 + i, 512 + i);
        current_ = (current_ + i) % 4;
        return encode(encoder, models, time);
      }
      symbol(2, 512);
      integers_.encode(encoder, static_cast<std::int32_t>(times_[current_] >> 32),
                       static_cast<std::int32_t>(time >> 32), 8);
      encoder.encode_bits(static_cast<std::uint32_t>(time), 32);
      newest_ = (newest_ + 1) % 4;
      current_ = newest_;
      steps_[current_] = extremes_[current_] = 0;
    }
    times_[current_] = time;
  }

 private:
  bool fits(std::int64_t time, unsigned sequence) const {
    const auto distance = static_cast<std::int64_t>(static_cast<std::uint64_t>(time) -
                                                    static_cast<std::uint64_t>(times_[sequence]));
    return distance == static_cast<std::int32_t>(distance);
  }
  void encode_multiple(ArithmeticEncoder& encoder, Models& models, std::int32_t difference) {
    std::int32_t& step = steps_[current_];
    const double ratio = std::round(static_cast<double>(difference) / step);
    const int multiple = static_cast<int>(std::clamp(ratio, -10.0, 500.0));
    models.encode(encoder, 't', 0, 516,
                  static_cast<unsigned>(multiple >= 0 ? multiple : 500 - multiple));
    const unsigned context = multiple == 0     ? 7
                             : multiple == 1   ? 1
                             : multiple == -10 ? 6
                             : multiple < 0    ? 5
                             : multiple < 10   ? 2
                             : multiple < 500  ? 3
                                               : 4;
    integers_.encode(encoder,
                     static_cast<std::int32_t>(static_cast<std::uint32_t>(multiple) *
                                               static_cast<std::uint32_t>(step)),
                     difference, context);
    if (multiple == 1) extremes_[current_] = 0;
    if ((multiple == 0 || multiple == 500 || multiple == -10) && ++extremes_[current_] > 3) {
      step = difference;
      extremes_[current_] = 0;
    }
  }

  std::array<std::int64_t, 4> times_{};
  std::array<std::int32_t, 4> steps_{}, extremes_{};
  unsigned current_ = 0, newest_ = 0;
  IntegerEncoder integers_{32, 9};
};

std::string encode_pointwise_chunk(const LasFile& file, const char* records, std::size_t count) {
  const std::size_t size = file.record_size();
  const bool has_time = file.format == 1 || file.format == 3, has_colour = file.format >= 2;
  const std::size_t colour = has_time ? 28 : 20, extra = colour + (has_colour ? 6 : 0);
  ArithmeticEncoder encoder;
  Models models, colours;
  IntegerEncoder intensities(16, 4), sources(16, 1), x(32, 2), y(32, 22), z(32, 20);
  std::array<StreamingMedian, 16> x_steps, y_steps;
  std::array<std::uint16_t, 16> last_intensity{};
  std::array<std::int32_t, 8> last_z{};
  TimeEncoder times(has_time ? load<std::int64_t>(records + 20) : 0);
  for (std::size_t i = 1; i < count; ++i) {
    const char *last = records + (i - 1) * size, *now = last + size;
    const auto byte = [](const char* record, int at) {
      return static_cast<unsigned>(static_cast<unsigned char>(record[at]));
    };
    const unsigned number = byte(now, 14) & 7, returns = byte(now, 14) >> 3 & 7;
    const unsigned map = return_map_of_8(returns, number);
    const auto intensity = load<std::uint16_t>(now + 12);
    const auto changed = [&](int at) { return now[at] != last[at] ? 1U : 0U; };
    const unsigned source = load<std::uint16_t>(now + 18) != load<std::uint16_t>(last + 18) ? 1 : 0;
    const unsigned changes = changed(14) << 5 | (intensity != last_intensity[map] ? 16U : 0U) |
                             changed(15) << 3 | changed(16) << 2 | changed(17) << 1 | source;
    models.encode(encoder, 'n', 0, 64, changes);
    if ((changes & 32) != 0) models.encode(encoder, 'r', byte(last, 14), 256, byte(now, 14));
    if ((changes & 16) != 0) {
      intensities.encode(encoder, last_intensity[map], intensity, std::min(map, 3U));
      last_intensity[map] = intensity;
    }
    if ((changes & 8) != 0) models.encode(encoder, 'k', byte(last, 15), 256, byte(now, 15));
    if ((changes & 4) != 0) {
      models.encode(encoder, 'a', byte(now, 14) >> 6 & 1, 256,
                    (byte(now, 16) - byte(last, 16)) & 255);
    }
    if ((changes & 2) != 0) models.encode(encoder, 'd', byte(last, 17), 256, byte(now, 17));
    if (source != 0) {
      sources.encode(encoder, load<std::uint16_t>(last + 18), load<std::uint16_t>(now + 18), 0);
    }
    const unsigned level = returns > number ? returns - number : number - returns;
    encode_coordinates(encoder, encoder, last, now, x, y, z, x_steps[map], y_steps[map],
                       last_z[level], returns == 1 ? 1 : 0);
    if (has_time) times.encode(encoder, models, load<std::int64_t>(now + 20));
    if (has_colour) encode_colour(encoder, colours, last + colour, now + colour);
    for (std::size_t k = 0; k < file.extra_bytes; ++k) {
      const auto at = static_cast<int>(extra + k);
      models.encode(encoder, 'e', static_cast<unsigned>(k), 256,
                    (byte(now, at) - byte(last, at)) & 255);
    }
  }
  return std::string(records, size) + encoder.finish();
}

// One channel of a scanner. The last record of it is what predicts.
struct Channel {
  bool used = false, time_changed = false;
  std::string last;
  Models models;
  IntegerEncoder x{32, 2}, y{32, 22}, z{32, 20}, intensities{16, 4};
  std::array<StreamingMedian, 12> x_steps, y_steps;
  std::array<std::int32_t, 8> last_z;
  std::array<std::uint16_t, 8> last_intensity;

  void begin(const std::string& record) {
    used = true;
    last = record;
    last_z.fill(load<std::int32_t>(record.data()));
    last_z.fill(load<std::int32_t>(record.data() + 8));
    last_intensity.fill(load<std::uint16_t>(record.data() + 12));
  }
};

struct Returns {
  unsigned number, count;
  explicit Returns(const char* record)
      : number(static_cast<unsigned char>(record[14]) & 15),
        count(static_cast<unsigned char>(record[14]) >> 4) {}
};

unsigned channel_of(const char* record) { return static_cast<unsigned char>(record[15]) >> 4 & 3; }

struct Layers {
  ArithmeticEncoder plane, heights, classes, intensities, colours;
  bool any_height = false, any_class = false, any_intensity = false, any_colour = false;
};

void encode_layered_point(Layers& layers, Channel*& channel, std::array<Channel, 4>& channels,
                          const char* now) {
  const unsigned next = channel_of(now);
  Channel& before = *channel;
  const unsigned from = static_cast<unsigned>(channel - channels.data());
  Channel& after = channels[next];
  const Returns before_returns(before.last.data());
  const unsigned context = (before_returns.number == 1 ? 1U : 0U) +
                           (before_returns.number >= before_returns.count ? 2U : 0U) +
                           (before.time_changed ? 4U : 0U);
  const std::string last = after.used ? after.last : before.last;
  const Returns last_returns(last.data()), returns(now);
  const bool time = std::memcmp(now + 22, last.data() + 22, 8) != 0;
  const unsigned step = (returns.number + 16 - last_returns.number) % 16;
  const unsigned changes = (next != from ? 64U : 0U) | (time ? 16U : 0U) |
                           (returns.count != last_returns.count ? 4U : 0U) |
                           (step == 0    ? 0U
                            : step == 1  ? 1U
                            : step == 15 ? 2U
                                         : 3U);
  before.models.encode(layers.plane, 'n', context, 128, changes);
  if (next != from) {
    before.models.encode(layers.plane, 's', 0, 3, (next + 3 - from) % 4);
    if (!after.used) after.begin(before.last);
    channel = &after;
  }
  if ((changes & 4) != 0) {
    after.models.encode(layers.plane, 'c', last_returns.count, 16, returns.count);
  }
  if ((changes & 3) == 3) {
    if (time) {
      after.models.encode(layers.plane, 'r', last_returns.number, 16, returns.number);
    } else {
      after.models.encode(layers.plane, 'g', 0, 13, step - 2);
    }
  }
  const unsigned map = return_map_of_16(returns.count, returns.number) * 2 + (time ? 1 : 0);
  const unsigned place =
      (returns.number == 1 ? 2U : 0U) + (returns.number >= returns.count ? 1U : 0U);
  const unsigned level = static_cast<unsigned>(
      std::abs(static_cast<int>(returns.count) - static_cast<int>(returns.number)));
  encode_coordinates(layers.plane, layers.heights, last.data(), now, after.x, after.y, after.z,
                     after.x_steps[map], after.y_steps[map], after.last_z[std::min(level, 7U)],
                     returns.count == 1 ? 1 : 0);
  const auto kind = static_cast<unsigned char>(last[16]);
  after.models.encode(layers.classes, 'k', (kind & 31U) * 2 + (place == 3 ? 1 : 0), 256,
                      static_cast<unsigned char>(now[16]));
  std::uint16_t& intensity = after.last_intensity[place * 2 + (time ? 1 : 0)];
  after.intensities.encode(layers.intensities, intensity, load<std::uint16_t>(now + 12), place);
  intensity = load<std::uint16_t>(now + 12);
  after.time_changed = time;
}

// The colours of a chunk, with the slips that version 3 makes over channels.
class LayeredColourEncoder {
 public:
  LayeredColourEncoder(const char* first, unsigned channel, int version)
      : version_(version), current_(channel) {
    last_[channel].assign(first, 6);
  }
  void encode(ArithmeticEncoder& encoder, unsigned channel, bool changed, const char* now) {
    std::string* last = &last_[current_];
    const unsigned next = version_ == 4 || changed ? channel : 0;
    if (next != current_) {
      const bool used = !last_[next].empty();
      if (!used) last_[next] = *last;
      if (!used || version_ == 4) last = &last_[next];
      current_ = next;
    }
    encode_colour(encoder, models_[current_], last->data(), now);
    last->assign(now, 6);
  }

 private:
  int version_;
  unsigned current_;
  std::array<std::string, 4> last_;
  std::array<Models, 4> models_;
};

std::string encode_layered_chunk(const LasFile& file, const LazOptions& options,
                                 const char* records, std::size_t count) {
  const std::size_t size = file.record_size();
  std::array<Channel, 4> channels;
  Channel* channel = &channels[channel_of(records)];
  channel->begin(std::string(records, size));
  std::optional<LayeredColourEncoder> colours;
  if (file.format >= 7) colours.emplace(records + 30, channel_of(records), options.version);
  Layers layers;
  for (std::size_t i = 1; i < count; ++i) {
    const char* now = records + i * size;
    const Channel* before = channel;
    encode_layered_point(layers, channel, channels, now);
    if (colours) colours->encode(layers.colours, channel_of(now), channel != before, now + 30);
    channel->last.assign(now, size);
  }

  // Layers that readers skip are some bytes of anything.
  const std::string skipped = "skipped";
  std::vector<std::string> all = {layers.plane.finish(),
                                  layers.heights.finish(),
                                  layers.classes.finish(),
                                  skipped,
                                  layers.intensities.finish(),
                                  "",
                                  skipped,
                                  "",
                                  skipped};
  if (file.format >= 7) all.push_back(layers.colours.finish());
  if (file.format == 8) all.push_back(skipped);
  for (std::size_t i = 0; i < file.extra_bytes; ++i) all.emplace_back();
  std::string chunk(records, size);
  put(chunk, static_cast<std::uint32_t>(count));
  for (const std::string& layer : all) put(chunk, static_cast<std::uint32_t>(layer.size()));
  for (const std::string& layer : all) chunk += layer;
  return chunk;
}

// Header and records between header and points.
std::string encode_header(const LasFile& file, const std::string& records, bool compressed) {
  const bool new_format = file.format >= 6;
  std::string header(new_format ? 375 : 227, '\0');
  header.replace(0, 4, "LASF");
  put_at(header, 24, std::uint8_t{1});
  put_at(header, 25, static_cast<std::uint8_t>(new_format ? 4 : 2));
  put_at(header, 94, static_cast<std::uint16_t>(header.size()));
  put_at(header, 96, static_cast<std::uint32_t>(header.size() + records.size()));
  put_at(header, 100, std::uint32_t{records.empty() ? 0U : 1U});
  put_at(header, 104, static_cast<std::uint8_t>(file.format | (compressed ? 128 : 0)));
  put_at(header, 105, static_cast<std::uint16_t>(file.record_size()));
  if (!new_format) put_at(header, 107, static_cast<std::uint32_t>(file.count()));
  if (new_format) put_at(header, 247, std::uint64_t{file.count()});
  for (int k = 0; k < 3; ++k) put_at(header, 131 + 8 * k, 0.01);
  return header + records;
}

std::string encode_description(const LasFile& file, const LazOptions& options) {
  struct Item {
    std::uint16_t type, size;
  };
  std::vector<Item> items;
  const bool layered = file.format >= 6;
  if (layered) {
    items = {{10, 30}};
    if (file.format == 7) items.push_back({11, 6});
    if (file.format == 8) items.push_back({12, 8});
  } else {
    items = {{6, 20}};
    if (file.format == 1 || file.format == 3) items.push_back({7, 8});
    if (file.format >= 2) items.push_back({8, 6});
  }
  if (file.extra_bytes > 0) {
    items.push_back({static_cast<std::uint16_t>(layered ? 14 : 0),
                     static_cast<std::uint16_t>(file.extra_bytes)});
  }
  std::string content;
  put(content, static_cast<std::uint16_t>(layered ? 3 : 2));
  put(content, std::uint16_t{0});
  content.append("\3\4\3\0", 4);
  put(content, std::uint32_t{0});
  put(content, options.variable ? std::numeric_limits<std::uint32_t>::max()
                                : static_cast<std::uint32_t>(options.chunks.front()));
  put(content, std::int64_t{-1});
  put(content, std::int64_t{-1});
  put(content, static_cast<std::uint16_t>(items.size()));
  for (const Item& item : items) {
    put(content, item.type);
    put(content, item.size);
    put(content, static_cast<std::uint16_t>(layered ? options.version : 2));
  }
  std::string record(54, '\0');
  record.replace(2, 14, "laszip encoded");
  put_at(record, 18, std::uint16_t{22204});
  put_at(record, 20, static_cast<std::uint16_t>(content.size()));
  return record + content;
}

}  // namespace

std::size_t LasFile::record_size() const { return kRecordSizes[format] + extra_bytes; }

std::string encode_las(const LasFile& file) {
  return encode_header(file, "", false) + file.records;
}

std::string encode_laz(const LasFile& file, const LazOptions& options) {
  std::string bytes = encode_header(file, encode_description(file, options), true);
  const std::size_t position = bytes.size();
  put(bytes, std::int64_t{-1});
  ArithmeticEncoder table;
  IntegerEncoder integers(32, 2);
  std::int32_t last_count = 0, last_bytes = 0;
  std::uint32_t chunks = 0;
  for (std::size_t first = 0; first < file.count(); ++chunks) {
    const std::size_t count =
        std::min(options.chunks[std::min<std::size_t>(chunks, options.chunks.size() - 1)],
                 file.count() - first);
    const char* records = file.records.data() + first * file.record_size();
    const std::string chunk = file.format >= 6 ? encode_layered_chunk(file, options, records, count)
                                               : encode_pointwise_chunk(file, records, count);
    if (options.variable) {
      integers.encode(table, last_count, static_cast<std::int32_t>(count), 0);
      last_count = static_cast<std::int32_t>(count);
    }
    integers.encode(table, last_bytes, static_cast<std::int32_t>(chunk.size()), 1);
    last_bytes = static_cast<std::int32_t>(chunk.size());
    bytes += chunk;
    first += count;
  }
  const auto at = static_cast<std::int64_t>(bytes.size());
  put(bytes, std::uint32_t{0});
  put(bytes, chunks);
  bytes += table.finish();
  if (options.table_at_end) {
    put(bytes, at);
  } else {
    put_at(bytes, position, at);
  }
  return bytes;
}

}  // namespace delray::tests
