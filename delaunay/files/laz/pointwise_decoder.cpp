// LAZ points of the formats 0 to 3, version 2 of their items: every field of a point is coded as
// the difference to, or in the context of, that of the point before, x and y by the median of the
// last steps of points with as many returns (Isenburg, LASzip: lossless compression of LiDAR data,
// 2013).
#include "delaunay/files/laz/pointwise_decoder.h"

#include "delaunay/files/las_header.h"

namespace delray::delaunay::laz {
namespace {

// Of a record.
constexpr std::size_t kPointwiseClass = 15, kScanAngle = 16, kUserData = 17, kSource = 18,
                      kPointwiseSize = 20;

// Which predictor of steps and of intensity a point has, by its number of returns and its own
// number.
constexpr std::uint8_t kPointwiseReturnMap[8][8] = {
    {15, 14, 13, 12, 11, 10, 9, 8},  {14, 0, 1, 3, 6, 10, 10, 9},
    {13, 1, 2, 4, 7, 11, 11, 10},    {12, 3, 4, 5, 8, 12, 12, 11},
    {11, 6, 7, 8, 9, 13, 13, 12},    {10, 10, 11, 12, 13, 14, 14, 13},
    {9, 10, 11, 12, 13, 14, 15, 14}, {8, 9, 10, 11, 12, 13, 14, 15},
};

unsigned decode_byte(ArithmeticDecoder& decoder, SymbolModel& model) {
  if (!model.ready()) model.reset(256);
  return decoder.decode(model);
}

// The symbols of times. With a step: 0 to 500 and, above, -1 to -10 times the step, the same time
// again, another sequence. Without: 0 the same time, 1 a step, 2 and more another sequence.
constexpr int kMostSteps = 500, kFewestSteps = -10;
constexpr unsigned kSameTime = kMostSteps - kFewestSteps + 1, kNewSequence = kSameTime + 1,
                   kSymbols = kNewSequence + 4;
// Contexts of the difference to the predicted step.
enum StepContext { from_zero, once, few, several, most, negative, fewest, none, upper_half };

}  // namespace

void TimeDecoder::reset(std::int64_t first) {
  sequences_ = {};
  sequences_[0].time = first;
  current_ = newest_ = 0;
  multiples_.reset(kSymbols);
  multiples_of_zero_.reset(6);
  steps_.reset();
}

void TimeDecoder::begin_sequence(ArithmeticDecoder& decoder) {
  newest_ = (newest_ + 1) % sequences_.size();
  const auto last = static_cast<std::uint64_t>(sequences_[current_].time);
  const auto high = static_cast<std::uint32_t>(
      steps_.decode(decoder, static_cast<std::int32_t>(last >> 32), upper_half));
  const std::uint64_t time = static_cast<std::uint64_t>(high) << 32 | decoder.decode_bits(32);
  current_ = newest_;
  sequences_[current_] = {static_cast<std::int64_t>(time)};
}

void TimeDecoder::count_extreme(std::int32_t step) {
  constexpr int kInARow = 3;
  Sequence& sequence = sequences_[current_];
  if (++sequence.extremes <= kInARow) return;
  sequence.step = step;
  sequence.extremes = 0;
}

bool TimeDecoder::decode_without_step(ArithmeticDecoder& decoder) {
  const unsigned symbol = decoder.decode(multiples_of_zero_);
  if (symbol == 1) {
    Sequence& sequence = sequences_[current_];
    sequence.step = steps_.decode(decoder, 0, from_zero);
    sequence.time =
        static_cast<std::int64_t>(static_cast<std::uint64_t>(sequence.time) +
                                  static_cast<std::uint64_t>(std::int64_t{sequence.step}));
    sequence.extremes = 0;
  } else if (symbol == 2) {
    begin_sequence(decoder);
  } else if (symbol > 2) {
    current_ = (current_ + symbol - 2) % sequences_.size();
    return true;
  }
  return false;
}

bool TimeDecoder::decode_with_step(ArithmeticDecoder& decoder) {
  const unsigned symbol = decoder.decode(multiples_);
  if (symbol == kNewSequence) {
    begin_sequence(decoder);
  } else if (symbol > kNewSequence) {
    current_ = (current_ + symbol - kNewSequence) % sequences_.size();
    return true;
  }
  if (symbol >= kSameTime) return false;

  const int multiple =
      symbol <= kMostSteps ? static_cast<int>(symbol) : kMostSteps - static_cast<int>(symbol);
  constexpr int kFew = 10;
  const StepContext context = multiple == 0              ? none
                              : multiple == 1            ? once
                              : multiple == kFewestSteps ? fewest
                              : multiple < 0             ? negative
                              : multiple < kFew          ? few
                              : multiple < kMostSteps    ? several
                                                         : most;
  Sequence& sequence = sequences_[current_];
  const auto predicted = static_cast<std::int32_t>(static_cast<std::uint32_t>(multiple) *
                                                   static_cast<std::uint32_t>(sequence.step));
  const std::int32_t step = steps_.decode(decoder, predicted, context);
  if (context == once) sequence.extremes = 0;
  if (context == none || context == most || context == fewest) count_extreme(step);
  sequence.time = static_cast<std::int64_t>(static_cast<std::uint64_t>(sequence.time) +
                                            static_cast<std::uint64_t>(std::int64_t{step}));
  return false;
}

std::int64_t TimeDecoder::decode(ArithmeticDecoder& decoder) {
  // Damaged bytes could change sequences for ever.
  while (!decoder.overrun() && (sequences_[current_].step == 0 ? decode_without_step(decoder)
                                                               : decode_with_step(decoder))) {
  }
  return sequences_[current_].time;
}

PointwiseDecoder::PointwiseDecoder(const PointwiseItems& items)
    : items_(items),
      returns_(256),
      classifications_(256),
      user_data_(256),
      intensities_(16, 4),
      sources_(16, 1),
      x_(32, 2),
      y_(32, 22),
      z_(32, 20),
      extra_bytes_(items.extra_bytes) {}

void PointwiseDecoder::reset(const char* first) {
  changes_.reset(64);
  for (auto* models : {&returns_, &classifications_, &user_data_}) {
    for (SymbolModel& model : *models) model.clear();
  }
  for (SymbolModel& model : scan_angles_) model.reset(256);
  for (IntegerDecoder* integers : {&intensities_, &sources_, &x_, &y_, &z_}) integers->reset();
  x_steps_ = {};
  y_steps_ = {};
  last_intensity_ = {};
  last_z_ = {};
  if (items_.time) times_.reset(load<std::int64_t>(first + kPointwiseSize));
  if (items_.colour) colours_.reset();
  for (SymbolModel& model : extra_bytes_) model.reset(256);
}

void PointwiseDecoder::decode_point(ArithmeticDecoder& decoder, const char* last, char* record) {
  const auto byte = [&](std::size_t at) { return static_cast<unsigned char>(last[at]); };
  std::memcpy(record, last, kPointwiseSize);

  const unsigned changes = decoder.decode(changes_);
  if ((changes & 32) != 0) {
    record[kLasReturns] = static_cast<char>(decode_byte(decoder, returns_[byte(kLasReturns)]));
  }
  const auto returns = static_cast<unsigned char>(record[kLasReturns]);
  const unsigned number = returns & 7, count = returns >> 3 & 7;
  const unsigned map = kPointwiseReturnMap[count][number];
  const unsigned level = count > number ? count - number : number - count;
  const unsigned single = count == 1 ? 1 : 0;
  if (changes != 0) {
    if ((changes & 16) != 0) {
      last_intensity_[map] = static_cast<std::uint16_t>(
          intensities_.decode(decoder, last_intensity_[map], std::min(map, 3U)));
    }
    store(record + kLasIntensity, last_intensity_[map]);
  }
  if ((changes & 8) != 0) {
    record[kPointwiseClass] =
        static_cast<char>(decode_byte(decoder, classifications_[byte(kPointwiseClass)]));
  }
  if ((changes & 4) != 0) {
    record[kScanAngle] =
        static_cast<char>(byte(kScanAngle) + decoder.decode(scan_angles_[returns >> 6 & 1]));
  }
  if ((changes & 2) != 0) {
    record[kUserData] = static_cast<char>(decode_byte(decoder, user_data_[byte(kUserData)]));
  }
  if ((changes & 1) != 0) {
    store(record + kSource, static_cast<std::uint16_t>(
                                sources_.decode(decoder, load<std::uint16_t>(last + kSource), 0)));
  }

  const std::int32_t dx = x_.decode(decoder, x_steps_[map].get(), single);
  x_steps_[map].add(dx);
  store(record + kLasX, add(load<std::int32_t>(last + kLasX), dx));
  const std::int32_t dy =
      y_.decode(decoder, y_steps_[map].get(), single + even_context(x_.magnitude(), 20));
  y_steps_[map].add(dy);
  store(record + kLasY, add(load<std::int32_t>(last + kLasY), dy));
  const unsigned magnitude = (x_.magnitude() + y_.magnitude()) / 2;
  last_z_[level] = z_.decode(decoder, last_z_[level], single + even_context(magnitude, 18));
  store(record + kLasZ, last_z_[level]);
}

bool PointwiseDecoder::decode(std::string_view chunk, std::span<char> records) {
  const std::size_t size = items_.record_size();
  if (chunk.size() < size) return false;
  std::memcpy(records.data(), chunk.data(), size);
  reset(chunk.data());
  if (records.size() == size) return true;

  ArithmeticDecoder decoder(chunk.substr(size));
  const std::size_t time = kPointwiseSize, colour = time + (items_.time ? 8 : 0),
                    extra = colour + (items_.colour ? 6 : 0);
  // Of the first point the second one sees no intensity.
  std::array<char, kPointwiseSize> first;
  std::memcpy(first.data(), records.data(), kPointwiseSize);
  store(first.data() + kLasIntensity, std::uint16_t{0});
  for (std::size_t at = size; at < records.size(); at += size) {
    char* record = records.data() + at;
    const char* last = record - size;
    decode_point(decoder, at == size ? first.data() : last, record);
    if (items_.time) store(record + time, times_.decode(decoder));
    if (items_.colour) {
      store(record + colour, colours_.decode(decoder, load<Colour>(last + colour)));
    }
    for (std::size_t i = 0; i < items_.extra_bytes; ++i) {
      record[extra + i] = static_cast<char>(static_cast<unsigned char>(last[extra + i]) +
                                            decoder.decode(extra_bytes_[i]));
    }
    if (decoder.overrun()) return false;
  }
  return true;
}

}  // namespace delray::delaunay::laz
