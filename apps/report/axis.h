// An axis of a chart: from values to positions, and where its ticks are.
#pragma once

#include <span>
#include <string>
#include <vector>

namespace delray::apps::report {

enum class Scale { linear, logarithmic };

struct Tick {
  double value;
  std::string label;
};

// Covers a range of values; position() gives 0 at its lower and 1 at its upper end.
class Axis {
 public:
  // Around all finite values, of a logarithmic axis those above 0; [0, 1] or [1, 10] if there are
  // none. A linear axis starts at 0 unless values are negative.
  Axis(std::span<const double> values, Scale scale);

  double position(double value) const;
  // At 1, 2 and 5 times powers of ten, at powers of ten alone where that would be too many, or
  // closer together where it would be too few; at least two.
  std::vector<Tick> ticks() const;
  // At the values themselves, each once, where they are few enough to be told apart.
  static std::vector<Tick> ticks_at(std::span<const double> values);

 private:
  Scale scale_;
  double low_, high_;
};

}  // namespace delray::apps::report
