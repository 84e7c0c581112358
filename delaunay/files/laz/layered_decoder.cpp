// LAZ points of the formats 6 to 8: each field has a stream of its own, so that fields that nobody
// asks for are skipped, and each of the four channels of a scanner has models and a last point of
// its own (Isenburg, LASzip for LAS 1.4 (native extension), specification document, 2014).
#include "delaunay/files/laz/layered_decoder.h"

#include <algorithm>

#include "delaunay/files/las_header.h"
#include "delaunay/files/laz/laz_items.h"

namespace delray::delaunay::laz {
namespace {

// Of a record.
constexpr std::size_t kFlags = 15, kLayeredClass = 16, kLayeredSize = 30;
// The layers that are read, in the order of the nine that every chunk has.
constexpr std::size_t kPlane = 0, kHeights = 1, kClasses = 2, kIntensities = 4, kLayers = 9;

// Which predictor of steps a point has, by its number of returns and its own number: single, first
// of two, second of two, first, middle and last of several. Numbers that no pulse has fall in
// somewhere.
constexpr std::uint8_t kLayeredReturnMap[16][16] = {
    {0, 1, 2, 3, 4, 5, 3, 4, 4, 5, 5, 5, 5, 5, 5, 5},
    {1, 0, 1, 3, 3, 3, 3, 3, 3, 3, 3, 3, 3, 3, 3, 3},
    {2, 1, 2, 4, 4, 4, 4, 4, 4, 4, 4, 3, 3, 3, 3, 3},
    {3, 3, 4, 5, 4, 4, 4, 4, 4, 4, 4, 4, 4, 4, 4, 4},
    {4, 3, 4, 4, 5, 4, 4, 4, 4, 4, 4, 4, 4, 4, 4, 4},
    {5, 3, 4, 4, 4, 5, 4, 4, 4, 4, 4, 4, 4, 4, 4, 4},
    {3, 3, 4, 4, 4, 4, 5, 4, 4, 4, 4, 4, 4, 4, 4, 4},
    {4, 3, 4, 4, 4, 4, 4, 5, 4, 4, 4, 4, 4, 4, 4, 4},
    {4, 3, 4, 4, 4, 4, 4, 4, 5, 4, 4, 4, 4, 4, 4, 4},
    {5, 3, 4, 4, 4, 4, 4, 4, 4, 5, 4, 4, 4, 4, 4, 4},
    {5, 3, 4, 4, 4, 4, 4, 4, 4, 4, 5, 4, 4, 4, 4, 4},
    {5, 3, 3, 4, 4, 4, 4, 4, 4, 4, 4, 5, 5, 4, 4, 4},
    {5, 3, 3, 4, 4, 4, 4, 4, 4, 4, 4, 5, 5, 5, 4, 4},
    {5, 3, 3, 4, 4, 4, 4, 4, 4, 4, 4, 4, 5, 5, 5, 4},
    {5, 3, 3, 4, 4, 4, 4, 4, 4, 4, 4, 4, 4, 5, 5, 5},
    {5, 3, 3, 4, 4, 4, 4, 4, 4, 4, 4, 4, 4, 4, 5, 5},
};

struct Point {
  std::int32_t x = 0, y = 0, z = 0;
  std::uint16_t intensity = 0;
  std::uint8_t number = 0, count = 0;  // of the return, of returns
  std::uint8_t classification = 0;
};

Point parse_point(const char* record) {
  const auto returns = load<std::uint8_t>(record + kLasReturns);
  return {load<std::int32_t>(record + kLasX),        load<std::int32_t>(record + kLasY),
          load<std::int32_t>(record + kLasZ),        load<std::uint16_t>(record + kLasIntensity),
          static_cast<std::uint8_t>(returns & 15),   static_cast<std::uint8_t>(returns >> 4),
          load<std::uint8_t>(record + kLayeredClass)};
}

void store_point(char* record, const Point& point, unsigned channel) {
  store(record + kLasX, point.x);
  store(record + kLasY, point.y);
  store(record + kLasZ, point.z);
  store(record + kLasIntensity, point.intensity);
  record[kLasReturns] = static_cast<char>(point.number | point.count << 4);
  record[kFlags] = static_cast<char>((record[kFlags] & 0xcf) | channel << 4);
  record[kLayeredClass] = static_cast<char>(point.classification);
}

unsigned decode_lazily(ArithmeticDecoder& decoder, SymbolModel& model, unsigned symbols) {
  if (!model.ready()) model.reset(symbols);
  return decoder.decode(model);
}

// What the first symbol of a point says has changed since the last point of its channel.
struct Changes {
  unsigned bits;
  unsigned number() const { return bits & 3; }  // 0: same, 1: next, 2: previous, 3: another
  bool count() const { return (bits & 4) != 0; }
  bool time() const { return (bits & 16) != 0; }
  bool channel() const { return (bits & 64) != 0; }
};

}  // namespace

struct LayeredDecoder::Layers {
  ArithmeticDecoder plane, heights, classes, intensities;
  bool has_heights, has_classes, has_intensities;  // those without bytes: nothing changes

  bool overrun() const {
    return plane.overrun() || (has_heights && heights.overrun()) ||
           (has_classes && classes.overrun()) || (has_intensities && intensities.overrun());
  }
};

struct LayeredDecoder::Channel {
  bool used = false;
  Point last;
  bool time_changed = false;

  std::array<SymbolModel, 8> changes;
  SymbolModel channel_steps, number_steps;
  std::array<SymbolModel, 16> counts, numbers;
  std::array<SymbolModel, 64> classifications;
  IntegerDecoder x{32, 2}, y{32, 22}, z{32, 20}, intensities{16, 4};
  std::array<StreamingMedian, 12> x_steps, y_steps;
  std::array<std::int32_t, 8> last_z;
  std::array<std::uint16_t, 8> last_intensity;

  void begin(const Point& point) {
    used = true;
    last = point;
    time_changed = false;
    for (SymbolModel& model : changes) model.clear();
    channel_steps.clear();
    number_steps.clear();
    for (SymbolModel& model : counts) model.clear();
    for (SymbolModel& model : numbers) model.clear();
    for (SymbolModel& model : classifications) model.clear();
    for (IntegerDecoder* integers : {&x, &y, &z, &intensities}) integers->reset();
    x_steps.fill({});
    y_steps.fill({});
    last_z.fill(point.z);
    last_intensity.fill(point.intensity);
  }

  Changes decode_changes(Layers& layers) {
    const unsigned context = (last.number == 1 ? 1U : 0U) + (last.number >= last.count ? 2U : 0U) +
                             (time_changed ? 4U : 0U);
    return {decode_lazily(layers.plane, changes[context], 128)};
  }

  unsigned decode_number(Layers& layers, Changes now) {
    switch (now.number()) {
      case 0:
        return last.number;
      case 1:
        return (last.number + 1U) % 16;
      case 2:
        return (last.number + 15U) % 16;
      default:
        if (now.time()) return decode_lazily(layers.plane, numbers[last.number], 16);
        return (last.number + 2 + decode_lazily(layers.plane, number_steps, 13)) % 16;
    }
  }

  void decode_point(Layers& layers, Changes now) {
    if (now.count()) {
      last.count = static_cast<std::uint8_t>(decode_lazily(layers.plane, counts[last.count], 16));
    }
    last.number = static_cast<std::uint8_t>(decode_number(layers, now));
    time_changed = now.time();
    const unsigned map = kLayeredReturnMap[last.count][last.number] * 2U + (now.time() ? 1 : 0);
    const unsigned single = last.count == 1 ? 1 : 0;
    // 3: single, 2: first, 1: last, 0: one in between.
    const unsigned place = (last.number == 1 ? 2U : 0U) + (last.number >= last.count ? 1U : 0U);

    const std::int32_t dx = x.decode(layers.plane, x_steps[map].get(), single);
    x_steps[map].add(dx);
    last.x = add(last.x, dx);
    const std::int32_t dy =
        y.decode(layers.plane, y_steps[map].get(), single + even_context(x.magnitude(), 20));
    y_steps[map].add(dy);
    last.y = add(last.y, dy);
    if (layers.has_heights) {
      const int above = last.count - last.number;
      std::int32_t& height = last_z[std::min(above < 0 ? -above : above, 7)];
      const unsigned magnitude = (x.magnitude() + y.magnitude()) / 2;
      height = z.decode(layers.heights, height, single + even_context(magnitude, 18));
      last.z = height;
    }
    if (layers.has_classes) {
      const unsigned context = (last.classification & 31U) * 2 + (place == 3 ? 1 : 0);
      last.classification =
          static_cast<std::uint8_t>(decode_lazily(layers.classes, classifications[context], 256));
    }
    if (layers.has_intensities) {
      std::uint16_t& intensity = last_intensity[place * 2 + (now.time() ? 1 : 0)];
      intensity =
          static_cast<std::uint16_t>(intensities.decode(layers.intensities, intensity, place));
      last.intensity = intensity;
    }
  }
};

LayeredDecoder::LayeredDecoder(const LayeredItems& items) : items_(items) {}
LayeredDecoder::~LayeredDecoder() = default;

LayeredDecoder::Channel& LayeredDecoder::change_channel(unsigned channel) {
  const Point& last = channels_[current_]->last;
  std::unique_ptr<Channel>& next = channels_[channel];
  if (next == nullptr) next = std::make_unique<Channel>();
  if (!next->used) next->begin(last);
  current_ = channel;
  return *next;
}

bool LayeredDecoder::decode(std::string_view chunk, std::span<char> records) {
  const std::size_t size = items_.record_size();
  if (chunk.size() < size) return false;
  std::memcpy(records.data(), chunk.data(), size);
  if (records.size() == size) return true;

  // Behind the first point comes the number of points, then the size of each layer, then the
  // layers.
  const std::size_t colours = kLayers, count = kLayers + (items_.colour ? 1 : 0) +
                                               (items_.near_infrared ? 1 : 0) + items_.extra_bytes;
  const std::size_t sizes = size + 4;
  if (chunk.size() < sizes + 4 * count) return false;
  std::array<std::string_view, kLayers + 1> layer;
  std::string_view rest = chunk.substr(sizes + 4 * count);
  for (std::size_t i = 0; i < std::min(count, layer.size()); ++i) {
    const std::size_t bytes = load<std::uint32_t>(chunk.data() + sizes + 4 * i);
    if (bytes > rest.size()) return false;
    layer[i] = rest.substr(0, bytes);
    rest.remove_prefix(bytes);
  }
  Layers layers{ArithmeticDecoder(layer[kPlane]),   ArithmeticDecoder(layer[kHeights]),
                ArithmeticDecoder(layer[kClasses]), ArithmeticDecoder(layer[kIntensities]),
                !layer[kHeights].empty(),           !layer[kClasses].empty(),
                !layer[kIntensities].empty()};

  for (auto& each : channels_) {
    if (each != nullptr) each->used = false;
  }
  const char* first = records.data();
  current_ = load<std::uint8_t>(first + kFlags) >> 4 & 3;
  if (channels_[current_] == nullptr) channels_[current_] = std::make_unique<Channel>();
  channels_[current_]->begin(parse_point(first));
  if (items_.colour) {
    colours_.reset(layer[colours], load<Colour>(first + kLayeredSize), current_, items_.version);
  }
  Channel* channel = channels_[current_].get();
  for (std::size_t at = size; at < records.size(); at += size) {
    char* record = records.data() + at;
    std::memcpy(record, first, size);
    const Changes now = channel->decode_changes(layers);
    if (now.channel()) {
      const unsigned steps = 1 + decode_lazily(layers.plane, channel->channel_steps, 3);
      channel = &change_channel((current_ + steps) % 4);
    }
    channel->decode_point(layers, now);
    store_point(record, channel->last, current_);
    if (items_.colour) {
      store(record + kLayeredSize, colours_.decode(current_, now.channel()));
    }
    if (layers.overrun() || colours_.overrun()) return false;
  }
  return true;
}

}  // namespace delray::delaunay::laz
