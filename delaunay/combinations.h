// Everything that the table of methods allows together: tests, benchmarks and reports run it.
#pragma once

#include <string>
#include <vector>

#include "delaunay/triangulate.h"

namespace delray::delaunay {

// All legal methods, locations, splits, orders and deadlock strategies in a dimension, in the order
// of the tables, and with the first split and order all kinds of locks and times of unlocking; the
// rest of the options is as by default. "none" where a method leaves no choice.
std::vector<Options> combinations(int dim);

// The combinations with the method's default split, deadlock strategy, kind of locks and time of
// unlocking: every method with every location and order.
std::vector<Options> locations_and_orders(int dim);

// "optimistic/dag/curve/brio/detection/atomic/end".
std::string name_of(const Options& options);

}  // namespace delray::delaunay
