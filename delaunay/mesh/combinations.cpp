// Enumerates the legal options from the table of methods in nested loops; an empty choice becomes
// "none".
#include "delaunay/combinations.h"

#include <algorithm>
#include <string_view>

#include "delaunay/methods.h"

namespace delray::delaunay {
namespace {

using Names = std::vector<std::string_view>;

Names or_none(const Names& names) { return names.empty() ? Names{"none"} : names; }
Names default_of(const Names& names) { return {or_none(names).front()}; }

}  // namespace

std::vector<Options> combinations(int dim) {
  std::vector<Options> result;
  for (const Method& method : methods()) {
    if (std::ranges::find(method.dims, dim) == method.dims.end()) continue;
    Options options;
    options.dim = dim;
    options.method = method.name;
    for (const auto location : or_none(locations_for(method, dim))) {
      options.location = location;
      for (const auto split : or_none(method.splits)) {
        options.split = split;
        const Names orders = or_none(orders_for(method, location));
        for (const auto order : orders) {
          options.order = order;
          const bool is_default =
              split == default_of(method.splits).front() && order == orders.front();
          for (const auto strategy : or_none(method.deadlocks)) {
            options.deadlocks = strategy;
            for (const auto kind : is_default ? or_none(method.locks) : default_of(method.locks)) {
              options.locks = kind;
              for (const auto time :
                   is_default ? or_none(method.unlocks) : default_of(method.unlocks)) {
                options.unlock = time;
                result.push_back(options);
              }
            }
          }
        }
      }
    }
  }
  return result;
}

std::vector<Options> locations_and_orders(int dim) {
  std::vector<Options> result = combinations(dim);
  std::erase_if(result, [](const Options& options) {
    Options plain;
    plain.dim = options.dim;
    plain.method = options.method;
    plain.location = options.location;
    plain.order = options.order;
    return name_of(resolve(plain)) != name_of(options);
  });
  return result;
}

std::string name_of(const Options& options) {
  return options.method + "/" + options.location + "/" + options.split + "/" + options.order + "/" +
         options.deadlocks + "/" + options.locks + "/" + options.unlock;
}

}  // namespace delray::delaunay
