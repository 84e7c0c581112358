// The table of choices of returns.
#include "delaunay/point_filter.h"

namespace delray::delaunay {
namespace {

// Points that say nothing of returns, 0 of 0, count as the only one of their pulse.
constexpr std::array kReturnChoices = {
    ReturnChoice{"first", "the first return of each pulse, single ones included",
                 [](int number, int) { return number <= 1; }},
    ReturnChoice{"last", "the last return of each pulse, single ones included",
                 [](int number, int count) { return number >= count; }},
    ReturnChoice{"only", "returns of pulses that came back but once",
                 [](int, int count) { return count <= 1; }},
    ReturnChoice{"intermediate", "returns between the first and the last of their pulse",
                 [](int number, int count) { return number > 1 && number < count; }},
    ReturnChoice{"first-of-many", "first returns of pulses that came back several times",
                 [](int number, int count) { return number <= 1 && count > 1; }},
    ReturnChoice{"last-of-many", "last returns of pulses that came back several times",
                 [](int number, int count) { return number >= count && count > 1; }},
};

}  // namespace

std::span<const ReturnChoice> return_choices() { return kReturnChoices; }

}  // namespace delray::delaunay
